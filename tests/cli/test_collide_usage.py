"""What `obbtree collide` refuses to be asked, and the motion and accuracy it understands."""

from __future__ import annotations

from dataclasses import fields

import pytest

from obbcli import Accuracy


def test_collide_answers_a_moving_body_at_its_start(here, obbtree):
    ended = obbtree("collide", "cube.stl", "touching.obj", "--vel", 1, 0, 0, "--duration", 0,
                    "--json")  # fmt: skip

    assert ended.json["result"]["status"] == "overlap_at_start"
    assert ended.json["motion"]["a"]["linear_velocity"] == [1.0, 0.0, 0.0]


@pytest.mark.parametrize(
    "words",
    [
        ("--vel", "1", "0", "0"),
        ("--omega-b", "0", "0", "1"),
    ],
)
def test_collide_lists_no_pairs_of_a_moving_body(here, obbtree, words):
    moving = obbtree("collide", "cube.stl", "touching.obj", "--all-pairs", *words)
    at_start = obbtree("collide", "cube.stl", "touching.obj", "--all-pairs", *words,
                       "--duration", 0)  # fmt: skip

    assert (moving.code, at_start.code) == (2, 0)
    assert "bodies at rest" in moving.err


def test_collide_answers_motions_of_zero(here, obbtree):
    words = ("--vel", 0, 0, 0, "--omega", 0, 0, 0, "--pivot", 4, 5, 6, "--duration", 7)

    document = obbtree("collide", "cube.stl", "touching.obj", *words, "--json").json

    assert document["result"]["status"] == "overlap_at_start"
    assert document["motion"]["duration"] == 7.0
    assert document["motion"]["a"]["pivot"] == [4.0, 5.0, 6.0]


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (("--vel", "1", "0"), "requires 3 arguments"),
        (("--translate", "x", "0", "0"), "'x' is not a valid float"),
        (("--translate", "nan", "0", "0"), "'nan' is not a finite number"),
        (("--rotate", "0", "inf", "0"), "'inf' is not a finite number"),
        (("--rotate", "1.7e308", "1.7e308", "0"), "turns by inf"),
        (("--duration", "-1"), "'-1' is not a finite number of at least 0"),
        (("--clearance", "-1"), "at least 0"),
        (("--timeout", "nan"), "at least 0"),
        (("--max-depth", "-1"), "'-1' is not a whole number of at least 0"),
        (("--steps", "0", "--method", "sampled"), "'0' is not a whole number of at least 1"),
        (("--steps", "5"), "has a meaning with --method sampled alone"),
        (("--integrator", "rk4"), "has a meaning with --method sampled alone"),
        (("--max-depth", "1.5"), "'1.5' is not a whole number of at least 0"),
        (("--max-depth", "1_0"), "'1_0' is not a whole number of at least 0"),
        (("--max-depth", "9" * 5000), "is not a whole number"),
        (("--translate", "1_0", "0", "0"), "'1_0' is not a number"),
        (("-o", ""), "an empty word names no file"),
        (("-o", "cube.stl"), "-o cube.stl: is the input cube.stl, which would be lost"),
        (("-o", "./touching.obj"), "is the input touching.obj"),
        (("--leaves", "none"), "'none' is not one of"),
        (("--limit", "5"), "add --all-pairs"),
        (("--all-pairs", "--limit", "0"), "'0' is not a whole number of at least 1"),
        (("--all-pairs", "--max-depth", "3"), "always exactly"),
        (("--all-pairs", "--timeout", "3"), "cut the list with --limit"),
        (("--all-pairs", "--max-iterations", "3"), "cut the list with --limit"),
        (("--pivot", "0", "0", "0"), "--pivot: is where an axis of rotation passes; add --omega"),
        (("--omega", "0", "0", "1", "--pivot-b", "0", "0", "0"), "add --omega-b"),
        (("--translate", "1e308", "0", "0"), "error: --translate: posed coordinates"),
        (("--nonsense",), "No such option"),
        (("extra.stl",), "unexpected extra argument"),
    ],
)
def test_collide_refuses_usage_that_means_nothing(here, obbtree, words, fault):
    ended = obbtree("collide", "cube.stl", "touching.obj", *words)

    assert ended.code == 2
    assert ended.out == ""
    assert ended.err.count("\n") == 1
    assert fault in ended.err


def test_collide_has_an_option_for_every_field_of_accuracy(here, obbtree):
    words = {
        "time_tolerance": 1e-6,
        "distance_tolerance": 0.25,
        "max_depth_a": 3,
        "max_depth_b": 4,
        "leaves": "boxes",
        "clearance": 0.0,
        "max_iterations": 1000,
        "timeout": 5.0,
        "method": "certified",
    }
    options = [f"--{name.replace('_', '-')}={value}" for name, value in words.items()]

    used = obbtree("collide", "cube.stl", "apart.obj", *options, "--json").json["accuracy"]

    # The two that mean something to sampling alone are refused without it; see above.
    assert {*words, "steps", "integrator"} == {field.name for field in fields(Accuracy)}
    assert used == Accuracy(**words).as_dict()


def test_collide_depth_of_one_body_goes_before_that_of_both(here, obbtree):
    words = ("--max-depth", 2, "--max-depth-b", 5, "--json")

    used = obbtree("collide", "cube.stl", "apart.obj", *words).json["accuracy"]

    assert (used["max_depth_a"], used["max_depth_b"]) == (2, 5)
