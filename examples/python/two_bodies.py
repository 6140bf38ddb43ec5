"""A block on a block whose cells do not match, meshes as arrays: the uniform state, to the last digits."""

# %% Meshes as any program has them: points, cells, and names for parts of the surface.
import numpy as np

import dpana


def rectangle(x, y, cells):
    xs, ys = np.meshgrid(np.linspace(*x, cells[0] + 1), np.linspace(*y, cells[1] + 1))
    points = np.column_stack([xs.ravel(), ys.ravel()])
    node = np.arange(len(points)).reshape(xs.shape)
    quads = np.stack([node[:-1, :-1], node[:-1, 1:], node[1:, 1:], node[1:, :-1]], axis=-1)
    mesh = dpana.Mesh(points, {"quad4": quads.reshape(-1, 4)})
    for name, axis, at in [("bottom", 1, y[0]), ("top", 1, y[1]), ("left", 0, x[0])]:
        mesh = mesh.with_surface(name, points[:, axis] == at)
    return mesh


def block(name, mesh, *supports):
    symmetry = {"group": "left", "displacement": [0, None]}
    return {
        "name": name,
        "mesh": mesh,
        "model": "plane_strain",
        "materials": [{"young": 1000, "poisson": 0.3}],
        "supports": [symmetry, *supports],
    }


# %% A scene: bodies, contacts, and what may be left out.
scene = dpana.Scene(
    bodies=[
        block("upper", rectangle((0, 1), (1, 2), (7, 7)), {"group": "top", "displacement": [None, -0.02]}),
        block("lower", rectangle((0, 1), (0, 1), (5, 5)), {"group": "bottom", "displacement": [None, 0]}),
    ],
    contacts=[
        {"body": "upper", "group": "bottom", "against": {"body": "lower", "group": "top"}, "friction": 0.3}
    ],
)
result = scene.solve()
print(result.summary())

# %% Plane strain under a strain of 1 %: p = E ε / (1 − ν²) at every contact.
pressure = 1000 * 0.01 / (1 - 0.3**2)
error = np.abs(result.contacts.pressure / pressure - 1).max()
print("\nlargest error of the pressure:", error)
assert result.certified and error < 1e-10

# %% Stresses of either body, (nodes, 6) in the order xx, yy, zz, yz, xz, xy.
for body in result.bodies:
    stress = result.stress(body)
    print(body, "largest stress:", np.abs(stress).max())
    assert np.allclose(stress[:, 1], -pressure)
