"""Meshes of meshio: points, blocks of cells, sets of points and cells."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._dpana import Error, Mesh

# meshio's word, ours, and where our nodes stand in meshio's (VTK's) order: Gmsh numbers the edges of
# quadratic solids otherwise.
_HEX20 = [*range(8), 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14]
_CELLS: dict[str, tuple[str, int, list[int] | None]] = {
    "triangle": ("tri3", 2, None),
    "quad": ("quad4", 2, None),
    "triangle6": ("tri6", 2, None),
    "quad8": ("quad8", 2, None),
    "quad9": ("quad9", 2, None),
    "tetra": ("tet4", 3, None),
    "hexahedron": ("hex8", 3, None),
    "tetra10": ("tet10", 3, [*range(8), 9, 8]),
    "hexahedron20": ("hex20", 3, _HEX20),
    "hexahedron27": ("hex27", 3, [*_HEX20, 24, 22, 20, 21, 23, 25, 26]),
}
_LINES = {"line", "line3"}


def from_meshio(mesh: Any, cells: str | None = None, scale: float = 1.0) -> Mesh:
    """The body in a meshio mesh; `cells` names the set of cells that it is, of an assembly in one file.

    Sets of cells, sets of points and Gmsh's physical groups become groups: of cells, of facets (blocks
    of the dimension below) or of nodes. Points that no cell of the body has are left out, and the
    others keep their order: `numpy.unique` of the cells' nodes leads back. Positions are multiplied by
    `scale`. Points in a plane z = constant, with cells in it, are a mesh in 2D.
    """
    blocks = [(block.type, np.asarray(block.data)) for block in mesh.cells]
    known = [kind for kind, _ in blocks if kind in _CELLS]
    if not known:
        kinds = ", ".join(sorted({kind for kind, _ in blocks})) or "none"
        raise Error(f"mesh: cells of {kinds}; expected one or more of {', '.join(_CELLS)}")
    dimension = max(_CELLS[kind][1] for kind in known)
    sets = _sets(mesh, blocks)
    points = np.asarray(mesh.points, dtype=float) * scale
    if dimension == 2 and points.shape[1] == 3:
        if np.ptp(points[:, 2]) != 0.0:
            raise Error("mesh: plane cells on points of several z; expected one z, or solid cells")
        points = points[:, :2]
    # Cells of the body, block by block, and the points that they have.
    chosen: list[np.ndarray] = []
    for number, (kind, nodes) in enumerate(blocks):
        body = kind in _CELLS and _CELLS[kind][1] == dimension
        of_set = np.arange(len(nodes)) if cells is None else _named(sets, cells)[number]
        chosen.append(of_set if body else np.empty(0, dtype=np.int64))
    used = np.unique(np.concatenate([nodes[at].ravel() for (_, nodes), at in zip(blocks, chosen)]))
    if not len(used):
        raise Error(f"cells: `{cells}` holds no cell of dimension {dimension}")
    new = np.full(len(points), -1, dtype=np.int64)
    new[used] = np.arange(len(used))
    of_kinds: dict[str, list[np.ndarray]] = {}
    for (kind, nodes), at in zip(blocks, chosen):
        if len(at):
            name, _, order = _CELLS[kind]
            ours = nodes if order is None else nodes[:, order]
            of_kinds.setdefault(name, []).append(new[ours[at]])
    found = Mesh(points[used], {kind: np.concatenate(parts) for kind, parts in of_kinds.items()})
    numbers = _numbers(blocks, chosen, of_kinds)
    for name, of_blocks in sets.items():
        found = _with_set(found, name, of_blocks, blocks, numbers, new, dimension)
    for name, nodes in (getattr(mesh, "point_sets", None) or {}).items():
        kept = new[np.asarray(nodes, dtype=np.int64)]
        if np.any(kept >= 0) and name not in dict(found.groups):
            found = found.with_nodes(name, kept[kept >= 0])
    return found


def _numbers(
    blocks: list[tuple[str, np.ndarray]], chosen: list[np.ndarray], kinds: dict[str, list[np.ndarray]]
) -> list[np.ndarray]:
    """Number in our mesh of every cell of every block, or -1: kinds stand one after the other."""
    starts, start = {}, 0
    for kind, parts in kinds.items():
        starts[kind] = start
        start += sum(map(len, parts))
    numbers = []
    for (kind, nodes), at in zip(blocks, chosen):
        of_block = np.full(len(nodes), -1, dtype=np.int64)
        if len(at):
            name = _CELLS[kind][0]
            of_block[at] = starts[name] + np.arange(len(at))
            starts[name] += len(at)
        numbers.append(of_block)
    return numbers


def _with_set(
    found: Mesh,
    name: str,
    of_blocks: list[np.ndarray],
    blocks: list[tuple[str, np.ndarray]],
    numbers: list[np.ndarray],
    new: np.ndarray,
    dimension: int,
) -> Mesh:
    """The mesh with the cells of a set, or else its facets; sets of other bodies are left out."""
    cells = np.concatenate([number[at] for number, at in zip(numbers, of_blocks)] or [np.empty(0)])
    if np.any(cells >= 0):
        return found.with_cells(name, cells[cells >= 0])
    for (kind, nodes), at in zip(blocks, of_blocks):
        below = kind in _LINES if dimension == 2 else kind in _CELLS and _CELLS[kind][1] == 2
        facets = new[nodes[at]] if below else np.empty((0, 0), dtype=np.int64)
        facets = facets[np.all(facets >= 0, axis=1)] if len(facets) else facets
        if len(facets):
            found = found.with_facets(name, facets)
    return found


def _named(sets: dict[str, list[np.ndarray]], name: str) -> list[np.ndarray]:
    if name not in sets:
        raise Error(f"cells: `{name}` is not a set of the mesh; expected one of {', '.join(sorted(sets))}")
    return sets[name]


def _sets(mesh: Any, blocks: list[tuple[str, np.ndarray]]) -> dict[str, list[np.ndarray]]:
    """Cells of every set, block by block."""
    sets: dict[str, list[np.ndarray]] = {}
    for name, of_blocks in (getattr(mesh, "cell_sets", None) or {}).items():
        if not name.startswith("gmsh:"):
            sets[name] = [np.asarray([] if at is None else at, dtype=np.int64) for at in of_blocks]
    tags = (getattr(mesh, "cell_data", None) or {}).get("gmsh:physical")
    for name, (tag, of_dimension) in (getattr(mesh, "field_data", None) or {}).items():
        if tags is not None and name not in sets:
            sets[name] = [
                np.flatnonzero(np.asarray(of_block) == tag)
                if _dimension(kind) == of_dimension
                else np.empty(0, dtype=np.int64)
                for (kind, _), of_block in zip(blocks, tags)
            ]
    return sets


def _dimension(kind: str) -> int:
    if kind in _CELLS:
        return _CELLS[kind][1]
    return 1 if kind in _LINES else 0
