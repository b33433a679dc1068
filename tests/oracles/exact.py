"""Exact rational shapes: convex hulls on an integer grid, and the axes that decide about them.

Doubles are rationals: coordinates over one common unit are Python integers, and nothing rounds.
Shares nothing with the kernels.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import combinations, product
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

Vector = tuple[int, int, int]

UNIT_AXES: tuple[Vector, ...] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))
# Corners are numbered in binary, so that corner 0 meets one edge of each direction.
BOX_EDGES = ((0, 4), (0, 2), (0, 1))


class Box(NamedTuple):
    """A box as the literal set `center + sum x_i axes[i]`, `|x_i| <= half_extents[i]`."""

    center: Any
    axes: Any
    half_extents: Any


class Hull(NamedTuple):
    """The convex hull of `points * unit`; `edges` names a pair of points for each direction."""

    points: tuple[Vector, ...]
    edges: tuple[tuple[int, int], ...]
    unit: Fraction


def subtract(p: Vector, q: Vector) -> Vector:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def cross(p: Vector, q: Vector) -> Vector:
    return (
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    )


def dot(p: Vector, q: Vector) -> int:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def plain(numbers: Any) -> Any:
    """Return nested Python lists: NumPy's scalars lack exact ratios."""
    return numbers.tolist() if hasattr(numbers, "tolist") else numbers


def integers(numbers: Iterable[Any]) -> tuple[list[int], Fraction]:
    """Return integers and the positive unit with `number == integer * unit`, exactly."""
    ratios = [number.as_integer_ratio() for number in numbers]
    denominator = math.lcm(*(ratio[1] for ratio in ratios))
    scaled = [top * (denominator // bottom) for top, bottom in ratios]
    divisor = math.gcd(*scaled) or 1
    return [number // divisor for number in scaled], Fraction(divisor, denominator)


def vectors(rows: Any) -> tuple[tuple[Vector, ...], Fraction]:
    """Return the rows of an (N, 3) array as integer vectors, and their unit."""
    flat, unit = integers(number for row in plain(rows) for number in plain(row))
    return tuple(zip(flat[0::3], flat[1::3], flat[2::3], strict=True)), unit


def common_unit(p: Fraction, q: Fraction) -> tuple[int, int, Fraction]:
    """Return factors `i`, `j` and a unit with `p == i * unit` and `q == j * unit`."""
    bottom = math.lcm(p.denominator, q.denominator)
    i = p.numerator * (bottom // p.denominator)
    j = q.numerator * (bottom // q.denominator)
    divisor = math.gcd(i, j)
    return i // divisor, j // divisor, Fraction(divisor, bottom)


def relative_velocity(velocity_p: Any, velocity_q: Any) -> tuple[Vector, Fraction]:
    """Return `velocity_q - velocity_p` as an integer vector, and its unit."""
    pairs = zip(plain(velocity_p), plain(velocity_q), strict=True)
    (x, y, z), unit = integers(Fraction(w) - Fraction(v) for v, w in pairs)
    return (x, y, z), unit


def triangle_hull(triangle: Any) -> Hull:
    """Return a triangle (3, 3) as a hull; collinear and coincident vertices are no exception."""
    points, unit = vectors(triangle)
    return Hull(points, TRIANGLE_EDGES, unit)


def box_hull(box: Any) -> Hull:
    """Return a box `(center, axes, half_extents)` as the hull of its literal corners."""
    center, axes, half_extents = box
    middle, center_unit = integers(plain(center))
    rows, axes_unit = vectors(axes)
    lengths, length_unit = integers(plain(half_extents))
    i, j, unit = common_unit(center_unit, axes_unit * length_unit)
    arms = [tuple(j * n * x for x in row) for n, row in zip(lengths, rows, strict=True)]
    corners = tuple(
        (
            i * middle[0] + s * arms[0][0] + t * arms[1][0] + u * arms[2][0],
            i * middle[1] + s * arms[0][1] + t * arms[1][1] + u * arms[2][1],
            i * middle[2] + s * arms[0][2] + t * arms[1][2] + u * arms[2][2],
        )
        for s, t, u in product((-1, 1), repeat=3)
    )
    return Hull(corners, BOX_EDGES, unit)


def same_unit(p: Hull, q: Hull) -> tuple[Hull, Hull]:
    """Return the hulls on one grid."""
    i, j, unit = common_unit(p.unit, q.unit)
    return _on_grid(p, i, unit), _on_grid(q, j, unit)


def _on_grid(hull: Hull, factor: int, unit: Fraction) -> Hull:
    if factor == 1:
        return hull._replace(unit=unit)
    points = tuple((factor * x, factor * y, factor * z) for x, y, z in hull.points)
    return Hull(points, hull.edges, unit)


def edge_vectors(hull: Hull) -> Iterator[Vector]:
    for start, end in hull.edges:
        yield subtract(hull.points[end], hull.points[start])


def complete_axes(edges: Iterable[Vector]) -> Iterator[Vector]:
    """Yield axes that decide: two hulls with these edge directions meet iff no axis parts them.

    Their Minkowski difference has these edge directions only, so the normals of its facets are
    crossed pairs; where it is flat, a segment or a point, the axes chosen by rank fix its span.
    """
    edges = [edge for edge in edges if any(edge)]
    if not edges:
        yield from UNIT_AXES
        return
    normals = (n for e, f in combinations(edges, 2) if any(n := cross(e, f)))
    normal = next(normals, None)
    if normal is None:
        yield edges[0]
        yield from (cross(edges[0], axis) for axis in UNIT_AXES)
        return
    yield normal
    if any(dot(normal, edge) for edge in edges):
        yield from normals
    else:
        yield from (cross(normal, edge) for edge in edges)


def projection(points: Sequence[Vector], axis: Vector) -> tuple[int, int]:
    """Return the least and the greatest `axis . point`."""
    x, y, z = axis
    values = [x * p[0] + y * p[1] + z * p[2] for p in points]
    return min(values), max(values)
