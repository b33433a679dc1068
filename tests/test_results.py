"""Results: the words of a status, and a yes or no that is never guessed."""

from __future__ import annotations

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
