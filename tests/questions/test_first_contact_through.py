"""First contact of bodies that move through poses: closed forms, splits, breaks, clocks, limits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from claims.brackets import assert_at, bounds
from movers.meshes import angle_bar, box, cube, octahedron, tetrahedron
from oracles.mesh import mesh_pairs
from scenes.pairs import random_rotation

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, Pose, Query, Status

if TYPE_CHECKING:
    from obbcli.motion.path import PathMotion

# Above it a floor with its top at z = 0.
FLOOR = Mesh(*box((-8.0, -9.0, -1.0), (8.0, 10.0, 0.0)))
CUBE = Mesh(*cube())
# What legs may miss of a continuous path: some 1e-14 of coordinates of some tens.
NEAR = 1e-12


def heights(*levels: float) -> list[Pose]:
    """Return poses that hold the cube so high above the floor."""
    return [Pose(translation=(0.25, 0.125, 1.0 + level)) for level in levels]


def falling(times: Any, *levels: float) -> Body:
    return Body(CUBE, motion=Motion.through(times, heights(*levels)))


def split(motion: Motion, start: Pose, duration: float, pieces: int) -> PathMotion:
    times = np.linspace(0, duration, pieces + 1)
    return Motion.through(times, [motion.pose_at(t, start) for t in times])


def random_pair(seed: int) -> tuple[Body, Body]:
    """Return two bodies that turn about their origins and mostly meet within 2 s."""
    draw = np.random.default_rng(seed)
    meshes = [Mesh(*make()) for make in (cube, octahedron, tetrahedron, angle_bar)]
    bodies = []
    for side in (-1, 1):
        place = np.array([2.2 * side, 0, 0]) + draw.normal(size=3) * 0.3
        velocity = np.array([-1.2 * side, 0, 0]) + draw.normal(size=3) * 0.5
        motion = Motion(velocity, draw.normal(size=3), place)
        bodies.append(
            Body(
                meshes[draw.integers(4)], Pose(random_rotation(seed * 2 + 1 + side), place), motion
            )
        )
    return bodies[0], bodies[1]


@pytest.mark.parametrize("seed", range(24))
@pytest.mark.parametrize("pieces", [(5, None), (17, None), (4, 7)])
def test_split_motion_gives_the_same_first_time(seed: int, pieces: tuple[int, int | None]):
    a, b = random_pair(seed)
    truth = obbcli.first_contact(a, b, 2.0)
    there = (
        b if pieces[1] is None else Body(b.shape, motion=split(b.motion, b.pose, 2.0, pieces[1]))
    )
    here = Body(a.shape, motion=split(a.motion, a.pose, 2.0, pieces[0]))

    answer = obbcli.first_contact(here, there)

    assert answer.status is truth.status
    assert obbcli.collide(here, there).status is truth.status
    if truth.time is not None:
        assert bounds(answer)[0] <= bounds(truth)[1] + 1e-9
        assert_at(answer, truth.time, 2e-9)


@pytest.mark.parametrize("seed", range(12))
def test_no_sample_before_the_bound_overlaps(seed: int):
    draw = np.random.default_rng(seed + 100)
    bodies = []
    for side in (-1, 1):
        times = np.cumsum(draw.uniform(0.1, 0.6, 5)) - 0.1
        turns, places = draw.normal(size=(5, 3)), draw.normal(size=(5, 3))
        poses = [
            Pose(0.5 * turn, place + np.array([1.2 * side, 0, 0]) * (5 - k))
            for k, (turn, place) in enumerate(zip(turns, places, strict=True))
        ]
        mesh = Mesh(*(angle_bar() if side < 0 else octahedron()))
        bodies.append((mesh, Motion.through(times, poses)))

    answer = obbcli.first_contact(*(Body(mesh, motion=path) for mesh, path in bodies))

    end = max(path.times[-1] for _, path in bodies) if answer.time is None else answer.time
    for time in np.linspace(0, end, 60, endpoint=False):
        a, b = ((path.pose_at(time).apply(m.vertices), m.triangles) for m, path in bodies)
        assert not mesh_pairs(*a, *b)


def test_joint_sweep_reaches_the_wall_in_its_piece():
    # An arm that turns about z by given angles; its upper corner is at 2 sin x + cos x / 16.
    arm = Mesh(*box((0.0, -0.0625, -0.0625), (2.0, 0.0625, 0.0625)))
    wall = Mesh(*box((-8.0, 1.0, -9.0), (8.0, 2.0, 10.0)))
    angles, times = [0.0, 0.25, -1.0, 0.375, 1.5], [0.0, 0.5, 1.75, 2.0, 4.0]
    sweep = Motion.through(times, [Pose((0, 0, angle)) for angle in angles])
    true_angle = math.asin(1 / math.hypot(2, 0.0625)) - math.atan2(0.0625, 2)

    answer = obbcli.first_contact(Body(arm, motion=sweep), wall)

    assert_at(answer, 2 + 2 * (true_angle - 0.375) / 1.125, 4e-9)
    assert answer.evidence == "intersecting"
    assert answer.normal == pytest.approx((0, 1, 0), abs=1e-6)


def test_fall_in_steps_lands_in_its_piece():
    answer = obbcli.first_contact(falling([0, 1, 3, 4], 8, 4, 3, -1), FLOOR)

    assert_at(answer, 3.75, 4e-9)
    assert answer.evidence == "intersecting"
    assert answer.normal == pytest.approx((0, 0, -1), abs=1e-6)


@pytest.mark.parametrize("times", [(0, 1, 2), (0, 0.1, 0.7), (3, 5, 100)])
def test_touch_at_a_break_is_found(times: tuple[float, ...]):
    answer = obbcli.first_contact(falling(times, 2, 0, 2), FLOOR)

    assert_at(answer, times[1], 1e-9 * times[-1])
    assert answer.distance is not None
    assert answer.distance <= NEAR


@pytest.mark.parametrize("times", [(0, 1, 2), (0, 0.1, 0.7), (3, 5, 100)])
def test_near_miss_at_a_break_is_proven_apart(times: tuple[float, ...]):
    answer = obbcli.first_contact(falling(times, 2, 2.0**-32, 2), FLOOR)

    assert answer.status is Status.SEPARATED


def test_touch_in_the_last_pose_is_found():
    answer = obbcli.first_contact(falling((0, 0.3, 0.9), 2, 1, 0), FLOOR)

    assert_at(answer, 0.9, 1e-9)


def test_nothing_slips_through_between_two_legs():
    # The corner crosses the sheet just where one leg ends and the next begins.
    sheet = Mesh([[-8, -8, 0], [8, -8, 0], [0, 9, 0]], [[0, 1, 2]])
    spike = Mesh([[0, 0, 0], [-0.1, 0, 0], [0.1, 0, 0.0]], [[0, 1, 2]])
    for k in range(40):
        turn, low = (0.0, 0.0, 0.1 * k), 0.1 * (k + 1)
        poses = [Pose(turn, (0.3, 0.1, 3 * low)), Pose((0, 0, 0.7), (0.3, 0.1, 0.0))]
        poses.append(Pose((0, 0.1, 1), (0.3, 0.1, -low)))

        answer = obbcli.first_contact(
            Body(spike, motion=Motion.through([0, low, 1 + low], poses)), sheet
        )

        assert_at(answer, low, 1e-8)


def test_overlap_in_the_first_pose_is_at_the_start():
    answer = obbcli.first_contact(falling([1, 2], -0.5, 3), FLOOR)

    assert answer.status is Status.OVERLAP_AT_START
    assert answer.time_bounds == (0, 0)
    assert len(obbcli.triangle_pairs(falling([1, 2], -0.5, 3), FLOOR)) > 0


def test_path_and_constant_velocity_meet():
    # The cube hovers, then falls at 1; the floor rises at 1/2 all the time: gap 8 - t/2 - (t - 4).
    riser = Body(FLOOR, motion=Motion((0, 0, 0.5)))

    answer = obbcli.first_contact(falling([0, 4, 20], 8, 8, -8), riser)

    assert_at(answer, 8.0, 2e-8)


def test_path_and_constant_spin_meet():
    # A blade that turns about z once in 2 pi s, and a cube that drops beside it when it is away.
    blade = Mesh(*box((0.0, -0.0625, -2.0), (4.0, 0.0625, 2.0)))
    fan = Body(blade, motion=Motion(angular_velocity=(0, 0, 1), pivot=(0, 0, 0)))
    start, down = Pose(translation=(-3.0, 0, 9)), Pose(translation=(-3.0, 0, 0))
    drop = Body(CUBE, motion=Motion.through([0, 1, 2, 9], [start, start, down, down]))

    answer = obbcli.first_contact(drop, fan)

    # First at the cube's corner (-2, 1) or on (-4.., 1): the blade's near side reaches both.
    x, y = -2.0, 1.0
    true_time = math.atan2(y, x) - math.asin(0.0625 / math.hypot(x, y))
    far = math.pi - math.asin(1.0 / math.hypot(4.0, 0.0625)) - math.asin(0.0625 / 4)
    assert_at(answer, min(true_time, far), 2e-8)


def test_body_rests_before_its_path_and_after():
    mover = Body(FLOOR, Pose(translation=(0, 0, -10.0)), Motion((0, 0, 2.0)))

    before = obbcli.first_contact(falling([8, 9], 0, 30), mover)
    after = obbcli.first_contact(falling([0, 1], 30, 6), mover, 20)

    assert_at(before, 5.0, 2e-8)
    assert_at(after, 8.0, 2e-8)


def test_duration_is_that_of_the_path_unless_given():
    fall = falling([0, 1, 4], 4, 4, -2)

    assert Query(fall, FLOOR).duration == 4
    assert_at(obbcli.first_contact(fall, FLOOR), 3.0, 1e-8)
    assert obbcli.first_contact(fall, FLOOR, 2.5).status is Status.SEPARATED
    assert obbcli.first_contact(fall, FLOOR, 0).status is Status.SEPARATED
    assert_at(obbcli.first_contact(fall, FLOOR, 3), 3.0, 1e-8)


def test_clearance_counts_along_a_path():
    answer = obbcli.first_contact(falling([0, 1, 5], 4, 4, 0), FLOOR, None, Accuracy(clearance=0.5))

    assert_at(answer, 4.5, 1e-8)


@pytest.mark.parametrize("seed", range(4))
def test_query_goes_on_pop_by_pop_to_the_same_answer(seed: int):
    a, b = random_pair(seed)
    here = Body(a.shape, motion=split(a.motion, a.pose, 2.0, 9))
    whole = obbcli.first_contact(here, b)
    query = Query(here, b)
    proven = [0.0]

    while not query.is_finished:
        found = query.advance(3)
        proven.append(query.lower_bound)
        if not query.is_finished:
            assert found.status is Status.UNRESOLVED
            assert found.time_bounds == (query.lower_bound, None)

    assert proven == sorted(proven)
    assert found.status is whole.status
    assert found.time_bounds == whole.time_bounds
    assert query.lower_bound == (2.0 if whole.time is None else whole.time)


def test_default_limit_counts_pairs_and_not_pieces():
    times = np.arange(701)

    answer = obbcli.first_contact(falling(times, *np.linspace(9, 1, 701)), FLOOR)

    assert answer.status is Status.SEPARATED
    assert 700 <= answer.stats.pops < 100_000


def test_limit_leaves_a_proven_bound():
    fall = falling([0, 1, 2, 3], 9, 7, 5, -1)

    answer = obbcli.first_contact(fall, FLOOR, None, Accuracy(max_iterations=4))

    assert answer.status is Status.UNRESOLVED
    assert answer.time is not None
    assert 0 < answer.time < 2 + 5 / 6


def test_depth_limited_path_keeps_its_bound():
    fall = falling([0, 1, 3, 4], 8, 4, 3, -1)

    answer = obbcli.first_contact(fall, FLOOR, None, Accuracy(max_depth_a=0, max_depth_b=0))

    assert answer.status is not Status.SEPARATED
    assert answer.time == pytest.approx(3.75, abs=1e-6)
    assert answer.time <= 3.75
