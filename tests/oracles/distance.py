"""Exact squared distances of points, triangles and boxes: what a reported contact point is held to.

Squares, because those are rational; `oracles.root` gives the length to 100 bits.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

from oracles.exact import (
    Hull,
    Vector,
    box_hull,
    cross,
    dot,
    same_unit,
    subtract,
    triangle_hull,
    vectors,
)
from oracles.still import hulls_intersect

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

Segment = tuple[Vector, Vector]
Corners = tuple[Vector, Vector, Vector]


def point_triangle_distance_squared(point: Any, triangle: Any) -> Fraction:
    """Return the squared distance from a point (3,) to a closed triangle (3, 3)."""
    p, q = same_unit(_point_hull(point), triangle_hull(triangle))
    return _from_point(p.points[0], _faces(q)) * p.unit**2


def point_box_distance_squared(point: Any, box: Any) -> Fraction:
    """Return the squared distance from a point (3,) to a closed, solid box."""
    p, q = same_unit(_point_hull(point), box_hull(box))
    return Fraction(0) if hulls_intersect(p, q) else _from_point(p.points[0], _faces(q)) * p.unit**2


def point_in_triangle(point: Any, triangle: Any) -> bool:
    """Return whether a point lies in a closed triangle."""
    return point_triangle_distance_squared(point, triangle) == 0


def point_in_box(point: Any, box: Any) -> bool:
    """Return whether a point lies in a closed box."""
    return hulls_intersect(_point_hull(point), box_hull(box))


def triangle_distance_squared(a: Any, b: Any) -> Fraction:
    """Return the squared distance of two closed triangles."""
    return hulls_distance_squared(triangle_hull(a), triangle_hull(b))


def triangle_box_distance_squared(triangle: Any, box: Any) -> Fraction:
    """Return the squared distance of a closed triangle and a closed, solid box."""
    return hulls_distance_squared(triangle_hull(triangle), box_hull(box))


def box_distance_squared(box_a: Any, box_b: Any) -> Fraction:
    """Return the squared distance of two closed, solid boxes."""
    return hulls_distance_squared(box_hull(box_a), box_hull(box_b))


def hulls_distance_squared(p: Hull, q: Hull) -> Fraction:
    """Return the squared distance of two hulls: of a corner and a face, or of two edges."""
    p, q = same_unit(p, q)
    if hulls_intersect(p, q):
        return Fraction(0)
    square = min(
        *(_from_point(point, _faces(q)) for point in p.points),
        *(_from_point(point, _faces(p)) for point in q.points),
        *(_between_lines(e, f) for e, f in product(_rims(p), _rims(q))),
    )
    return square * p.unit**2


def _point_hull(point: Any) -> Hull:
    points, unit = vectors([point])
    return Hull(points, (), unit)


def _faces(hull: Hull) -> Iterator[Corners]:
    """Yield triangles that cover the surface."""
    points = hull.points
    if len(points) == 3:
        yield points[0], points[1], points[2]
        return
    for normal, i, j in ((4, 2, 1), (2, 4, 1), (1, 4, 2)):
        for side in (0, normal):
            yield points[side], points[side + i], points[side + j]
            yield points[side + i + j], points[side + i], points[side + j]


def _rims(hull: Hull) -> Iterator[Segment]:
    points = hull.points
    if len(points) == 3:
        yield from ((points[0], points[1]), (points[1], points[2]), (points[2], points[0]))
        return
    for along, bit in product(range(8), (4, 2, 1)):
        if not along & bit:
            yield points[along], points[along + bit]


def _from_point(point: Vector, faces: Iterable[Corners]) -> Fraction:
    return min(_from_point_to_triangle(point, corners) for corners in faces)


def _from_point_to_triangle(point: Vector, corners: Corners) -> Fraction:
    a, b, c = corners
    normal = cross(subtract(b, a), subtract(c, a))
    sides = ((a, b), (b, c), (c, a))
    if any(normal) and all(
        dot(normal, cross(subtract(end, start), subtract(point, start))) >= 0
        for start, end in sides
    ):
        return Fraction(dot(normal, subtract(point, a)) ** 2, dot(normal, normal))
    return min(_from_point_to_segment(point, *side) for side in sides)


def _from_point_to_segment(point: Vector, start: Vector, end: Vector) -> Fraction:
    direction, arm = subtract(end, start), subtract(point, start)
    square, along = dot(direction, direction), dot(arm, direction)
    if along <= 0:
        return Fraction(dot(arm, arm))
    if along >= square:
        arm = subtract(point, end)
        return Fraction(dot(arm, arm))
    return Fraction(dot(arm, arm) * square - along * along, square)


def _between_lines(e: Segment, f: Segment) -> Fraction:
    """Return the squared distance of two segments."""
    u, v, w = subtract(e[1], e[0]), subtract(f[1], f[0]), subtract(f[0], e[0])
    normal = cross(u, v)
    square = dot(normal, normal)
    if (
        square
        and 0 <= dot(cross(w, v), normal) <= square
        and 0 <= dot(cross(w, u), normal) <= square
    ):
        return Fraction(dot(w, normal) ** 2, square)
    ends = [_from_point_to_segment(point, *f) for point in e]
    return min(*ends, *(_from_point_to_segment(point, *e) for point in f))
