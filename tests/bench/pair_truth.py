"""Verdicts and times of many pairs by NumPy, in code of its own: what the sweep believes.

Whole numbers below 8 give projections below 2^17, so that quotients of them compare exactly as
doubles; other pairs are decided here only where a wide margin decides, the rest by `oracles.still`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from oracles.exact import Box, box_hull, triangle_hull
from oracles.moving import contact_interval

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray
    from pair_sets import Pairs

    Floats = NDArray[np.float64]

MARGIN = 1e-9
SIGNS = np.array(np.meshgrid(*[(-1.0, 1.0)] * 3)).reshape(3, 8).T


class Truth(NamedTuple):
    """Of each pair: whether it meets, and when first and last; times of misses mean nothing."""

    meets: NDArray[np.bool_]
    first: Floats
    last: Floats
    by_oracle: int


def points_and_edges(rows: Floats) -> tuple[Floats, Floats]:
    """Return corners (N, 3 or 8, 3) and edge vectors (N, 3, 3); those of flat boxes are zero."""
    if rows.shape[1] == 9:
        points = rows.reshape(-1, 3, 3)
        return points, np.roll(points, -1, axis=1) - points
    arms = rows[:, 3:12].reshape(-1, 3, 3) * rows[:, 12:, np.newaxis]
    return rows[:, np.newaxis, :3] + np.einsum("sk,nkd->nsd", SIGNS, arms), arms


def exact_truth(pairs: Pairs, *, still: bool) -> Truth:
    """Return the truth of pairs on a small grid."""
    size = max(np.abs(pairs.a).max(), np.abs(pairs.b).max(), np.abs(pairs.velocity).max())
    assert size < 8
    first, last = _interval(pairs, still, 0.0)
    return Truth(first <= last, first, last, 0)


def truth(pairs: Pairs, *, still: bool) -> Truth:
    """Return the truth of any pairs, from the oracles where the margin does not decide."""
    outer_first, outer_last = _interval(pairs, still, MARGIN)
    inner_first, inner_last = _interval(pairs, still, -MARGIN)
    meets = inner_first <= inner_last
    first, last = _interval(pairs, still, 0.0)
    unsure = np.flatnonzero((outer_first <= outer_last) & ~meets)
    for k in unsure:
        found = oracle(pairs, int(k), still=still)
        meets[k] = found is not None
        if found is not None:
            first[k], last[k] = map(float, found)
    return Truth(meets, first, last, len(unsure))


def oracle(pairs: Pairs, k: int, *, still: bool) -> Any:
    """Return the exact first and last time of contact of one pair, or None."""
    hulls = [
        triangle_hull(row.reshape(3, 3))
        if len(row) == 9
        else box_hull(Box(row[:3], row[3:12].reshape(3, 3), row[12:]))
        for row in (pairs.a[k], pairs.b[k])
    ]
    duration = 0.0 if still else pairs.duration
    return contact_interval(*hulls, [0.0] * 3, pairs.velocity[k].tolist(), duration)


def _interval(pairs: Pairs, still: bool, margin: float) -> tuple[Floats, Floats]:
    """Return the times that all axes allow, with projections wider by a relative margin."""
    points_a, edges_a = points_and_edges(pairs.a)
    points_b, edges_b = points_and_edges(pairs.b)
    size = np.abs(np.concatenate((points_a, points_b), axis=1)).max(axis=(1, 2))
    first = np.zeros(len(size))
    last = np.full(len(size), 0.0 if still else pairs.duration)
    for axis, scale in _axes(edges_a, edges_b, every_rank=margin == 0.0):
        on_a = np.einsum("nkd,nd->nk", points_a, axis)
        on_b = np.einsum("nkd,nd->nk", points_b, axis)
        slack = margin * scale * size
        low = on_a.min(axis=1) - on_b.max(axis=1) - slack
        high = on_a.max(axis=1) - on_b.min(axis=1) + slack
        speed = np.zeros(len(size)) if still else np.einsum("nd,nd->n", pairs.velocity, axis)
        backwards = speed < 0
        low, high = np.where(backwards, -high, low), np.where(backwards, -low, high)
        speed = np.abs(speed)
        rest = speed == 0
        pace = np.where(rest, 1.0, speed)
        never = rest & ((low > 0) | (high < 0))
        first = np.where(never, np.inf, np.where(rest, first, np.maximum(first, low / pace)))
        last = np.where(rest, last, np.minimum(last, high / pace))
    return first, last


def _axes(edges_a: Floats, edges_b: Floats, *, every_rank: bool) -> Iterator[tuple[Floats, Floats]]:
    """Yield axes (N, 3), and the size of the products they are made of (N,).

    Axes that no rank calls for do no harm: all are necessary. Those for coplanar, collinear and
    coincident shapes are left out where a margin would make them say nothing.
    """
    edges = np.concatenate((edges_a, edges_b), axis=1)
    normal = np.zeros_like(edges[:, 0])
    for i in range(6):
        for j in range(i):
            axis = np.cross(edges[:, j], edges[:, i])
            yield axis, np.abs(edges[:, j]).sum(axis=1) * np.abs(edges[:, i]).sum(axis=1)
            normal = np.where(normal.any(axis=1, keepdims=True), normal, axis)
    if not every_rank:
        return
    line = np.zeros_like(normal)
    units = np.broadcast_to(np.eye(3)[:, np.newaxis], (3, len(normal), 3))
    nothing = np.zeros(len(normal))
    for k in range(6):
        yield np.cross(normal, edges[:, k]), nothing
        yield edges[:, k], nothing
        line = np.where(line.any(axis=1, keepdims=True), line, edges[:, k])
    for unit in units:
        yield np.cross(line, unit), nothing
        yield np.where(line.any(axis=1, keepdims=True), 0.0, unit), nothing
