"""`TreeFacts`: what a tree tells of itself: its mesh, its options, what it is made of.

`ObbTree` in `tree` adds how it is built, opened, saved and proven.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli import kernels
from obbcli.errors import MeshError, TreeFileError
from obbcli.mesh import Mesh
from obbcli.mesh.measure import diagonal
from obbcli.motion.pose import Pose
from obbcli.tree import file as treefile
from obbcli.tree.growing import Growth

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from obbcli.tree.header import Surface
    from obbcli.tree.opened import OpenedTree
    from obbcli.tree.options import Fit, Split


class Level(NamedTuple):
    """Boxes of one depth.

    Attributes:
        box_count: how many boxes there are.
        leaf_count: how many nodes end here: leaves, and single triangles, which need no box.
        volume: sum of the boxes' volumes, cubed mesh units; None where a double cannot hold it.
    """

    box_count: int
    leaf_count: int
    volume: float | None


class TreeFacts:
    """What is known of a tree, whether it grows, is whole, or is read from a file."""

    def __init__(
        self, made: treefile.TreeArrays | Growth | OpenedTree, path: Path | None = None
    ) -> None:
        self._made = made
        self._path = path
        # What questions ask; no property, as these cost more than a test of two boxes.
        self.kernel = (
            self._kernel_of(made) if isinstance(made, treefile.TreeArrays) else made.kernel
        )

    @cached_property
    def at_rest(self) -> kernels.Placed:
        """The tree as its file has it, as the kernels see it: that of a body without a motion."""
        return kernels.Placed(self.kernel, Pose().kernel)

    def _kernel_of(self, arrays: treefile.TreeArrays) -> kernels.Tree:
        try:
            return kernels.Tree(
                arrays.vertices,
                arrays.corners,
                arrays.triangle_ids,
                arrays.nodes,
                arrays.scale_exponent,
            )
        except ValueError as fault:
            raise TreeFileError(self.place, str(fault), "build it again") from fault

    @property
    def place(self) -> str:
        """What errors name: the tree's file, or that of its mesh."""
        return str(self._path or self.source or "a tree")

    @property
    def fault(self) -> str | None:
        """What questions last found wrong in the tree's file; None where nothing was."""
        made = self._made
        return None if isinstance(made, (Growth, treefile.TreeArrays)) else made.fault or None

    @property
    def _arrays(self) -> treefile.TreeArrays:
        """The whole tree."""
        made = self._made
        return made if isinstance(made, treefile.TreeArrays) else made.arrays()

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices as the mesh has them, float64 (V, 3), read-only."""
        return self.mesh.vertices if isinstance(self._made, Growth) else self._arrays.vertices

    def triangle(self, row: int) -> NDArray[np.float64]:
        """Return the corners of a triangle of the mesh, (3, 3); reads no more of a file.

        Raises:
            TreeFileError: the tree was opened from a file that is damaged.
        """
        made = self._made
        if not isinstance(made, (Growth, treefile.TreeArrays)):
            return made.triangle(row)
        corners: NDArray[np.float64] = self.vertices[self.mesh.triangles[row]]
        return corners

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh, its triangles in file order; TreeFileError where a damaged tree holds none."""
        if isinstance(self._made, Growth):
            return self._made.mesh
        arrays = self._arrays
        ids = arrays.triangle_ids
        is_there = np.zeros(self.triangle_count, dtype=bool)
        is_there[ids[ids < self.triangle_count]] = True
        if not is_there.all():
            raise TreeFileError(
                self.place,
                f"no triangle has the id {int(np.argmin(is_there))}",
                "build it again from the mesh",
            )
        triangles = np.empty((self.triangle_count, 3), np.int32)
        triangles[ids] = arrays.corners.view(np.int32)
        try:
            return Mesh(self.vertices, triangles, self.source, self.source_sha256, self.notes)
        except MeshError as fault:
            raise TreeFileError(self.place, str(fault), "build it again from the mesh") from fault

    @property
    def _surface(self) -> Surface | None:
        """What the tree's file says of the mesh as a whole; None where the mesh is at hand."""
        return None if isinstance(self._made, Growth) else self._made.surface

    @property
    def _known_surface(self) -> Surface | None:
        """The same where it spares reading the file; what was read speaks for itself."""
        return None if isinstance(self._made, treefile.TreeArrays) else self._surface

    @cached_property
    def bounds(self) -> NDArray[np.float64]:
        """Lower and upper corner of the mesh's axis-aligned box, (2, 3), mesh units; as `mesh`."""
        known = self._known_surface
        return self.mesh.bounds if known is None else _read_only(known.bounds)

    @property
    def size(self) -> float:
        """Diagonal of `bounds`, mesh units; as `mesh`."""
        return diagonal(self.bounds)

    @cached_property
    def surface_centroid(self) -> NDArray[np.float64]:
        """Area-weighted centroid of the surface, (3,): the default pivot; as `mesh`."""
        known = self._known_surface
        return self.mesh.surface_centroid if known is None else _read_only(known.surface_centroid)

    @property
    def triangle_count(self) -> int:
        """How many triangles the mesh has."""
        made = self._made
        return len(made.corners) if isinstance(made, treefile.TreeArrays) else made.triangle_count

    @property
    def vertex_count(self) -> int:
        """How many vertices the mesh has."""
        made = self._made
        return len(made.vertices) if isinstance(made, treefile.TreeArrays) else made.vertex_count

    @property
    def node_count(self) -> int:
        """How many boxes there are by now; a single triangle needs none."""
        return self.node_counts()[0]

    @property
    def possible_node_count(self) -> int:
        """How many boxes the tree has when it is whole.

        Until it is, with a limit on leaves or depth, how many it has at most, unless it is parted
        by medians.
        """
        return self.node_counts()[1]

    def node_counts(self) -> tuple[int, int]:
        """Return `node_count` and `possible_node_count`."""
        return self.kernel.node_count, self.kernel.possible_node_count

    def loaded_counts(self) -> tuple[int, int]:
        """Return how many triangles and boxes are at hand: made, or read from a tree file."""
        made = self._made
        if isinstance(made, (Growth, treefile.TreeArrays)):
            return self.triangle_count, self.node_count
        return made.loaded_counts()

    @cached_property
    def levels(self) -> tuple[Level, ...]:
        """What stands at each depth, the root's first; nodes not reached yet are made first."""
        cube = 3 * self._arrays.scale_exponent
        try:
            found = self.kernel.levels()
        except kernels.TreeError as fault:
            raise TreeFileError(self.place, str(fault), "build it again") from fault
        return tuple(
            Level(boxes, leaves, _ldexp_or_none(volume, cube)) for boxes, leaves, volume in found
        )

    @property
    def fit(self) -> Fit:
        """How boxes were oriented."""
        return self._made.description.fit

    @property
    def split(self) -> Split:
        """How nodes were parted."""
        return self._made.description.split

    @property
    def leaf_size(self) -> int:
        """A node of so many triangles is a leaf."""
        return self._made.description.leaf_size

    @property
    def max_depth(self) -> int | None:
        """The depth at which a node is a leaf; None: no limit."""
        return self._made.description.max_depth

    @property
    def source(self) -> str | None:
        """Name of the mesh file, or None for a mesh made in code."""
        return self._made.description.source

    @property
    def source_sha256(self) -> str | None:
        """SHA-256 of the mesh file's bytes, or None."""
        return self._made.description.source_sha256

    @property
    def notes(self) -> tuple[str, ...]:
        """What of the mesh file was taken with a change, a sentence each; as `mesh`."""
        return self._made.description.notes

    @property
    def tool_version(self) -> str:
        """Version of the obbtree that built the tree."""
        return self._made.description.tool_version

    @property
    def nbytes(self) -> int:
        """Bytes of the tree as far as it is made, its triangles and vertices among them."""
        a = self._made
        if not isinstance(a, treefile.TreeArrays):
            return a.nbytes
        return a.nodes.nbytes + a.corners.nbytes + a.triangle_ids.nbytes + a.vertices.nbytes


def _read_only(values: tuple[object, ...]) -> NDArray[np.float64]:
    array = np.array(values, np.float64)
    array.setflags(write=False)
    return array


def _ldexp_or_none(value: float, exponent: int) -> float | None:
    """Return value times 2^exponent, or None where it leaves the range of double."""
    try:
        result = math.ldexp(value, exponent)
    except OverflowError:
        return None
    return result if math.isfinite(result) else None
