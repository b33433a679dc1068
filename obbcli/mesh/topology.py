"""Edges and repeats of a surface by exact positions; called by `Mesh`."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: Odd 64-bit multipliers (golden ratio, and two of MurmurHash3's) that spread three words over one.
_MULTIPLIERS = (0x9E3779B97F4A7C15, 0xFF51AFD7ED558CCD, 0xC4CEB9FE1A85EC53)


def position_ids(vertices: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return for each vertex the number of its exact position, (V,); equal positions share one.

    One sort of one word a vertex: positions are hashed, and where two that differ share a hash
    the whole is sorted by coordinates instead.
    """
    # Adding zero turns -0.0 into 0.0: the same place.
    words = np.ascontiguousarray(vertices + 0.0).view(np.uint64)
    keys = np.zeros(len(words), dtype=np.uint64)
    for axis, multiplier in enumerate(_MULTIPLIERS):
        keys = (keys ^ words[:, axis]) * np.uint64(multiplier)
        keys ^= keys >> np.uint64(29)
    order = np.argsort(keys)
    ids = _number_runs(words, order, keys)
    if ids is None:
        order = np.lexsort((words[:, 2], words[:, 1], words[:, 0]))
        ids = _number_runs(words, order, None)
    assert ids is not None
    result = np.empty(len(ids), dtype=np.int64)
    result[order] = ids
    return result


def _number_runs(
    words: NDArray[np.uint64], order: NDArray[np.int64], keys: NDArray[np.uint64] | None
) -> NDArray[np.int64] | None:
    """Return running numbers of equal rows in `order`, None where equal keys hide unequal rows."""
    new = np.zeros(len(words) - 1, dtype=bool)
    for axis in range(3):
        column = words[:, axis][order]
        new |= column[1:] != column[:-1]
    if keys is not None:
        ordered = keys[order]
        if (new & (ordered[1:] == ordered[:-1])).any():
            return None
    ids = np.zeros(len(words), dtype=np.int64)
    np.cumsum(new, out=ids[1:])
    return ids


def duplicate_count(corners: NDArray[np.int64]) -> int:
    """Return how many rows repeat an earlier one up to the order of their three ids."""
    rows = np.sort(corners, axis=1)
    # Two ids fit one word; the third is a second key.
    pairs = rows[:, 0] * (int(rows.max()) + 1) + rows[:, 1]
    order = np.lexsort((rows[:, 2], pairs))
    pairs, third = pairs[order], rows[order, 2]
    return int(np.count_nonzero((pairs[1:] == pairs[:-1]) & (third[1:] == third[:-1])))


def is_watertight(corners: NDArray[np.int64]) -> bool:
    """Return whether every edge is run through exactly once in either direction."""
    a, b, c = corners.T
    whole = (a != b) & (b != c) & (c != a)
    if not whole.any():
        return False
    start = corners[whole].reshape(-1)
    end = corners[whole][:, [1, 2, 0]].reshape(-1)
    count = int(corners.max()) + 1
    forward = np.sort(start * count + end)
    if (forward[1:] == forward[:-1]).any():
        return False
    return bool(np.array_equal(forward, np.sort(end * count + start)))


def open_positions(corners: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the ends of all edges that are not run through once in either direction, sorted."""
    a, b, c = corners.T
    whole = corners[(a != b) & (b != c) & (c != a)]
    start, end = whole.reshape(-1), whole[:, [1, 2, 0]].reshape(-1)
    count = int(corners.max()) + 1
    forward, runs = np.unique(start * count + end, return_counts=True)
    # Searched for among the sorted: np.isin hashes, which takes several times as long.
    single = np.append(forward[runs == 1], count * count)
    backward = forward // count + forward % count * count
    there_and_back = single[np.searchsorted(single, backward)] == backward
    bad = forward[(runs != 1) | ~there_and_back]
    return np.unique(np.concatenate([bad // count, bad % count]))


class Seam(NamedTuple):
    """An edge at which a surface does not close.

    Attributes:
        triangle: the first row with that edge.
        corner: where the edge starts in that row; it ends at the next corner.
        along: how many triangles run through it in that direction.
        against: how many in the other.
    """

    triangle: int
    corner: int
    along: int
    against: int


def bad_seams(corners: NDArray[np.int64]) -> tuple[int, Seam] | None:
    """Return how many edges keep a surface from being watertight, and one of the first triangle.

    None where there are none. Collapsed triangles bound nothing, as in `is_watertight`.
    """
    a, b, c = corners.T
    rows = np.flatnonzero((a != b) & (b != c) & (c != a))
    if len(rows) == 0:
        return None
    start = corners[rows].reshape(-1)
    end = corners[rows][:, [1, 2, 0]].reshape(-1)
    is_up = start < end
    keys = np.where(is_up, start, end) * (int(corners.max()) + 1) + np.where(is_up, end, start)
    order = np.argsort(keys, kind="stable")
    ordered = keys[order]
    heads = np.flatnonzero(np.concatenate([[True], ordered[1:] != ordered[:-1]]))
    up = np.add.reduceat(is_up[order].astype(np.int64), heads)
    down = np.diff(np.append(heads, len(keys))) - up
    bad = np.flatnonzero((up != 1) | (down != 1))
    if len(bad) == 0:
        return None
    # A stable order: the head of each run is the edge's first place in the file.
    worst = bad[np.argmin(order[heads[bad]])]
    place = int(order[heads[worst]])
    both = int(up[worst]), int(down[worst])
    along, against = both if is_up[place] else both[::-1]
    return len(bad), Seam(int(rows[place // 3]), place % 3, along, against)
