"""How much space closed surfaces have in common, exactly, by tetrahedra from a point.

A closed surface winds about a place as often as the tetrahedra from one apex to its triangles hold
it, with signs. So the integral of the product of two winding numbers is a sum over pairs of
tetrahedra, which are cut by each other's planes. Coordinates are rational numbers, and nothing
rounds. Shares nothing with the kernels, which sum over columns along an axis.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

Point = tuple[Fraction, Fraction, Fraction]
Tetrahedron = tuple[Point, Point, Point, Point]


def shared_volume(surface_a: Any, surface_b: Any) -> Fraction:
    """Return the integral of the product of the winding numbers of two closed surfaces."""
    parts_b = _tetrahedra(surface_b)
    return sum(
        (
            sign_a * sign_b * _volume_in_common(part_a, part_b)
            for part_a, sign_a in _tetrahedra(surface_a)
            for part_b, sign_b in parts_b
        ),
        Fraction(0),
    )


def signed_volume(surface: Any) -> Fraction:
    """Return the integral of the winding number of a closed surface."""
    return sum(
        (sign * _volume(part) for part, sign in _tetrahedra(surface)),
        Fraction(0),
    )


def _tetrahedra(surface: Any) -> list[tuple[Tetrahedron, int]]:
    """Return the tetrahedra from an apex that turn to the left, and how they turned before."""
    vertices, faces = surface
    points = [tuple(Fraction(float(x)) for x in row) for row in vertices]
    apex: Any = points[0]
    found = []
    for i, j, k in [[int(x) for x in row] for row in faces]:
        turn = _determinant(apex, points[i], points[j], points[k])
        if turn > 0:
            found.append(((apex, points[i], points[j], points[k]), 1))
        elif turn < 0:
            found.append(((apex, points[i], points[k], points[j]), -1))
    return found  # type: ignore[return-value]  # rows of a mesh have three coordinates


def _determinant(a: Any, b: Any, c: Any, d: Any) -> Fraction:
    """Return six times the volume of a tetrahedron, positive where b, c, d turn left seen from a.

    That is, from the side on which the outward normal of b, c, d does not point.
    """
    p, q, r = ([x - y for x, y in zip(corner, a, strict=True)] for corner in (b, c, d))
    return (
        p[0] * (q[1] * r[2] - q[2] * r[1])
        - p[1] * (q[0] * r[2] - q[2] * r[0])
        + p[2] * (q[0] * r[1] - q[1] * r[0])
    )


def _volume(part: Tetrahedron) -> Fraction:
    return abs(_determinant(*part)) / 6


def _volume_in_common(part: Tetrahedron, other: Tetrahedron) -> Fraction:
    """Return the volume of what two tetrahedra have in common."""
    for k in range(3):
        mine, theirs = [p[k] for p in part], [p[k] for p in other]
        if max(mine) <= min(theirs) or max(theirs) <= min(mine):
            return Fraction(0)
    pieces = [part]
    for k in range(4):
        face = [other[i] for i in range(4) if i != k]
        inside = _determinant(*face, other[k])
        pieces = [
            piece
            for whole in pieces
            for piece in _cut(whole, [inside * _determinant(*face, p) for p in whole])
        ]
    return sum(map(_volume, pieces), Fraction(0))


def _cut(part: Tetrahedron, heights: list[Fraction]) -> list[Tetrahedron]:
    """Return what of a tetrahedron lies above a plane, as tetrahedra."""
    above = [k for k in range(4) if heights[k] > 0]
    below = [k for k in range(4) if heights[k] <= 0]

    def crossing(i: int, k: int) -> Any:
        share = heights[i] / (heights[i] - heights[k])
        return tuple(x + share * (y - x) for x, y in zip(part[i], part[k], strict=True))

    if not below:
        return [part]
    if len(above) == 1:
        (i,) = above
        return [(part[i], *(crossing(i, k) for k in below))]  # type: ignore[list-item]  # four
    if len(above) == 2:
        (i, j), (k, n) = above, below
        first = (part[i], crossing(i, k), crossing(i, n))
        return _prism(first, (part[j], crossing(j, k), crossing(j, n)))
    if len(above) == 3:
        (n,) = below
        corners = tuple(part[i] for i in above)
        return _prism(corners, tuple(crossing(i, n) for i in above))
    return []


def _prism(first: Any, second: Any) -> list[Tetrahedron]:
    """Return a wedge between two triangles as tetrahedra."""
    a, b, c = first
    d, e, f = second
    return [(a, b, c, d), (b, c, d, e), (c, d, e, f)]
