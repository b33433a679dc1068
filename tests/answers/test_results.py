"""Results: the words of a status, and a yes or no that is never guessed."""

from __future__ import annotations

import copy
import dataclasses
import gc
import pickle
import weakref
from dataclasses import FrozenInstanceError, replace

import pytest

from obbcli import (
    Accuracy,
    Body,
    Collision,
    ObbTree,
    Pose,
    QueryStats,
    Status,
    UnresolvedError,
    collide,
)

STATS = QueryStats(
    box_tests=1,
    triangle_tests=2,
    exact_triangle_tests=0,
    pops=3,
    image_tests=0,
    nodes_built_a=4,
    nodes_built_b=5,
    nodes_possible_a=6,
    nodes_possible_b=7,
    seconds={"query": 0.5},
)


def answer(status: Status) -> Collision:
    return Collision(status=status, witness=None, approximate=False, error_bound=0.0, stats=STATS)


def test_status_words_are_those_of_the_documents():
    words = [str(status) for status in Status]

    assert words == ["separated", "contact", "overlap_at_start", "unresolved"]
    assert Status("contact") is Status.CONTACT


@pytest.mark.parametrize(
    ("status", "collides"),
    [(Status.SEPARATED, False), (Status.CONTACT, True), (Status.OVERLAP_AT_START, True)],
)
def test_resolved_answers_say_yes_or_no(status, collides):
    assert answer(status).collides is collides


def test_unresolved_answer_refuses_to_guess():
    with pytest.raises(UnresolvedError, match="before its answer was known; raise max_iterations"):
        _ = answer(Status.UNRESOLVED).collides


@pytest.fixture(scope="module")
def tree() -> ObbTree:
    return ObbTree.build("sample_meshes/gear.stl", lazy=False)


def test_answer_of_the_kernels_equals_one_of_its_fields(tree):
    made = collide(Body(tree), Body(tree, Pose(translation=(0, 0, 1))))

    fields = {field.name: getattr(made, field.name) for field in dataclasses.fields(made)}
    same = Collision(**fields)
    assert made == same
    assert repr(made) == repr(same)
    assert replace(made) == same
    assert replace(made, part_a="shaft").part_a == "shaft"
    assert made.stats is made.stats
    assert type(made.stats) is QueryStats
    assert type(made.witness) is tuple
    assert made != replace(made, error_bound=1.0)


def test_answers_hash_as_their_fields_do(tree):
    with pytest.raises(TypeError, match="unhashable"):  # seconds are a mapping
        hash(collide(tree, tree))


@pytest.mark.parametrize(
    "copied",
    [
        copy.copy,
        copy.deepcopy,
        *(
            lambda x, n=n: pickle.loads(pickle.dumps(x, n))
            for n in range(pickle.HIGHEST_PROTOCOL + 1)
        ),
    ],
)
def test_copies_and_pickles_are_equal(tree, copied):
    for made in (collide(tree, tree), replace(answer(Status.CONTACT), contained="a", part_b="pin")):
        again = copied(made)

        assert again == made
        assert repr(again) == repr(made)
        assert again.collides is made.collides


def test_status_follows_from_what_the_kernels_found(tree):
    here, there = Body(tree), Body(tree, Pose(translation=(0, 0, 1)))
    far = Body(tree, Pose(translation=(1000, 0, 0)))
    coarse, brief = Accuracy(max_depth_a=1, max_depth_b=1), Accuracy(max_iterations=1)

    separated, found = collide(here, far), collide(here, there)
    by_boxes, stopped = collide(here, there, accuracy=coarse), collide(here, there, accuracy=brief)

    assert (separated.status, separated.witness) == (Status.SEPARATED, None)
    assert (found.status, found.approximate) == (Status.OVERLAP_AT_START, False)
    assert found.witness is not None
    assert (by_boxes.status, by_boxes.approximate) == (Status.OVERLAP_AT_START, True)
    assert by_boxes.witness is None
    assert by_boxes.error_bound > 0
    assert stopped.status is Status.UNRESOLVED
    assert [one.collides for one in (separated, found, by_boxes)] == [False, True, True]
    with pytest.raises(UnresolvedError, match="before its answer was known"):
        _ = stopped.collides


def test_fields_of_an_answer_are_frozen(tree):
    made = collide(tree, tree)

    for name in ("status", "stats", "contained", "nonsense"):
        with pytest.raises(FrozenInstanceError):
            setattr(made, name, None)
        with pytest.raises(FrozenInstanceError):
            delattr(made, name)
    with pytest.raises(AttributeError):
        made.collides = True


def test_answer_made_past_its_constructor_claims_nothing():
    made = Collision.__new__(Collision)

    assert made.status is Status.UNRESOLVED
    with pytest.raises(UnresolvedError):
        _ = made.collides


def test_answers_can_be_watched_and_collected(tree):
    class Noted(Collision):
        pass

    made = Noted(Status.SEPARATED, None, False, 0.0, STATS)
    vars(made)["note"] = made  # a cycle through the object
    ring: list[object] = []
    other = Noted(Status.SEPARATED, None, False, 0.0, ring)  # and one through a field
    ring.append(other)
    watched = [weakref.ref(made), weakref.ref(other), weakref.ref(collide(tree, tree))]

    del made, other, ring
    gc.collect()

    assert [ref() for ref in watched] == [None, None, None]
