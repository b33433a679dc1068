"""Frames that turn, integrated step by step: Euler and Runge-Kutta. Eberly 2008 §5.

The way of the sampled method; `rotation.turn_after` has the closed form.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from obbcli.errors import MotionError

if TYPE_CHECKING:
    from collections.abc import Sequence

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
    # The equation is linear and W constant, so the four stages add up to a polynomial in S.
    with np.errstate(all="ignore"):
        turn = _cross(time * spin)
        result = frame
        for order in (4, 3, 2, 1):
            result = frame + (turn / order) @ result
        return _orthonormalized(result, spin, time)


def _cross(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the matrix S of the paper: S x = vector x x."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _orthonormalized(
    frame: NDArray[np.float64], spin: NDArray[np.float64], time: float
) -> NDArray[np.float64]:
    """Return the right-handed frame that Gram and Schmidt make of three columns."""
    first, second, _ = frame.T.tolist()
    x = _normalized(first)
    rest = _across(_normalized(second), x)
    # NaN fails this comparison, and is refused.
    if not max(map(abs, rest)) > _LOST:
        angle = math.hypot(*spin.tolist()) * time
        raise MotionError(
            "steps",
            f"too few: one turns by {angle:.3g} rad, of which the integrator makes no frame",
            "take more, or the exact integrator",
        )
    # A second pass removes what the first has left by rounding relative to the columns' length.
    y = _normalized(_across(_normalized(rest), x))
    z = x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]
    orthonormal: NDArray[np.float64] = np.array((x, y, z)).T
    return orthonormal


def _normalized(vector: Sequence[float]) -> list[float]:
    length = math.hypot(*vector)
    return [v / length for v in vector]


def _across(vector: Sequence[float], unit: Sequence[float]) -> list[float]:
    """Return what is left of a vector across a unit one."""
    along = vector[0] * unit[0] + vector[1] * unit[1] + vector[2] * unit[2]
    return [v - along * u for v, u in zip(vector, unit, strict=True)]
