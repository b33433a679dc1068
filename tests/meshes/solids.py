"""Closed surfaces made of several parts, as vertices and faces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from movers.meshes import Mesh


def joined(*meshes: Mesh) -> Mesh:
    """Return meshes as one, its parts in this order."""
    vertices, faces, count = [], [], 0
    for corners, triangles in meshes:
        vertices.append(np.asarray(corners, dtype=np.float64))
        faces.append(np.asarray(triangles) + count)
        count += len(corners)
    return np.concatenate(vertices), np.concatenate(faces)


def turned_over(mesh: Mesh) -> Mesh:
    """Return the mesh with its inside out."""
    return mesh[0], np.asarray(mesh[1])[:, ::-1]


def shifted(mesh: Mesh, shift: Any) -> Mesh:
    """Return the mesh moved."""
    return mesh[0] + np.asarray(shift, dtype=np.float64), mesh[1]


def unshared(mesh: Mesh) -> Mesh:
    """Return the mesh as STL has it: no two triangles share a vertex."""
    vertices, faces = mesh
    return vertices[np.asarray(faces).reshape(-1)], np.arange(3 * len(faces)).reshape(-1, 3)
