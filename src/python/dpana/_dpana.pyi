"""The compiled part; the docstrings are in it (`help(dpana.Problem)`)."""

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Floats = NDArray[np.float64]
_Ints = NDArray[np.int64]
_Path = str | os.PathLike[str]

__version__: str

def schema() -> dict[str, Any]:
    """The JSON Schema of a scene."""

class Error(ValueError):
    """An input that cannot be solved: place, value, what is accepted."""

@final
class Mesh:
    """Nodes, cells and named groups of a body."""

    def __new__(cls, points: ArrayLike, cells: Mapping[str, ArrayLike]) -> Mesh: ...
    @staticmethod
    def read(path: _Path) -> Mesh: ...
    def to_msh(self) -> str: ...
    def with_surface(
        self, name: str, where: ArrayLike | Callable[[_Floats], ArrayLike]
    ) -> Mesh: ...
    def with_facets(self, name: str, nodes: ArrayLike) -> Mesh: ...
    def with_cells(self, name: str, cells: ArrayLike) -> Mesh: ...
    def with_nodes(self, name: str, nodes: ArrayLike) -> Mesh: ...
    def group_nodes(self, name: str) -> _Ints: ...
    @property
    def points(self) -> _Floats:
        """(nodes, d), in the unit of length."""
    @property
    def cells(self) -> dict[str, _Ints]:
        """(cells, nodes per cell) per kind, in Gmsh's order."""
    @property
    def groups(self) -> list[tuple[str, str]]:
        """Names, and what each is of: cells, facets, edges, nodes."""

@final
class StatedScene:
    def __new__(
        cls, text: str, source: _Path | None, meshes: Sequence[tuple[int, Mesh]]
    ) -> StatedScene: ...
    @staticmethod
    def read_deck(path: _Path) -> tuple[str, list[tuple[int, Mesh]], list[str]]: ...
    def solve(self, each: Callable[[Result], object] | None, restart: str | None) -> Result: ...
    def cases(self, variations: Sequence[tuple[str, Sequence[float]]]) -> dict[str, Any]: ...
    def limit(self) -> dict[str, Any]: ...
    def condense(self) -> Problem: ...
    def check(self) -> dict[str, Any]: ...

@final
class Result:
    """A solved scene."""

    @property
    def status(self) -> str:
        """certified, not_converged, no_equilibrium or coupling_fault."""
    @property
    def certified(self) -> bool: ...
    def summary(self) -> str: ...
    def report(self) -> dict[str, Any]: ...
    def to_json(self) -> str: ...
    @property
    def totals(self) -> dict[str, Any]: ...
    @property
    def certificate(self) -> dict[str, Any]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def step(self) -> dict[str, Any] | None: ...
    @property
    def contacts(self) -> Contacts: ...
    @property
    def problem(self) -> Problem: ...
    @property
    def bodies(self) -> list[str]: ...
    def mesh(self, body: str | int | None = None) -> Mesh: ...
    def displacement(self, body: str | int | None = None) -> _Floats:
        """(nodes, d), in the unit of length."""
    def stress(self, body: str | int | None = None) -> _Floats:
        """(nodes, 6), in force per area: xx, yy, zz, yz, xz, xy."""
    def cell_stress(self, body: str | int | None = None) -> _Floats:
        """(cells, 6), in force per area: xx, yy, zz, yz, xz, xy."""
    def stress_error_estimate(self) -> float: ...
    def stress_error_bound(self) -> float:
        """Plane and axisymmetric bodies of straight cells; Error says what it does not know."""
    def trust(self, starts: int = 4) -> dict[str, Any] | None: ...
    def state(self) -> str | None: ...
    def write_vtu(self, path: _Path) -> None: ...
    def to_svg(self) -> str: ...

