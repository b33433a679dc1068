"""Which welding would close a surface: found from the gaps of its open edges, proven by welding."""

from __future__ import annotations

import decimal
from typing import TYPE_CHECKING

import numpy as np

from obbcli.errors import MeshError
from obbcli.mesh.topology import open_positions
from obbcli.mesh.weld import lengths, pairs_within

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.mesh import Mesh

#: Of a mesh's size: what is farther apart is no crack of rounding.
_LARGEST_GAP = 1e-6
#: Each costs a welding of the whole mesh.
_MOST_TRIES = 10
_UP = decimal.Context(prec=2, rounding=decimal.ROUND_CEILING)


def closing_distance(mesh: Mesh) -> float | None:
    """Return a distance within which welding makes a mesh watertight, mesh units.

    It is a gap between ends of open edges, rounded up to two digits, and at most 1e-6 of the
    mesh's size. The first tried is the least that can join each such end to its nearest. None
    where none of those tried closes the mesh.
    """
    limit = _LARGEST_GAP * mesh.size
    corners = mesh.corner_ids.reshape(-1)
    ids, places = np.unique(corners, return_index=True)
    is_open = np.zeros(len(ids), dtype=bool)
    is_open[np.searchsorted(ids, open_positions(mesh.corner_ids))] = True
    points = mesh.vertices[mesh.triangles.reshape(-1)[places[is_open]]]
    if len(points) == 0 or not 0 < limit < np.inf:
        return None
    try:
        gaps = _Gaps(points, limit)
    except MeshError:
        return None
    tried = set()
    for start in gaps.starts():
        width = gaps.settled(start)
        distance = None if width is None else _rounded(width, limit)
        if distance is not None and distance not in tried and _closes(mesh, distance):
            return distance
        tried.add(distance)
    return None


class _Gaps:
    """The gaps between points that are at most `limit` apart.

    Raises:
        MeshError: there are too many.
    """

    def __init__(self, points: NDArray[np.float64], limit: float) -> None:
        self._count = len(points)
        self._pairs = pairs_within(points, limit)
        self._gaps = lengths(points[self._pairs[:, 1]] - points[self._pairs[:, 0]])

    def starts(self) -> list[float]:
        """Return gaps to begin with: the largest from a point to its nearest, then some of all."""
        if len(self._gaps) == 0:
            return []
        nearest = np.full(self._count, np.inf)
        for side in (0, 1):
            np.minimum.at(nearest, self._pairs[:, side], self._gaps)
        ranked = np.sort(self._gaps)
        steps = np.linspace(0, len(ranked) - 1, _MOST_TRIES - 1).astype(np.int64)
        return [float(nearest[np.isfinite(nearest)].max()), *ranked[steps].tolist()]

    def settled(self, gap: float) -> float | None:
        """Return the least width from `gap` on that clusters joined by its steps do not exceed.

        None where they are wider than the limit.
        """
        while True:
            labels = self._joined(self._gaps <= gap)
            first, second = labels[self._pairs[:, 0]], labels[self._pairs[:, 1]]
            inside = first == second
            sizes = np.bincount(labels)
            if np.count_nonzero(inside) < int((sizes * (sizes - 1) // 2).sum()):
                return None
            widest = float(self._gaps[inside].max())
            if widest <= gap:
                return gap
            gap = widest

    def _joined(self, chosen: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Return the least point of the connected set of each point."""
        labels = np.arange(self._count)
        first, second = self._pairs[chosen].T
        while True:
            before = labels.copy()
            least = np.minimum(labels[first], labels[second])
            for side in (first, second):
                np.minimum.at(labels, side, least)
            labels = labels[labels]
            if np.array_equal(labels, before):
                return labels


def _closes(mesh: Mesh, distance: float) -> bool:
    """Return whether welding makes a mesh watertight."""
    try:
        return mesh.welded(distance).is_watertight
    except MeshError:
        return False


def _rounded(gap: float, limit: float) -> float:
    """Return a gap rounded up to two digits, as long as that is within the limit."""
    short = float(_UP.create_decimal(decimal.Decimal(gap)))
    return short if short <= limit else gap
