"""`obbtree first-contact`: closed forms on sample meshes and cubes, documents, exit codes."""

from __future__ import annotations

import json
import math
from dataclasses import fields
from pathlib import Path

import pytest
from mesh_files.cube_files import as_input

from obbcli import Accuracy, FirstContact

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
KEYS = ["schema", "tool_version", "inputs", "motion", "accuracy", "solid", "result", "stats"]


def ask(obbtree, a, b, *words):
    return obbtree("first-contact", SAMPLES / a, SAMPLES / b, *words, "--json")


@pytest.mark.parametrize(
    ("a", "b", "words", "time"),
    [
        # 2 mm of slack, pulled by 1 mm/s.
        ("chain_link_a.off", "chain_link_b.ply", ("--vel-b", 1, 0, 0, "--duration", 5), 2.0),
        # 0.05 mm above the floor, sinking by 1 mm/s.
        ("housing.stl", "board.vtk", ("--vel-b", 0, 0, -1), 0.05),
        # 5 mm beside the workpiece, closing by 10 mm/s.
        ("finger_left.off", "workpiece.obj", ("--vel", 0, -10, 0), 0.5),
        ("workpiece.obj", "finger_left.off", ("--vel-b", 0, -10, 0), 0.5),
    ],
)
def test_first_contact_of_sliding_parts_is_exact(obbtree, a, b, words, time):
    result = ask(obbtree, a, b, *words).json["result"]

    low, high = result["time_bounds"]
    assert result["status"] == "contact"
    assert result["time"] == low
    assert math.isclose(low, time, rel_tol=1e-14)
    assert high - low <= math.ulp(time)
    assert result["evidence"] == "intersecting"


def test_first_contact_of_gears_out_of_ratio_is_bracketed(obbtree):
    words = ("--omega", 0, 0, 3, "--omega-b", 0, 0, -5.9, "--duration", 2)

    result = ask(obbtree, "gear.stl", "pinion.stl", *words).json["result"]

    low, high = result["time_bounds"]
    assert math.isclose(low, 0.0567993, abs_tol=1e-7)
    assert 0 < high - low <= 2e-9
    assert result["evidence"] == "intersecting"
    assert math.hypot(*result["point"][:2]) < 38.0
    assert math.isclose(math.hypot(*result["normal"]), 1.0)


def test_first_contact_of_gears_in_ratio_is_proven_never_to_come(obbtree):
    words = ("--omega", 0, 0, 3, "--omega-b", 0, 0, -6, "--duration", 0.1, "--exit-code")

    ended = ask(obbtree, "gear.stl", "pinion.stl", *words)

    assert ended.code == 0
    assert ended.json["result"]["status"] == "separated"


def test_first_contact_of_nut_and_bolt_stays_away_while_screwed(obbtree):
    words = ("--vel-b", 0, 0, -2, "--omega-b", 0, 0, -360, "--degrees", "--pivot-b", 0, 0, 0,
             "--duration", 0.05, "--exit-code")  # fmt: skip

    assert ask(obbtree, "bolt.ply", "nut.obj", *words).json["result"]["status"] == "separated"


def test_first_contact_document_holds_what_was_asked_and_answered(here, obbtree):
    document = obbtree("first-contact", "cube.stl", "apart.obj", "--vel", 1, 0, 0, "--json").json

    left_out = "part_a", "part_b", "stats", "released"
    names = [field.name for field in fields(FirstContact) if field.name not in left_out]
    assert list(document) == KEYS
    assert document["schema"] == "obbtree/first-contact/1"
    assert document["inputs"]["a"] == as_input(here / "cube.stl")
    assert document["motion"]["a"]["linear_velocity"] == [1.0, 0.0, 0.0]
    assert document["motion"]["duration"] == 1.0
    assert document["accuracy"] == Accuracy().as_dict()
    assert list(document["result"]) == names
    assert document["result"]["time_bounds"] == [2**-40, 2**-40]
    assert set(document["stats"]["seconds"]) == {"load", "query"}


def test_first_contact_fields_that_do_not_apply_are_null(here, obbtree):
    ended = obbtree("first-contact", "cube.stl", "apart.obj", "--vel", -1, 0, 0, "--json")

    result = ended.json["result"]
    assert result.pop("status") == "separated"
    assert result.pop("approximate") is False
    assert result.pop("error_bound") == 0.0
    assert set(result.values()) == {None}


@pytest.mark.parametrize("limit", [("--max-iterations", 1), ("--timeout", 0)])
def test_first_contact_at_a_limit_keeps_what_is_proven(obbtree, limit):
    words = ("--omega", 0, 0, 3, "--omega-b", 0, 0, -6, "--duration", 2)

    ended = ask(obbtree, "gear.stl", "pinion.stl", *words, *limit)

    low, high = ended.json["result"]["time_bounds"]
    assert ended.code == 4
    assert ended.json["result"]["status"] == "unresolved"
    assert 0 <= low < 2
    assert high is None


def test_first_contact_of_boxes_says_approximate(here, obbtree):
    words = ("--vel", 1, 0, 0, "--translate-b", 1, 0, 0, "--max-depth", 0)

    result = obbtree("first-contact", "cube.stl", "apart.obj", *words, "--json").json["result"]

    assert result["approximate"] is True
    assert (result["evidence"], result["feature"]) == ("boxes", "box")
    assert 0 < result["time_bounds"][0] <= 1 + 2**-40
    assert result["time_bounds"][1] is None
    assert result["error_bound"] > 0


