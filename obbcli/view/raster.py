"""Triangles and segments to pixels: which of them each pixel shows, and how near it is.

All in arrays: triangles become rows of pixels, rows become pixels, and each pixel keeps the
nearest. A sliver costs what it covers, and not what its bounding box does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

# What is worked on at a time, so that memory does not grow with what is drawn.
_TRIANGLES_A_SLICE = 1 << 16
_PIXELS_A_SLICE = 1 << 21
# Depths are whole steps of this many bits; the rest of a key tells what is drawn there.
_DEPTH_BITS = 32
DEEPEST = 2.0**_DEPTH_BITS - 2.0
EMPTY = 0


class Fragments(NamedTuple):
    """What some pixels show.

    Attributes:
        pixels: row times width plus column.
        depths: steps towards the eye, 1 to `DEEPEST`.
        owners: which triangle or segment, from 0.
    """

    pixels: NDArray[np.int64]
    depths: NDArray[np.float64]
    owners: NDArray[np.int64]

    def where(self, keep: NDArray[np.bool_]) -> Fragments:
        """Return some of them."""
        return Fragments(self.pixels[keep], self.depths[keep], self.owners[keep])


NOTHING = Fragments(np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.int64))


def triangle_fragments(corners: NDArray[np.float64], size: tuple[int, int]) -> Iterator[Fragments]:
    """Yield the pixels whose middle each triangle covers.

    Args:
        corners: (F, 3, 3) x and y in pixels, and depth in steps.
        size: width and height; nothing beyond is yielded.
    """
    for first in range(0, len(corners), _TRIANGLES_A_SLICE):
        some = corners[first : first + _TRIANGLES_A_SLICE]
        owners, rows = _rows_of(some, size)
        slopes = _slopes(some)
        spans = _spans(some, owners, rows, slopes, size)
        for chosen in _slices(spans.counts):
            part = spans.part(chosen)
            row, place = _repeated(part.counts)
            pixels = part.starts[row] + place
            depths = part.depths[row] + part.slopes[row] * place
            yield Fragments(pixels, depths, part.owners[row] + first)


class Spans(NamedTuple):
    """What triangles cover of rows: the first pixel, how many, and the depths there."""

    starts: NDArray[np.int64]
    counts: NDArray[np.int64]
    depths: NDArray[np.float64]
    slopes: NDArray[np.float64]
    owners: NDArray[np.int64]

    def part(self, some: slice) -> Spans:
        """Return some of them."""
        return Spans(
            self.starts[some],
            self.counts[some],
            self.depths[some],
            self.slopes[some],
            self.owners[some],
        )


def _rows_of(
    corners: NDArray[np.float64], size: tuple[int, int]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return triangles and rows of pixels whose middle they reach over."""
    x, y = corners[:, :, 0], corners[:, :, 1]
    first = np.ceil(np.clip(y.min(axis=1) - 0.5, 0, size[1])).astype(np.int64)
    last = np.floor(np.clip(y.max(axis=1) - 0.5, -1, size[1] - 1)).astype(np.int64)
    is_beside = (x.max(axis=1) < 0) | (x.min(axis=1) > size[0])
    owners, place = _repeated(np.where(is_beside, 0, np.maximum(last - first + 1, 0)))
    return owners, first[owners] + place


def _slopes(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how depth changes with x and with y in the planes of triangles, (F, 2)."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        by_x = u[:, 2] * v[:, 1] - u[:, 1] * v[:, 2]
        by_y = u[:, 0] * v[:, 2] - u[:, 2] * v[:, 0]
        slopes: NDArray[np.float64] = np.stack([by_x, by_y], axis=1)
        slopes /= (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])[:, None]
    return slopes


def _spans(
    corners: NDArray[np.float64],
    owners: NDArray[np.int64],
    rows: NDArray[np.int64],
    slopes: NDArray[np.float64],
    size: tuple[int, int],
) -> Spans:
    """Return what triangles cover of rows of pixels."""
    y = rows + 0.5
    left, right = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        for a, b in ((0, 1), (1, 2), (2, 0)):
            p, q = corners[:, a], corners[:, b]
            lean = (q[:, 0] - p[:, 0]) / (q[:, 1] - p[:, 1])
            low, high = np.minimum(p[:, 1], q[:, 1]), np.maximum(p[:, 1], q[:, 1])
            meets = (low[owners] <= y) & (y <= high[owners]) & np.isfinite(lean)[owners]
            x = p[owners, 0] + (y - p[owners, 1]) * lean[owners]
            left = np.where(meets, np.minimum(left, x), left)
            right = np.where(meets, np.maximum(right, x), right)
    first = np.ceil(np.clip(left - 0.5, 0, size[0])).astype(np.int64)
    last = np.floor(np.clip(right - 0.5, -1, size[0] - 1)).astype(np.int64)
    counts = np.maximum(last - first + 1, 0)
    keep = counts > 0
    owners, rows, first, counts, y = (some[keep] for some in (owners, rows, first, counts, y))
    at_first = _depths(corners, owners, first + 0.5, y, slopes)
    at_last = _depths(corners, owners, first + counts - 0.5, y, slopes)
    slope = (at_last - at_first) / np.maximum(counts - 1, 1)
    return Spans(rows * size[0] + first, counts, at_first, slope, owners)


