"""`obbtree tradeoff`: documents, tables, command lines that hold, pictures, exit codes."""

from __future__ import annotations

import json
import shlex
from dataclasses import replace

import pytest
from scenes.turning_cubes import TURN, TURN_TIME, asked

import obbcli
from obbcli.study.tradeoff.judge import Judge
from obbcli.study.tradeoff.measuring import Study


@pytest.fixture
def lying(monkeypatch):
    """Make sampled answers say contact too early, and claim that their paths are hardly off."""
    whole = Study._timed

    def timed(self, built, accuracy, limit):
        answer, seconds = whole(self, built, accuracy, limit)
        if accuracy.method == "sampled" and answer.time is not None:
            answer = replace(answer, time=0.0, time_bounds=(0.0, 0.0), error_bound=0.01)
        return answer, seconds

    monkeypatch.setattr(Study, "_timed", timed)


@pytest.mark.usefixtures("here", "small")
def test_document_holds_every_row_and_what_it_was_asked(obbtree):
    ended = asked(obbtree, "--json", "--max-error", 1e-6, "--max-time", 1.0)

    document = ended.json
    assert ended.code == 0
    assert document["schema"] == "obbtree/tradeoff/1"
    assert document["inputs"]["b"]["triangle_count"] == 12
    assert document["motion"]["a"]["angular_velocity"] == [0, 0, 1]
    assert document["accuracy"]["time_tolerance"] == 1e-12
    result = document["result"]
    assert result["reference"]["time"] == pytest.approx(TURN_TIME, abs=1e-11)
    assert result["claims_broken"] == 0
    assert result["claims_checked"] > len(result["rows"])
    assert not result["interrupted"]
    assert len(result["rows"]) >= 8
    for row in result["rows"]:
        assert row["warm_seconds"]["rounds"] >= 1
        assert row["warm_seconds"]["low_quartile"] <= row["warm_seconds"]["median"]
        if row["time"] is not None:
            assert row["time_error"] == pytest.approx(row["time"] - TURN_TIME, abs=1e-11)
    for part in result["recommended"]:
        chosen = result["rows"][part["row_proven"]]
        assert chosen["approximate"] is False
        assert not chosen["verdict_wrong"]


@pytest.mark.usefixtures("here", "small")
def test_command_lines_give_the_answers_of_their_rows(obbtree):
    rows = asked(obbtree, "--json").json["result"]["rows"]

    for row in rows:
        *builds, question = row["command"].split(" && ")
        assert bool(builds) == (row["build"]["fit"] != "triangles" or row["build"]["leaf_size"] > 1
                                or row["build"]["split"] != "compact"
                                or row["build"]["max_depth"] is not None)  # fmt: skip
        for line in builds:
            assert obbtree(*shlex.split(line)[1:], "--force").code == 0
        answer = obbtree(*shlex.split(question)[1:], "--json").json
        assert answer["accuracy"] == row["accuracy"]
        for name in ("status", "time", "time_bounds", "evidence", "approximate", "error_bound"):
            assert answer["result"][name] == row[name]


@pytest.mark.usefixtures("here", "small")
def test_tables_show_front_prices_and_recommendations(obbtree):
    ended = asked(obbtree, "--max-error", 1e-6)

    assert ended.code == 0
    assert ended.err == ""
    for text in ("all true", "the front", "what an error costs", "for --max-error 1e-06",
                 "--method sampled", "proof", "1e-09 of the duration"):  # fmt: skip
        assert text in ended.out


@pytest.mark.usefixtures("here", "small")
def test_gap_is_a_limit_of_its_own(obbtree):
    result = asked(obbtree, "--json", "--max-gap", 1e-3).json["result"]

    (part,) = result["recommended"]
    assert part["limits"] == {"max_gap": 1e-3}
    fit = [row for row in result["rows"] if not row["verdict_wrong"] and row["gap"] <= 1e-3]
    fastest = min((row["warm_seconds"]["median"], abs(row["time_error"])) for row in fit)
    chosen = result["rows"][part["row"]]
    assert chosen in fit
    assert (chosen["warm_seconds"]["median"], abs(chosen["time_error"])) == fastest
    assert any(row["gap"] > 1e-3 for row in result["rows"] if row["gap"] is not None)


@pytest.mark.usefixtures("here", "small")
def test_quiet_prints_command_lines_alone(obbtree):
    best = asked(obbtree, "--quiet", "--max-error", 1e-6).out.splitlines()
    front = asked(obbtree, "--quiet").out.splitlines()

    assert len(best) == 1
    assert front
    assert all("obbtree first-contact" in line for line in (*best, *front))


