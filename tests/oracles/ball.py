"""Largest balls: in convex bodies by their planes, and about points by all triangles.

Nothing here imports the package. The largest ball in an intersection of half-spaces is a linear
programme in four unknowns: its best corner is among the solutions of four equations, all of which
are tried.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def planes_of(vertices: Any, faces: Any) -> Floats:
    """Return the planes (n, d), n.x <= d with |n| = 1, of a convex body turned outwards: (P, 4)."""
    corners = np.asarray(vertices, dtype=np.float64)[np.asarray(faces)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    planes = np.column_stack((normals, (normals * corners[:, 0]).sum(axis=1)))
    kept: list[Any] = []
    for plane in planes:
        if all(np.abs(plane - other).max() > 1e-9 for other in kept):
            kept.append(plane)
    return np.array(kept)


def largest_ball(planes: Floats) -> float:
    """Return the radius of the largest ball within planes (P, 4); 0 where there is none."""
    fours = planes[list(combinations(range(len(planes)), 4))]
    matrices = fours.copy()
    matrices[:, :, 3] = 1
    regular = np.abs(np.linalg.det(matrices)) > 1e-9
    solutions = np.linalg.solve(matrices[regular], fours[regular][:, :, 3:])[:, :, 0]
    reach = solutions[:, :3] @ planes[:, :3].T + solutions[:, 3:]
    within = (reach <= planes[:, 3] + 1e-9).all(axis=1)
    return max(0.0, float(solutions[within, 3].max(initial=0.0)))


def distances_from(points: Any, vertices: Any, faces: Any) -> Floats:
    """Return how far points (N, 3) are from the nearest triangle, by trying all."""
    points = np.asarray(points, dtype=np.float64)
    best = np.full(len(points), np.inf)
    for a, b, c in np.asarray(vertices, dtype=np.float64)[np.asarray(faces)]:
        for start, end in ((a, b), (b, c), (c, a)):
            way = end - start
            t = np.clip((points - start) @ way / max(way @ way, 1e-300), 0, 1)
            best = np.minimum(best, np.linalg.norm(points - start - t[:, None] * way, axis=1))
        normal = np.cross(b - a, c - a)
        length = np.linalg.norm(normal)
        if length > 0:
            height = (points - a) @ (normal / length)
            foot = points - height[:, None] * (normal / length)
            sides = [
                np.cross(e, foot - s) @ normal for s, e in ((a, b - a), (b, c - b), (c, a - c))
            ]
            over = np.min(sides, axis=0) >= 0
            best = np.where(over, np.minimum(best, np.abs(height)), best)
    return best
