"""The least distance over a motion: closed forms, laws against an independent oracle."""

from __future__ import annotations

import math

import numpy as np
import pytest
from movers.answers import as_body
from movers.meshes import box, cube
from movers.random_pairs import KINDS, random_pair
from oracles.gaps import gap_at

import obbcli
from obbcli import (
    Accuracy,
    Body,
    ClearanceQuery,
    Mesh,
    MeshError,
    Motion,
    Pose,
    Status,
    clearance,
    first_contact,
)

CUBE = Mesh(*cube())
SMALL = Mesh(*cube(0.25))
# The oracle's own rounding, of coordinates below 20.
NOISE = 1e-12


def moving(mesh=CUBE, place=(0, 0, 0), **motion):
    return Body(mesh, Pose(translation=place), Motion(**motion))


def reversed_in_time(body, duration):
    """Return the body that goes the same way back."""
    motion = body.motion
    start = body.motion.moment(duration, body.pose, np.asarray(motion.pivot))
    pivot = np.asarray(motion.pivot) + duration * np.asarray(motion.linear_velocity)
    back = Motion(-motion.linear_velocity, -motion.angular_velocity, pivot)
    return Body(body.shape, start.pose, back)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(12))
def test_no_pose_of_a_motion_is_nearer_than_proven(kind, seed):
    a, b = random_pair(kind, seed)
    answer = clearance(as_body(a), as_body(b), 1.0)
    low, high = answer.minimum.bounds
    times = np.linspace(0.0, 1.0, 65)

    assert answer.complete
    assert all(gap_at(a, b, time) >= low - NOISE for time in times)
    if answer.first_contact is None:
        assert high - low <= 1e-6 * high + 1e-11
        assert gap_at(a, b, answer.minimum.time) == pytest.approx(high, abs=1e-11)
        distance = math.dist(answer.minimum.point_a, answer.minimum.point_b)
        assert distance == pytest.approx(high, abs=1e-11)
        for time in times:
            is_told = any(lo <= time <= hi for lo, hi in answer.minimum.when)
            assert is_told or gap_at(a, b, time) > high - NOISE
        assert any(lo <= answer.minimum.time <= hi for lo, hi in answer.minimum.when)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(20, 30))
def test_first_contact_within_a_clearance_agrees(kind, seed):
    a, b = (as_body(mover) for mover in random_pair(kind, seed))
    answer = clearance(a, b, 1.0)
    low, high = answer.minimum.bounds

    if answer.first_contact is not None:
        assert first_contact(a, b, 1.0).status is Status.CONTACT
        assert answer.minimum.bounds == (0, 0)
        assert clearance(a, b, 1.0, at_least=1e-3).at_least.verdict == "violated"
        return
    below, above = Accuracy(clearance=0.999 * low), Accuracy(clearance=1.001 * high)
    assert first_contact(a, b, 1.0, below).status is Status.SEPARATED
    assert first_contact(a, b, 1.0, above).status is not Status.SEPARATED
    assert clearance(a, b, 1.0, at_least=0.999 * low).at_least.verdict == "holds"
    violated = clearance(a, b, 1.0, at_least=1.001 * high)
    assert violated.at_least.verdict == "violated"
    assert violated.minimum.bounds[1] < 1.001 * high


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(40, 46))
def test_swapped_and_reversed_motions_come_as_near(kind, seed):
    a, b = (as_body(mover) for mover in random_pair(kind, seed))
    low, high = clearance(a, b, 1.0).minimum.bounds
    others = [
        clearance(b, a, 1.0).minimum.bounds,
        clearance(reversed_in_time(a, 1.0), reversed_in_time(b, 1.0), 1.0).minimum.bounds,
    ]

    for other_low, other_high in others:
        assert other_low <= high + NOISE
        assert low <= other_high + NOISE


@pytest.mark.parametrize("seed", range(6))
def test_slices_and_times_to_stop_change_no_answer(seed):
    a, b = (as_body(mover) for mover in random_pair("both_turning", seed))
    whole = clearance(a, b, 1.0)
    query = ClearanceQuery(a, b, 1.0)
    lows, highs = [], []
    while not query.is_finished:
        query.advance(max_iterations=1)
        lows.append(query.bounds[0])
        highs.append(query.bounds[1])

    assert query.answer().minimum == whole.minimum
    assert query.answer().first_contact == whole.first_contact
    if whole.first_contact is None:
        assert max(lows) <= whole.minimum.bounds[1]
        assert min(highs) == whole.minimum.bounds[1]
        assert lows == sorted(lows)


def test_box_passing_a_box_is_nearest_where_they_overlap_along_the_way():
    answer = clearance(CUBE, moving(SMALL, (-5, 3, 0), linear_velocity=(5, 0, 0)), 2.0)

    low, high = answer.minimum.bounds
    assert low <= 1.75 <= high
    assert high - low <= 2e-6
    ((begin, end),) = answer.minimum.when
    assert begin <= 0.75
    assert end >= 1.25


def test_hinge_comes_nearest_where_the_leaf_stands_upright():
    leaf = Mesh(*box((0, 0, 0), (4, 0.5, 1)))
    stop = Mesh(*box((-1, 4.5, 0), (1, 5, 1)))
    turning = Body(leaf, motion=Motion(angular_velocity=(0, 0, 1), pivot=(0, 0, 0)))
    answer = clearance(turning, stop, 3.0)

    # The leaf's far corner is at (4, 0.5): it goes round at that radius.
    nearest = 4.5 - math.hypot(4, 0.5)
    low, high = answer.minimum.bounds
    assert low <= nearest <= high
    assert answer.minimum.time == pytest.approx(math.pi / 2 - math.atan2(0.5, 4), abs=1e-3)
    assert not answer.first_contact


