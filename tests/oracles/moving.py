"""Exact truth for shapes under constant velocity: first and last time of contact, as rationals.

Each of the complete axes of the shapes at rest bounds the time of contact by two inequalities.
The interval needs no axis that depends on the velocity, unlike the yes or no of Eberly 2008, 2.2.2.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import chain
from typing import TYPE_CHECKING, Any

from oracles.exact import (
    Hull,
    box_hull,
    complete_axes,
    dot,
    edge_vectors,
    projection,
    relative_velocity,
    same_unit,
    triangle_hull,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

Interval = tuple[Fraction, Fraction]


def contact_interval_triangles(
    a: Any, b: Any, velocity_a: Any, velocity_b: Any, duration: float
) -> Interval | None:
    """Return the first and last time in [0, duration] at which two triangles meet, or None."""
    return contact_interval(triangle_hull(a), triangle_hull(b), velocity_a, velocity_b, duration)


def contact_interval_boxes(
    box_a: Any, box_b: Any, velocity_a: Any, velocity_b: Any, duration: float
) -> Interval | None:
    """Return the first and last time in [0, duration] at which two boxes meet, or None."""
    return contact_interval(box_hull(box_a), box_hull(box_b), velocity_a, velocity_b, duration)


def contact_interval_triangle_box(
    triangle: Any, box: Any, velocity_triangle: Any, velocity_box: Any, duration: float
) -> Interval | None:
    """Return the first and last time in [0, duration] at which the two meet, or None."""
    hulls = triangle_hull(triangle), box_hull(box)
    return contact_interval(*hulls, velocity_triangle, velocity_box, duration)


def first_contact_triangles(
    a: Any, b: Any, velocity_a: Any, velocity_b: Any, duration: float
) -> Fraction | None:
    """Return the first time in [0, duration] at which two closed triangles meet, or None."""
    return _first(contact_interval_triangles(a, b, velocity_a, velocity_b, duration))


def _first(interval: Interval | None) -> Fraction | None:
    return None if interval is None else interval[0]


def contact_interval(
    p: Hull,
    q: Hull,
    velocity_p: Sequence[float],
    velocity_q: Sequence[float],
    duration: float,
) -> Interval | None:
    """Return the first and last time in [0, duration] at which two moving hulls meet, or None."""
    p, q = same_unit(p, q)
    velocity, velocity_unit = relative_velocity(velocity_p, velocity_q)
    clock = p.unit / velocity_unit
    first, last = Fraction(0), Fraction(duration) / clock
    for axis in complete_axes(chain(edge_vectors(p), edge_vectors(q))):
        low_p, high_p = projection(p.points, axis)
        low_q, high_q = projection(q.points, axis)
        # Contact needs low <= speed * t <= high.
        low, high = low_p - high_q, high_p - low_q
        speed = dot(axis, velocity)
        if speed < 0:
            low, high, speed = -high, -low, -speed
        if speed:
            first = max(first, Fraction(low, speed))
            last = min(last, Fraction(high, speed))
        elif low > 0 or high < 0:
            return None
        if first > last:
            return None
    return first * clock, last * clock
