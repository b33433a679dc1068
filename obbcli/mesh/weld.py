"""Welding: vertices nearer to each other than a distance become one, so that cracks close.

A cluster is a set of positions that are joined by steps of at most the distance. Each becomes its
first position in file order. A cluster that is wider than the distance is refused: which of its
vertices belong together is not told by the distance then.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.errors import MeshError
from obbcli.mesh.topology import position_ids

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

#: Pairs of vertices that may share a cell: beyond, a distance is far larger than the triangles.
_MOST_PAIRS = 50_000_000
_REMEDY = "use a smaller distance, or mend the mesh"


class Welded(NamedTuple):
    """Vertices after welding.

    Attributes:
        vertices: float64 (V, 3); rows stay where they are.
        moved: how many of them have another position than before.
        farthest: how far one was moved at most.
    """

    vertices: NDArray[np.float64]
    moved: int
    farthest: float


def checked_distance(distance: object) -> float:
    """Return a distance within which vertices can be welded.

    Raises:
        MeshError: it is no finite number above 0.
    """
    is_number = isinstance(distance, (int, float)) and not isinstance(distance, bool)
    if not is_number or not 0.0 < distance < np.inf:  # type: ignore[operator]
        raise MeshError("weld", f"is {distance!r}", "use a finite number above 0")
    return float(distance)  # type: ignore[arg-type]


def welded(vertices: NDArray[np.float64], triangles: NDArray[np.int32], distance: float) -> Welded:
    """Return the vertices, those within `distance` of each other at the first one's position.

    Distances are rounded to double. Vertices that no triangle uses are no part of the surface.

    Args:
        vertices: float64 (V, 3).
        triangles: int32 (F, 3).
        distance: finite and above 0.

    Raises:
        MeshError: the distance is none, or a cluster is wider than it.
    """
    limit = checked_distance(distance)
    used = np.flatnonzero(np.bincount(triangles.reshape(-1), minlength=len(vertices)))
    _, firsts, inverse = np.unique(
        position_ids(vertices)[used], return_index=True, return_inverse=True
    )
    # Positions are numbered in the order in which the file first uses their vertices' rows.
    order = np.argsort(firsts)
    rows = used[firsts[order]]
    points = vertices[rows]
    pairs = pairs_within(points, limit)
    labels = np.arange(len(points))
    np.minimum.at(labels, pairs[:, 1], pairs[:, 0])
    _refuse_wide(points, rows, pairs, labels, limit)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    number = rank[inverse.reshape(-1)]
    moves = labels[number] != number
    target, source = points[labels[number[moves]]], vertices[used[moves]]
    result = vertices.copy()
    result[used[moves]] = target
    far = float(lengths(target - source).max()) if moves.any() else 0.0
    return Welded(result, int(np.count_nonzero(moves)), far)


def note_of(done: Welded, distance: float) -> str:
    """Return the sentence that tells what welding did."""
    if done.moved == 0:
        return f"welded within {float(distance)!r}: no vertex moved"
    vertices = "1 vertex" if done.moved == 1 else f"{done.moved} vertices"
    return f"welded within {float(distance)!r}: {vertices} moved by at most {done.farthest!r}"


def lengths(differences: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the lengths of vectors, (N,), whatever their size."""
    with np.errstate(over="ignore", under="ignore"):
        return np.hypot(np.hypot(differences[:, 0], differences[:, 1]), differences[:, 2])


