"""How far apart two surfaces are at most: explicit points of all pairs of features, in doubles.

Quick enough for thousands of poses. Every value is the distance of two points of the surfaces, so
that it bounds their distance from above, and is it where they do not cross, to a few roundings.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from oracles.rigid import rotation_matrix

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from oracles.screw import Mover


def places_at(body: Mover, time: float) -> NDArray[np.float64]:
    """Return the vertices of a moving body at a time, in doubles, (V, 3)."""
    turn = np.array(rotation_matrix(body.spin, time), dtype=np.float64)
    pivot, velocity = np.asarray(body.pivot), np.asarray(body.velocity)
    return np.asarray(pivot + time * velocity + (body.start - pivot) @ turn.T)


def gap_at(a: Mover, b: Mover, time: float) -> float:
    """Return the least distance of points of two moving surfaces at a time."""
    (p, f), (q, g) = ((places_at(body, time), np.asarray(body.faces)) for body in (a, b))
    return min(
        _least_to_faces(p, q[g]),
        _least_to_faces(q, p[f]),
        _least_of_segments(p[_edges(f)], q[_edges(g)]),
    )


def _edges(faces: Any) -> Any:
    sides = np.asarray(faces)[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    return np.unique(np.sort(sides, axis=1), axis=0)


def _least_to_faces(points: Any, faces: Any) -> float:
    """Return the least distance of points from faces above whose inside they are, or infinity."""
    origin, one, two = faces[:, 0], faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]
    arm = points[:, None] - origin
    square_one, product, square_two = (_dot(x, y) for x, y in ((one, one), (one, two), (two, two)))
    along_one, along_two = _dot(arm, one), _dot(arm, two)
    area = square_one * square_two - product * product
    flat = area <= 1e-14 * square_one * square_two  # its edges tell
    area = np.where(flat, 1.0, area)
    v = (square_two * along_one - product * along_two) / area
    w = (square_one * along_two - product * along_one) / area
    off = arm - v[..., None] * one - w[..., None] * two
    is_inside = (v >= 0) & (w >= 0) & (v + w <= 1) & ~flat
    return float(np.sqrt(np.where(is_inside, _dot(off, off), np.inf).min()))


def _least_of_segments(p: Any, q: Any) -> float:
    """Return the least distance of points of segments; any parameters give points of them."""
    start, way = p[:, None, 0], p[:, None, 1] - p[:, None, 0]
    other, course = q[None, :, 0], q[None, :, 1] - q[None, :, 0]
    between = start - other
    a, e = np.maximum(_dot(way, way), 1e-300), np.maximum(_dot(course, course), 1e-300)
    b, c, f = _dot(way, course), _dot(way, between), _dot(course, between)
    area = a * e - b * b
    is_parallel = area <= 1e-14 * a * e
    s = np.where(is_parallel, 0.0, (b * f - c * e) / np.where(is_parallel, 1.0, area))
    t = np.clip((b * np.clip(s, 0.0, 1.0) + f) / e, 0.0, 1.0)
    s = np.clip((b * t - c) / a, 0.0, 1.0)
    t = np.clip((b * s + f) / e, 0.0, 1.0)
    off = between + s[..., None] * way - t[..., None] * course
    return float(np.sqrt(_dot(off, off).min()))


def _dot(x: Any, y: Any) -> Any:
    return (x * y).sum(axis=-1)
