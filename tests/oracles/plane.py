"""Do convex figures in the plane meet? Points, segments and triangles in exact arithmetic."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

Point = tuple[Fraction, Fraction]


def figures_gap(p: Sequence[Any], q: Sequence[Any]) -> Fraction:
    """Return the widest gap between the hulls of two to three points each, or of one, on any axis.

    Below or at 0 exactly where the closed hulls meet. Axes are not normalised: the sign counts.
    """
    one, two = _exact(p), _exact(q)
    return max(
        max(min(b) - max(a), min(a) - max(b))
        for x, y in (*_axes(one), *_axes(two), (1, 0), (0, 1))
        for a, b in [tuple([x * u + y * v for u, v in points] for points in (one, two))]
    )


def figures_meet(p: Sequence[Any], q: Sequence[Any]) -> bool:
    """Return whether the closed hulls of two sets of points meet."""
    return figures_gap(p, q) <= 0


def _exact(points: Sequence[Any]) -> list[Point]:
    return [(Fraction(float(x)), Fraction(float(y))) for x, y in points]


def _axes(points: Sequence[Point]) -> Iterator[Point]:
    """Yield the normals of the edges and, where they are all the figure has, their directions."""
    for i, (x, y) in enumerate(points):
        u, v = points[i - 1]
        if (x, y) != (u, v):
            yield y - v, u - x
            if len(points) < 3:
                yield x - u, y - v
