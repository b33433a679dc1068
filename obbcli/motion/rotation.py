"""Rotations in numbers: matrices from vectors and back, and turns of any length in closed form."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.arrays import as_vector
from obbcli.errors import MotionError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

# Bits kept of an angle before it is split into two doubles: 53 each, and some to spare.
_ANGLE_BITS = 128


class Turn(NamedTuple):
    """A rotation about a unit axis; `versine` is 1 - cos, without cancellation near 0."""

    axis: NDArray[np.float64]
    cosine: float
    sine: float
    versine: float

    @property
    def matrix(self) -> NDArray[np.float64]:
        """The rotation matrix, (3, 3)."""
        x, y, z = self.axis.tolist()
        cosine, sine, versine = self.cosine, self.sine, self.versine
        matrix = np.array(
            [
                [cosine + versine * x * x, versine * x * y - sine * z, versine * x * z + sine * y],
                [versine * x * y + sine * z, cosine + versine * y * y, versine * y * z - sine * x],
                [versine * x * z - sine * y, versine * y * z + sine * x, cosine + versine * z * z],
            ]
        )
        return matrix + 0.0  # no negative zeros

    def shift_of(self, arm: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return `R arm - arm`, (3,), to few roundings of itself however small the angle."""
        across = np.cross(self.axis, arm)
        shift: NDArray[np.float64] = self.sine * across + self.versine * np.cross(self.axis, across)
        return shift


_NO_TURN = Turn(np.zeros(3), 1.0, 0.0, 0.0)


def turn_after(spin: NDArray[np.float64], time: float) -> Turn:
    """Return the rotation R(t W), to a few roundings however many turns that is.

    Args:
        spin: W, (3,) rad/s.
        time: t, s.

    Raises:
        MotionError: the angle exceeds the range of double.
    """
    root, shift, axis = _speed(tuple(spin.tolist()))
    numerator, denominator = abs(time).as_integer_ratio()
    angle = root * numerator
    if angle == 0:
        return _NO_TURN
    unit = denominator << shift
    try:
        high = angle / unit  # both are integers, so the quotient is rounded once
    except OverflowError as fault:
        raise MotionError("time", "turns by more than a double can hold", "shorten it") from fault
    whole, part = high.as_integer_ratio()
    low = (angle * part - whole * unit) / (unit * part)
    axis = math.copysign(1.0, time) * axis
    cosine, sine = _cosine_sine(high, low)
    half = _cosine_sine(0.5 * high, 0.5 * low)[1]
    return Turn(axis, cosine, sine, 2.0 * half * half)


def axis_of(spin: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the unit axis W / |W| of a spin other than 0, (3,)."""
    # Scaling by a power of two first keeps the direction of subnormal spins.
    unit = np.ldexp(spin, -math.frexp(float(np.abs(spin).max()))[1])
    axis: NDArray[np.float64] = unit / math.hypot(*unit.tolist())
    return axis


@lru_cache(maxsize=64)
def _speed(spin: tuple[float, float, float]) -> tuple[int, int, NDArray[np.float64]]:
    """Return |W| as a whole number, by how many bits it is too large, and the axis.

    Rounded down: the root of a sum of squares in integers, shifted so that it has enough bits.
    """
    ratios = [w.as_integer_ratio() for w in spin]
    bits = max(denominator.bit_length() - 1 for _, denominator in ratios)
    square = sum(((n << bits) // d) ** 2 for n, d in ratios)
    more = max(_ANGLE_BITS - square.bit_length() // 2, 0)
    axis = axis_of(np.array(spin)) if square else np.zeros(3)
    axis.setflags(write=False)
    return math.isqrt(square << 2 * more), bits + more, axis


def _cosine_sine(high: float, low: float) -> tuple[float, float]:
    """Return cos and sin of high + low: the platform's reduce any double exactly."""
    c, s = math.cos(high), math.sin(high)
    dc, ds = math.cos(low), math.sin(low)
    return c * dc - s * ds, s * dc + c * ds


def rotation_matrix(vector: ArrayLike, *, degrees: bool = False) -> NDArray[np.float64]:
    """Return the float64 (3, 3) matrix that turns by the length of `vector` about its direction.

    A zero vector gives the identity exactly; in degrees, quarter turns about a coordinate axis
    are exact as well.

    Args:
        vector: (3,) axis times angle.
        degrees: whether the angle is in degrees rather than radians.

    Raises:
        MotionError: not three finite numbers.
    """
    turn = as_vector(vector, "rotation", MotionError)
    angle = math.hypot(*turn)
    if angle == 0.0:
        return np.eye(3)
    if not math.isfinite(angle):
        raise MotionError("rotation", f"turns by {angle}", "give an angle that a double can hold")
    return Turn(turn / angle, *_trigonometry(angle, degrees)).matrix


def _trigonometry(angle: float, degrees: bool) -> tuple[float, float, float]:
    """Return cos, sin and 1 - cos of an angle, the last without cancellation near 0."""
    if not degrees:
        return math.cos(angle), math.sin(angle), 2.0 * math.sin(0.5 * angle) ** 2
    # The remainder is exact, so multiples of a right angle stay exact.
    angle = math.remainder(angle, 360.0)
    quarter = round(angle / 90.0)
    rest = math.radians(angle - 90.0 * quarter)
    pairs = (
        (math.cos(rest), math.sin(rest)),
        (-math.sin(rest), math.cos(rest)),
        (-math.cos(rest), -math.sin(rest)),
        (math.sin(rest), -math.cos(rest)),
    )
    cosine, sine = pairs[quarter % 4]
    versine = 2.0 * math.sin(0.5 * rest) ** 2 if quarter % 4 == 0 else 1.0 - cosine
    return cosine, sine, versine


def rotation_vector(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return axis times angle of a rotation, (3,), the angle at most half a turn.

    Through the quaternion's largest component (Shepperd 1978), so that no angle loses digits.

    Args:
        matrix: (3, 3), about orthonormal and right-handed.
    """
    m = matrix
    trace = float(np.trace(m))
    # The rows of 4 q q^T are multiples of the quaternion q; its diagonal is known.
    skew = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
    diagonal = np.diagonal(m)
    largest = int(np.argmax(diagonal))
    if trace >= diagonal[largest]:
        real, imaginary = 1.0 + trace, skew
    else:
        imaginary = m[largest] + m[:, largest]
        imaginary[largest] = 1.0 + 2.0 * diagonal[largest] - trace
        real = float(skew[largest])
    if real < 0:
        real, imaginary = -real, -imaginary
    length = math.hypot(*imaginary.tolist())
    if length == 0.0:
        return np.zeros(3)
    vector: NDArray[np.float64] = imaginary / length * (2.0 * math.atan2(length, real))
    return vector
