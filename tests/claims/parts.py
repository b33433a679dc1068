"""What holds of the parts of every file: placed and joined they are the file, bit for bit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli import load_mesh, load_parts

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from obbcli import Mesh


def corners(mesh: Mesh, vertices: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    """Return the corners of a mesh's triangles, (F, 3, 3)."""
    return (mesh.vertices if vertices is None else vertices)[mesh.triangles]


def require_whole(path: Path) -> None:
    """Assert that the parts, placed, are what `load_mesh` returns, bit for bit, and so bounded."""
    parts = load_parts(path)
    placed = np.concatenate([corners(part.mesh, part.vertices()) for part in parts])
    for part in parts:
        points = corners(part.mesh, part.vertices()).reshape(-1, 3)
        bounds = [points.min(axis=0).tolist(), points.max(axis=0).tolist()]
        assert part.placed_bounds().tolist() == bounds
    # Of -0 a pose may make 0.
    assert (placed + 0.0).tobytes() == (corners(load_mesh(path)) + 0.0).tobytes()
    assert corners(load_mesh(f"{path}#**")).tobytes() == corners(load_mesh(path)).tobytes()
