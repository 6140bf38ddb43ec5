"""Scenes: dicts of the shape of scene files, with meshes in memory."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np

from ._dpana import Error, Mesh, Problem, Result, StatedScene
from ._mesh import from_meshio

SceneLike = Union["Scene", Mapping[str, Any], str, "os.PathLike[str]"]


class Scene:
    """Elastic bodies that may touch rigid obstacles and each other.

    `bodies` and `contacts` are lists of dicts with the keys of a scene file (`dpana.schema()`, README);
    a body's `mesh` may be a `Mesh` or a meshio mesh, numbers and lists may be NumPy's. `steps` is a load
    history, `settings` a dict. Mesh files are relative to `folder`. All of it may be changed before
    the scene is solved; it is read and checked then.
    """

    def __init__(
        self,
        bodies: Sequence[Mapping[str, Any]],
        contacts: Sequence[Mapping[str, Any]],
        *,
        steps: Mapping[str, Any] | None = None,
        settings: Mapping[str, Any] | None = None,
        title: str = "",
        units: str = "",
        folder: str | os.PathLike[str] = "",
    ) -> None:
        self.bodies: list[dict[str, Any]] = _copied(bodies)
        self.contacts: list[dict[str, Any]] = _copied(contacts)
        self.steps: dict[str, Any] | None = _copied(steps)
        self.settings: dict[str, Any] | None = _copied(settings)
        self.title, self.units = title, units
        self.folder = Path(folder)
        #: What was read of a deck and left, by file, line and keyword.
        self.notes: list[str] = []
        self._source: Path | None = None
        self._other: dict[str, Any] = {}

    @classmethod
    def from_dict(cls, scene: Mapping[str, Any], folder: str | os.PathLike[str] = "") -> Scene:
        """A scene of a dict with the keys of a scene file; unknown keys are refused by the solve."""
        parts = dict(scene)
        found = cls(
            parts.pop("bodies", []),
            parts.pop("contacts", []),
            steps=parts.pop("steps", None),
            settings=parts.pop("settings", None),
            title=parts.pop("title", ""),
            units=parts.pop("units", ""),
            folder=folder,
        )
        found._other = parts
        return found

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Scene:
        """Reads a scene in JSON, or a deck of Abaqus or CalculiX (`.inp`)."""
        path = Path(path)
        if path.suffix.lower() == ".inp":
            text, meshes, notes = StatedScene.read_deck(path)
            found = cls.from_dict(json.loads(text), path.parent)
            for at, mesh in meshes:
                found.bodies[at]["mesh"] = mesh
            found.notes = notes
        else:
            text = _read(path)
            # Its mistakes are told with their line, as the command line does.
            StatedScene(text, path, [])
            found = cls.from_dict(json.loads(text), path.parent)
        found._source = path
        return found

    def solve(
        self,
        *,
        each: Callable[[Result], object] | None = None,
        restart: str | None = None,
    ) -> Result:
        """Solves the scene; one with steps to its end or to the first state that is not certified.

        `each` is called with the result of every state, in order. `restart` is the text of
        `Result.state()` after a step, from which the history goes on bit for bit. Other threads of
        Python run meanwhile, and Ctrl-C ends the solve.
        """
        return self._stated().solve(each, restart)

    def solve_steps(self, *, restart: str | None = None) -> list[Result]:
        """The results of all states of a history."""
        states: list[Result] = []
        self.solve(each=states.append, restart=restart)
        return states

    def cases(
        self, quantities: Mapping[str, Any] | None = None, /, **named: Any
    ) -> dict[str, np.ndarray]:
        """Solves the scene for every combination of values, all on one factorisation.

        `cases(friction=values)`, or a dict for names such as `contacts[0].gap`, `bodies[0].loads[1]`
        (factors) and `contacts[0].x` (motion of an obstacle). Returns one array per column, a row per
        case, the last quantity changing fastest: the values, `status`, totals, certificate.
        """
        given = {**(quantities or {}), **named}
        values = [(name, [float(x) for x in np.atleast_1d(of)]) for name, of in given.items()]
        table = self._stated().cases(values)
        columns = zip(*table["rows"]) if table["rows"] else ([] for _ in table["columns"])
        return {name: _column(entries) for name, entries in zip(table["columns"], columns)}

    def limit(self) -> dict[str, Any]:
        """By what factor each load can grow before contact cannot hold it, and the least friction."""
        return self._stated().limit()

    def condense(self) -> Problem:
        """The condensed problem without solving it: G, u_free, gap, mu, frames."""
        return self._stated().condense()

    def check(self) -> dict[str, Any]:
        """Reads meshes and finds contacts: numbers of nodes and contacts, rigid motions per body that
        only contact holds, memory of the condensed problem in bytes, notes."""
        return self._stated().check()

    def to_dict(self) -> dict[str, Any]:
        """The scene as a dict; meshes in memory stay objects."""
        found: dict[str, Any] = dict(self._other)
        found |= {"title": self.title} if self.title else {}
        found |= {"units": self.units} if self.units else {}
        found |= {"bodies": self.bodies, "contacts": self.contacts}
        found |= {"steps": self.steps} if self.steps is not None else {}
        found |= {"settings": self.settings} if self.settings is not None else {}
        return found

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene as JSON, and every mesh in memory beside it as a Gmsh file.

        Names of mesh files stay as they are: write into the scene's own folder."""
        path, stated = Path(path), self.to_dict()
        stated["bodies"], meshes = _apart(self.bodies)
        for at, mesh in meshes:
            file = path.with_name(f"{path.stem}_{at}.msh")
            file.write_text(mesh.to_msh(), encoding="utf-8")
            stated["bodies"][at]["mesh"] = {"file": file.name}
        path.write_text(json.dumps(stated, indent=2, default=_plain) + "\n", encoding="utf-8")

    def _stated(self) -> StatedScene:
        stated = self.to_dict()
        stated["bodies"], meshes = _apart(self.bodies)
        source = self._source
        if source is None and self.folder != Path(""):
            source = self.folder / "scene"
        return StatedScene(json.dumps(stated, default=_plain), source, meshes)

    def __repr__(self) -> str:
        return f"dpana.Scene({len(self.bodies)} bodies, {len(self.contacts)} contacts)"


