"""Exact truth for triangle meshes by brute force: pairs whose boxes overlap are decided exactly.

Vertices may be doubles or rationals; ids are rows of the faces.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from oracles.distance import hulls_distance_squared
from oracles.exact import TRIANGLE_EDGES, Hull, plain, vectors
from oracles.moving import contact_interval
from oracles.still import hulls_intersect

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

Pair = tuple[int, int]


def posed(vertices: Any, rotation: Any, translation: Any) -> NDArray[np.float64]:
    """Return `rotation p + translation` with the contract's rounding, component by component.

    Products and sums are separate array operations in this order, so that none is contracted.
    """
    points = np.asarray(vertices, dtype=np.float64)
    matrix = np.asarray(rotation, dtype=np.float64)
    total = points[:, 0:1] * matrix[:, 0]
    total = total + points[:, 1:2] * matrix[:, 1]
    total = total + points[:, 2:3] * matrix[:, 2]
    return np.asarray(total + np.asarray(translation, dtype=np.float64))


def mesh_pairs(vertices_a: Any, faces_a: Any, vertices_b: Any, faces_b: Any) -> list[Pair]:
    """Return every pair of triangles that share a point, sorted."""
    hulls_a, hulls_b = _hulls(vertices_a, faces_a, vertices_b, faces_b)
    bounds = _bounds(vertices_a, faces_a), _bounds(vertices_b, faces_b)
    candidates = _overlapping(*bounds)
    return [(i, j) for i, j in candidates if hulls_intersect(hulls_a[i], hulls_b[j])]


def mesh_contact_intervals(
    mesh_a: tuple[Any, Any],
    mesh_b: tuple[Any, Any],
    velocity_a: Any,
    velocity_b: Any,
    duration: float,
) -> dict[Pair, tuple[Fraction, Fraction]]:
    """Return the first and last time of contact of every pair of triangles that meets.

    Args:
        mesh_a: vertices and faces; translates with `velocity_a` over [0, duration].
        mesh_b: likewise with `velocity_b`.
        velocity_a: (3,).
        velocity_b: (3,).
        duration: the end of the closed interval.
    """
    hulls_a, hulls_b = _hulls(*mesh_a, *mesh_b)
    bounds_a = _swept(_bounds(*mesh_a), velocity_a, duration)
    bounds_b = _swept(_bounds(*mesh_b), velocity_b, duration)
    intervals = {}
    for i, j in _overlapping(bounds_a, bounds_b):
        interval = contact_interval(hulls_a[i], hulls_b[j], velocity_a, velocity_b, duration)
        if interval is not None:
            intervals[i, j] = interval
    return intervals


def mesh_first_contact(
    mesh_a: tuple[Any, Any],
    mesh_b: tuple[Any, Any],
    velocity_a: Any,
    velocity_b: Any,
    duration: float,
) -> tuple[Fraction, list[Pair]] | None:
    """Return the first time of contact of two translating meshes and the pairs that meet then."""
    intervals = mesh_contact_intervals(mesh_a, mesh_b, velocity_a, velocity_b, duration)
    if not intervals:
        return None
    first = min(interval[0] for interval in intervals.values())
    return first, sorted(pair for pair, interval in intervals.items() if interval[0] == first)


def mesh_distance_squared(
    vertices_a: Any, faces_a: Any, vertices_b: Any, faces_b: Any
) -> tuple[Fraction, list[Pair]]:
    """Return the squared distance of two surfaces and the pairs that attain it, sorted."""
    hulls_a, hulls_b = _hulls(vertices_a, faces_a, vertices_b, faces_b)
    best: Fraction | None = None
    nearest: list[Pair] = []
    for bound, i, j in _by_bound(_bounds(vertices_a, faces_a), _bounds(vertices_b, faces_b)):
        if best is not None and Fraction(bound) ** 2 > best:
            break
        square = hulls_distance_squared(hulls_a[i], hulls_b[j])
        if best is None or square < best:
            best, nearest = square, []
        if square == best:
            nearest.append((i, j))
    if best is None:
        raise ValueError("a mesh without triangles has no distance")
    return best, sorted(nearest)


def _hulls(
    vertices_a: Any, faces_a: Any, vertices_b: Any, faces_b: Any
) -> tuple[list[Hull], list[Hull]]:
    points, unit = vectors([*plain(vertices_a), *plain(vertices_b)])
    points_b = points[len(vertices_a) :]

    def hull(corners: tuple[Any, ...], face: Any) -> Hull:
        i, j, k = face
        return Hull((corners[i], corners[j], corners[k]), TRIANGLE_EDGES, unit)

    return [hull(points, face) for face in plain(faces_a)], [
        hull(points_b, face) for face in plain(faces_b)
    ]


def _bounds(vertices: Any, faces: Any) -> NDArray[np.float64]:
    """Return the boxes (2, F, 3) of the triangles; rounding rationals keeps their order."""
    points = np.array([[float(x) for x in row] for row in plain(vertices)], dtype=np.float64)
    corners = points[np.asarray(faces, dtype=np.int64)]
    return np.stack((corners.min(axis=1), corners.max(axis=1)))


def _swept(bounds: NDArray[np.float64], velocity: Any, duration: float) -> NDArray[np.float64]:
    """Return boxes of the whole path, widened by far more than the sums can round."""
    path = np.array([float(v) * float(duration) for v in plain(velocity)])
    # Infinite sums only keep a pair that is then decided exactly.
    with np.errstate(over="ignore"):
        low = np.minimum(bounds[0], bounds[0] + path)
        high = np.maximum(bounds[1], bounds[1] + path)
        margin = 1e-12 * (np.abs(bounds).max(axis=0) + np.abs(path)) + 1e-300
        return np.stack((low - margin, high + margin))


def _overlapping(bounds_a: NDArray[np.float64], bounds_b: NDArray[np.float64]) -> Iterator[Pair]:
    """Yield the pairs whose closed boxes overlap, in order."""
    (low_a, high_a), (low_b, high_b) = bounds_a, bounds_b
    for i in range(len(low_a)):
        hits = ((low_a[i] <= high_b) & (low_b <= high_a[i])).all(axis=1)
        for j in np.flatnonzero(hits):
            yield i, int(j)


def _by_bound(
    bounds_a: NDArray[np.float64], bounds_b: NDArray[np.float64]
) -> Iterator[tuple[float, int, int]]:
    """Yield pairs with a lower bound of their distance, least first."""
    (low_a, high_a), (low_b, high_b) = bounds_a[:, :, None], bounds_b[:, None]
    gaps = np.maximum(np.maximum(low_a - high_b, low_b - high_a), 0.0)
    # The rounding of differences is far below the share given away here.
    bound = gaps.max(axis=2) * (1 - 1e-12)
    for flat in np.argsort(bound, axis=None, kind="stable"):
        i, j = divmod(int(flat), bound.shape[1])
        yield float(bound[i, j]), i, j