@final
class Contacts:
    """The contacts of a solved scene as arrays, d = 2 or 3; vectors in global axes."""

    @property
    def position(self) -> _Floats:
        """(contacts, d), before loading, in the unit of length."""
    @property
    def normal(self) -> _Floats:
        """(contacts, d), out of the body towards the other side."""
    @property
    def state(self) -> NDArray[np.int8]:
        """(contacts,): 0 open, 1 slip, 2 stick."""
    @property
    def initial_gap(self) -> _Floats:
        """(contacts,), in the unit of length."""
    @property
    def gap(self) -> _Floats:
        """(contacts,), in the unit of length."""
    @property
    def slip(self) -> _Floats:
        """(contacts, d), since the start of the load step, in the unit of length."""
    @property
    def area(self) -> _Floats:
        """(contacts,)."""
    @property
    def normal_reaction(self) -> _Floats:
        """(contacts,), t_N, <= 0 where pressed, in the unit of force."""
    @property
    def force(self) -> _Floats:
        """(contacts, d), on the body, in the unit of force."""
    @property
    def pressure(self) -> _Floats:
        """(contacts,), >= 0, in force per area; NaN without an area."""
    @property
    def friction_traction(self) -> _Floats:
        """(contacts, d), on the body, in force per area; NaN without an area."""
    @property
    def body(self) -> _Ints: ...
    @property
    def node(self) -> _Ints: ...
    @property
    def pair(self) -> _Ints: ...
    def to_dict(self) -> dict[str, NDArray[Any]]: ...
    def __len__(self) -> int: ...

@final
class Problem:
    """Find reactions t and displacements u = u_free + G t that satisfy Signorini's and Coulomb's laws."""

    def __new__(
        cls,
        G: ArrayLike,
        u_free: ArrayLike,
        gap: ArrayLike,
        mu: ArrayLike,
        tangents: ArrayLike | None = None,
        modes: ArrayLike | None = None,
        mode_load: ArrayLike | None = None,
    ) -> Problem: ...
    @staticmethod
    def load(path: _Path) -> Problem: ...
    def save(self, path: _Path) -> None: ...
    @staticmethod
    def from_json(text: str, name: str) -> Problem: ...
    @staticmethod
    def from_siconos(
        W: ArrayLike, q: ArrayLike, mu: ArrayLike, dimension: int | None = None
    ) -> Problem: ...
    def to_siconos(self) -> tuple[_Floats, _Floats, _Floats]: ...
    def solve(
        self,
        tolerance: float | None = None,
        max_sweeps: int | None = None,
        time_limit: float | None = None,
        near: ProblemResult | None = None,
    ) -> ProblemResult: ...
    def with_friction(self, mu: ArrayLike) -> Problem: ...
    def with_gap(self, gap: ArrayLike) -> Problem: ...
    @property
    def contacts(self) -> int: ...
    @property
    def unknowns(self) -> int: ...
    @property
    def G(self) -> _Floats:
        """(unknowns, unknowns), in m/N; a copy."""
    @property
    def u_free(self) -> _Floats:
        """(unknowns,), in m."""
    @property
    def gap(self) -> _Floats:
        """(contacts,), before loading, in m."""
    @property
    def mu(self) -> _Floats:
        """(contacts,)."""
    @property
    def tangents(self) -> _Ints:
        """(contacts,)."""
    @property
    def modes(self) -> _Floats | None:
        """(unknowns, modes)."""
    @property
    def mode_load(self) -> _Floats | None:
        """(modes,), in N."""
    @property
    def positions(self) -> _Floats | None:
        """(contacts, d), in m; None without a scene."""
    @property
    def frames(self) -> _Floats | None:
        """(contacts, d, d), rows normal and tangents; None without a scene."""
    @property
    def areas(self) -> _Floats | None:
        """(contacts,), in m^2; None without a scene."""

@final
class ProblemResult:
    """A solved bare problem."""

    @property
    def status(self) -> str:
        """certified, not_converged or no_equilibrium."""
    @property
    def certified(self) -> bool: ...
    @property
    def reason(self) -> str | None: ...
    @property
    def reaction(self) -> _Floats:
        """(unknowns,), in N; normal ones <= 0 where pressed."""
    @property
    def displacement(self) -> _Floats:
        """(unknowns,), in m."""
    @property
    def motion(self) -> _Floats:
        """(modes,), in m."""
    @property
    def gap(self) -> _Floats:
        """(contacts,), what is left of the distance, in m."""
    @property
    def state(self) -> NDArray[np.int8]:
        """(contacts,): 0 open, 1 slip, 2 stick."""
    @property
    def residual(self) -> float: ...
    @property
    def certificate(self) -> dict[str, Any]: ...
    @property
    def work(self) -> dict[str, int]: ...
