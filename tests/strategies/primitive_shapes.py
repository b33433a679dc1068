"""What the tests of the pair questions share: the oracles' shapes as the library's, and back."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from oracles import moving as oracles_moving
from oracles.distance import point_box_distance_squared, point_triangle_distance_squared
from oracles.exact import Box, Hull, box_hull, triangle_hull
from oracles.still import root

from obbcli.primitives import Obb, Triangle

if TYPE_CHECKING:
    from numpy.typing import NDArray

Shape = Any


def as_shape(shape: Shape) -> Obb | Triangle:
    """Return an oracle's box or triangle (3, 3) as the library takes it."""
    return Obb(*shape) if isinstance(shape, Box) else Triangle(shape)


def as_array(shapes: list[Shape]) -> Obb | Triangle:
    """Return shapes of one kind as an array of them."""
    if isinstance(shapes[0], Box):
        return Obb(*(np.array(column) for column in zip(*shapes, strict=True)))
    return Triangle(np.array(shapes))


def hull_of(shape: Shape) -> Hull:
    """Return the oracles' hull of a box or triangle."""
    return box_hull(shape) if isinstance(shape, Box) else triangle_hull(shape)


def contact_interval(moving: Any) -> tuple[Fraction, Fraction] | None:
    """Return the exact first and last time of contact of `strategies_moving.Moving`."""
    return oracles_moving.contact_interval(hull_of(moving.a), hull_of(moving.b), *moving[2:])


def distance(point: NDArray[np.float64], shape: Shape, velocity: Any, time: Fraction) -> float:
    """Return the distance of a point from a shape where it is at `time`.

    Everything is exact up to the result.
    """
    place = [
        Fraction(x) - Fraction(v) * time for x, v in zip(point.tolist(), velocity, strict=True)
    ]
    if isinstance(shape, Box):
        return float(root(point_box_distance_squared(place, shape)))
    return float(root(point_triangle_distance_squared(place, shape)))


def size_of(shape: Shape) -> float:
    """Return the largest coordinate or length of a shape."""
    parts = (shape.center, shape.half_extents) if isinstance(shape, Box) else (shape,)
    return max(float(np.abs(part).max()) for part in parts)
