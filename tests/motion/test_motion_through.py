"""Motion through poses: the poses themselves, what lies between, what is refused."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scenes import pairs as scenes

from obbcli import Body, Mesh, Motion, MotionError, Pose
from obbcli.motion.rotation import rotation_matrix, rotation_vector

if TYPE_CHECKING:
    from obbcli.motion.path import PathMotion

TRIANGLE = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
TWO = [Pose(), Pose([0, 0, 1.0], [1, 2, 3])]


def random_path(seed: int, count: int = 6) -> PathMotion:
    draw = np.random.default_rng(seed)
    times = np.cumsum(draw.uniform(0.01, 2, count))
    poses = [Pose(scenes.random_rotation(k), draw.normal(size=3) * 5) for k in range(count)]
    return Motion.through(times, poses)


@pytest.mark.parametrize("seed", range(20))
def test_pieces_end_where_the_next_begin(seed: int):
    path = random_path(seed)

    for k in range(len(path.poses) - 1):
        end = path.piece(k).pose_at(path.times[k + 1] - path.times[k], path.poses[k])
        np.testing.assert_allclose(end.rotation, path.poses[k + 1].rotation, rtol=0, atol=4e-15)
        np.testing.assert_allclose(
            end.translation, path.poses[k + 1].translation, rtol=0, atol=4e-15
        )


def test_poses_are_met_exactly():
    path = random_path(3)

    for time, pose in zip(path.times, path.poses, strict=True):
        at = path.pose_at(time)
        np.testing.assert_array_equal(at.rotation, pose.rotation)
        np.testing.assert_array_equal(at.translation, pose.translation)


def test_origin_goes_straight_and_the_turn_is_even():
    path = Motion.through([1, 3], [Pose([0, 0, 0.2], [0, 0, 1]), Pose([0, 0, 1.8], [4, 0, 1])])

    at = path.pose_at(1.5)

    np.testing.assert_allclose(at.rotation, rotation_matrix((0, 0, 0.6)), rtol=0, atol=1e-15)
    np.testing.assert_allclose(at.translation, [1, 0, 1], rtol=0, atol=1e-15)


def test_body_rests_before_and_after():
    path = Motion.through([1, 2], TWO)

    assert path.pose_at(0) is path.poses[0]
    assert path.pose_at(0.999) is path.poses[0]
    assert path.pose_at(7) is path.poses[1]


def test_steady_path_is_the_constant_motion():
    motion = Motion((1, -2, 0.5), (0.3, 0.2, -0.4), (0, 0, 0))
    path = Motion.through(range(5), [motion.pose_at(k) for k in range(5)])

    for t in np.linspace(0, 4, 33):
        here, there = path.pose_at(t), motion.pose_at(t)
        np.testing.assert_allclose(here.rotation, there.rotation, rtol=0, atol=4e-15)
        np.testing.assert_allclose(here.translation, there.translation, rtol=0, atol=2e-14)


def test_equal_poses_are_rest():
    crooked = Pose(np.eye(3) + 1e-11 * np.arange(9).reshape(3, 3))

    path = Motion.through([0, 1, 2], [crooked, crooked, crooked])

    assert path.is_at_rest
    assert not Motion.through([0, 1], TWO).is_at_rest


@pytest.mark.parametrize("angle", [0.0, 1e-300, 1e-9, 0.1, 1.5, 3.0, math.pi - 1e-7])
@pytest.mark.parametrize("axis", [(1, 0, 0), (0, -1, 0), (0, 0, 1), (1, 1, 1), (-3, 2, 0.1)])
def test_vector_of_a_matrix_gives_the_matrix(angle: float, axis: Any):
    vector = angle * np.array(axis) / np.linalg.norm(axis)

    back = rotation_vector(rotation_matrix(vector))

    np.testing.assert_allclose(back, vector, rtol=1e-15, atol=2e-15 if angle > 1e-6 else 1e-24)


def test_body_starts_where_its_path_does():
    first = Pose([0, 0, 0.5], [1, 2, 3])
    path = Motion.through([0, 1], [first, Pose()])

    assert Body(TRIANGLE, motion=path).pose is first
    assert Body(TRIANGLE, pose=first, motion=path).pose is first
    with pytest.raises(MotionError, match=r"^pose: is given beside a motion through poses"):
        Body(TRIANGLE, Pose(translation=(0, 0, 1)), path)


def test_path_takes_no_other_pose_or_pivot():
    path = Motion.through([0, 1], TWO)

    with pytest.raises(MotionError, match=r"^pose: is given"):
        path.pose_at(0.5, Pose([0, 1, 0]))
    with pytest.raises(MotionError, match=r"^pivot: is given"):
        path.pose_at(0.5, pivot=(0, 0, 0))


@pytest.mark.parametrize(
    ("times", "poses", "message"),
    [
        ([0, 1, 1], [*TWO, Pose()], r"times\[2\]: is 1.0 after 1.0"),
        ([0, 2, 1], [*TWO, Pose()], r"times\[2\]: is 1.0 after 2.0"),
        ([0, math.nan], TWO, r"times\[1\]: is nan"),
        ([0, math.inf], TWO, r"times\[1\]: is inf"),
        ([-1, 1], TWO, r"times\[0\]: is -1.0"),
        ([0], TWO[:1], "times: 1 for 1 poses"),
        ([], [], "times: 0 for 0 poses"),
        ([0, 1, 2], TWO, "times: 3 for 2 poses"),
        ([[0, 1]], TWO, r"times: has shape \(1, 2\)"),
        ("later", TWO, "times: expected numbers"),
        ([0, 1], [Pose(), np.eye(4)], r"poses\[1\]: is of type ndarray"),
        ([0, 1], [Pose(), Pose([0, 0, math.pi])], "piece 0 .*turns by half a turn"),
        ([0, 1e-300], [Pose(), Pose(None, [1e10, 0, 0])], "piece 0 .*too fast"),
    ],
)
def test_through_refuses(times: Any, poses: Any, message: str):
    with pytest.raises(MotionError, match=message):
        Motion.through(times, poses)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0.6, 0, -0.8), (1, 2, 3)])
def test_through_names_the_piece_of_a_half_turn(axis: Any):
    unit = np.array(axis) / np.linalg.norm(axis)
    poses = [Pose(), Pose(unit), Pose((1 + math.pi) * unit)]

    with pytest.raises(MotionError, match="piece 1 of the motion, from pose 1 to 2"):
        Motion.through([0, 1, 2], poses)


def test_through_keeps_nothing_of_the_callers_arrays():
    times = np.array([0.0, 1.0])
    path = Motion.through(times, TWO)

    times[1] = 5

    assert path.times.tolist() == [0, 1]
