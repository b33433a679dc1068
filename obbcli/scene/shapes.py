"""`Shapes`: the meshes and trees of a scene, each loaded once and as far as questions reach."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from obbcli.files import file_and_pattern
from obbcli.mesh import Mesh, load_mesh
from obbcli.mesh.measured_file import MeasuredFile
from obbcli.motion.body import Body, with_pivot
from obbcli.motion.lazy_mesh import LazyMesh
from obbcli.scene.results import BodyStats
from obbcli.tree.head import TreeHead
from obbcli.tree.tree import ObbTree, begins_as_tree, check_measures

if TYPE_CHECKING:
    from collections.abc import Hashable

    from obbcli.motion.body import Shape
    from obbcli.scene.bodies import SceneBody


class Shapes:
    """What bodies are made of. A file is loaded once, however many bodies name it.

    Args:
        verify: whether the checksums of tree files are compared.
    """

    def __init__(self, *, verify: bool = True) -> None:
        self._verify = verify
        self._loaded: dict[Hashable, Mesh | TreeHead] = {}
        self._trees: dict[Hashable, ObbTree] = {}

    def load(self, shape: Shape) -> Mesh | ObbTree | TreeHead:
        """Return what bounds and centroid are known of; of a tree file that is its header.

        Raises:
            MeshError: a mesh cannot be read or is refused.
            TreeFileError: a tree file is damaged.
            OSError: a file cannot be read.
        """
        if isinstance(shape, (Mesh, ObbTree)):
            return shape
        key = _key(shape)
        found = self._loaded.get(key)
        if found is None and isinstance(shape, LazyMesh):
            found = self._loaded[key] = shape.mesh
        if found is None:
            assert isinstance(shape, (str, os.PathLike))
            if begins_as_tree(Path(shape)):
                found = TreeHead(os.fspath(shape), verify=self._verify)
                check_measures(shape, found.unit)
            else:
                found = load_mesh(shape, hashed=False)
            self._loaded[key] = found
        return found

    def body(self, body: Body) -> Body:
        """Return a body on its tree.

        Raises:
            MeshError, TreeFileError, OSError: as `load`.
        """
        shape = self.load(body.shape)
        if not isinstance(shape, ObbTree):
            key = _key(body.shape)
            tree = self._trees.get(key)
            if tree is None:
                tree = shape.open() if isinstance(shape, TreeHead) else ObbTree.build(shape)
                self._trees[key] = tree
            shape = tree
        # The pivot is posed once, and not for each question about the body.
        return Body(shape, body.pose, with_pivot(body, shape))

    def stats(self, body: SceneBody) -> BodyStats:
        """Return what of a body was used so far."""
        shape = body.body.shape
        key = _key(shape)
        made = shape if isinstance(shape, (Mesh, ObbTree)) else self._loaded.get(key)
        made = self._trees.get(key, made)
        if isinstance(made, TreeHead):
            return BodyStats(body.name, made.triangle_count, 0, 0, made.node_count)
        if made is None:
            return BodyStats(body.name, None, 0, 0, None)
        if isinstance(made, ObbTree):
            triangles, nodes = made.loaded_counts()
            return BodyStats(
                body.name, made.triangle_count, triangles, nodes, made.possible_node_count
            )
        # A single triangle needs no box.
        count = len(made.triangles)
        return BodyStats(body.name, count, count, 0, count - 1)


def _key(shape: Shape) -> Hashable:
    """Return what two names of one file, and a shape that stands for two bodies, have in common."""
    if not isinstance(shape, (str, os.PathLike)):
        return id(shape)
    file, pattern = file_and_pattern(os.fspath(shape))
    measures = None
    if isinstance(shape, MeasuredFile):
        measures = shape.unit, shape.own, shape.scale, shape.weld, shape.sag
    return os.path.realpath(file), pattern, measures
