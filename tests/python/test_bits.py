"""The same bits as the command line: reports, fields, decks, cases, restarts."""

import json

import numpy as np
import pytest
from conftest import DATA, SCENES, read_report, without_seconds

import dpana


@pytest.mark.parametrize("name", ["square", "ssnv128", "hertz", "punch", "cube", "two_cubes", "fretting"])
def test_a_scene_has_the_report_and_the_fields_of_the_command_line(program, tmp_path, name):
    scene = SCENES / f"{name}.json"
    report, vtu = tmp_path / "report.json", tmp_path / "theirs.vtu"
    ran = program("solve", scene, "--report", report, "--vtu", vtu)
    assert ran.returncode == 0, ran.stderr
    result = dpana.solve(scene)
    theirs = read_report(report)
    assert without_seconds(result.report()) == theirs
    assert result.certified and result.status == theirs["status"]
    assert result.totals == theirs["totals"] and result.notes == theirs["notes"]
    # VTU holds every bit of displacement and stress.
    ours = tmp_path / "ours.vtu"
    result.write_vtu(ours)
    steps = sorted(tmp_path.glob("theirs_0*.vtu"))
    last = [path for path in steps if "contact" not in path.name][-1] if steps else vtu
    assert ours.read_bytes() == last.read_bytes()


def test_the_schema_is_that_of_the_command_line():
    assert dpana.schema() == json.loads((SCENES / "scene.schema.json").read_text())


def test_contacts_are_those_of_the_report(tmp_path):
    result = dpana.solve(SCENES / "square.json")
    contacts, stated = result.contacts, result.report()["contacts"]
    assert len(contacts) == len(stated) > 0
    words = np.array(["open", "slip", "stick"])
    assert words[contacts.state].tolist() == [contact["state"] for contact in stated]
    for name, of in contacts.to_dict().items():
        if name not in ("state", "normal_reaction", "initial_gap"):
            assert of.tolist() == [contact[name] for contact in stated], name
    assert contacts.position.shape == contacts.slip.shape == (len(stated), 2)
    assert np.all(contacts.normal_reaction <= 0)


def test_a_deck_is_solved_as_the_command_line_does(program, tmp_path):
    deck = DATA / "decks" / "own_blocks_c3d8.inp"
    assert program("solve", deck, "--report", tmp_path / "report.json").returncode == 0
    scene = dpana.Scene.read(deck)
    ours = without_seconds(scene.solve().report())
    theirs = read_report(tmp_path / "report.json")
    assert ours["contacts"] == theirs["contacts"]
    assert ours["certificate"] == theirs["certificate"]


def test_cases_are_those_of_the_command_line(program, tmp_path):
    table = tmp_path / "cases.json"
    vary = ["--vary", "friction=0:1:4", "--vary", "contacts[0].gap=0,-0.0001"]
    assert program("cases", SCENES / "square.json", *vary, "--out", table).returncode == 0
    theirs = json.loads(table.read_text())
    scene = dpana.Scene.read(SCENES / "square.json")
    ours = scene.cases({"friction": np.linspace(0, 1, 4), "contacts[0].gap": [0, -0.0001]})
    assert list(ours) == theirs["columns"]
    for name, column in zip(theirs["columns"], zip(*theirs["rows"])):
        if "seconds" not in name:
            assert ours[name].tolist() == list(column), name


def test_a_history_goes_on_from_a_state_bit_for_bit():
    scene = dpana.Scene.read(SCENES / "fretting.json")
    states = scene.solve_steps()
    assert [state.step["at"] for state in states] == scene.steps["at"]
    again = scene.solve_steps(restart=states[3].state())
    assert len(again) == len(states) - 4
    for one, other in zip(states[4:], again):
        assert np.array_equal(one.displacement(), other.displacement())
        assert np.array_equal(one.contacts.force, other.contacts.force)


def test_an_input_is_refused_in_the_words_of_the_command_line(program, tmp_path):
    scene = json.loads((SCENES / "square.json").read_text())
    scene["bodies"][0]["materials"][0]["poisson"] = 0.7
    path = tmp_path / "bad.json"
    for text in (json.dumps(scene), '{"bodies": [],\n "contcts": []}', "", json.dumps({**scene, "contacts": []})):
        path.write_text(text)
        ran = program("solve", path)
        assert ran.returncode == 2
        with pytest.raises(dpana.Error) as refused:
            dpana.solve(path)
        assert str(refused.value) in ran.stderr


def test_the_condensed_problem_of_a_scene_solves_to_the_reactions_of_the_scene():
    scene = dpana.Scene.read(SCENES / "square.json")
    result, problem = scene.solve(), scene.condense()
    assert np.array_equal(problem.G, result.problem.G)
    assert np.array_equal(problem.u_free, result.problem.u_free)
    bare = dpana.Problem(problem.G, problem.u_free, problem.gap, problem.mu, problem.tangents)
    for solved in (problem.solve(), bare.solve()):
        assert solved.certified
        first = np.concatenate([[0], np.cumsum(1 + problem.tangents)[:-1]])
        assert np.array_equal(solved.reaction[first], result.contacts.normal_reaction)
    # Frames turn the blocks into global forces.
    frames, contacts = problem.frames, result.contacts
    assert frames.shape == (problem.contacts, 2, 2)
    reaction = solved.reaction.reshape(-1, 2)
    assert np.allclose(np.einsum("ij,ijk->ik", reaction, frames), contacts.force, rtol=0, atol=1e-12 * abs(reaction).max())
    assert np.array_equal(frames[:, 0], contacts.normal)