def solve(
    scene: SceneLike,
    *,
    each: Callable[[Result], object] | None = None,
    restart: str | None = None,
) -> Result:
    """Solves a scene: a `Scene`, a dict of the same shape as a scene file, or the path of a scene in JSON
    or of a deck (`.inp`). See `Scene.solve`."""
    if isinstance(scene, Mapping):
        scene = Scene.from_dict(scene)
    elif not isinstance(scene, Scene):
        scene = Scene.read(scene)
    return scene.solve(each=each, restart=restart)


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise Error(f"scene: {path} cannot be read: {error}") from error


def _copied(value: Any) -> Any:
    """A copy down to what is neither dict nor list: meshes and arrays are shared."""
    if isinstance(value, Mapping):
        return {key: _copied(of) for key, of in value.items()}
    return [_copied(of) for of in value] if isinstance(value, (list, tuple)) else value


def _apart(bodies: Any) -> tuple[Any, list[tuple[int, Mesh]]]:
    """Bodies as JSON can say them, and the meshes in memory by body."""
    stated, meshes = _copied(bodies), []
    for at, body in enumerate(stated if isinstance(stated, list) else []):
        mesh = _mesh(body.get("mesh")) if isinstance(body, dict) else None
        if mesh is not None:
            meshes.append((at, mesh))
            body["mesh"] = {"file": "in memory"}
    return stated, meshes


def _mesh(mesh: Any) -> Mesh | None:
    """A mesh in memory; None for one that JSON can say."""
    if isinstance(mesh, Mesh):
        return mesh
    return from_meshio(mesh) if hasattr(mesh, "cells") and hasattr(mesh, "points") else None


def _plain(value: Any) -> Any:
    """What JSON has no word for."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise Error(f"scene: {type(value).__name__} is not accepted; expected numbers, text, lists, dicts")


def _column(entries: Sequence[Any]) -> np.ndarray:
    if any(isinstance(entry, str) for entry in entries):
        return np.array(entries)
    return np.array([np.nan if entry is None else entry for entry in entries])
