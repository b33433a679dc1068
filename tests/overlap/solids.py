"""Closed solids of all sorts for overlap queries, and points where they are hard."""

from __future__ import annotations

from typing import Any

import numpy as np
from meshes.solids import joined, shifted, turned_over
from meshes.surfaces import blob, sphere, torus
from movers.meshes import angle_bar, box, disc, star, tube

Floats = "NDArray[np.float64]"


def _needle() -> Any:
    corners = [(0, 0, 0), (1, 1e-9, 0), (1, 0, 1e-9), (1, -1e-9, -1e-9)]
    return np.array(corners, dtype=np.float64), np.array(
        [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)]
    )


def _plain(surface: Any) -> Any:
    return surface.vertices, surface.faces


SOLIDS = {
    "box": box((0, 0, 0), (3, 2, 1)),
    "plate": box((0, 0, 0), (10, 10, 1e-3)),
    "bar": angle_bar(),
    "star": star(),
    "tube": tube(1.0, 2.0, 0.0, 0.25),
    "ball": _plain(sphere(80)),
    "blob": _plain(blob(80)),
    "torus": _plain(torus(72, 0.3)),
    "hollow": joined(box((0, 0, 0), (4, 4, 4)), turned_over(box((1, 1, 1), (3, 3, 3)))),
    "parts": joined(box((0, 0, 0), (1, 1, 1)), box((1, 0, 0), (2, 1, 1)), disc(9, 1, 3, 4)),
    "far": shifted(box((0, 0, 0), (1, 1, 1)), (1e6, -2e6, 3e5)),
    "needle": _needle(),
}


def hard_points(triangles: Any, random: np.random.Generator, count: int) -> Any:
    """Return points all over, near triangles (V, 3, 3) at any scale, and on their corners."""
    corners = triangles.reshape(-1, 3)
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = float((high - low).max())
    around = random.uniform(low - 0.3 * size, high + 0.3 * size, (count, 3))
    weights = random.dirichlet(np.full(3, 0.6), count)
    on_faces = np.einsum(
        "nk,nkd->nd", weights, triangles[random.integers(len(triangles), size=count)]
    )
    aside = size * 10.0 ** random.uniform(-16, -1, (count, 1)) * random.normal(size=(count, 3))
    at_corners = corners[random.integers(len(corners), size=max(1, count // 4))]
    return np.concatenate([around, on_faces + aside, at_corners])
