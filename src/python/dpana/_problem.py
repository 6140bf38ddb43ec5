"""Bare problems in files, and in the convention of rigid-body codes.

    v = W r + q,  r_N >= 0 pressed,  v_N >= 0 opens           Siconos, FCLIB
    r = D t,  v = (gap, 0) + D u,  G = D W D,  D = diag(-1, 1, 1, ...)    their signs in ours
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np

from ._dpana import Error, Problem

_OURS = ("G", "u_free", "gap", "mu")
_MORE = ("tangents", "modes", "mode_load")
_THEIRS = ("W", "q", "mu")


def load(path: str | os.PathLike[str]) -> Problem:
    """Behind `Problem.load`."""
    path = Path(path)
    try:
        if path.suffix.lower() == ".json":
            return Problem.from_json(path.read_text(encoding="utf-8-sig"), str(path))
        with np.load(path, allow_pickle=False) as arrays:
            found = {name: arrays[name] for name in arrays.files}
    except Error:
        raise
    except (OSError, ValueError) as error:
        raise Error(f"problem: {path} cannot be read: {error}") from error
    if all(name in found for name in _OURS):
        more = {name: found[name] for name in _MORE if name in found}
        return Problem(*(found[name] for name in _OURS), **more)
    if all(name in found for name in _THEIRS):
        dimension = int(found["dimension"]) if "dimension" in found else None
        return from_siconos(found["W"], found["q"], found["mu"], dimension)
    raise Error(
        f"problem: {path} holds {', '.join(found) or 'nothing'}; expected arrays "
        f"{', '.join(_OURS)} (signs of dpana), or {', '.join(_THEIRS)} (signs of Siconos)"
    )


def save(problem: Problem, path: str | os.PathLike[str]) -> None:
    """Behind `Problem.save`."""
    path = Path(path)
    if path.suffix.lower() == ".json":
        W, q, mu = to_siconos(problem)
        rows, columns = np.nonzero(W)
        stated = {
            "name": path.stem,
            "source": "dpana",
            "dimension": len(q) // len(mu),
            "contacts": len(mu),
            "convention": "v = W r + q; r_N >= 0 pressed, v_N >= 0 opens; |r_T| <= mu r_N; contact-major, normal first",
            "w_rows": rows.tolist(),
            "w_cols": columns.tolist(),
            "w_values": W[rows, columns].tolist(),
            "q": q.tolist(),
            "mu": mu.tolist(),
        }
        path.write_text(json.dumps(stated) + "\n", encoding="utf-8")
        return
    if path.suffix.lower() != ".npz":
        raise Error(f"problem: {path} is not accepted; expected a name that ends in .npz or .json")
    arrays = {name: getattr(problem, name) for name in _OURS + _MORE}
    np.savez_compressed(path, **{name: of for name, of in arrays.items() if of is not None})


def from_siconos(W: np.ndarray, q: np.ndarray, mu: np.ndarray, dimension: int | None) -> Problem:
    """Behind `Problem.from_siconos`."""
    W, q, mu = (np.asarray(of, dtype=float) for of in (W, q, mu))
    dimension = dimension or len(q) // max(len(mu), 1)
    if dimension not in (2, 3) or len(q) != dimension * len(mu) or W.shape != (len(q), len(q)):
        raise Error(
            f"W, q, mu: shapes {W.shape}, {q.shape}, {mu.shape} are not accepted; expected (d n, d n), "
            "(d n,), (n,) for n contacts in d = 2 or 3 dimensions"
        )
    signs = _signs(len(mu), dimension)
    G, gap = signs[:, None] * W * signs, np.zeros(len(mu))
    return Problem(G, signs * q, gap, mu, [dimension - 1] * len(mu))


def to_siconos(problem: Problem) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Behind `Problem.to_siconos`."""
    blocks = 1 + np.unique(problem.tangents)
    if problem.modes is not None or len(blocks) != 1 or blocks[0] not in (2, 3):
        raise Error(
            "problem: bodies that float, or contacts with different numbers of tangents or none; "
            "expected one or two tangents at every contact and bodies that supports hold (.npz keeps all)"
        )
    signs = _signs(problem.contacts, int(blocks[0]))
    q = signs * problem.u_free
    q[:: blocks[0]] += problem.gap
    return signs[:, None] * problem.G * signs, q, problem.mu


def _signs(contacts: int, dimension: int) -> np.ndarray:
    return np.tile([-1.0, 1.0, 1.0][:dimension], contacts)