def pairs_within(points: NDArray[np.float64], limit: float) -> NDArray[np.int64]:
    """Return all pairs of different rows that are at most `limit` apart, sorted, (N, 2).

    Space is cut into cells. A point is in the cell of its own coordinates, and, an axis at a time,
    in that of its coordinate plus `limit`: rounding keeps order, so of two points within `limit`
    the lower one's two cells along an axis hold the upper one's cell. They share a cell therefore.

    Raises:
        MeshError: so many points share cells that their pairs cannot be looked at.
    """
    reach = limit * (1 + 1e-12)
    largest = float(np.abs(points).max())
    # Cells are numbered without rounding below 2^48.
    side = max(8 * reach, largest * 2.0**-48)
    with np.errstate(over="ignore"):
        ends = np.minimum(points + reach, np.finfo(float).max)
    low, high = np.floor(points / side), np.floor(ends / side)
    cells, members = [], []
    for corner in range(8):
        is_high = [bool(corner >> axis & 1) for axis in range(3)]
        differs = np.ones(len(points), dtype=bool)
        for axis in range(3):
            if is_high[axis]:
                differs &= low[:, axis] != high[:, axis]
        members.append(np.flatnonzero(differs))
        cells.append(np.where(is_high, high, low)[differs])
    found = [_near(points, each, limit) for each in _sharing(cells, members)]
    pairs = np.concatenate([np.empty((0, 2), dtype=np.int64), *found])
    # Two points may share several cells. A pair of numbers fits one word.
    # (Sorted and compared: np.unique hashes, which takes several times as long.)
    keys = np.sort(pairs[:, 0] * len(points) + pairs[:, 1])
    keys = keys[np.diff(keys, prepend=-1) != 0]
    return np.stack(np.divmod(keys, len(points)), axis=1)


def _sharing(
    cells: list[NDArray[np.float64]], members: list[NDArray[np.int64]]
) -> Iterator[NDArray[np.int64]]:
    """Yield pairs of points that share a cell, (N, 2) each, the smaller number first."""
    ids = position_ids(np.concatenate(cells))
    points = np.concatenate(members)
    order = np.lexsort((points, ids))
    ids, points = ids[order], points[order]
    counts = np.bincount(ids).astype(np.float64)
    total = float((counts * (counts - 1) / 2).sum())
    if total > _MOST_PAIRS:
        fault = f"is so large that {total:.3g} pairs of vertices lie about as near to each other"
        raise MeshError("weld", fault, _REMEDY)
    for step in range(1, int(counts.max())):
        same = np.flatnonzero(ids[step:] == ids[:-step])
        yield np.stack([points[same], points[same + step]], axis=1)


def _near(points: NDArray[np.float64], pairs: NDArray[np.int64], limit: float) -> NDArray[np.int64]:
    with np.errstate(over="ignore"):
        apart = points[pairs[:, 1]] - points[pairs[:, 0]]
    return pairs[lengths(apart) <= limit]


def _refuse_wide(
    points: NDArray[np.float64],
    rows: NDArray[np.int64],
    pairs: NDArray[np.int64],
    labels: NDArray[np.int64],
    limit: float,
) -> None:
    """Refuse clusters that are wider than `limit`.

    Args:
        points: distinct positions.
        rows: the vertex of each.
        pairs: all that are within `limit`.
        labels: the least neighbour of each position, or itself.
        limit: of the distance.
    """
    first, second = pairs.T
    torn = np.flatnonzero(labels[first] != labels[second])
    if len(torn):
        # The smaller label is next to one end alone: it and the other end are too far apart.
        i, j = pairs[torn[0]].tolist()
        end, other = (i, j) if labels[i] > labels[j] else (j, i)
        _wide(points, rows, (int(labels[other]), end), limit)
    sizes = np.bincount(labels, minlength=len(points))
    known = np.bincount(labels[first], minlength=len(points))
    open_ = np.flatnonzero(known < sizes * (sizes - 1) // 2)
    if len(open_):
        members = np.flatnonzero(labels == open_[0])
        for place, member in enumerate(members):
            far = lengths(points[members[place + 1 :]] - points[member]) > limit
            if far.any():
                _wide(points, rows, (int(member), int(members[place + 1 + far.argmax()])), limit)


def _wide(
    points: NDArray[np.float64], rows: NDArray[np.int64], ends: tuple[int, int], limit: float
) -> None:
    with np.errstate(over="ignore"):
        gap = float(lengths((points[ends[1]] - points[ends[0]])[None])[0])
    a, b = sorted(int(rows[end]) for end in ends)
    fault = f"{limit!r} joins vertices {a} and {b} by steps, and they are {gap!r} apart"
    raise MeshError("weld", fault, _REMEDY)
