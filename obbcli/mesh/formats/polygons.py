"""Faces of any number of corners as triangles; shared by the readers.

A polygon of n corners becomes n - 2 triangles, all polygons in the file's order. A convex one is a
fan about its first corner. Of others a fan may leave the polygon: they are cut within themselves by
ear clipping (mapbox_earcut).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.text import counted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.source import Source

    #: Triangles of one polygon, (n - 2, 3), as places in its ring.
    Cut = NDArray[np.int64]

#: Polygons looked at in one piece, so that temporary arrays stay small.
_SLICE = 1 << 13
#: A turn to the wrong side below this share of the squared lengths beside it is rounding.
_STRAIGHT = 1e-14
#: Corners off their polygon's plane by less than this share of the largest coordinate are rounding.
_FLAT = 1e-6
#: How much of its area a cut may miss before it is taken for one that leaves its polygon.
_SAME_AREA = 1e-9


def triangulated(
    source: Source,
    vertices: NDArray[np.float64],
    corners: NDArray[np.int64],
    counts: NDArray[np.int64],
) -> NDArray[np.int64]:
    """Return polygons as triangles in the polygons' order, (F, 3): n - 2 of n corners.

    Polygons that are not convex, that are not flat, and those that no cut can stay within are told
    in the source's notes.

    Args:
        source: the file, which is given the notes.
        vertices: (V, 3).
        corners: rows of `vertices`, of all polygons, one after the other.
        counts: how many corners each polygon has, at least three.
    """
    triangles = fans(corners, counts)
    if (counts == 3).all():
        return triangles
    points, scale = _scaled(vertices)
    starts = np.cumsum(counts) - counts
    firsts = starts - 2 * np.arange(len(counts))
    found = _Findings()
    for count in np.unique(counts[counts > 3]).tolist():
        same = np.flatnonzero(counts == count)
        for begin in range(0, len(same), _SLICE):
            part = same[begin : begin + _SLICE]
            rings = corners[starts[part, np.newaxis] + np.arange(count)]
            looked_at = _look(points[rings])
            found.see_off_plane(looked_at.off_plane)
            for place in np.flatnonzero(~looked_at.is_convex).tolist():
                cut = found.cut(points[rings[place]], looked_at.normals[place])
                if cut is not None:
                    first = firsts[part[place]]
                    triangles[first : first + count - 2] = rings[place][cut]
    found.tell(source, scale)
    return triangles


def fans(corners: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return polygons as triangles, each a fan about its first corner, in order: (F, 3).

    Args:
        corners: the corners of all polygons, one after the other.
        counts: how many corners each polygon has, at least three.
    """
    if (counts == 3).all():
        return corners.reshape(-1, 3)
    starts = np.cumsum(counts) - counts
    triangle_counts = counts - 2
    first = np.repeat(starts, triangle_counts)
    before = np.cumsum(triangle_counts) - triangle_counts
    step = np.arange(len(first)) - np.repeat(before, triangle_counts)
    return np.stack([corners[first], corners[first + step + 1], corners[first + step + 2]], axis=1)


class _Findings:
    """What is to be told of all polygons of a file."""

    def __init__(self) -> None:
        self._concave = self._pieces = self._crossed = 0
        self._off_plane: list[NDArray[np.float64]] = []

    def see_off_plane(self, distances: NDArray[np.float64]) -> None:
        """Keep how far the corners of polygons are off their planes."""
        self._off_plane.append(distances)

    def cut(self, ring: NDArray[np.float64], normal: NDArray[np.float64]) -> Cut | None:
        """Return how a polygon that is not convex is cut; None for a fan."""
        cut, is_within = _clipped(ring, normal)
        if is_within:
            self._concave += 1
            self._pieces += len(ring) - 2
        else:
            self._crossed += 1
        return cut

    def tell(self, source: Source, scale: float) -> None:
        """Write the notes; `scale` is how many mesh units the unit of the distances seen is."""
        off_plane = np.concatenate(self._off_plane)
        count = int(np.count_nonzero(off_plane > _FLAT))
        if self._concave:
            what = counted(self._concave, "concave polygon")
            within = "itself" if self._concave == 1 else "themselves"
            into = counted(self._pieces, "triangle")
            source.note(f"{what} cut within {within} into {into}")
        if self._crossed:
            what = counted(self._crossed, "polygon")
            why = "the outline crosses itself or holds nothing"
            source.note(f"{what} cut as well as can be: {why}")
        if count:
            most = float(off_plane.max()) * scale
            what = counted(count, "polygon") + (" is" if count == 1 else " are")
            source.note(f"{what} not flat: corners up to {most:.3g} off plane")


class _Look(NamedTuple):
    """What is known of polygons of equally many corners.

    Attributes:
        normals: (P, 3), twice the area of the polygon long.
        is_convex: (P,), whether a fan about the first corner stays within.
        off_plane: (P,), how far the corner farthest from the plane through the middle is from it.
    """

    normals: NDArray[np.float64]
    is_convex: NDArray[np.bool_]
    off_plane: NDArray[np.float64]