def test_bodies_that_turn_together_are_asked_once():
    spin = {"angular_velocity": (0, 0, 600.0)}
    a = moving(CUBE, **spin, pivot=(0, 0, 1))
    b = moving(SMALL, (3, 0, 0), **spin, pivot=(0, 0, -2))
    answer = clearance(a, b, 1.0)

    assert answer.minimum.bounds == pytest.approx((1.75, 1.75), rel=2e-6)
    assert answer.stats.pops < 100
    assert answer.minimum.when == ((0.0, 1.0),)


def test_many_turns_end():
    turning = moving(CUBE, angular_velocity=(0, 0, 400.0))
    answer = clearance(turning, moving(SMALL, (3, 0, 0)), 1.0)

    low, high = answer.minimum.bounds
    assert low <= 2.75 - math.sqrt(2) <= high
    assert answer.complete


@pytest.mark.parametrize("duration", [0.0, 1.0])
def test_bodies_at_rest_have_their_distance(duration):
    answer = clearance(CUBE, Body(SMALL, Pose(translation=(3, 0, 0))), duration)

    assert answer.minimum.bounds == pytest.approx((1.75, 1.75), rel=1e-15)
    assert (answer.minimum.time, answer.minimum.when) == (0.0, ((0.0, duration),))
    assert answer.minimum.when_share == 1


def test_moving_bodies_at_one_time_have_their_distance():
    body = moving(SMALL, (3, 0, 0), linear_velocity=(1, 0, 0))

    assert clearance(CUBE, body, 0.0).minimum.bounds == pytest.approx((1.75, 1.75), rel=1e-15)


def test_touch_at_the_very_end_is_contact():
    body = moving(SMALL, (3, 0, 0), linear_velocity=(-1, 0, 0))
    answer = clearance(CUBE, body, 1.75)

    assert answer.minimum.bounds == (0, 0)
    assert answer.first_contact.time == 1.75
    assert answer.minimum.when == ((1.75, 1.75),)


def test_contact_comes_with_its_first_time():
    body = moving(SMALL, (3, 0, 0), linear_velocity=(-4, 0, 0))
    answer = clearance(CUBE, body, 1.0)

    assert answer.minimum.bounds == (0, 0)
    assert answer.first_contact.time == 0.4375
    assert answer.minimum.when == ((0.4375, 1.0),)


def test_contact_is_told_of_bodies_that_start_in_it():
    answer = clearance(CUBE, moving(CUBE, (1, 0, 0), linear_velocity=(4, 0, 0)), 1.0)

    assert answer.first_contact.status is Status.OVERLAP_AT_START
    assert answer.minimum.bounds == (0, 0)


def test_solid_holds_what_is_inside():
    inner = moving(SMALL, angular_velocity=(0, 0, 1.0))

    assert clearance(CUBE, inner, 1.0).minimum.bounds[0] > 0.6
    answer = clearance(CUBE, inner, 1.0, solid=True)
    assert answer.minimum.bounds == (0, 0)
    assert answer.first_contact.contained == "b"


def test_solid_asks_for_closed_surfaces():
    opened = Mesh(cube()[0], cube()[1][:-1])

    with pytest.raises(MeshError, match="watertight"):
        clearance(opened, moving(SMALL, (3, 0, 0)), solid=True)


@pytest.mark.parametrize("seed", range(8))
def test_path_comes_as_near_as_its_legs(seed):
    random = np.random.default_rng(seed)
    times = [0.0, *np.sort(random.uniform(0.1, 0.9, 3)), 1.0]
    places = random.normal((3, 0, 0), 1, (len(times), 3))
    poses = [Pose(random.normal(size=3), place) for place in places]
    body = Body(SMALL, motion=Motion.through(times, poses))
    other = moving(CUBE, (-2, 0, 0), angular_velocity=random.normal(size=3))
    answer = clearance(other, body)
    low, high = answer.minimum.bounds

    assert answer.complete
    sampled = []
    for time in np.linspace(0, 1, 60):
        placed = [
            Body(one.shape, one.motion.moment(time, one.pose, one.motion.pivot or np.zeros(3)).pose)
            for one in (body,)
        ]
        turned = other.motion.moment(time, other.pose, np.array([-2.0, 0, 0]))
        sampled.append(obbcli.distance(Body(CUBE, turned.pose), placed[0]).distance)
    assert min(sampled) >= low - NOISE
    if answer.first_contact is None:
        assert high <= min(sampled) + NOISE
        assert high - low <= 1e-6 * high + 1e-11


@pytest.mark.parametrize("exponent", [-900, -300, 300, 900])
def test_scale_changes_no_digit(exponent):
    scale = 2.0**exponent
    a, b = random_pair("one_turning", 4)
    plain = clearance(as_body(a), as_body(b), 1.0).minimum
    scaled = [
        Body(
            Mesh(scale * np.asarray(mover.vertices), mover.faces),
            Pose(mover.rotation, scale * np.asarray(mover.translation)),
            Motion(scale * mover.velocity, mover.spin, scale * mover.pivot),
        )
        for mover in (a, b)
    ]
    answer = clearance(*scaled, 1.0).minimum

    assert answer.bounds == tuple(scale * bound for bound in plain.bounds)
    assert answer.time == plain.time
