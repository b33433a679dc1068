"""Integrated frames against closed forms: order, orthonormality, what each step does."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.rigid import rotation_matrix

from obbcli import MotionError
from obbcli.motion.integrators import euler_step, rk4_step

U = 2.0**-53
STEPS = pytest.mark.parametrize("step", [euler_step, rk4_step])
# Not along an axis of the frame: there, orthonormalizing Euler's method mends part of its error.
SPIN = np.array([0.6, -1.1, 0.8])


def turned(step: Any, spin: Any, time: float, count: int) -> Any:
    frame = np.eye(3)
    for _ in range(count):
        frame = step(frame, np.asarray(spin), time / count)
    return frame


def error(step: Any, count: int) -> float:
    """Return the Frobenius norm of what `count` steps over 2 s are off."""
    truth = np.array(rotation_matrix(SPIN, 2), dtype=float)
    return float(np.linalg.norm(turned(step, SPIN, 2.0, count) - truth))


@pytest.mark.parametrize(("step", "order", "counts"), [
    (euler_step, 1, (64, 128, 256, 512, 1024)),
    (rk4_step, 4, (8, 16, 32, 64, 128)),
])  # fmt: skip
def test_halving_the_step_shows_the_order(step: Any, order: int, counts: tuple[int, ...]):
    errors = [error(step, count) for count in counts]

    for coarse, fine in itertools.pairwise(errors):
        assert 0.8 * 2**order < coarse / fine < 1.25 * 2**order


def test_euler_turns_about_an_axis_of_the_frame_by_the_arc_tangent():
    angle, spin = 0.75, (0.0, 0.0, 3.0)

    frame = euler_step(np.eye(3), np.array(spin), angle / 3)

    turn = math.atan(angle)
    expected = [[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]
    np.testing.assert_allclose(frame[:2, :2], expected, rtol=0, atol=4 * U)
    assert frame[2].tolist() == frame[:, 2].tolist() == [0, 0, 1]


def test_rk4_turns_about_an_axis_of_the_frame_by_its_taylor_polynomial():
    angle, spin = 0.75, (3.0, 0.0, 0.0)

    frame = rk4_step(np.eye(3), np.array(spin), angle / 3)

    real, imaginary = 1 - angle**2 / 2 + angle**4 / 24, angle - angle**3 / 6
    turn = math.atan2(imaginary, real)
    expected = [[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]
    np.testing.assert_allclose(frame[1:, 1:], expected, rtol=0, atol=4 * U)


@STEPS
@given(
    spin=st.lists(st.floats(-1, 1), min_size=3, max_size=3),
    exponent=st.integers(-60, 6),
    count=st.integers(1, 5),
)
def test_every_frame_is_orthonormal_and_right_handed(
    step: Any, spin: list[float], exponent: int, count: int
):
    frame = turned(step, spin, count * 2.0**exponent, count)

    assert np.abs(frame.T @ frame - np.eye(3)).max() <= 8 * U
    assert np.linalg.det(frame) > 0


@pytest.mark.parametrize(
    ("step", "spin"), [(euler_step, (1e8, -3e8, 0.0)), (rk4_step, (30.0, 50.0, 0.0))]
)
def test_frame_stays_orthonormal_where_most_of_it_is_lost(step: Any, spin: tuple[float, ...]):
    # The axis lies between the first two columns, which all but fall together.
    frame = step(np.eye(3), np.array(spin), 1.0)

    assert np.abs(frame.T @ frame - np.eye(3)).max() <= 8 * U


@STEPS
def test_no_spin_keeps_the_frame(step: Any):
    assert np.array_equal(step(np.eye(3), np.zeros(3), 1.0), np.eye(3))


@pytest.mark.parametrize(
    ("step", "spin"),
    [
        (euler_step, (1e14, 1e14, 0)),
        (rk4_step, (1e4, 1e4, 0)),
        (euler_step, (1e308, 1e308, 0)),
        (rk4_step, (1e100, 0, 1e100)),
    ],
)
def test_step_that_leaves_nothing_of_the_frame_is_refused(step: Any, spin: tuple[float, ...]):
    with pytest.raises(MotionError, match=r"^steps: too few: one turns by .* rad"):
        step(np.eye(3), np.array(spin), 1.0)