def _depths(
    corners: NDArray[np.float64],
    owners: NDArray[np.int64],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    slopes: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the depths of points in the planes of triangles, within those of their corners."""
    a, slope = corners[:, 0][owners], slopes[owners]
    z = corners[:, :, 2]
    with np.errstate(invalid="ignore", over="ignore"):
        depths = a[:, 2] + slope[:, 0] * (x - a[:, 0]) + slope[:, 1] * (y - a[:, 1])
    # Seen edge-on a plane says nothing; fmax takes the corner where that is no number.
    depths = np.fmax(depths, z.min(axis=1)[owners])
    clamped: NDArray[np.float64] = np.minimum(depths, z.max(axis=1)[owners])
    return clamped


def segment_fragments(
    ends: NDArray[np.float64], size: tuple[int, int], width: int
) -> Iterator[Fragments]:
    """Yield the pixels of segments that are `width` pixels thick.

    Args:
        ends: (S, 2, 3) x and y in pixels, and depth in steps.
        size: width and height; nothing beyond is yielded.
        width: in pixels.
    """
    start, along, length = _clipped(ends, size, width)
    steps = np.ceil(length).astype(np.int64) + 1
    nib = np.arange(width) - width // 2
    for some in _slices(steps):
        owner, place = _repeated(steps[some])
        owner += some.start
        share = place / np.maximum(steps[owner] - 1, 1)
        points = start[owner] + share[:, None] * along[owner]
        x, y = np.floor(points[:, 0]).astype(np.int64), np.floor(points[:, 1]).astype(np.int64)
        for dx in nib:
            for dy in nib:
                column, line = x + dx, y + dy
                keep = (column >= 0) & (column < size[0]) & (line >= 0) & (line < size[1])
                pixels = line[keep] * size[0] + column[keep]
                yield Fragments(pixels, points[keep, 2], owner[keep])


def _clipped(
    ends: NDArray[np.float64], size: tuple[int, int], width: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return starts, directions and lengths in pixels of what segments have in the picture."""
    start, along = ends[:, 0], ends[:, 1] - ends[:, 0]
    low, high = np.zeros(len(ends)), np.ones(len(ends))
    with np.errstate(divide="ignore", invalid="ignore"):
        for axis in (0, 1):
            near = (-width - start[:, axis]) / along[:, axis]
            far = (size[axis] + width - start[:, axis]) / along[:, axis]
            low = np.fmax(low, np.fmin(near, far))
            high = np.fmin(high, np.fmax(near, far))
    is_seen = low <= high
    start = start + low[:, None] * along
    along = np.where(is_seen, high - low, 0.0)[:, None] * along
    # Those beside the picture keep a point, which the test of pixels drops.
    start[~is_seen] = -2.0 * width - 2.0
    return start, along, np.abs(along[:, :2]).max(axis=1, initial=0.0)


def _slices(counts: NDArray[np.int64]) -> Iterator[slice]:
    """Yield slices of what comes to about as many pixels as are worked on at a time."""
    total = np.cumsum(counts)
    start = 0
    while start < len(counts):
        done = int(total[start] - counts[start])
        stop = max(start + 1, int(np.searchsorted(total, done + _PIXELS_A_SLICE, "right")))
        yield slice(start, stop)
        start = stop


def _repeated(counts: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return each index as often as counted, and 0, 1, ... within it."""
    owners = np.repeat(np.arange(len(counts)), counts)
    begins = np.cumsum(counts) - counts
    return owners, np.arange(len(owners)) - begins[owners]


class Nearest:
    """What is nearest in each pixel. Ids count from 1; 0 is nothing.

    Args:
        size: width and height in pixels.
    """

    def __init__(self, size: tuple[int, int]) -> None:
        self.size = size
        self._keys = np.zeros(size[0] * size[1], np.uint64)

    def add(self, fragments: Fragments, ids: NDArray[np.int64]) -> None:
        """Keep what is nearer than what is there; `ids` has one a fragment."""
        keys = fragments.depths.astype(np.uint64)
        keys <<= np.uint64(_DEPTH_BITS)
        keys |= ids.view(np.uint64)
        np.maximum.at(self._keys, fragments.pixels, keys)

    def is_before(self, fragments: Fragments) -> NDArray[np.bool_]:
        """Return which fragments are nearer than what is there."""
        there = self._keys[fragments.pixels] >> np.uint64(_DEPTH_BITS)
        is_nearer: NDArray[np.bool_] = fragments.depths.astype(np.uint64) > there
        return is_nearer

    @property
    def ids(self) -> NDArray[np.int64]:
        """What each pixel shows, (height, width)."""
        low = self._keys & np.uint64(2**_DEPTH_BITS - 1)
        ids: NDArray[np.int64] = low.view(np.int64).reshape(self.size[1], self.size[0])
        return ids

    @property
    def depths(self) -> NDArray[np.float64]:
        """How near it is, in steps, (height, width); 0 where nothing is."""
        steps = (self._keys >> np.uint64(_DEPTH_BITS)).astype(np.float64)
        depths: NDArray[np.float64] = steps.reshape(self.size[1], self.size[0])
        return depths
