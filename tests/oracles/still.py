"""Exact truth for shapes at rest: closed sets, touching counts, any double including subnormals.

`triangles_intersect` has an independent twin, `triangles_intersect_by_features`, and `lp` a
second opinion on every question.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import chain
from typing import TYPE_CHECKING, Any

from oracles.exact import (
    Hull,
    Vector,
    box_hull,
    complete_axes,
    cross,
    dot,
    edge_vectors,
    projection,
    same_unit,
    subtract,
    triangle_hull,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

Point2 = tuple[int, int]


def triangles_intersect(a: Any, b: Any) -> bool:
    """Return whether two closed triangles (3, 3) share a point, by projections on axes."""
    return hulls_intersect(triangle_hull(a), triangle_hull(b))


def boxes_intersect(box_a: Any, box_b: Any) -> bool:
    """Return whether two closed boxes `(center, axes, half_extents)` share a point."""
    return hulls_intersect(box_hull(box_a), box_hull(box_b))


def triangle_box_intersect(triangle: Any, box: Any) -> bool:
    """Return whether a closed triangle and a closed box share a point."""
    return hulls_intersect(triangle_hull(triangle), box_hull(box))


def hulls_intersect(p: Hull, q: Hull) -> bool:
    """Return whether two hulls share a point."""
    p, q = same_unit(p, q)
    for axis in complete_axes(chain(edge_vectors(p), edge_vectors(q))):
        low_p, high_p = projection(p.points, axis)
        low_q, high_q = projection(q.points, axis)
        if high_p < low_q or high_q < low_p:
            return False
    return True


def triangles_separation(a: Any, b: Any) -> Fraction:
    """Return `hulls_separation` of two triangles."""
    return hulls_separation(triangle_hull(a), triangle_hull(b))


def boxes_separation(box_a: Any, box_b: Any) -> Fraction:
    """Return `hulls_separation` of two boxes."""
    return hulls_separation(box_hull(box_a), box_hull(box_b))


def triangle_box_separation(triangle: Any, box: Any) -> Fraction:
    """Return `hulls_separation` of a triangle and a box."""
    return hulls_separation(triangle_hull(triangle), box_hull(box))


def hulls_separation(p: Hull, q: Hull) -> Fraction:
    """Return the widest gap along any complete axis, as a length to 100 bits with the exact sign.

    Positive: the hulls are at least so far apart. Zero: they touch. Negative: every axis shows an
    overlap of at least this.
    """
    p, q = same_unit(p, q)
    best: tuple[int, int] | None = None
    for axis in complete_axes(chain(edge_vectors(p), edge_vectors(q))):
        low_p, high_p = projection(p.points, axis)
        low_q, high_q = projection(q.points, axis)
        gap = max(low_q - high_p, low_p - high_q)
        square = dot(axis, axis)
        if square and (best is None or _signed_square_less(best, (gap, square))):
            best = gap, square
    assert best is not None
    gap, square = best
    return _sign(gap) * p.unit * root(Fraction(gap * gap, square))


def _signed_square_less(p: tuple[int, int], q: tuple[int, int]) -> bool:
    """Return whether `p[0] / sqrt(p[1]) < q[0] / sqrt(q[1])`."""
    return p[0] * abs(p[0]) * q[1] < q[0] * abs(q[0]) * p[1]


def root(square: Fraction) -> Fraction:
    """Return the square root of a rational, to 100 bits."""
    top, bottom = square.as_integer_ratio()
    shift = max(0, 200 + bottom.bit_length() - top.bit_length())
    shift += shift % 2
    return Fraction(math.isqrt((top << shift) // bottom), 1 << (shift // 2))


def triangles_intersect_by_features(a: Any, b: Any) -> bool:
    """Return what `triangles_intersect` does, by edges meeting triangles and no axes.

    An extreme point of the common set lies on an edge of one of the two, whatever degenerates.
    """
    p, q = same_unit(triangle_hull(a), triangle_hull(b))
    return any(
        _segment_meets_triangle(start, end, q.points) for start, end in _sides(p.points)
    ) or any(_segment_meets_triangle(start, end, p.points) for start, end in _sides(q.points))


def _sides(points: tuple[Vector, ...]) -> Iterator[tuple[Vector, Vector]]:
    a, b, c = points
    yield from ((a, b), (b, c), (c, a))


def _segment_meets_triangle(start: Vector, end: Vector, corners: tuple[Vector, ...]) -> bool:
    a, b, c = corners
    normal = cross(subtract(b, a), subtract(c, a))
    if not any(normal):
        return any(_segments_meet(start, end, p, q) for p, q in _sides(corners))
    height_start = dot(normal, subtract(start, a))
    height_end = dot(normal, subtract(end, a))
    if height_start == height_end == 0:
        return _coplanar_segment_meets_triangle(start, end, corners, normal)
    if height_start * height_end > 0:
        return False
    # The piercing point times `weight`, which is positive and so changes no sign below.
    weight = abs(height_start - height_end)
    near, far = abs(height_end), abs(height_start)
    x, y, z = (near * p + far * q for p, q in zip(start, end, strict=True))
    for p, q in _sides(corners):
        arm = x - weight * p[0], y - weight * p[1], z - weight * p[2]
        if dot(normal, cross(subtract(q, p), arm)) < 0:
            return False
    return True


def _coplanar_segment_meets_triangle(
    start: Vector, end: Vector, corners: tuple[Vector, ...], normal: Vector
) -> bool:
    dropped = max(range(3), key=lambda axis: abs(normal[axis]))
    u, v = (axis for axis in range(3) if axis != dropped)
    p, q, *triangle = [(point[u], point[v]) for point in (start, end, *corners)]
    if _inside_2d(p, triangle):
        return True
    return any(_segments_meet_2d(p, q, triangle[i], triangle[i - 1]) for i in range(3))


def _turn(p: Point2, q: Point2, r: Point2) -> int:
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def _inside_2d(point: Point2, triangle: list[Point2]) -> bool:
    turns = [_turn(triangle[i - 1], triangle[i], point) for i in range(3)]
    return min(turns) >= 0 or max(turns) <= 0


def _segments_meet_2d(p: Point2, q: Point2, r: Point2, s: Point2) -> bool:
    boxes_overlap = all(
        max(min(p[i], q[i]), min(r[i], s[i])) <= min(max(p[i], q[i]), max(r[i], s[i]))
        for i in range(2)
    )
    return (
        boxes_overlap
        and _sign(_turn(p, q, r)) * _sign(_turn(p, q, s)) <= 0
        and _sign(_turn(r, s, p)) * _sign(_turn(r, s, q)) <= 0
    )


def _sign(number: int) -> int:
    return (number > 0) - (number < 0)


def _segments_meet(p: Vector, q: Vector, r: Vector, s: Vector) -> bool:
    """Return whether two segments, points included, share a point in space."""
    u, v, w = subtract(q, p), subtract(s, r), subtract(r, p)
    normal = cross(u, v)
    if any(normal):
        square = dot(normal, normal)
        return (
            dot(w, normal) == 0
            and 0 <= dot(cross(w, v), normal) <= square
            and 0 <= dot(cross(w, u), normal) <= square
        )
    direction = u if any(u) else v
    if any(cross(w, direction)):
        return False
    if not any(direction):
        return p == r
    low_p, high_p = projection((p, q), direction)
    low_r, high_r = projection((r, s), direction)
    return max(low_p, low_r) <= min(high_p, high_r)
