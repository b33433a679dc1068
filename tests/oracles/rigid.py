"""Bodies in rigid motion to 50 digits: where a point is at a time, independent of any kernel.

`x(t) = K + t V + R(t W) (x0 - K)`, R turning by `|W| t` about `W / |W|`, right-handed.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import mpmath
from oracles.exact import plain

DIGITS = 50


def rotation_matrix(w: Any, t: Any = 1, digits: int = DIGITS) -> list[list[mpmath.mpf]]:
    """Return the rotation by the vector `w t`, each entry right to about `digits` digits."""
    with mpmath.workdps(digits + 10):
        x, y, z = (_mpf(n) for n in plain(w))
        speed = mpmath.sqrt(x * x + y * y + z * z)
        if speed == 0:
            return [[mpmath.mpf(int(i == j)) for j in range(3)] for i in range(3)]
        x, y, z = x / speed, y / speed, z / speed
        angle = speed * _mpf(t)
        s, c = mpmath.sin(angle), mpmath.cos(angle)
        # 1 - cos, without its cancellation at small angles.
        v = 2 * mpmath.sin(angle / 2) ** 2
        return [
            [c + x * x * v, x * y * v - z * s, x * z * v + y * s],
            [y * x * v + z * s, c + y * y * v, y * z * v - x * s],
            [z * x * v - y * s, z * y * v + x * s, c + z * z * v],
        ]


def rigid_point(
    x0: Any,
    linear_velocity: Any,
    angular_velocity: Any,
    pivot: Any,
    t: Any,
    digits: int = DIGITS,
) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf]:
    """Return where the world point `x0` at time 0 is at time `t`."""
    matrix = rotation_matrix(angular_velocity, t, digits)
    return _moved(matrix, x0, linear_velocity, pivot, t, digits)


def rigid_points(
    points: Any,
    linear_velocity: Any,
    angular_velocity: Any,
    pivot: Any,
    t: Any,
    digits: int = DIGITS,
) -> list[tuple[Fraction, Fraction, Fraction]]:
    """Return the points (N, 3) at time `t` as rationals, which the exact oracles take."""
    matrix = rotation_matrix(angular_velocity, t, digits)
    moved = (_moved(matrix, point, linear_velocity, pivot, t, digits) for point in plain(points))
    return [(_fraction(x), _fraction(y), _fraction(z)) for x, y, z in moved]


def _moved(
    matrix: list[list[mpmath.mpf]], x0: Any, velocity: Any, pivot: Any, t: Any, digits: int
) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf]:
    with mpmath.workdps(digits + 10):
        center = [_mpf(n) for n in plain(pivot)]
        time = _mpf(t)
        arm = [_mpf(n) - k for n, k in zip(plain(x0), center, strict=True)]
        x, y, z = (
            k + time * _mpf(v) + mpmath.fdot(row, arm)
            for k, v, row in zip(center, plain(velocity), matrix, strict=True)
        )
    return x, y, z


def _mpf(number: Any) -> mpmath.mpf:
    if isinstance(number, mpmath.mpf):
        return number
    top, bottom = number.as_integer_ratio()
    return mpmath.mpf(top) / bottom


def _fraction(number: mpmath.mpf) -> Fraction:
    mantissa, exponent = number.man_exp  # without the sign
    size = Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
    return -size if number < 0 else size
