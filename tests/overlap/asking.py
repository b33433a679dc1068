"""Asks the kernels of overlap queries about solids, and keeps what they say."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from obbcli import Mesh, ObbTree, Pose, kernels

ANY_NUMBER = 2**62


class Solid(NamedTuple):
    """A closed surface where it stands: the tree that the kernels know, and the posed vertices."""

    tree: ObbTree
    pose: Pose
    vertices: Any
    faces: Any

    @property
    def triangles(self) -> Any:
        """The corners (F, 3, 3) in the world."""
        return self.vertices[self.faces]

    @property
    def size(self) -> float:
        """The diagonal of the box around it."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))


def solid(mesh: Any, rotation: Any = None, shift: Any = (0.0, 0.0, 0.0), **options: Any) -> Solid:
    """Return a mesh as a solid of the kernels; a rotation is a matrix."""
    vertices, faces = np.asarray(mesh[0], dtype=np.float64), np.asarray(mesh[1])
    tree = ObbTree.build(Mesh(vertices, faces), **options)
    matrix = np.eye(3) if rotation is None else np.asarray(rotation)
    pose = Pose(matrix, shift) if rotation is not None or np.any(shift) else Pose()
    total = vertices[:, :1] * matrix[:, 0] + vertices[:, 1:2] * matrix[:, 1]
    return Solid(tree, pose, total + vertices[:, 2:] * matrix[:, 2] + np.asarray(shift), faces)


def protrusion(a: Solid, b: Solid, **options: Any) -> kernels.ProtrusionQuery:
    """Return the answered query of how deep A's surface reaches into B."""
    query = protrusion_query(a, b, **options)
    while not query.advance(ANY_NUMBER):
        pass
    return query


def protrusion_query(a: Solid, b: Solid, **options: Any) -> kernels.ProtrusionQuery:
    """Return the query before it has begun, with a floor of 1e-9 sizes where none is given."""
    asked = {"tolerance": 0.01, "floor": 1e-9 * max(a.size, b.size), "max_cells": 200_000}
    return kernels.ProtrusionQuery(
        a.tree.kernel, a.pose.kernel, b.tree.kernel, b.pose.kernel, **(asked | options)
    )