def _look(rings: NDArray[np.float64]) -> _Look:
    """Return what is known of polygons, (P, n, 3), by Newell's normals.

    Arrays inside are (3, n, P), so that each operation runs through polygons side by side.
    """
    corners = np.ascontiguousarray(rings.transpose(2, 1, 0))
    with np.errstate(invalid="ignore", over="ignore"):  # what is not finite is refused later
        arms = corners - corners[:, :1]
        fan = _crossed(arms[:, 1:-1], arms[:, 2:])
        normals = fan.sum(axis=1)
        lengths = np.sqrt(np.square(normals).sum(axis=0))
        units = normals / np.where(lengths > 0, lengths, 1.0)
        sides = np.roll(corners, -1, axis=1) - corners
        before = np.roll(sides, 1, axis=1)
        turns = _along(_crossed(before, sides), units)
        squares = np.square(sides).sum(axis=0)
        room = _STRAIGHT * (np.roll(squares, 1, axis=0) + squares)
        is_convex = (turns >= -room).all(axis=0)
        # A star turns one way at all corners as well, but goes around more than once.
        slack = _STRAIGHT * np.square(arms).sum(axis=0).max(axis=0)
        is_convex &= (_along(fan, units) >= -slack).all(axis=0)
        # Where the loops of a crossed outline cancel there is no normal, but there is area.
        areas = np.sqrt(np.square(fan).sum(axis=0)).sum(axis=0)
        is_convex &= (areas <= slack) | (lengths > _SAME_AREA * areas)
        off = _along(corners - corners.mean(axis=1, keepdims=True), units)
    is_convex |= ~np.isfinite(lengths)
    return _Look(normals.T, is_convex, np.nan_to_num(np.abs(off).max(axis=0)))


def _crossed(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the cross products of vectors whose coordinates come first."""
    rows = [a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1))]
    return np.stack(rows)


def _along(vectors: NDArray[np.float64], units: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far each of (3, n, P) goes along its polygon's normal, (n, P)."""
    return np.asarray((vectors * units[:, np.newaxis]).sum(axis=0))


def _clipped(ring: NDArray[np.float64], normal: NDArray[np.float64]) -> tuple[Cut | None, bool]:
    """Return the cut of one polygon by ear clipping, and whether it stays within the polygon.

    Coordinates along the normal's longest axis are dropped, which moves no other coordinate.
    """
    # Imported where it is needed: most files hold no concave polygon.
    from mapbox_earcut import triangulate_float64

    axis = int(np.argmax(np.abs(normal)))
    flat = np.ascontiguousarray(np.delete(ring, axis, axis=1))
    ends = np.array([len(ring)], dtype=np.uint32)
    ears = triangulate_float64(flat, ends).astype(np.int64).reshape(-1, 3)
    cut = _with_all_corners(ears, len(ring))
    if cut is None:
        return None, False
    a, b, c = (flat[cut[:, corner]] for corner in range(3))
    areas = _cross(b - a, c - a)
    # The projection turns a polygon around where the normal points down, or along y.
    wanted = float(normal[axis]) * (-1.0 if axis == 1 else 1.0)
    if areas.sum() * wanted < 0:
        cut, areas = cut[:, ::-1], -areas
    missed = abs(float(np.abs(areas).sum()) - abs(wanted))
    return cut, bool(missed <= _SAME_AREA * float(np.abs(areas).sum()))


def _with_all_corners(ears: NDArray[np.int64], count: int) -> Cut | None:
    """Return the triangles with the corners that ear clipping left out, or None.

    It leaves out corners on a straight line between others and repeated ones. Between two corners
    that follow one another in what is left, one triangle has that side: it is parted there.
    """
    left = np.unique(ears)
    if len(ears) != len(left) - 2 or len(left) < 3:
        return None
    if len(left) == count:
        return ears
    after = dict(zip(left.tolist(), np.roll(left, -1).tolist(), strict=True))
    rows: list[tuple[int, int, int]] = []
    for row in ears.tolist():
        rows += _parted(row, after, count)
    return np.array(rows, dtype=np.int64) if len(rows) == count - 2 else None


def _parted(row: list[int], after: dict[int, int], count: int) -> list[tuple[int, int, int]]:
    """Return a triangle parted at all corners left out on its sides.

    Args:
        row: its corners.
        after: of each corner that was kept the next one.
        count: how many corners the polygon has.
    """
    rows = [(row[0], row[1], row[2])]
    for start, end in zip(row, (row[1], row[2], row[0]), strict=True):
        if after[start] == end:
            between = [(start + k) % count for k in range(1, (end - start) % count)]
        elif after[end] == start:
            between = [(start - k) % count for k in range(1, (start - end) % count)]
        else:
            continue
        for corner in between:
            place, opposite = _beside(rows, start, end)
            rows[place : place + 1] = [(start, corner, opposite), (corner, end, opposite)]
            start = corner
    return rows


def _beside(rows: list[tuple[int, int, int]], start: int, end: int) -> tuple[int, int]:
    """Return which triangle runs from `start` to `end`, and its third corner."""
    for place, (a, b, c) in enumerate(rows):
        for one, two, three in ((a, b, c), (b, c, a), (c, a, b)):
            if (one, two) == (start, end):
                return place, three
    raise AssertionError("a side that was just made is there")


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _scaled(vertices: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return vertices times a power of two that brings them below 1, and that power's inverse."""
    with np.errstate(invalid="ignore"):
        most = float(np.abs(np.where(np.isfinite(vertices), vertices, 0.0)).max(initial=0.0))
    # Powers of two stay within those of doubles, so that nothing overflows.
    exponent = min(max(int(np.frexp(most)[1]), -1000), 1000)
    with np.errstate(over="ignore", invalid="ignore"):  # of what is not finite
        return np.ldexp(vertices, -exponent), float(np.ldexp(1.0, exponent))
