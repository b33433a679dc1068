"""`Query.advance(until=...)`: a question goes no further than asked, and loses nothing by it."""

from __future__ import annotations

import math
from typing import Any

import pytest
from scenes.random_scenes import CUBE, MESHES

from obbcli import Accuracy, Body, Motion, Pose, Query, first_contact

SPIN = Motion([-3, 0, 0], [1, 5, -2])
PATH = Motion.through(
    [0.1, 0.3, 0.7, 0.9],
    [
        Pose([0.1, 0, 0], [4, 0, 0]),
        Pose([0.4, 0.5, 0], [5, 1, 0]),
        Pose([0, 0, 1], [3, 0, 1]),
        Pose(None, [0.5, 0, 0]),
    ],
)
BODIES = {
    "spinning": Body(MESHES[0], Pose(translation=[4, 0, 0]), SPIN),
    "straight": Body(MESHES[0], Pose(translation=[4, 0, 0]), Motion([-3, 0, 0])),
    "away": Body(MESHES[0], Pose(translation=[2.6, 0, 0]), Motion([0.1, 0, 0], [9, 8, 7])),
    "along a path": Body(MESHES[0], motion=PATH),
    "at rest": Body(MESHES[0], Pose(translation=[2.0, 0, 0])),
}


@pytest.mark.parametrize("method", ["certified", "sampled"])
@pytest.mark.parametrize("name", BODIES)
def test_question_asked_bit_by_bit_answers_the_same(name: str, method: Any) -> None:
    accuracy = Accuracy(method=method, steps=13)
    whole = first_contact(BODIES[name], CUBE, accuracy=accuracy)
    query = Query(BODIES[name], CUBE, accuracy=accuracy)

    for k in range(1001):
        query.advance(until=k / 1000)
        assert query.is_finished or query.time > k / 1000

    answer = query.advance()
    assert {**vars(answer), "stats": None} == {**vars(whole), "stats": None}
    assert answer.stats[:4] == whole.stats[:4]
    assert query.iterations >= answer.stats.pops


@pytest.mark.parametrize("name", ["spinning", "straight", "along a path"])
def test_question_goes_no_further_than_asked(name: str) -> None:
    query, whole = (Query(BODIES[name], CUBE) for _ in range(2))
    time = whole.advance().time
    assert time is not None

    answer = query.advance(until=0.25 * time)

    assert answer.status == "unresolved"
    assert 0.25 * time < query.lower_bound < time
    assert answer.stats.pops < whole.advance().stats.pops


def test_question_that_has_come_far_enough_is_left_alone() -> None:
    query = Query(BODIES["spinning"], CUBE)
    pops = query.advance(until=0.1).stats.pops

    assert query.advance(until=0.1).stats.pops == pops
    assert query.advance(until=math.inf).status == "contact"


def test_nearness_that_turns_out_to_be_no_contact_ends() -> None:
    # Past a cube at a distance that only the slack of the path's pieces can bridge.
    places = [[4, 0, 2 + 2**-51], [-4, 0, 2 + 2**-51], [-4, 0, 9]]
    poses = [Pose([0, 0, 0.5 * k], place) for k, place in enumerate(places)]
    poses[1] = Pose(None, places[1])
    body = Body(CUBE, motion=Motion.through([0, 1, 2], poses))
    query = Query(body, CUBE)

    answer = query.advance(until=0.3)

    assert query.is_finished
    assert answer.evidence == "within_tolerance"
    assert answer.time == pytest.approx(0.25)


@pytest.mark.parametrize("limit", [1, 5, 40, 200])
@pytest.mark.parametrize("name", BODIES)
def test_limit_of_steps_counts_all_steps(name: str, limit: int) -> None:
    whole = first_contact(BODIES[name], CUBE, accuracy=Accuracy(max_iterations=limit))
    query = Query(BODIES[name], CUBE)
    until = 0.0
    while not query.is_finished and query.iterations < limit:
        query.advance(limit - query.iterations, until=until)
        until += 0.01

    answer = query.advance(0)
    assert {**vars(answer), "stats": None} == {**vars(whole), "stats": None}
    assert whole.stats.pops <= limit
