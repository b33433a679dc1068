"""Overlap found by dense sampling: edges that pierce faces at given times.

What this finds is confirmed exactly, so a hit is a proof of contact; a miss is none of separation.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from oracles.screw import Mover, scaled, triangles_touch
from oracles.screw_bounds import DOUBLE, cross, dot, places

if TYPE_CHECKING:
    from oracles.screw_bounds import Couple


def sampled_overlap(a: Mover, b: Mover, duration: float, times: Any) -> Fraction | None:
    """Return the first of the times (in [0, duration]) at which triangles are proven to meet."""
    couple = scaled(a, b, duration, DOUBLE)
    moments = np.asarray(sorted(times), dtype=np.float64)
    edges_a, edges_b = (_edges(faces) for faces in (a.faces, b.faces))
    found = [
        *_pierced(couple, moments / duration, edges_a, np.asarray(b.faces), swap=False),
        *_pierced(couple, moments / duration, edges_b, np.asarray(a.faces), swap=True),
    ]
    for index, edge, face, swap in sorted(found):
        time = Fraction(float(moments[index]))
        if swap:
            owners = (face,), _with(b.faces, edges_b[edge])
        else:
            owners = _with(a.faces, edges_a[edge]), (face,)
        if triangles_touch(a, b, owners, time):
            return time
    return None


def _edges(faces: Any) -> Any:
    sides = np.asarray(faces)[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    return np.unique(np.sort(sides, axis=1), axis=0)


def _pierced(
    couple: Couple, moments: Any, edges: Any, faces: Any, *, swap: bool
) -> list[tuple[int, int, int, bool]]:
    """Return (time, edge, face) numbers that look pierced; rounding may err either way."""
    body, other = (couple.b, couple.a) if swap else (couple.a, couple.b)
    pairs = np.array(list(product(range(len(edges)), range(len(faces)))))
    found = []
    for index, moment in enumerate(moments):
        time = np.full(len(pairs), moment)
        segment, _ = places(body, edges[pairs[:, 0]], time, DOUBLE)
        triangle, _ = places(other, faces[pairs[:, 1]], time, DOUBLE)
        for number in np.flatnonzero(_pierces(segment, triangle)):
            found.append((index, *pairs[number].tolist(), swap))
    return found


def _pierces(segment: Any, triangle: Any) -> Any:
    normal = cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0])
    heights = [dot(normal, segment[:, i] - triangle[:, 0]) for i in range(2)]
    along = segment[:, 1] - segment[:, 0]
    sides = [
        dot(along, cross(triangle[:, i - 1] - segment[:, 0], triangle[:, i] - segment[:, 0]))
        for i in range(3)
    ]
    inside = (np.minimum.reduce(sides) > 0) | (np.maximum.reduce(sides) < 0)
    return (heights[0] * heights[1] < 0) & inside


def _with(faces: Any, edge: Any) -> tuple[int, ...]:
    """Return the numbers of the faces that an edge belongs to."""
    return tuple(i for i, face in enumerate(np.asarray(faces)) if set(edge) <= set(face))
