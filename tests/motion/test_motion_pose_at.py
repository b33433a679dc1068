"""Where a motion has taken a body: closed forms against 50 digits, however many turns."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.rigid import rigid_point, rotation_matrix

from obbcli import Motion, MotionError, Pose

U = 2.0**-53
VECTORS = st.lists(st.floats(-10, 10), min_size=3, max_size=3)


def far_off(pose: Pose, true: list[list[mpmath.mpf]]) -> float:
    """Return by how much an entry of a rotation is wrong."""
    return max(
        abs(float(mpmath.mpf(x) - y))
        for row, wide in zip(pose.rotation.tolist(), true, strict=True)
        for x, y in zip(row, wide, strict=True)
    )


def true_origin(velocity, spin, pivot, start, t):
    return rigid_point(start, velocity, spin, pivot, t)


@pytest.mark.parametrize("turns", [1e-12, 0.3, 1, 1e3, 1e6, 1e9, 1e15])
@pytest.mark.parametrize("spin", [(0, 0, 1), (3, -4, 0.1), (1e-200, 2e-200, 0), (1e150, 0, 3e150)])
def test_pose_at_keeps_its_digits_over_many_turns(turns: float, spin: tuple[float, ...]):
    time = turns * 2 * math.pi / float(np.linalg.norm(np.array(spin) / max(spin))) / max(spin)
    pivot = (3.0, -2.0, 0.5)

    pose = Motion(angular_velocity=spin, pivot=pivot).pose_at(time)

    assert far_off(pose, rotation_matrix(spin, time)) <= 8 * U
    truth = true_origin((0, 0, 0), spin, pivot, (0, 0, 0), time)
    assert pose.translation == pytest.approx([float(x) for x in truth], rel=0, abs=32 * U)


@given(VECTORS, VECTORS, VECTORS, VECTORS, st.floats(0, 1e7))
def test_pose_at_follows_the_closed_form(velocity, spin, pivot, start, time):
    pose = Motion(velocity, spin, pivot).pose_at(time, Pose(translation=start))

    truth = true_origin(velocity, spin, pivot, start, time)
    reach = np.abs(velocity).max() * time + np.abs(pivot).max() + np.abs(start).max()
    error = [abs(mpmath.mpf(x) - y) for x, y in zip(pose.translation.tolist(), truth, strict=True)]
    assert max(error) <= 16 * U * reach + 1e-300
    assert far_off(pose, rotation_matrix(spin, time)) <= 8 * U


def test_pose_at_of_a_tiny_turn_keeps_the_shift():
    motion = Motion(angular_velocity=(0, 0, 1e-20), pivot=(1, 0, 0))

    assert motion.pose_at(1).translation.tolist() == [5e-41, -1e-20, 0.0]


def test_pose_at_turns_back_before_zero():
    motion = Motion((1, 2, 3), (0.5, -1, 2), (4, 5, 6))
    back, forth = motion.pose_at(-0.75), motion.pose_at(0.75)

    np.testing.assert_allclose(back.rotation, forth.rotation.T, rtol=0, atol=8 * U)


def test_pose_at_carries_the_pose():
    pose = Pose([0.1, 0.2, 0.3], [1, 2, 3])
    motion = Motion((1, 0, 0), (0, 0, math.pi / 2), (1, 2, 3))
    point = np.array([[0.5, -1.0, 2.0]])

    moved = motion.pose_at(1.0, pose).apply(point)

    x, y, z = (pose.apply(point)[0] - (1, 2, 3)).tolist()
    np.testing.assert_allclose(moved, [[2 - y, 2 + x, 3 + z]], rtol=0, atol=1e-15)


def test_pose_at_follows_what_is_barely_orthonormal():
    # Its Q Q^T is off by 9.8e-10 in six entries: turned, by more than 1e-9 in one.
    skew = np.eye(3) + 4.9e-10 * (1 - np.eye(3))
    motion = Motion((0, 0, 1), (0.3, 0.4, 0.5), (1, 2, 3))

    pose = motion.pose_at(2.0, Pose(skew))

    turn = motion.pose_at(2.0).rotation
    np.testing.assert_allclose(pose.rotation, turn @ skew, rtol=0, atol=8 * U)


def test_pose_at_start_or_at_rest_is_the_pose_itself():
    pose = Pose([0.1, 0.2, 0.3], [1, 2, 3])

    assert Motion((1, 2, 3), (4, 5, 6)).pose_at(0, pose) is pose
    assert Motion().pose_at(1e9, pose) is pose


def test_pose_at_without_turning_needs_no_pivot():
    assert Motion((1, 2, 3)).pose_at(2).translation.tolist() == [2, 4, 6]


def test_pose_at_asks_for_the_pivot_it_needs():
    motion = Motion(angular_velocity=(0, 0, math.pi))

    with pytest.raises(MotionError, match=r"pivot: is not given, .*turns"):
        motion.pose_at(1)
    np.testing.assert_allclose(
        motion.pose_at(1, pivot=(1, 0, 0)).translation, [2, 0, 0], atol=1e-15
    )


def test_pose_at_prefers_the_motions_own_pivot():
    motion = Motion(angular_velocity=(0, 0, math.pi), pivot=(1, 0, 0))

    np.testing.assert_allclose(
        motion.pose_at(1, pivot=(9, 9, 9)).translation, [2, 0, 0], atol=1e-15
    )


@pytest.mark.parametrize("time", [math.nan, math.inf, "soon", None, [1.0, 2.0]])
def test_pose_at_refuses_what_is_no_time(time):
    with pytest.raises(MotionError, match=r"^t: |^t\["):
        Motion((1, 0, 0)).pose_at(time)


def test_pose_at_refuses_what_leaves_the_range_of_double():
    with pytest.raises(MotionError, match="translation"):
        Motion((1e300, 0, 0)).pose_at(1e10)
    with pytest.raises(MotionError, match="more than a double can hold"):
        Motion(angular_velocity=(1e300, 0, 0), pivot=(0, 0, 0)).pose_at(1e10)
