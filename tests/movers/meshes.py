"""Small closed meshes with dyadic coordinates for scenes of moving bodies."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

Mesh = tuple[Any, Any]

# Corner i of a box has its bits as coordinates, x first.
_BOX_FACES = (
    (0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
    (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5),
)  # fmt: skip


def box(low: Any, high: Any) -> Mesh:
    """Return the box between two corners: 8 vertices, 12 faces."""
    x, y, z = zip(low, high, strict=True)
    corners = [(x[i & 1], y[i >> 1 & 1], z[i >> 2 & 1]) for i in range(8)]
    return np.array(corners, dtype=np.float64), np.array(_BOX_FACES)


def cube(half: float = 1.0) -> Mesh:
    """Return the cube of side `2 half` about 0."""
    return box((-half,) * 3, (half,) * 3)


def tetrahedron() -> Mesh:
    """Return the regular tetrahedron on alternate corners of `cube(1)`."""
    corners = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
    faces = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)]
    return np.array(corners, dtype=np.float64), np.array(faces)


def octahedron() -> Mesh:
    """Return the octahedron with its corners at 1 on the axes; the first is (0, 0, -1)."""
    corners = [(0, 0, -1), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1)]
    ring = [(1, 2), (2, 3), (3, 4), (4, 1)]
    faces = [(0, j, i) for i, j in ring] + [(5, i, j) for i, j in ring]
    return np.array(corners, dtype=np.float64), np.array(faces)


def prism(outline: Any, low: float, high: float) -> Mesh:
    """Return a prism over a polygon (n, 2) that its first corner sees whole, from z low to high."""
    n = len(outline)
    corners = [(x, y, z) for z in (low, high) for x, y in outline]
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, n + j), (i, n + j, n + i)]
    for i in range(1, n - 1):
        faces += [(0, i + 1, i), (n, n + i, n + i + 1)]
    return np.array(corners, dtype=np.float64), np.array(faces)


def angle_bar() -> Mesh:
    """Return an L-shaped prism about 0: 12 vertices, 20 faces."""
    # Listed from the inner corner, which sees the whole.
    outline = [(0, 0), (0, 1), (-1, 1), (-1, -1), (1, -1), (1, 0)]
    return prism(outline, -0.5, 0.5)


def star() -> Mesh:
    """Return a cube of side 1 with a spike on each side: 14 vertices, 24 faces."""
    base, _ = cube(0.5)
    tips = [tuple(s * 1.5 * (k == axis) for k in range(3)) for axis in range(3) for s in (-1, 1)]
    faces = []
    for number, (axis, s) in enumerate(product(range(3), (-1, 1))):
        ring = [i for i in range(8) if base[i, axis] == s * 0.5]
        a, b, c, d = ring
        for i, j in ((a, b), (b, d), (d, c), (c, a)):
            arm = np.cross(base[i] - tips[number], base[j] - tips[number])
            faces.append(
                (8 + number, i, j) if arm @ base[[i, j]].sum(axis=0) > 0 else (8 + number, j, i)
            )
    return np.concatenate((base, np.array(tips))), np.array(faces)


def disc(corners: int, radius: float, low: float, high: float) -> Mesh:
    """Return the prism over a regular polygon about the z axis."""
    angle = np.arange(corners) * (2 * np.pi / corners)
    return prism(radius * np.stack((np.cos(angle), np.sin(angle)), axis=1), low, high)


def tube(inner: float, outer: float, low: float, high: float) -> Mesh:
    """Return a square bar along z with a square hole: 16 vertices, 32 faces."""
    ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    corners = [(r * x, r * y, z) for z, r in product((low, high), (inner, outer)) for x, y in ring]
    faces = []
    for i in range(4):
        j = (i + 1) % 4
        quads = [
            (i, 8 + i, 8 + j, j),  # the hole, seen from the axis
            (4 + i, 4 + j, 12 + j, 12 + i),
            (i, j, 4 + j, 4 + i),
            (8 + i, 12 + i, 12 + j, 8 + j),
        ]
        faces += [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    return np.array(corners, dtype=np.float64), np.array(faces)
