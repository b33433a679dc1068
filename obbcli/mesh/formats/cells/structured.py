"""The surface of a structured grid: a sheet of quadrilaterals, or the six sides of a block."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def grid_surface(shape: tuple[int, int, int], points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the quadrilaterals of a grid, (F, 4), rows of points.

    Of a grid with extent along two indices all cells; along three the faces that one cell alone
    has, turned outwards: the sides at the least and the greatest of each index, in turn.

    Args:
        shape: how many points it has along each index, the first running fastest.
        points: (V, 3).
    """
    rows = np.arange(len(points), dtype=np.int64).reshape(shape[::-1]).transpose(2, 1, 0)
    if min(shape) == 1:
        return _sheet(rows.reshape([size for size in shape if size > 1]))
    sides = []
    for axis in range(3):
        first, last = np.take(rows, 0, axis), np.take(rows, -1, axis)
        # Turned so that each axis follows the one before it: I J K, J K I, K I J.
        if axis == 1:
            first, last = first.T, last.T
        sides += [_sheet(first)[:, ::-1], _sheet(last)]
    quads = np.concatenate(sides)
    return quads[:, ::-1] if _volume(quads, points) < 0.0 else quads


def _sheet(rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the cells of a grid of two indices, the first running fastest."""
    corners = (rows[:-1, :-1], rows[1:, :-1], rows[1:, 1:], rows[:-1, 1:])
    return np.stack([corner.T.reshape(-1) for corner in corners], axis=1)


def _volume(quads: NDArray[np.int64], points: NDArray[np.float64]) -> float:
    """Return a multiple of the volume that quadrilaterals enclose: above 0 if turned outwards."""
    scale = float(np.abs(points).max(initial=0.0)) or 1.0
    a, b, c, d = np.moveaxis((points / scale - points[0] / scale)[quads], 1, 0)
    return float((a * np.cross(b, c) + a * np.cross(c, d)).sum())
