"""Against closed forms and statics; meshes from arrays and from meshio."""

import meshio
import numpy as np
import pytest
from conftest import SCENES, block

import dpana


def squares(nx, ny):
    """Points and quadrilaterals of a rectangle of 2 by 1, written as any program would."""
    x, y = np.meshgrid(np.linspace(0, 2, nx + 1), np.linspace(0, 1, ny + 1))
    at = np.arange((nx + 1) * (ny + 1)).reshape(ny + 1, nx + 1)
    corners = [at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]]
    return np.column_stack([x.ravel(), y.ravel()]), np.stack(corners, axis=-1).reshape(-1, 4)


def pressed(mesh, nu=0.3):
    """The block on a smooth line, its top lowered by 0.01: uniaxial in plane strain."""
    scene = block([None, -0.01], friction=0)
    scene["bodies"][0] |= {"mesh": mesh, "materials": [{"young": 1000, "poisson": nu}]}
    scene["bodies"][0]["supports"].append({"group": "left", "displacement": [0, None]})
    return dpana.Scene.from_dict(scene)


def assert_uniform(result, nu=0.3):
    # Plane strain: p = E ε / (1 − ν²), ε_x = ν / (1 − ν) ε.
    points, found = result.mesh().points, result.displacement()
    exact = np.column_stack([nu / (1 - nu) * 0.01 * points[:, 0], -0.01 * points[:, 1]])
    assert np.abs(found - exact).max() < 1e-14
    assert np.allclose(result.contacts.pressure, 10 / (1 - nu**2), rtol=1e-11)
    stress = result.stress()
    assert stress.shape == (len(points), 6)
    assert np.allclose(stress[:, 1], -10 / (1 - nu**2), rtol=1e-11)
    assert np.allclose(result.cell_stress()[:, 2], -10 * nu / (1 - nu**2), rtol=1e-11)


def test_a_mesh_of_arrays_carries_the_uniform_state():
    points, cells = squares(5, 3)
    mesh = dpana.Mesh(points, {"quad4": cells})
    mesh = mesh.with_surface("bottom", lambda x: x[:, 1] == 0)
    mesh = mesh.with_surface("top", points[:, 1] == 1)
    mesh = mesh.with_nodes("left", np.flatnonzero(points[:, 0] == 0))
    assert dict(mesh.groups) == {"bottom": "facets", "left": "nodes", "top": "facets"}
    assert np.array_equal(mesh.cells["quad4"], cells) and np.array_equal(mesh.points, points)
    assert_uniform(pressed(mesh).solve())


def test_a_meshio_mesh_with_sets_carries_the_uniform_state():
    points, cells = squares(4, 3)
    # A point that no cell has, in front, and z = 0, as meshio's readers give.
    points = np.vstack([[9.0, 9.0], points])
    points = np.column_stack([points, np.zeros(len(points))])
    lines = [[a + 1, b + 1] for a, b in zip(range(4), range(1, 5))]
    mesh = meshio.Mesh(
        points,
        [("line", lines), ("quad", cells + 1)],
        cell_sets={"bottom": [np.arange(4), []], "all": [[], np.arange(len(cells))]},
        point_sets={
            "top": np.flatnonzero(points[:, 1] == 1),
            "left": np.flatnonzero(points[:, 0] == 0),
        },
    )
    found = dpana.from_meshio(mesh)
    assert dict(found.groups) == {"all": "cells", "bottom": "facets", "left": "nodes", "top": "nodes"}
    assert_uniform(pressed(found).solve())
    # The scene takes meshio's object itself.
    assert_uniform(pressed(mesh).solve())


