"""`obbtree clearance`: answers, documents, exit codes, and options that are never ignored."""

from __future__ import annotations

from dataclasses import fields

import pytest

from obbcli import Clearance, __version__
from obbcli.cli.commands.clearance import _CONCERNS
from obbcli.questions.clearance.asked import CONCERNS

KEYS = [
    *("schema", "tool_version", "inputs", "motion", "accuracy", "solid", "asked"),
    *("result", "stats"),
]
# A cube of side 1 goes by another, 1 away.
PASSING = ("cube.stl", "cube.stl", "--translate-b", -6, 2, 0, "--vel-b", 6, 0, 0, "--duration", 2)
TURNING = (*PASSING, "--omega-b", 3, 2, 1)
MEETING = ("cube.stl", "cube.stl", "--translate-b", -5, 0, 0, "--vel-b", 4, 0, 0, "--duration", 2)


def test_clearance_document_holds_what_was_asked_and_answered(here, obbtree):
    ended = obbtree("clearance", *PASSING, "--json")

    document = ended.json
    result = document["result"]
    least = result["minimum"]
    assert (ended.code, ended.err) == (0, "")
    assert list(document) == KEYS
    assert document["schema"] == "obbtree/clearance/1"
    assert document["tool_version"] == __version__
    assert document["asked"] == {"tolerance": 1e-6, "at_least": None}
    assert list(result) == [field.name for field in fields(Clearance) if field.name != "stats"]
    assert least["bounds"][0] <= 1 <= least["bounds"][1]
    assert least["when"][0][0] <= least["time"] <= least["when"][-1][1]
    assert (
        result["curve"]
        is result["maximum"]
        is result["at_least"]
        is result["first_contact"]
        is None
    )
    assert result["complete"] is True


def test_contact_comes_with_its_time_and_place(here, obbtree):
    ended = obbtree("clearance", *MEETING, "--json")

    result = ended.json["result"]
    assert result["minimum"]["bounds"] == [0, 0]
    assert result["minimum"]["time"] == result["first_contact"]["time"] == 1
    assert result["first_contact"]["status"] == "contact"


def test_clearance_table_tells_it_to_people(here, obbtree):
    lines = dict(line.split("  ", 1) for line in obbtree("clearance", *PASSING).out.splitlines())
    told = {name: value.strip() for name, value in lines.items()}

    assert told["answer"] == "apart at all times"
    assert told["least distance"].endswith("proven")
    assert told["at"].startswith("t = ")
    assert "first contact at t = 1.0 s" in obbtree("clearance", *MEETING).out
    assert "greatest distance  " in obbtree("clearance", *PASSING, "--greatest").out
    assert "violated at t = " in obbtree("clearance", *PASSING, "--at-least", 2).out


@pytest.mark.parametrize(
    ("words", "bare"),
    [((), None), (("--at-least", 0.5), "holds"), (("--at-least", 1.5), "violated")],
)
def test_bare_answer_is_the_bound_or_the_verdict(here, obbtree, words, bare):
    out = obbtree("clearance", *PASSING, *words, "--quiet").out

    assert out.strip() == bare or float(out) == pytest.approx(1, rel=1e-6)


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (PASSING, 0),
        ((*PASSING, "--at-least", 0.5), 0),
        ((*PASSING, "--at-least", 1.5), 1),
        ((*TURNING, "--max-iterations", 1), 4),
        ((*TURNING, "--max-iterations", 1, "--at-least", 0.5), 4),
        (MEETING, 1),
        ((*MEETING, "--at-least", 0.1), 1),
        (("cube.stl", "cube.stl"), 1),
        (("cube.stl", "cube.stl", "--translate-b", 3, 0, 0), 0),
    ],
)
def test_exit_code_tells_bodies_that_come_too_near(here, obbtree, words, code):
    assert obbtree("clearance", *words, "--exit-code").code == code


def test_exit_code_is_not_asked_unasked(here, obbtree):
    assert obbtree("clearance", *MEETING).code == 0
    assert obbtree("clearance", *PASSING, "--at-least", 1.5).code == 0
    assert obbtree("clearance", *TURNING, "--max-iterations", 1).code == 4


def test_curve_has_a_row_an_interval(here, obbtree):
    curve = obbtree("clearance", *PASSING, "--curve", 3, "--json").json["result"]["curve"]

    assert [(row["from"], row["to"]) for row in curve][::2] == [(0, 2 / 3), (4 / 3, 2)]
    assert curve[1]["bounds"] == pytest.approx([1, 1], rel=1e-5)
    table = obbtree("clearance", *PASSING, "--curve", 3).out
    assert "least distance, interval by interval" in table


def test_solid_counts_what_is_inside(here, obbtree):
    inside = ("cube.stl", "cube.stl", "--scale-b", 0.25, "--translate-b", 0.3, 0.3, 0.3)

    assert obbtree("clearance", *inside, "--exit-code").code == 0
    ended = obbtree("clearance", *inside, "--solid", "--exit-code")
    assert ended.code == 1
    assert "one body is inside the other" in ended.out


@pytest.mark.parametrize(
    ("words", "where"),
    [
        (("--greatest", "--solid"), "greatest"),
        (("--curve", "3", "--solid"), "--curve"),
        (("--curve", "0"), "--curve"),
        (("--tolerance", "0"), "tolerance"),
        (("--tolerance", "1"), "tolerance"),
        (("--tolerance", "nan"), "--tolerance"),
        (("--at-least", "-1"), "--at-least"),
        (("--at-least", "inf"), "--at-least"),
        (("--clearance", "1"), "--at-least"),
        (("--max-depth", "3"), "--max-depth"),
        (("--leaves", "boxes"), "--leaves"),
        (("--time-tolerance", "1e-3"), "--time-tolerance"),
        (("--method", "sampled"), "--method"),
    ],
)
def test_what_says_nothing_is_one_clear_error(here, obbtree, words, where):
    ended = obbtree("clearance", *PASSING, *words)

    assert (ended.code, ended.out) == (2, "")
    assert where in ended.err
    assert ended.err.count("\n") == 1


def test_command_and_question_know_the_same_fields():
    assert _CONCERNS == CONCERNS
