"""`obbtree overlap`: answers, documents, exit codes, and options that are never ignored."""

from __future__ import annotations

from dataclasses import fields

import pytest
from mesh_files.cube_files import as_input, cube, obj, objects

from obbcli import Overlap, __version__
from obbcli.cli.commands.overlap import _CONCERNS
from obbcli.questions.overlap.asked import CONCERNS

KEYS = ["schema", "tool_version", "inputs", "motion", "accuracy", "asked", "result", "stats"]
APART = ("cube.stl", "cube.stl", "--translate-b", 3, 0, 0)


def opened(here):
    """Write a cube without its last triangle, and return its name."""
    text = obj(cube()).rstrip("\n").rpartition("\n")[0]
    (here / "opened.obj").write_text(text + "\n")
    return "opened.obj"


def test_overlap_document_holds_what_was_asked_and_answered(here, obbtree):
    ended = obbtree("overlap", *APART, "--along", 1, 0, 0, "--json")

    document = ended.json
    result = document["result"]
    assert (ended.code, ended.err) == (0, "")
    assert list(document) == KEYS
    assert document["schema"] == "obbtree/overlap/1"
    assert document["tool_version"] == __version__
    assert document["inputs"]["a"] == as_input(here / "cube.stl")
    assert document["asked"] == {"tolerance": 0.01, "deeper_than": None}
    assert list(result) == [field.name for field in fields(Overlap) if field.name != "stats"]
    assert result["relation"] == "clear"
    assert result["distance"]["bounds"][0] <= 2 <= result["distance"]["bounds"][1]
    assert result["thickness"]["bounds"] == [0, 0]
    assert result["separation_along"]["bounds"][0] <= 4 <= result["separation_along"]["bounds"][1]


def test_overlap_table_tells_it_to_people(here, obbtree):
    ended = obbtree("overlap", *APART, "--along", 1, 0, 0)

    lines = dict(line.split("  ", 1) for line in ended.out.splitlines())
    told = {name: value.strip() for name, value in lines.items()}
    assert told["relation"] == "clear"
    assert told["distance"] == "2 to 2, proven"
    assert told["A is free along 1 0 0"] == "after 4, proven"
    assert told["band"].endswith("4 spacings of the coordinates of A (float32)")


def test_bare_answer_is_the_relation(here, obbtree):
    assert obbtree("overlap", "cube.stl", "cube.stl", "--quiet").out == "duplicate\n"


def test_open_surface_is_told_with_its_edge(here, obbtree):
    ended = obbtree("overlap", opened(here), "cube.stl", "--translate", 0.5, 0, 0, "--json")

    result = ended.json["result"]
    assert result["relation"] == "crossing"
    assert result["thickness"] is None
    assert result["reason"].startswith("A (opened.obj) is not watertight: 3 edges do not join")


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (APART, 0),
        ((*APART, "--clearance", 5), 0),
        ((*APART, "--touch", 2.5, 0), 0),
        (("cube.stl", "cube.stl"), 1),
        ((*APART, "--max-iterations", 1), 4),
        (("cube.stl", "cube.stl", "--rotate", 0.1, 0.2, 0.3, "--max-iterations", 1), 4),
    ],
)
def test_exit_code_tells_bodies_that_meet(here, obbtree, words, code):
    assert obbtree("overlap", *words, "--exit-code").code == code


def test_exit_code_is_not_asked_unasked(here, obbtree):
    assert obbtree("overlap", "cube.stl", "cube.stl").code == 0


@pytest.mark.parametrize(
    ("words", "where", "code"),
    [
        (("--tolerance", "0"), "tolerance", 2),
        (("--tolerance", "nan"), "--tolerance", 2),
        (("--deeper-than", "-1"), "--deeper-than", 2),
        (("--touch", "-1", "0"), "--touch", 2),
        (("--touch", "inf", "0"), "--touch", 2),
        (("--along", "0", "0", "0"), "along", 2),
        (("--vel", "1", "0", "0"), "--vel", 2),
        (("--duration", "1"), "--duration", 2),
        (("--max-depth", "3"), "--max-depth", 2),
        (("--steps", "3"), "--steps", 2),
        (("--leaves", "boxes"), "--leaves", 2),
    ],
)
def test_what_says_nothing_is_one_clear_error(here, obbtree, words, where, code):
    ended = obbtree("overlap", *APART, *words)

    assert (ended.code, ended.out) == (code, "")
    assert where in ended.err
    assert ended.err.count("\n") == 1


def test_command_and_question_know_the_same_fields():
    assert _CONCERNS == CONCERNS


def test_regions_are_listed(here, obbtree):
    (here / "two.obj").write_text(objects(left=0.0, right=2.0))
    (here / "long.obj").write_text(obj([(4 * x - 0.5, y + 0.5, z) for x, y, z in cube()]))
    words = ("overlap", "two.obj", "long.obj", "--regions", "--resolution", 0.25)

    result = obbtree(*words, "--json").json["result"]
    table = obbtree(*words).out

    assert len(result["regions"]) == 2
    assert result["resolution"] == 0.25
    assert result["regions"][0]["thickness"][0] <= 0.5 <= result["regions"][0]["thickness"][1]
    assert "2, told apart by boxes of at most 0.25" in table
    assert "region 2" in table


def test_resolution_without_regions_is_refused(here, obbtree):
    ended = obbtree("overlap", *APART, "--resolution", 1)

    assert ended.code == 2
    assert "add --regions" in ended.err
    assert obbtree("overlap", *APART, "--regions", "--resolution", 0).code == 2


def test_regions_name_the_selected_parts_that_they_are_of(here, obbtree):
    (here / "two.obj").write_text(objects(left=0.0, right=2.0))
    (here / "long.obj").write_text(obj([(4 * x - 0.5, y + 0.5, z) for x, y, z in cube()]))
    words = ("overlap", "two.obj#*", "long.obj", "--regions", "--resolution", 0.25)

    regions = obbtree(*words, "--json").json["result"]["regions"]

    assert sorted(region["part_a"] for region in regions) == ["left", "right"]
    assert not any("part_b" in region for region in regions)
    assert "(left of A)" in obbtree(*words).out
