"""Curves of least distances, interval by interval, held against an independent oracle."""

from __future__ import annotations

import numpy as np
import pytest
from movers.answers import as_body
from movers.meshes import cube
from movers.random_pairs import KINDS, random_pair
from oracles.gaps import gap_at

from obbcli import Accuracy, Body, Mesh, Motion, MotionError, Pose, clearance, clearance_curve

CUBE = Mesh(*cube())
SMALL = Mesh(*cube(0.25))
NOISE = 1e-11


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_no_pose_is_below_the_bracket_of_its_interval(kind, seed):
    a, b = random_pair(kind, seed)
    pieces = clearance_curve(as_body(a), as_body(b), 1.0, intervals=7)

    assert [piece.start for piece in pieces] == [0.0, *(piece.end for piece in pieces[:-1])]
    assert pieces[-1].end == 1.0
    for piece in pieces:
        low, high = piece.bounds
        assert high - low <= 1e-6 * high + NOISE or low == 0
        assert piece.start <= piece.time <= piece.end
        assert high == 0 or gap_at(a, b, piece.time) == pytest.approx(high, abs=NOISE)
        for time in np.linspace(piece.start, piece.end, 12):
            assert gap_at(a, b, time) >= low - NOISE
    least = clearance(as_body(a), as_body(b), 1.0).minimum.bounds
    assert min(piece.bounds[0] for piece in pieces) <= least[1]
    assert min(piece.bounds[1] for piece in pieces) >= least[0]


@pytest.mark.parametrize("intervals", [1, 2, 3, 5])
def test_path_is_cut_at_intervals_and_legs(intervals):
    places = [(3, 0, 0), (5, 0, 0), (2, 0, 0), (4, 0, 0)]
    path = Motion.through([0, 1, 2, 3], [Pose(translation=place) for place in places])
    pieces = clearance_curve(CUBE, Body(SMALL, motion=path), intervals=intervals)

    for piece in pieces:
        times = np.linspace(piece.start, piece.end, 400)
        gaps = np.interp(times, [0, 1, 2, 3], [1.75, 3.75, 0.75, 2.75])
        low, high = piece.bounds
        assert low <= gaps.min() + NOISE
        assert high == pytest.approx(gaps.min(), abs=0.02)
        assert high >= gaps.min() - 0.02
    assert min(piece.bounds[1] for piece in pieces) == pytest.approx(0.75, rel=1e-6)


def test_contact_is_0_in_its_intervals_alone():
    body = Body(SMALL, Pose(translation=(3, 0, 0)), Motion(linear_velocity=(-4, 0, 0)))
    pieces = clearance_curve(CUBE, body, 1.0, intervals=4)

    assert pieces[0].bounds == pytest.approx((0.75, 0.75), rel=1e-5)
    assert [piece.bounds for piece in pieces[1:3]] == [(0, 0), (0, 0)]


def test_one_interval_where_there_is_no_duration():
    (piece,) = clearance_curve(CUBE, Body(SMALL, Pose(translation=(3, 0, 0))), intervals=9)

    assert (piece.start, piece.end) == (0, 0)
    assert piece.bounds == pytest.approx((1.75, 1.75), rel=1e-5)


def test_limits_leave_pieces_that_say_nothing():
    a, b = (as_body(mover) for mover in random_pair("both_turning", 1))
    pieces = clearance_curve(a, b, 1.0, Accuracy(max_iterations=1), intervals=4)

    assert len(pieces) == 4
    assert pieces[-1].bounds == (0, None)
    assert pieces[-1].time is None


@pytest.mark.parametrize("intervals", [0, -1, 1.5, True, 1_000_001, "2"])
def test_numbers_of_intervals_that_mean_nothing_are_refused(intervals):
    with pytest.raises(MotionError, match="intervals"):
        clearance_curve(CUBE, SMALL, intervals=intervals)
