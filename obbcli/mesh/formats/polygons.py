"""Faces of any number of corners as triangles; shared by the readers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


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
