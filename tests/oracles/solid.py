"""How often a closed surface winds about a point, by exact rays and by solid angles.

Nothing here imports the package, and the rays go where no edge is instead of being moved aside.
"""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, Any

import mpmath
import numpy as np
from oracles.exact import cross, dot, integers, plain, subtract

if TYPE_CHECKING:
    from collections.abc import Iterator

    from oracles.exact import Vector

Corners = tuple["Vector", "Vector", "Vector"]


def winding_number(point: Any, vertices: Any, faces: Any) -> int | None:
    """Return how often a closed surface winds about a point, exactly; None for a point on it."""
    triangles = list(_seen_from(point, vertices, faces))
    if any(_holds_origin(corners) for corners in triangles):
        return None
    for k in count(1):
        # Directions all over, none of them special.
        ray = (1_000_003 * k % 2001 - 1000, 777_767 * k % 1999 - 999, 424_243 * k % 1997 - 998)
        crossings = [_crossing(ray, corners) for corners in triangles]
        if None not in crossings:
            return sum(int(c) for c in crossings if c is not None)
    raise AssertionError


def _seen_from(point: Any, vertices: Any, faces: Any) -> Iterator[Corners]:
    """Yield the triangles relative to a point, in integers of a common unit."""
    used = plain(vertices)
    flat, _ = integers(x for row in [plain(point), *used] for x in row)
    rows = list(zip(flat[0::3], flat[1::3], flat[2::3], strict=True))
    places = [subtract(row, rows[0]) for row in rows[1:]]
    for i, j, k in plain(faces):
        yield places[i], places[j], places[k]


def _holds_origin(corners: Corners) -> bool:
    """Return whether the origin lies in the triangle, edges and corners included."""
    a, b, c = corners
    normal = cross(subtract(b, a), subtract(c, a))
    if dot(normal, a) != 0:
        return False
    if normal == (0, 0, 0):
        return any(cross(p, q) == (0, 0, 0) and dot(p, q) <= 0 for p, q in ((a, b), (b, c), (c, a)))
    return all(dot(normal, cross(p, q)) >= 0 for p, q in ((a, b), (b, c), (c, a)))


def _crossing(ray: Vector, corners: Corners) -> int | None:
    """Return 1 where the ray from the origin leaves through a triangle, -1 where it enters.

    None where it meets an edge.
    """
    a, b, c = corners
    sides = [dot(ray, cross(p, q)) for p, q in ((a, b), (b, c), (c, a))]
    if min(sides) < 0 < max(sides):
        return 0
    normal = cross(subtract(b, a), subtract(c, a))
    if normal == (0, 0, 0):
        return 0
    along = dot(normal, ray)
    if along != 0 and dot(normal, a) * along < 0:
        return 0  # behind
    if 0 in sides:
        return None
    return 1 if along > 0 else -1


def winding_by_angles(point: Any, vertices: Any, faces: Any) -> float:
    """Return the solid angle under which a surface is seen, over that of a sphere.

    Van Oosterom and Strackee 1983, in 40 digits.
    """
    with mpmath.workdps(40):
        total = mpmath.mpf(0)
        p = [mpmath.mpf(x) for x in plain(point)]
        places = [
            [mpmath.mpf(x) - y for x, y in zip(row, p, strict=True)] for row in plain(vertices)
        ]
        for face in np.asarray(faces).tolist():
            a, b, c = (places[i] for i in face)
            la, lb, lc = (mpmath.sqrt(mpmath.fdot(v, v)) for v in (a, b, c))
            volume = mpmath.fdot(a, cross(b, c))
            below = (
                la * lb * lc
                + mpmath.fdot(a, b) * lc
                + mpmath.fdot(b, c) * la
                + mpmath.fdot(c, a) * lb
            )
            total += 2 * mpmath.atan2(volume, below)
        return float(total / (4 * mpmath.pi))
