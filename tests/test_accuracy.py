"""`Accuracy`: its defaults, its plain values, and what it refuses."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest

from obbcli import Accuracy, MotionError

NUMBERS = ("time_tolerance", "distance_tolerance", "clearance", "timeout")
DEPTHS = ("max_depth_a", "max_depth_b")
COUNTS = ("steps", "max_iterations")
WORDS = {
    "leaves": ("triangles", "boxes"),
    "method": ("certified", "sampled"),
    "integrator": ("exact", "euler", "rk4"),
}


def test_defaults_ask_for_the_best_answer():
    accuracy = Accuracy()

    assert accuracy.as_dict() == {
        "time_tolerance": None,
        "distance_tolerance": None,
        "max_depth_a": None,
        "max_depth_b": None,
        "leaves": "triangles",
        "method": "certified",
        "integrator": "exact",
        "steps": 100,
        "clearance": 0.0,
        "max_iterations": 10_000_000,
        "timeout": None,
    }


def test_every_field_is_covered_here():
    names = {field.name for field in dataclasses.fields(Accuracy)}

    assert names == {*NUMBERS, *DEPTHS, *COUNTS, *WORDS}


def test_fields_are_keyword_only_and_frozen():
    with pytest.raises(TypeError):
        Accuracy(1e-9)
    with pytest.raises(dataclasses.FrozenInstanceError):
        Accuracy().steps = 5


def test_numpy_scalars_become_plain_numbers():
    accuracy = Accuracy(clearance=np.float32(0.5), max_depth_a=np.int64(3), timeout=2)

    assert json.loads(json.dumps(accuracy.as_dict()))["clearance"] == 0.5
    assert type(accuracy.max_depth_a) is int
    assert type(accuracy.timeout) is float


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [-1e-300, math.nan, math.inf, -math.inf, "1", "x", [1.0, 2.0]])
def test_numbers_are_finite_and_not_negative(name, value):
    with pytest.raises(MotionError, match=f"^{name}: is"):
        Accuracy(**{name: value})


@pytest.mark.parametrize("name", NUMBERS)
def test_numbers_may_be_zero(name):
    assert getattr(Accuracy(**{name: 0}), name) == 0.0


@pytest.mark.parametrize("name", DEPTHS)
@pytest.mark.parametrize("value", [-1, 1.0, True, "2"])
def test_depths_are_whole_numbers_from_zero(name, value):
    assert getattr(Accuracy(**{name: 0}), name) == 0
    with pytest.raises(MotionError, match=f"^{name}: is"):
        Accuracy(**{name: value})


@pytest.mark.parametrize("name", COUNTS)
@pytest.mark.parametrize("value", [0, -1, 1.5, True, None])
def test_counts_are_whole_numbers_from_one(name, value):
    assert getattr(Accuracy(**{name: 1}), name) == 1
    with pytest.raises(MotionError, match=f"^{name}: is"):
        Accuracy(**{name: value})


@pytest.mark.parametrize("name", WORDS)
def test_words_are_one_of_those_documented(name):
    for word in WORDS[name]:
        assert getattr(Accuracy(**{name: word}), name) == word
    with pytest.raises(MotionError, match=f"^{name}: is 'fast'; use one of {WORDS[name][0]}"):
        Accuracy(**{name: "fast"})
