"""Frames that turn, integrated step by step: Euler and Runge-Kutta. Eberly 2008 §5.

The way of the sampled method; `rotation.turn_after` has the closed form.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from obbcli.errors import MotionError

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Of a column's length: what is left of it across the others is rounding where it is no more.
_LOST = 2.0**-40


def euler_step(
    frame: NDArray[np.float64], spin: NDArray[np.float64], time: float
) -> NDArray[np.float64]:
    """Return a frame after one step of Euler's method on dF/dt = W x F, orthonormalized.

    Off by about half the square of the angle turned, so by O(time) over a given duration.

    Args:
        frame: (3, 3), its columns are the axes.
        spin: W, (3,) rad/s.
        time: s.

    Raises:
        MotionError: the step turns by so much that nothing is left of the frame.
    """
    with np.errstate(all="ignore"):
        return _orthonormalized(frame + _cross(time * spin) @ frame, spin, time)


def rk4_step(
    frame: NDArray[np.float64], spin: NDArray[np.float64], time: float
) -> NDArray[np.float64]:
    """Return a frame after one step of the classical Runge-Kutta method, orthonormalized.

    Off by O(time^4) over a given duration.

    Args:
        frame: (3, 3), its columns are the axes.
        spin: W, (3,) rad/s.
        time: s.

    Raises:
        MotionError: the step turns by so much that nothing is left of the frame.
    """
    with np.errstate(all="ignore"):
        turn = _cross(time * spin)
        first = turn @ frame
        second = turn @ (frame + 0.5 * first)
        third = turn @ (frame + 0.5 * second)
        fourth = turn @ (frame + third)
        change = (first + 2.0 * (second + third) + fourth) / 6.0
        return _orthonormalized(frame + change, spin, time)


def _cross(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the matrix S of the paper: S x = vector x x."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _orthonormalized(
    frame: NDArray[np.float64], spin: NDArray[np.float64], time: float
) -> NDArray[np.float64]:
    """Return the right-handed frame that Gram and Schmidt make of three columns."""
    x, y = _normalized(frame[:, 0]), _normalized(frame[:, 1])
    rest = y - (x @ y) * x
    # Written so that it refuses what is not a number.
    if not np.abs(rest).max() > _LOST:
        angle = math.hypot(*spin.tolist()) * time
        raise MotionError(
            "steps",
            f"too few: one turns by {angle:.3g} rad, of which the integrator makes no frame",
            "take more, or the exact integrator",
        )
    # Once more: what was left has been rounded by as much as the columns were long.
    rest = _normalized(rest)
    y = _normalized(rest - (x @ rest) * x)
    return np.column_stack((x, y, _cross(x) @ y))


def _normalized(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    unit: NDArray[np.float64] = vector / math.sqrt(vector @ vector)
    return unit