@pytest.mark.parametrize(
    ("other", "words", "code"),
    [
        ("apart.obj", ("--vel", "1", "0", "0"), 1),
        ("apart.obj", ("--vel", "-1", "0", "0"), 0),
        ("touching.obj", (), 1),
        ("apart.obj", (), 0),
        ("apart.obj", ("--vel", "1", "0", "0", "--max-iterations", "1"), 4),
    ],
)
def test_first_contact_exit_codes(here, obbtree, other, words, code):
    assert obbtree("first-contact", "cube.stl", other, *words, "--exit-code").code == code
    assert obbtree("first-contact", "cube.stl", other, *words).code == (4 if code == 4 else 0)


@pytest.mark.parametrize(
    ("other", "words", "line"),
    [
        ("apart.obj", ("--vel", "-1", "0", "0"), "separated\n"),
        ("touching.obj", (), "overlap_at_start 0.0\n"),
        ("apart.obj", ("--vel", "1", "0", "0"), f"contact {2**-40!r}\n"),
        ("apart.obj", ("--vel", "1", "0", "0", "--max-iterations", "1"), "unresolved 0.0\n"),
    ],
)
def test_first_contact_quiet_is_status_and_time(here, obbtree, other, words, line):
    assert obbtree("first-contact", "cube.stl", other, *words, "-q").out == line


@pytest.mark.parametrize(
    ("other", "words", "texts"),
    [
        ("apart.obj", ("--vel", "1", "0", "0"),
         ("status", f"first contact at t = {2**-40!r} s", "the triangles intersect",
          "cube.stl (12 triangles)", "(from A to B)")),
        ("apart.obj", ("--vel", "-1", "0", "0"), ("no contact in the whole duration",)),
        ("touching.obj", (), ("in contact at t = 0\n", "triangles")),
        ("touching.obj", ("--translate-b", "-0.5", "0.25", "0.25"), ("of B\n",)),
        ("touching.obj", ("--max-depth", "0"), ("in contact at t = 0 of boxes: the surfaces",)),
        ("apart.obj", ("--vel", "1", "0", "0", "--translate-b", "1", "0", "0", "--max-depth", "0"),
         ("first contact of boxes at t = ", "none before, and then the surfaces are at most")),
        ("apart.obj",
         ("--clearance", "0.5", "--translate-b", "1", "0", "0", "--vel", "1", "0", "0"),
         ("first contact at t = 0.5", "the points are at most 0.5")),
        ("apart.obj", ("--vel", "1", "0", "0", "--max-iterations", "1"),
         ("a limit was reached; no contact before t = 0.0 s",)),
    ],
)  # fmt: skip
def test_first_contact_table_says_what_is_proven(here, obbtree, other, words, texts):
    ended = obbtree("first-contact", "cube.stl", other, *words)

    assert ended.err == ""
    for text in texts:
        assert text in ended.out


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (("--pivot", "0", "0", "0", "--vel", "1", "0", "0"), "add --omega"),
        (("--duration", "-1"), "at least 0"),
        (("--omega", "1e308", "1e308", "nan"), "not a finite number"),
        (("--vel-b", "1e308", "0", "0", "--duration", "99"), "error: --vel-b --duration: "),
    ],
)
def test_first_contact_refuses_usage_that_means_nothing(here, obbtree, words, fault):
    ended = obbtree("first-contact", "cube.stl", "apart.obj", *words)

    assert ended.code == 2
    assert ended.out == ""
    assert ended.err.count("\n") == 1
    assert fault in ended.err


@pytest.mark.parametrize(
    "words",
    [("--omega", "1e308", "0", "0"), ("--omega", "0", "0", "1", "--pivot", "1e300", "0", "0")],
)
@pytest.mark.parametrize("command", ["first-contact", "collide"])
def test_end_of_digits_is_no_limit_of_the_users(here, obbtree, command, words):
    ended = obbtree(command, "cube.stl", "apart.obj", *words)

    assert ended.code == 4
    assert "a limit was reached or the digits of doubles ended" in ended.out


@pytest.mark.parametrize("tolerance", [0.0, 1e-300])
def test_first_contact_says_how_near_where_less_was_asked(here, obbtree, tolerance):
    words = ("--vel", 1, 0, 0, "--omega", 0, 0, 0.5, "--translate-b", 1, 0, 0, "--duration", 2,
             "--time-tolerance", tolerance, "--distance-tolerance", tolerance)  # fmt: skip

    document = obbtree("first-contact", "cube.stl", "apart.obj", *words, "--json").json

    assert document["accuracy"]["distance_tolerance"] == tolerance
    assert document["result"]["evidence"] == "within_tolerance"
    assert 1e-16 < document["result"]["distance"] < 1e-12
    out = obbtree("first-contact", "cube.stl", "apart.obj", *words).out
    assert "s later contact, or they pass each other at most" in out


def test_first_contact_is_the_same_on_meshes_and_trees(here, obbtree):
    obbtree("build", "cube.stl", "apart.obj")
    words = ("--omega", 0, 0, 1, "--json")

    documents = [
        obbtree("first-contact", f"cube.{a}", f"apart.{b}", *words).json
        for a, b in (("stl", "obj"), ("obbt", "obj"), ("obbt", "obbt"))
    ]

    for document in documents:
        del document["stats"], document["inputs"]
    assert len({json.dumps(document) for document in documents}) == 1