KINDS = ["quad4", "tri3", "quad8", "quad9", "tri6", "hex8", "tet4", "hex20", "hex27", "tet10"]


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_cell_comes_back_from_a_gmsh_file_through_meshio(tmp_path, kind):
    if kind in ("quad4", "tri3", "quad8", "quad9", "tri6"):
        scene = block([0.002, -0.01])
        scene["bodies"][0]["mesh"]["rectangle"]["cell"] = kind
    else:
        scene = block([0.002, 0, -0.01])
        box = {"x": [0, 2], "y": [0, 1], "z": [0, 1], "cells": [2, 1, 2], "cell": kind}
        scene["bodies"][0] |= {"mesh": {"box": box}, "model": "solid"}
        scene["contacts"][0]["obstacle"] = {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}
    first = dpana.solve(scene)
    path = tmp_path / "mesh.msh"
    path.write_text(first.mesh().to_msh())
    read = dpana.from_meshio(meshio.read(path))
    assert np.array_equal(read.cells[kind], first.mesh().cells[kind])
    scene["bodies"][0]["mesh"] = read
    again = dpana.solve(scene)
    assert np.array_equal(again.displacement(), first.displacement())
    # meshio's reader of VTU has VTK's order of nodes.
    first.write_vtu(tmp_path / "bodies.vtu")
    vtk = dpana.from_meshio(meshio.read(tmp_path / "bodies.vtu"))
    assert np.array_equal(vtk.cells[kind], first.mesh().cells[kind])


def test_one_body_of_an_assembly():
    points, cells = squares(2, 1)
    both = np.vstack([points, points + [0, 1]])
    mesh = meshio.Mesh(
        both,
        [("quad", np.vstack([cells, cells + len(points)]))],
        cell_sets={"lower": [[0, 1]], "upper": [[2, 3]]},
    )
    upper = dpana.from_meshio(mesh, cells="upper", scale=2)
    assert upper.points[:, 1].min() == 2 and len(upper.cells["quad4"]) == 2
    with pytest.raises(dpana.Error, match="lower, upper"):
        dpana.from_meshio(mesh, cells="middle")


def test_hertz():
    # (E3) a = √(4 P R / (π E*)), p₀ = 2 P / (π a); half of the body is modelled, so P is twice the load.
    result = dpana.solve(SCENES / "hertz.json")
    load = 2 * result.totals["normal"]
    modulus = 210000 / (1 - 0.3**2)
    width = np.sqrt(4 * load * 100 / (np.pi * modulus))
    peak = 2 * load / (np.pi * width)
    x, pressure = result.contacts.position[:, 0], result.contacts.pressure
    exact = peak * np.sqrt(np.maximum(0, 1 - (x / width) ** 2))
    # What the mesh leaves, as the Rust tests hold it: the peak to 1 %, the curve to 4 % of the peak.
    assert abs(pressure.max() / peak - 1) < 0.01
    assert np.abs(pressure - exact).max() < 0.04 * peak


def test_a_loose_block_slides_at_the_load_of_statics():
    scene = block([0, 0], cells=(4, 2))
    scene["bodies"][0]["supports"] = []
    scene["bodies"][0]["loads"] = [{"body_force": [0, -5]}, {"group": "left", "traction": [1, 0]}]
    scene = dpana.Scene.from_dict(scene)
    # 10 N of weight, μ = 0.3: 3 N against a push of 1 N.
    limits = scene.limit()
    assert limits["loads"][1]["certified"]
    assert abs(limits["loads"][1]["factor"] - 3) < 1e-6
    assert scene.check()["free_modes"] == [3]
    result = scene.solve()
    assert abs(result.totals["normal"] - 10) < 1e-9 and abs(result.totals["friction"][0] + 1) < 1e-9
    # Beyond it nothing holds the block: a status, not an exception.
    scene.bodies[0]["loads"][1]["traction"] = np.array([3.1, 0])
    beyond = scene.solve()
    assert beyond.status == "no_equilibrium" and not beyond.certified
    assert "failure" in beyond.report()


def test_more_friction_holds_more_up_to_sticking():
    scene = dpana.Scene.from_dict(block([0.01, -0.01]))
    table = scene.cases(friction=np.linspace(0, 0.6, 13))
    pull, all_slip, all_stick = -table["friction_x"], table["stick"] == 0, table["slip"] == 0
    assert set(table["status"]) == {"certified"} and all_stick.sum() == 3
    assert pull[0] == 0 and np.all(np.diff(pull[~all_stick]) > 0)
    # Coulomb: μ times the pressing force while all of it slides one way, never more; no change once it sticks.
    bound = table["friction"] * table["normal"]
    held = (table["open"] == 0) & all_slip
    assert held.sum() == 4 and np.allclose(pull[held], bound[held], rtol=1e-11)
    assert np.all(pull <= bound * (1 + 1e-11)) and np.ptp(pull[all_stick]) < 1e-11
