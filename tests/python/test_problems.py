"""Bare problems: closed forms, files, the signs of rigid-body codes, certificates recomputed here."""

import numpy as np
import pytest
from conftest import DATA, SCENES

import dpana

DISCRETE = sorted((DATA / "discrete").glob("*.json"))
DISCRETE = [path for path in DISCRETE if not path.name.endswith("_loads.json")]


def test_one_contact_slips_as_by_hand():
    # μ = 1/2: t_N = −0.5, t_T = −0.25, u_T = 0.5 + 0.5 − 0.5.
    problem = dpana.Problem([[1, -1], [-1, 2]], [0.25, 0.5], [0], [0.5])
    solved = problem.solve()
    assert solved.certified and solved.reason is None and solved.state.tolist() == [1]
    assert np.abs(solved.reaction - [-0.5, -0.25]).max() < 1e-12
    assert np.abs(solved.displacement - [0, 0.5]).max() < 1e-12
    assert abs(solved.gap[0]) < 1e-12
    assert solved.certificate["natural_map"] == solved.residual <= 1e-12


def test_gap_and_friction_are_changed_on_the_same_operator():
    problem = dpana.Problem(np.eye(2), [0.3, 0.1], [0], [0.5])
    assert problem.with_gap([0.4]).solve().state.tolist() == [0]
    # (L2): 0.5 · 0.3 > 0.1 sticks, 0.1 · 0.3 slips.
    near = problem.solve()
    assert near.state.tolist() == [2]
    assert problem.with_friction([0.1]).solve(near=near).state.tolist() == [1]


def natural_map(W, q, mu, r):
    """Of Siconos: r − P_K(r − (v + μ‖v_T‖ n)), relative to r."""
    v = W @ r + q
    d = len(q) // len(mu)
    r, v = r.reshape(-1, d), v.reshape(-1, d)
    z = r - v
    z[:, 0] -= mu * np.linalg.norm(v[:, 1:], axis=1)
    n, t = z[:, 0], np.linalg.norm(z[:, 1:], axis=1)
    inside, polar = t <= mu * n, mu * t <= -n
    onto = np.where(polar, 0, (n + mu * t) / (1 + mu**2))
    size = np.divide(mu * onto, t, out=np.zeros_like(t), where=t > 0)
    cone = np.column_stack([onto, z[:, 1:] * size[:, None]])
    cone[inside] = z[inside]
    return np.linalg.norm(r - cone) / np.linalg.norm(r)


@pytest.mark.parametrize("path", DISCRETE, ids=lambda path: path.stem)
def test_problems_of_other_codes_are_solved_in_their_own_signs(path):
    problem = dpana.Problem.load(path)
    solved = problem.solve(tolerance=1e-8)
    assert solved.certified
    W, q, mu = problem.to_siconos()
    signs = np.tile([-1.0, 1.0, 1.0][: len(q) // len(mu)], len(mu))
    # The map scales with the unit of v: measured for G of size one.
    scale = np.abs(W).max()
    assert natural_map(W / scale, q / scale, mu, signs * solved.reaction) < 1e-7


def test_a_problem_comes_back_from_files(tmp_path):
    problem = dpana.Scene.read(SCENES / "punch.json").condense()
    assert problem.modes.shape == (problem.unknowns, 3)
    problem.save(tmp_path / "punch.npz")
    again = dpana.Problem.load(tmp_path / "punch.npz")
    for name in ("G", "u_free", "gap", "mu", "tangents", "modes", "mode_load"):
        assert np.array_equal(getattr(again, name), getattr(problem, name)), name
    with pytest.raises(dpana.Error, match="float"):
        problem.save(tmp_path / "punch.json")

    square = dpana.Scene.read(SCENES / "square.json").condense()
    square.save(tmp_path / "square.json")
    theirs = dpana.Problem.load(tmp_path / "square.json")
    assert np.array_equal(theirs.G, square.G) and np.array_equal(theirs.mu, square.mu)
    W, q, mu = square.to_siconos()
    np.savez(tmp_path / "theirs.npz", W=W, q=q, mu=mu)
    found = dpana.Problem.load(tmp_path / "theirs.npz").solve()
    assert np.array_equal(found.reaction, theirs.solve().reaction)


def test_a_problem_that_is_none_is_refused_with_its_place(tmp_path):
    eye = np.eye(2)
    for arguments, words in [
        (([[1, 0.1], [0, 1]], [0, 0], [0], [1]), "symmetric"),
        ((-eye, [0, 0], [0], [1]), r"operator\[0\]\[0\]: -1"),
        ((eye, [0, np.nan], [0], [1]), "free_displacement.*finite"),
        ((eye, [0, 0], [0, 0], [1]), "initial_gap"),
        ((eye, [0, 0], [0], [-1]), r"friction\[0\]"),
        ((eye, [0] * 5, [0], [1]), "u_free"),
        ((eye, [0, 0], [0], [1], [3]), "tangents"),
        ((eye, [0, 0], [0], [1], [-1]), "tangents: -1"),
    ]:
        with pytest.raises(dpana.Error, match=words):
            dpana.Problem(*arguments)
    with pytest.raises(dpana.Error, match="tolerance"):
        dpana.Problem(eye, [0.1, 0], [0], [1]).solve(tolerance=1)
    with pytest.raises(dpana.Error, match="time_limit"):
        dpana.Problem(eye, [0.1, 0], [0], [1]).solve(time_limit=-1)
    with pytest.raises(dpana.Error, match="W, q, mu"):
        dpana.Problem.from_siconos(eye, [0, 0, 0], [1])
    np.savez(tmp_path / "other.npz", A=eye)
    for path in (tmp_path / "other.npz", tmp_path / "none.npz", tmp_path / "none.json"):
        with pytest.raises(dpana.Error, match="problem: "):
            dpana.Problem.load(path)
