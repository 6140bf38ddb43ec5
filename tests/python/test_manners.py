"""Lock, Ctrl-C, exceptions, hostile input, stubs, examples."""

import ast
import json
import runpy
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, SCENES, block

import dpana

LONG = """
import dpana, json, sys
scene = json.loads(sys.stdin.read())
print("begins", flush=True)
try:
    dpana.solve(scene)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def long_history(steps=200_000):
    scene = block([0.001, -0.01])
    at = list(range(1, steps + 1))
    scene["steps"] = {"at": at, "factors": {"bodies[0].supports[0]": [[0, 0], [steps, 1]]}}
    return scene


def test_ctrl_c_ends_a_solve():
    running = subprocess.Popen(
        [sys.executable, "-c", LONG], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    running.stdin.write(json.dumps(long_history()))
    running.stdin.close()
    assert running.stdout.readline() == "begins\n"
    time.sleep(1)
    assert running.poll() is None
    begin = time.monotonic()
    running.send_signal(signal.SIGINT)
    assert running.stdout.readline() == "interrupted\n"
    assert running.wait(20) == 0 and time.monotonic() - begin < 10


def test_other_threads_run_while_a_scene_is_solved():
    turns, done = 0, threading.Event()

    def count():
        nonlocal turns
        while not done.wait(0.001):
            turns += 1

    counter = threading.Thread(target=count)
    counter.start()
    begin = time.monotonic()
    dpana.solve(SCENES / "punch.json")
    seconds = time.monotonic() - begin
    done.set()
    counter.join()
    # A thread that waits for the lock would not have turned at all.
    assert turns > 10 * seconds


def test_solves_in_several_threads_give_the_same_bits():
    found = [None] * 4

    def solve(at):
        found[at] = dpana.solve(SCENES / "square.json").displacement()

    threads = [threading.Thread(target=solve, args=(at,)) for at in range(4)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all(np.array_equal(found[0], other) for other in found)


def test_an_exception_in_each_ends_the_history():
    seen = []

    def each(result):
        seen.append(result.step["number"])
        if len(seen) == 3:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        dpana.solve(long_history(), each=each)
    assert seen == [1, 2, 3]


def test_a_dict_is_refused_by_place_and_value():
    def refused(change):
        scene = block([0, -0.01])
        change(scene)
        with pytest.raises(dpana.Error) as error:
            dpana.solve(scene)
        assert isinstance(error.value, ValueError)
        return str(error.value)

    body = "bodies"
    assert "bodies[0].yung" in refused(lambda s: s[body][0].update(yung=1))
    assert "did you mean" in refused(lambda s: s.update(contcts=[]))
    words = refused(lambda s: s[body][0]["materials"][0].update(young=-1))
    assert "bodies[0].materials[0].young: -1" in words
    assert "young" in refused(lambda s: s[body][0]["materials"][0].update(young=float("nan")))
    assert "set" in refused(lambda s: s[body][0].update(name={1, 2}))
    assert "contacts" in refused(lambda s: s.update(contacts=[]))
    assert "in memory" not in refused(lambda s: s[body][0].update(mesh=dpana.Mesh([[0, 0]], {})))


def test_arrays_that_are_no_mesh_are_refused():
    corners = [[0, 0], [1, 0], [0, 1]]
    for points, cells, words in [
        (corners, {"tri3": [[0, 1, 3]]}, "tri3.*node 3"),
        (corners, {"tri3": [[0, 1, -1]]}, "-1"),
        (corners, {"tri3": [[0, 1, 0.5]]}, "0.5"),
        (corners, {"tri3": [[0, 1]]}, "2 columns"),
        (corners, {"tet4": [[0, 1, 2, 2]]}, "tet4.*2D; expected tri3"),
        ([[0], [1]], {}, "1 columns"),
    ]:
        with pytest.raises(dpana.Error, match=words):
            dpana.Mesh(points, cells)
    mesh = dpana.Mesh(corners, {"tri3": [[0, 1, 2]]})
    for call in (
        lambda: mesh.with_surface("a", [True]),
        lambda: mesh.with_surface("a", lambda x: x[:, 0] > 5),
        lambda: mesh.with_cells("a", [1]),
        lambda: mesh.with_nodes("a", [3]),
        lambda: mesh.with_facets("a", [[0, 7]]),
        lambda: mesh.group_nodes("a"),
        lambda: dpana.Mesh.read("no such file.msh"),
    ):
        with pytest.raises(dpana.Error):
            call()
    # Not a facet of the mesh, and not finite: refused when the scene is read.
    for mesh in (mesh.with_facets("bottom", [[0, 1, 2]]), dpana.Mesh([[0, 0], [1, 0], [np.nan, 1]], {"tri3": [[0, 1, 2]]})):
        scene = block([0, 0])
        scene["bodies"][0]["mesh"] = mesh.with_nodes("top", [2])
        with pytest.raises(dpana.Error):
            dpana.solve(scene)


def test_a_scene_is_written_with_its_meshes_and_read_again(tmp_path):
    scene = dpana.Scene.read(SCENES / "square.json")
    first = scene.solve()
    scene.bodies[0]["mesh"] = first.mesh()
    scene.write(tmp_path / "square.json")
    again = dpana.solve(tmp_path / "square.json")
    assert np.array_equal(again.displacement(), first.displacement())


def test_bodies_go_by_name_or_number():
    result = dpana.solve(SCENES / "punch.json")
    assert result.bodies == ["punch", "foundation"]
    assert np.array_equal(result.displacement("foundation"), result.displacement(1))
    with pytest.raises(dpana.Error, match="punch, foundation"):
        result.displacement("punsh")
    with pytest.raises(dpana.Error):
        result.stress(2)
    assert result.trust(starts=1)["starts"] == 1 if result.certified else True
    assert result.to_svg().startswith("<svg")
    assert 0 < result.stress_error_estimate() < 1


def test_the_error_of_the_stress_has_a_bound_or_a_reason_why_not():
    result = dpana.solve(
        {
            "bodies": [
                {
                    "mesh": {"rectangle": {"x": [0, 2], "y": [0, 1], "cells": [8, 4]}},
                    "model": "plane_strain",
                    "materials": [{"young": 1000, "poisson": 0.3}],
                    "supports": [{"group": "top", "displacement": [0, -0.01]}],
                }
            ],
            "contacts": [
                {
                    "group": "bottom",
                    "friction": 0.9,
                    "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}},
                }
            ],
        }
    )
    estimate, bound = result.stress_error_estimate(), result.stress_error_bound()
    assert 0.5 * estimate < bound < 3 * estimate
    with pytest.raises(dpana.Error, match="3D|plane"):
        dpana.solve(SCENES / "cube.json").stress_error_bound()


def test_the_stubs_name_what_there_is():
    package = Path(dpana.__file__).parent
    assert (package / "py.typed").exists()
    stub = ast.parse((package / "_dpana.pyi").read_text())
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    from dpana import _dpana

    public = {name for name in vars(_dpana) if not name.startswith("_")}
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    assert public == set(classes) | functions
    for name, node in classes.items():
        stated = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        there = {key for key in vars(getattr(_dpana, name)) if not key.startswith("_")}
        assert there == {key for key in stated if not key.startswith("_")}, name
        # What there is says what it is.
        for key in there:
            assert getattr(getattr(_dpana, name), key).__doc__, f"{name}.{key}"


@pytest.mark.parametrize("path", sorted((ROOT / "examples" / "python").glob("*.py")), ids=lambda p: p.stem)
def test_examples_run_and_find_their_numbers(path, monkeypatch):
    try:
        import matplotlib
    except ImportError:
        if "matplotlib" in path.read_text():
            pytest.skip("no matplotlib")
    else:
        matplotlib.use("Agg")
    monkeypatch.chdir(ROOT)
    runpy.run_path(str(path), run_name="__main__")
