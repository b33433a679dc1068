"""The greatest distance over a motion, held against an independent oracle."""

from __future__ import annotations

import numpy as np
import pytest
from movers.answers import as_body
from movers.meshes import cube
from movers.random_pairs import KINDS, random_pair
from oracles.gaps import gap_at

from obbcli import (
    Accuracy,
    Body,
    ClearanceQuery,
    Mesh,
    Motion,
    MotionError,
    Pose,
    clearance,
    distance,
)

CUBE = Mesh(*cube())
SMALL = Mesh(*cube(0.25))
# Of coordinates below 20, doubled where positions are rounded more than once.
NOISE = 1e-10


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_no_pose_of_a_motion_is_further_apart_than_proven(kind, seed):
    a, b = random_pair(kind, seed)
    answer = clearance(as_body(a), as_body(b), 1.0, tolerance=1e-4, greatest=True)
    low, high = answer.maximum.bounds

    assert answer.complete
    assert high - low <= 1e-4 * high + NOISE
    assert gap_at(a, b, answer.maximum.time) == pytest.approx(low, abs=NOISE)
    assert max(gap_at(a, b, time) for time in np.linspace(0, 1, 65)) <= high
    assert answer.minimum.bounds[0] <= high


def test_box_goes_as_far_as_its_way():
    body = Body(SMALL, Pose(translation=(3, 0, 0)), Motion(linear_velocity=(2, 0, 0)))
    answer = clearance(CUBE, body, 1.0, greatest=True)

    assert answer.maximum.bounds == pytest.approx((3.75, 3.75), rel=2e-6)
    assert answer.maximum.time == 1.0


def test_path_is_asked_leg_by_leg():
    places = [(3, 0, 0), (5, 0, 0), (2, 0, 0), (4, 0, 0)]
    path = Motion.through([0, 1, 2, 3], [Pose(translation=place) for place in places])
    answer = clearance(CUBE, Body(SMALL, motion=path), greatest=True)

    assert answer.maximum.bounds == pytest.approx((3.75, 3.75), rel=2e-6)
    assert answer.maximum.time == pytest.approx(1.0, abs=1e-5)
    assert answer.minimum.bounds == pytest.approx((0.75, 0.75), rel=2e-6)


def test_bodies_at_rest_have_their_distance():
    body = Body(SMALL, Pose((0.1, 0.2, 0.3), (3, 0, 0)))
    answer = clearance(CUBE, body, 1.0, greatest=True)

    assert answer.maximum.bounds == pytest.approx([distance(CUBE, body).distance] * 2, rel=1e-9)


def test_greatest_is_left_out_unasked_and_after_a_limit():
    a, b = (as_body(mover) for mover in random_pair("both_turning", 1))

    assert clearance(a, b, 1.0).maximum is None
    limited = clearance(a, b, 1.0, Accuracy(max_iterations=1), greatest=True)
    assert not limited.complete
    assert limited.maximum is None


def test_greatest_of_solids_is_refused():
    with pytest.raises(MotionError, match="greatest"):
        clearance(CUBE, SMALL, solid=True, greatest=True)


def test_legs_of_a_long_path_are_asked_within_limits():
    places = [Pose(translation=(3 + 0.001 * k, 0, 0)) for k in range(200)]
    body = Body(SMALL, motion=Motion.through(np.arange(200.0), places))
    least = ClearanceQuery(CUBE, body)
    least.advance()
    limits = Accuracy(max_iterations=least.iterations + 5)
    answer = clearance(CUBE, body, None, limits, greatest=True)

    assert not answer.complete
    assert answer.maximum is None
