"""`obbtree scene --least-clearance`."""

from __future__ import annotations

import pytest

from obbcli.scene.clearances import Clearances

SCENE = """
duration = 1.0
[[body]]
name = "comes"
mesh = "cube.stl"
motion = { linear_velocity = [1.5, 0, 0] }
[[body]]
name = "near"
mesh = "cube.stl"
pose = { translation = [3, 0, 0] }
[[body]]
name = "mid"
mesh = "cube.stl"
pose = { translation = [9, 0, 0] }
[[body]]
name = "far"
mesh = "cube.stl"
pose = { translation = [104, 0, 0] }
"""
GAPS = [0.5, 5.0, 6.5, 94.0, 100.0, 101.5]


@pytest.fixture
def row(here):
    """Write a scene of cubes in a row, the first of which moves towards the others."""
    (here / "row.toml").write_text(SCENE)
    return "row.toml"


def test_document_holds_the_pairs_nearest_first(row, obbtree):
    ended = obbtree("scene", row, "--least-clearance", "--json")

    document = ended.json
    result = document["result"]
    assert (ended.code, ended.err) == (0, "")
    assert document["schema"] == "obbtree/scene-clearances/1"
    assert [body["name"] for body in document["bodies"]] == ["comes", "near", "mid", "far"]
    for pair, gap in zip(result["pairs"], GAPS, strict=True):
        low, high = pair["minimum"]["bounds"]
        assert low <= gap <= high <= gap * 1.00001
    assert result["pairs"][0]["minimum"]["time"] == 1.0
    assert result["complete"]
    assert not result["interrupted"]
    assert result["others_at_least"] is None
    assert document["stats"]["apart_by_trees"] == 6


def test_table_and_bare_answer_name_the_pairs(row, obbtree):
    table = obbtree("scene", row, "--least-clearance", "--within", 1).out

    assert "least distance 0.5, of comes and near" in table
    assert "5 further than 1 by their bounds" in table
    bare = obbtree("scene", row, "--least-clearance", "--within", 5.5, "--quiet").out
    assert [line.split()[1:] for line in bare.splitlines()] == [["comes", "near"], ["near", "mid"]]
    assert obbtree("scene", row, "--least-clearance", "--within", 0, "--quiet").out == "none\n"


def test_first_pairs_alone_say_what_is_proven_of_others(row, obbtree):
    result = obbtree("scene", row, "--least-clearance", "--limit", 1, "--json").json["result"]

    assert [pair["body_b"] for pair in result["pairs"]] == ["near"]
    assert 0.5 <= result["others_at_least"] <= 5.0


def test_explained_answer_says_what_of_each_body_was_used(row, obbtree):
    told = obbtree("scene", row, "--least-clearance", "--explain").out

    assert "what of each body was used" in told
    assert "what of each body was used" not in obbtree("scene", row, "--least-clearance").out


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ((), 0),
        (("--exit-code",), 0),
        (("--at-least", 0.6), 0),
        (("--exit-code", "--at-least", 0.6), 1),
        (("--exit-code", "--at-least", 0.4), 0),
        (("--exit-code", "--duration", 3), 1),
        (("--duration", 3), 0),
        (("--max-iterations", 1), 4),
        (("--timeout", 0), 4),
    ],
)
def test_exit_code_tells_what_comes_nearer(row, obbtree, words, code):
    assert obbtree("scene", row, "--least-clearance", *words).code == code


def test_verdicts_stand_with_the_pairs(row, obbtree):
    words = ("scene", row, "--least-clearance", "--at-least", 6)

    assert obbtree(*words, "--quiet").out == "violated comes near\nviolated near mid\n"
    assert "answer          2 pairs come nearer than 6" in obbtree(*words).out
    pair = obbtree(*words, "--json").json["result"]["pairs"][0]
    assert pair["at_least"]["verdict"] == "violated"


def test_interrupt_tells_what_is_known_by_then(row, obbtree, monkeypatch):
    advance = Clearances.advance

    def interrupted(self):
        if self.stats.apart_by_trees == 2 and not self.is_stopped:
            raise KeyboardInterrupt
        return advance(self)

    monkeypatch.setattr(Clearances, "advance", interrupted)
    ended = obbtree("scene", row, "--least-clearance", "--json")

    result = ended.json["result"]
    assert ended.code == 130
    assert result["interrupted"]
    assert not result["complete"]
    assert [pair["body_b"] for pair in result["pairs"]][:2] == ["near", "mid"]
    assert ended.json["stats"]["later"] == 6 - len(result["pairs"])


@pytest.mark.parametrize(
    "words",
    [
        ("--least-clearance", "--first"),
        ("--least-clearance", "--all-contacts"),
        ("--least-clearance", "--overlaps"),
        ("--least-clearance", "--threads", 2),
        ("--least-clearance", "--touch", 0.1, 0.1),
        ("--least-clearance", "--clearance", 1),
        ("--least-clearance", "--max-depth", 2),
        ("--least-clearance", "--method", "sampled"),
        ("--least-clearance", "--tolerance", 0),
        ("--least-clearance", "--pairs", "near"),
        ("--within", 1),
        ("--at-least", 1),
        ("--overlaps", "--within", 1),
    ],
)
def test_what_says_nothing_is_one_clear_error(row, obbtree, words):
    ended = obbtree("scene", row, *words)

    assert (ended.code, ended.out) == (2, "")
    assert ended.err.count("\n") == 1


def test_accuracy_of_the_file_that_says_nothing_is_refused(here, obbtree):
    (here / "close.toml").write_text("accuracy = { clearance = 1.0 }\n" + SCENE)

    ended = obbtree("scene", "close.toml", "--least-clearance")

    assert (ended.code, ended.out) == (3, "")
    assert "accuracy.clearance" in ended.err
    assert "two things" in ended.err
