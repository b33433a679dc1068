"""`obbtree scene --overlaps` and `obbtree collide --solid --relation`."""

from __future__ import annotations

import pytest

SCENE = """
[[body]]
name = "one"
mesh = "cube.stl"
[[body]]
name = "two"
mesh = "cube.stl"
pose = { translation = [1, 0, 0] }
[[body]]
name = "three"
mesh = "cube.stl"
pose = { translation = [1.75, 0, 0] }
[[body]]
name = "far"
mesh = "cube.stl"
pose = { translation = [9, 0, 0] }
"""


@pytest.fixture
def row(here):
    """Write a scene of cubes in a row: flush, sunk and far."""
    (here / "row.toml").write_text(SCENE)
    return "row.toml"


def test_document_holds_the_pairs_that_are_not_clear(row, obbtree):
    ended = obbtree("scene", row, "--overlaps", "--json")

    document = ended.json
    pairs = document["result"]["pairs"]
    assert (ended.code, ended.err) == (0, "")
    assert document["schema"] == "obbtree/scene-overlaps/1"
    assert [body["name"] for body in document["bodies"]] == ["one", "two", "three", "far"]
    assert document["bodies"][1]["pose"]["translation"] == [1, 0, 0]
    assert [(one["body_a"], one["body_b"], one["relation"]) for one in pairs] == [
        ("one", "two", "touching"),
        ("two", "three", "overlapping"),
    ]
    low, high = pairs[1]["thickness"]["bounds"]
    assert low <= 0.25 <= high
    assert document["stats"]["apart_by_bounds"] == 4
    assert not document["result"]["interrupted"]


def test_table_and_bare_answer_name_the_pairs(row, obbtree):
    table = obbtree("scene", row, "--overlaps").out

    assert "answer          1 overlap, 1 touch" in table
    assert obbtree("scene", row, "--overlaps", "--quiet").out == (
        "touching one two\noverlapping two three\n"
    )


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ((), 1),
        (("--pairs", "one,two"), 0),
        (("--touch", 0.3, 0.3), 0),
        (("--max-iterations", 1), 4),
    ],
)
def test_exit_code_tells_overlap_and_not_touch(row, obbtree, words, code):
    assert obbtree("scene", row, "--overlaps", "--exit-code", *words).code == code


def test_clear_scene_says_so(row, obbtree):
    words = ("--overlaps", "--pairs", "one,far", "--quiet")

    assert obbtree("scene", row, *words).out == "clear\n"


@pytest.mark.parametrize(
    "words",
    [
        ("--overlaps", "--first"),
        ("--overlaps", "--all-contacts"),
        ("--overlaps", "--limit", 3),
        ("--overlaps", "--solid"),
        ("--overlaps", "--threads", 2),
        ("--overlaps", "--duration", 2),
        ("--overlaps", "--max-depth", 2),
        ("--overlaps", "--method", "sampled"),
        ("--touch", 0.1, 0.1),
        ("--tolerance", 0.1),
        ("--overlaps", "--tolerance", 0),
        ("--overlaps", "--pairs", "one"),
    ],
)
def test_what_says_nothing_is_one_clear_error(row, obbtree, words):
    ended = obbtree("scene", row, *words)

    assert (ended.code, ended.out) == (2, "")
    assert ended.err.count("\n") == 1


def test_collide_adds_relation_and_depths_where_asked(here, obbtree):
    words = ("collide", "cube.stl", "cube.stl", "--translate", 0.75, 0, 0, "--solid")

    result = obbtree(*words, "--relation", "--json").json["result"]

    assert result["collides"] is True
    assert result["relation"] == "overlapping"
    for name in ("thickness", "protrusion_a", "protrusion_b"):
        low, high = result[name]["bounds"]
        assert low <= 0.25 <= high
    assert "relation" not in obbtree(*words, "--json").json["result"]
    table = obbtree(*words, "--relation").out.splitlines()
    assert [line.split()[1] for line in table if line.startswith("relation")] == ["overlapping"]


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (("--relation",), "add --solid"),
        (("--solid", "--relation", "--vel", 1, 0, 0), "at t = 0"),
        (("--solid", "--relation", "--max-depth", 2), "--max-depth"),
    ],
)
def test_relation_is_asked_of_solids_at_rest(here, obbtree, words, fault):
    ended = obbtree("collide", "cube.stl", "cube.stl", *words)

    assert (ended.code, ended.out) == (2, "")
    assert fault in ended.err
