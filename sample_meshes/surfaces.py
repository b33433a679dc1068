"""Builds closed surfaces out of rings of points, on a fixed decimal grid.

The shapes are made of these; the writers take what comes out of `weld`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

Points: TypeAlias = NDArray[np.float64]
Face: TypeAlias = tuple[int, ...]

# Math libraries differ in the last digit of a sine; on this grid (mm) their answers are the same.
GRID_DECIMALS = 6


@dataclass(frozen=True)
class Surface:
    """Polygons over shared points.

    Attributes:
        points: float64 (V, 3), mm.
        faces: corner indices of each polygon, counter-clockwise seen from outside; a polygon can be
            cut into triangles as a fan from its first corner.
    """

    points: Points
    faces: list[Face]

    def reversed(self) -> Surface:
        """Return the same surface with its inside out."""
        return Surface(self.points, [face[::-1] for face in self.faces])

    def moved(self, x: float, y: float, z: float) -> Surface:
        """Return the surface shifted by (x, y, z)."""
        return Surface(self.points + np.array([x, y, z]), self.faces)

    def turned_over(self) -> Surface:
        """Return the surface turned by half a turn about the z axis."""
        return Surface(self.points * np.array([-1.0, -1.0, 1.0]), self.faces)


def polar(radii: Points | float, angles: Points, z: Points | float) -> Points:
    """Return points (N, 3) at polar radii and angles (radians) and heights z."""
    x, y = radii * np.cos(angles), radii * np.sin(angles)
    return np.stack([x, y, np.broadcast_to(np.asarray(z, dtype=np.float64), x.shape)], axis=1)


def turn_angles(count: int) -> Points:
    """Return `count` equally spaced angles from 0 up to, but not including, a full turn."""
    return 2.0 * np.pi * np.arange(count) / count


def circle(radius: float, z: float, count: int) -> Points:
    """Return a counter-clockwise ring of `count` points about the z axis."""
    return polar(radius, turn_angles(count), z)


def loft(rings: Sequence[Points], *, closed: bool = False) -> Surface:
    """Return the surface through rings of points, each joined to the next one.

    Rings run counter-clockwise about the way that leads from ring to ring along the outside. Of two
    neighbours the longer one has a multiple of the shorter one's points.
    """
    starts = np.cumsum([0, *(len(ring) for ring in rings)]).tolist()
    faces: list[Face] = []
    for lower in range(len(rings) if closed else len(rings) - 1):
        upper = (lower + 1) % len(rings)
        for face in _band(len(rings[lower]), len(rings[upper])):
            faces.append(tuple(starts[(lower, upper)[side]] + index for side, index in face))
    return Surface(np.concatenate(rings), faces)


def _band(lower: int, upper: int) -> list[list[tuple[int, int]]]:
    """Faces between rings of `lower` and `upper` points, corners as (ring 0 or 1, index)."""
    if lower == upper:
        pairs = [(i, (i + 1) % lower) for i in range(lower)]
        return [[(0, i), (0, j), (1, j), (1, i)] for i, j in pairs]
    if upper > lower:
        flipped = _band(upper, lower)
        return [[(1 - side, index) for side, index in reversed(face)] for face in flipped]
    ratio = lower // upper
    faces = []
    for coarse in range(upper):
        after = (coarse + 1) % upper
        fine = [(coarse * ratio + step) % lower for step in range(ratio + 1)]
        middle = (ratio + 1) // 2
        for step in range(ratio):
            apex = coarse if step < middle else after
            faces.append([(0, fine[step]), (0, fine[step + 1]), (1, apex)])
        faces.append([(0, fine[middle]), (1, after), (1, coarse)])
    return faces


def polygon(ring: Points) -> Surface:
    """Return one flat convex polygon."""
    return Surface(ring, [tuple(range(len(ring)))])


def cap(ring: Points) -> Surface:
    """Return triangles from a ring to its mean."""
    count = len(ring)
    faces: list[Face] = [(i, (i + 1) % count, count) for i in range(count)]
    return Surface(np.concatenate([ring, ring.mean(axis=0, keepdims=True)]), faces)


def capped_loft(rings: Sequence[Points], *, flat: bool = False) -> Surface:
    """Return a loft closed at both ends, by single polygons (`flat`) or by triangles."""
    close = polygon if flat else cap
    return weld([loft(rings), close(rings[0]).reversed(), close(rings[-1])])


def weld(parts: Iterable[Surface]) -> Surface:
    """Return one surface on the grid, in which equal points are one point."""
    index_of: dict[tuple[float, float, float], int] = {}
    faces: list[Face] = []
    for part in parts:
        # Adding zero turns -0.0 into 0.0: two spellings of one coordinate.
        rows = (np.round(part.points, GRID_DECIMALS) + 0.0).tolist()
        indices = [index_of.setdefault((x, y, z), len(index_of)) for x, y, z in rows]
        faces.extend(tuple(indices[corner] for corner in face) for face in part.faces)
    return Surface(np.array(list(index_of)), faces)


def triangulated(surface: Surface) -> NDArray[np.int64]:
    """Return the faces cut into triangles, int64 (F, 3), each polygon as a fan."""
    fans = [
        (face[0], face[i], face[i + 1]) for face in surface.faces for i in range(1, len(face) - 1)
    ]
    return np.array(fans, dtype=np.int64)
