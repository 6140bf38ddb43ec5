"""A bare problem without a mesh: compliance, free displacement, gaps, friction; and one of another code."""

# %% One contact in the plane, μ = 1/2, by hand: it slips by 0.5 m under −0.25 N of friction.
from pathlib import Path

import numpy as np

import dpana

problem = dpana.Problem(G=[[1, -1], [-1, 2]], u_free=[0.25, 0.5], gap=[0], mu=[0.5])
solved = problem.solve()
print(solved, "reaction", solved.reaction, "displacement", solved.displacement)
assert np.allclose(solved.reaction, [-0.5, -0.25]) and np.allclose(solved.displacement, [0, 0.5])

# %% A problem of Siconos, whose signs are others: v = W r + q, r_N >= 0 pressed.
data = Path(__file__).resolve().parents[2] / "tests" / "data" / "discrete"
problem = dpana.Problem.load(data / "Confeti-ex03-Fc3D-SBM.json")
solved = problem.solve(tolerance=1e-8)
W, q, mu = problem.to_siconos()
r = solved.reaction * np.tile([-1, 1, 1], problem.contacts)
v = (W @ r + q).reshape(-1, 3)
print(problem, solved.status, "after", solved.work)
scale = np.abs(q).max()
assert solved.certified and v[:, 0].min() > -1e-7 * scale
r = r.reshape(-1, 3)
assert np.all(np.linalg.norm(r[:, 1:], axis=1) <= mu * r[:, 0] + 1e-7 * np.abs(r).max())

# %% The operator of a scene, taken out, changed and solved again.
scene = dpana.Scene.read(data.parents[2] / "examples" / "scenes" / "square.json")
problem = scene.condense()
stiffer = dpana.Problem(problem.G / 2, problem.u_free, problem.gap, problem.mu)
print(stiffer, stiffer.solve().status)
assert stiffer.solve().certified
