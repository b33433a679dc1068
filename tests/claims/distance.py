"""Held to exact arithmetic: what a `Distance` claims, in rational numbers."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from oracles.distance import point_triangle_distance_squared
from oracles.still import root

if TYPE_CHECKING:
    from obbcli import Distance

ULP = 2.0**-52


def assert_bounds_hold(answer: Distance, square: Fraction) -> None:
    """Assert that the bounds hold the root of `square`, and that 0 is said of contact alone."""
    low, high = map(Fraction, answer.bounds)
    assert 0 <= low <= high
    assert low * low <= square <= high * high
    assert answer.distance == answer.bounds[1]
    assert (answer.distance == 0) == (square == 0)


def assert_bounds_are_close(answer: Distance, extent: float) -> None:
    """Assert that the bounds are a few ulps of the distance apart, or an ulp of the extent."""
    low, high = answer.bounds
    assert high - low <= max(8 * float(np.spacing(high)), ULP * extent)


def assert_points_say_it(answer: Distance, corners_a: Any, corners_b: Any) -> None:
    """Assert that the points lie in the triangles named, and are as far apart as is said.

    Args:
        answer: of `distance`.
        corners_a: A's triangle, posed, (3, 3).
        corners_b: B's.
    """
    # A point is rounded to double: by half an ulp of its coordinates, and as it is computed by a
    # few of the pair's extent, which is no larger than twice the coordinates.
    largest = max(float(np.abs(corners_a).max()), float(np.abs(corners_b).max()))
    rounding = Fraction(largest) * Fraction(32 * ULP) + Fraction(5e-324) * 4
    off_a = root(point_triangle_distance_squared(answer.point_a, corners_a))
    off_b = root(point_triangle_distance_squared(answer.point_b, corners_b))
    assert max(off_a, off_b) <= rounding
    steps = [Fraction(p) - Fraction(q) for p, q in zip(answer.point_a, answer.point_b, strict=True)]
    apart = root(sum((step * step for step in steps), Fraction(0)))
    # An upper end that is not refined, of coarse answers, has 16 roundoffs of the distance and the
    # extent, sums of three lengths, added to it.
    margin = Fraction(8 * ULP) * (apart + 6 * Fraction(largest))
    assert abs(apart - Fraction(answer.distance)) <= 2 * rounding + margin


def extent_of(*vertices: Any) -> float:
    """Return the largest coordinate difference among points, halved where it would overflow."""
    points = np.concatenate([np.asarray(v, dtype=np.float64).reshape(-1, 3) / 2 for v in vertices])
    return float(np.ptp(points, axis=0).max())