@pytest.mark.usefixtures("here", "small", "lying")
def test_bound_that_is_not_true_is_a_fault_of_ours(obbtree):
    ended = asked(obbtree, "--json")
    table = asked(obbtree)

    assert (ended.code, table.code) == (6, 6)
    broken = [row for row in ended.json["result"]["rows"] if row["faults"]]
    assert {row["accuracy"]["method"] for row in broken} == {"sampled"}
    assert "apart, and at most 0.01 is claimed" in broken[0]["faults"][0]
    assert "BROKEN" in table.out


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"time": 0.3, "time_bounds": (0.3, 0.3)}, "no contact before 0.3 s, and there is one by"),
        ({"time": 0.1, "time_bounds": (0.1, 0.1)}, "contact by 0.1 s, and there is none before"),
        (
            {"status": obbcli.Status.SEPARATED, "time": None, "time_bounds": None,
             "evidence": None, "distance": None},
            "it proves separation, and the reference proves contact",
        ),
        ({"evidence": "boxes", "time": 0.1, "time_bounds": (0.1, None), "approximate": True,
          "distance": None, "error_bound": 1e-3}, "at 0.1 s the surfaces are"),
    ],
)  # fmt: skip
def test_false_proofs_are_seen(here, change, fault):
    mesh = obbcli.load_mesh("cube.stl")
    tree = obbcli.ObbTree.build(mesh)
    a = obbcli.Body(tree, motion=obbcli.Motion(angular_velocity=[0, 0, 1]))
    b = obbcli.Body(tree, obbcli.Pose(translation=[1.1, 0, 0]))
    reference = obbcli.first_contact(a, b, 1.0, obbcli.Accuracy(time_tolerance=1e-12))
    judge = Judge((a, b), reference, 0.0)
    true = obbcli.first_contact(a, b, 1.0)

    judged = judge.judge(replace(true, **change))

    assert judge.judge(true).faults == ()
    assert any(fault in text for text in judged.faults)
    turned = Judge((a, b), replace(true, **change), 0.0).judge(reference)
    assert turned.faults or change.get("evidence") == "boxes"


@pytest.mark.usefixtures("here", "small")
def test_interrupt_keeps_what_was_measured(obbtree, monkeypatch):
    whole, calls = Study._timed, []

    def timed(self, *args):
        calls.append(args)
        if len(calls) > 4:
            raise KeyboardInterrupt
        return whole(self, *args)

    monkeypatch.setattr(Study, "_timed", timed)

    ended = asked(obbtree, "--json")

    assert ended.code == 130
    assert ended.json["result"]["interrupted"] is True
    assert len(ended.json["result"]["rows"]) == 3
    assert (ended.error["error"], ended.error["code"]) == ("interrupted", 130)


@pytest.mark.usefixtures("here")
def test_interrupt_before_the_reference_leaves_nothing(obbtree, monkeypatch):
    def timed(self, *args):
        raise KeyboardInterrupt

    monkeypatch.setattr(Study, "_timed", timed)

    ended = asked(obbtree)

    assert ended.code == 130
    assert ended.out == ""
    assert "nothing was measured" in ended.err


@pytest.mark.usefixtures("here")
def test_limit_that_ends_the_reference_is_unresolved(obbtree):
    ended = asked(obbtree, "--max-iterations", 1, "--json")

    assert ended.code == 4
    assert ended.json["result"]["reference"]["status"] == "unresolved"
    assert ended.json["result"]["rows"] == []
    assert "no certified answer" in asked(obbtree, "--max-iterations", 1).err


@pytest.mark.usefixtures("here", "small")
def test_trees_are_used_as_they_are(obbtree):
    assert obbtree("build", "cube.stl", "touching.obj", "-o", ".", "--fit", "points").code == 0

    ended = obbtree("tradeoff", "cube.obbt", "touching.obbt", *TURN, "--budget", 1000, "--json")

    assert ended.code == 0
    assert {json.dumps(row["build"]) for row in ended.json["result"]["rows"]} == {"{}"}
    assert all("build" not in row["command"] for row in ended.json["result"]["rows"])


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (("--budget", -1), 2, "--budget"),
        (("--max-error", "nan"), 2, "--max-error"),
        (("--max-gap", -1), 2, "--max-gap"),
        (("--max-time", -1), 2, "--max-time"),
        (("--plot", "trade.pdf"), 2, "is no .svg or .png file"),
        (("--plot", "gone/trade.svg"), 5, "folder"),
        (("--plot", "trade.svg", "-o", "trade.svg"), 2, "where the answer goes"),
        (("--steps", 5), 2, "--method sampled"),
        (("--pivot", 0, 0, 0, "--omega-b", 0, 0, 1), 0, None),
        (("-o", "cube.stl"), 2, "would be lost"),
    ],
)
@pytest.mark.usefixtures("here", "small")
def test_bad_options_are_refused_before_anything_is_measured(obbtree, words, code, text):
    ended = asked(obbtree, *words)

    assert ended.code == code
    if text is not None:
        assert text in ended.err
        assert ended.out == ""


@pytest.mark.usefixtures("here", "small")
def test_one_mesh_against_itself_is_built_once(obbtree):
    ended = obbtree("tradeoff", "cube.stl", "cube.stl", "--translate-b", 3, 0, 0, "--vel", 1, 0, 0,
                    "--duration", 1.5, "--budget", 1000, "--json")  # fmt: skip

    assert ended.code == 0
    for row in ended.json["result"]["rows"]:
        assert row["command"].count("obbtree build") <= 1


@pytest.mark.usefixtures("here", "small")
def test_meshes_of_one_name_get_trees_of_their_own(here, obbtree):
    (here / "other").mkdir()
    (here / "other" / "cube.obj").write_text((here / "touching.obj").read_text())

    ended = obbtree("tradeoff", "cube.stl", "other/cube.obj", *TURN, "--budget", 1000, "--json")

    built = [row["command"] for row in ended.json["result"]["rows"] if "build" in row["command"]]
    assert built
    assert all("-o cube.obbt " in line and "-o cube-b.obbt " in line for line in built)


@pytest.mark.usefixtures("here")
def test_standard_input_for_both_is_refused(obbtree):
    ended = obbtree("tradeoff", "-", "-")

    assert ended.code == 2
    assert "name a file for one of them" in ended.err


@pytest.mark.usefixtures("here")
def test_file_that_is_not_there_is_refused(obbtree):
    ended = obbtree("tradeoff", "cube.stl", "gone.stl")

    assert ended.code == 3
    assert "gone.stl" in ended.err
