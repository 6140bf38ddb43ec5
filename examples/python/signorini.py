"""The SSNV128 square of code_aster, pressed on a rigid plane and pushed along it, beside published values.

`python examples/python/signorini.py` after `pip install .`; the cells (`# %%`) run one by one in editors
and notebooks.
"""

# %% The scene is a file; a dict of the same shape would do.
from pathlib import Path

import numpy as np

import dpana

scenes = Path(__file__).resolve().parents[1] / "scenes"
result = dpana.solve(scenes / "ssnv128.json")
print(result.summary())

# %% u_x of nodes on the contact line, in 1e-6 m: positions and displacements are arrays.
published = {0: 28.59438, 1.25: 27.21685, 5: 22.84998, 7.5: 19.79627, 11.25: 15.40564}
points, moved = result.mesh().points, result.displacement()
print("\n x [mm]       here  published")
for x, expected in published.items():
    node = np.argmin(np.hypot(points[:, 0] - x / 1000, points[:, 1]))
    print(f"{x:7.2f} {1e6 * moved[node, 0]:10.5f} {expected:10.5f}")
    assert abs(1e6 * moved[node, 0] - expected) < 6e-6

# %% What the contacts do: 0 open, 1 slip, 2 stick.
contacts = result.contacts
open_slip_stick = np.bincount(contacts.state, minlength=3)
print("\nopen, slip, stick:", *open_slip_stick)
assert open_slip_stick.tolist() == [3, 21, 8]
print("largest pressure:", contacts.pressure.max())

# %% The certificate: what a judge measured that shares no code with the solver.
print("natural-map residual:", result.certificate["natural_map"])
assert result.certified and result.certificate["natural_map"] <= 1e-12
