"""Results: the words of a status, and a yes or no that is never guessed."""

from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError, replace

import pytest

from obbcli import Collision, QueryStats, Status, UnresolvedError

STATS = QueryStats(
    box_tests=1,
    triangle_tests=2,
    exact_triangle_tests=0,
    pops=3,
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


def test_answer_of_the_kernels_equals_one_of_its_fields():
    found = (True, False, 0.0, (3, 4), 0.5, (1, 2, 0, 3, 4, 5, 6, 7))

    made = Collision.at_rest(found, 0.25)

    stats = STATS._replace(seconds={"load": 0.25, "query": 0.5})
    same = Collision(Status.OVERLAP_AT_START, (3, 4), False, 0.0, stats)
    assert made == same
    assert repr(made) == repr(same)
    assert replace(made) == same
    assert pickle.loads(pickle.dumps(Collision.at_rest(found, 0.25))) == same
    assert made.stats is made.stats


@pytest.mark.parametrize(
    ("is_complete", "by_boxes", "witness", "status"),
    [
        (True, False, None, Status.SEPARATED),
        (True, True, None, Status.OVERLAP_AT_START),
        (True, False, (0, 0), Status.OVERLAP_AT_START),
        (False, False, None, Status.UNRESOLVED),
    ],
)
def test_status_follows_from_what_the_kernels_found(is_complete, by_boxes, witness, status):
    made = Collision.at_rest((is_complete, by_boxes, 0.0, witness, 0.0, (0,) * 8))

    assert made.status is status
    assert made.approximate is by_boxes


def test_fields_of_an_answer_are_frozen():
    made = Collision.at_rest((True, False, 0.0, None, 0.0, (0,) * 8))

    for name in ("status", "stats", "contained"):
        with pytest.raises(FrozenInstanceError):
            setattr(made, name, None)
