"""`ObbTree`: a mesh under oriented boxes, built, saved, opened and proven. Eberly 2008 §6."""

from __future__ import annotations

import math
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli import kernels, treefile, treeheader
from obbcli.errors import MeshError, TreeFileError
from obbcli.growth import Growth
from obbcli.mesh import Mesh, load_mesh

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    from numpy.typing import NDArray

    from obbcli.opened import OpenedTree
    from obbcli.treeheader import Fit, Split
_NO_LIMIT = 2**32 - 1


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


class ObbTree:
    """A tree of oriented boxes over the triangles of a mesh.

    Made by `build` or `open`. Safe to share between threads, and the same for every question: that
    nodes may be made as questions reach them changes no answer.
    """

    def __init__(
        self, made: treefile.TreeArrays | Growth | OpenedTree, path: Path | None = None
    ) -> None:
        self._made = made
        self._path = path
        # What questions ask; no property, as these cost more than a test of two boxes.
        self.kernel = (
            self._kernel_of(made) if isinstance(made, treefile.TreeArrays) else made.kernel
        )

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

    @classmethod
    def build(
        cls,
        mesh_or_path: Mesh | str | os.PathLike[str],
        fit: Fit = "triangles",
        split: Split = "median",
        leaf_size: int = 1,
        max_depth: int | None = None,
        lazy: bool = True,
        *,
        max_memory: int | None = None,
        progress: Callable[[float], object] | None = None,
    ) -> ObbTree:
        """Return a tree over a mesh.

        Iterative, whatever the shape of the tree; the same mesh and options give the same bytes on
        every machine. Between slices of the work other threads and signals get their turn.

        Args:
            mesh_or_path: the mesh, or the file to load it from.
            fit: orients a box by the spread of its triangles' area (`"triangles"`, §6.1.3 with its
                weights mended), of their corners (`"points"`, §6.1.2), of their convex hull's area
                (`"hull"`), for the least volume (`"min-volume"`, §6.1.1: nearly; slow to build), or
                not at all (`"axis-aligned"`).
            split: parts a node across its longest axis at the median of the triangles' centroids,
                or at the box's center, trying the next longest axes and at last the median (§6.2).
            leaf_size: a node of so many triangles is not split.
            max_depth: nodes this deep are not split; the root's depth is 0. None: no limit.
            lazy: whether nodes wait until a question first reaches them. The tree and the answers
                are the same either way.
            max_memory: bytes that the build may need at its peak. None: no limit.
            progress: called now and then with the share done, from 0 to 1; only where `lazy` is
                false.

        Raises:
            MeshError: the mesh cannot be read or is refused, an option is none of the above, or the
                build would need more than `max_memory`.
            OSError: the file cannot be read.
        """
        mesh = mesh_or_path if isinstance(mesh_or_path, Mesh) else load_mesh(mesh_or_path)
        growth = Growth(mesh, fit, split, leaf_size, max_depth, max_memory, on_demand=lazy)
        return cls(growth if lazy else growth.arrays(progress))

    @classmethod
    def open(cls, path: str | os.PathLike[str], verify: bool = True) -> ObbTree:
        """Return the tree in a file, of which questions read what they reach.

        The file stays open. One that is replaced, as `save` does it, goes on answering as it was;
        one that is overwritten or cut short is refused where a question reaches what is gone.

        Args:
            path: a tree file (`.obbt`).
            verify: whether data are compared with their checksums when they are first read. Links
                are checked all the same.

        Raises:
            TreeFileError: no tree file, another version, truncated or damaged where it was read.
            OSError: the file cannot be read.
        """
        from obbcli.opened import OpenedTree

        return cls(OpenedTree(path, verify=verify), Path(path))

    @classmethod
    def from_bytes(
        cls, data: bytes | bytearray | memoryview, name: str = "bytes", verify: bool = True
    ) -> ObbTree:
        """Return the tree in the bytes of a tree file; `name` is the place named in errors.

        The bytes are copied: what their owner does to them later changes no answer.

        Raises:
            TreeFileError: as `open`.
        """
        return cls(treefile.parse_tree(data, name, verify=verify))

    def save(self, path: str | os.PathLike[str]) -> int:
        """Write the tree to a file, whole or not at all, and return the file's size in bytes.

        Nodes that no question has reached yet are made or read first.

        Raises:
            TreeFileError: the tree was opened from a file that is damaged.
            OSError: the place cannot be written to.
        """
        return treefile.write_tree(path, self._arrays)

    def check(self) -> None:
        """Prove the tree: checksums, structure, and every triangle inside all boxes above it.

        Nodes that no question has reached yet are made first. O(n depth). Containment is proven
        with the rounding of the proof counted against the box.

        Raises:
            TreeFileError: it is not what it claims to be; the message names the first fault.
            OSError: the file that the tree was opened from can no longer be read.
        """
        if self._path is not None:
            from obbcli.opened import OpenedTree

            OpenedTree(self._path).arrays()
        depth = self.max_depth
        fault = self._kernel_of(self._arrays).check(
            min(self.leaf_size, _NO_LIMIT), _NO_LIMIT if depth is None else min(depth, _NO_LIMIT)
        )
        if fault is not None:
            raise TreeFileError(self.place, fault, "build it again from the mesh")

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
            return Mesh(self.vertices, triangles, source=self.source, sha256=self.source_sha256)
        except MeshError as fault:
            raise TreeFileError(self.place, str(fault), "build it again from the mesh") from fault

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Lower and upper corner of the mesh's axis-aligned box, (2, 3), mesh units; as `mesh`."""
        return self.mesh.bounds

    @property
    def size(self) -> float:
        """Diagonal of `bounds`, mesh units; as `mesh`."""
        return self.mesh.size

    @property
    def surface_centroid(self) -> NDArray[np.float64]:
        """Area-weighted centroid of the surface, (3,): the default pivot; as `mesh`."""
        return self.mesh.surface_centroid

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

        Until it is, with `split="center"` and a limit on leaves or depth, how many it has at most.
        """
        return self.node_counts()[1]

    def node_counts(self) -> tuple[int, int]:
        """Return `node_count` and `possible_node_count`, for those who count in microseconds."""
        made = self._made
        if isinstance(made, Growth):
            return made.node_count, made.possible_node_count
        count = len(made.nodes) if isinstance(made, treefile.TreeArrays) else made.node_count
        return count, count

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
    def fit(self) -> str:
        """How boxes were oriented."""
        return self._made.description.fit

    @property
    def split(self) -> str:
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

    def __repr__(self) -> str:
        return f"ObbTree({self.triangle_count} triangles, {self.node_count} boxes)"


def load_tree(path: str | os.PathLike[str], *, verify: bool = True) -> ObbTree:
    """Return the tree in a tree file, or one built with default options over a mesh file.

    Tree files are told by their first bytes, whatever their name.

    Raises:
        MeshError: the mesh cannot be read or is refused.
        TreeFileError: the tree file is damaged.
        OSError: the file cannot be read.
    """
    if begins_as_tree(Path(path)):
        return ObbTree.open(path, verify=verify)
    # Nobody sees a tree that is made for one question: its mesh needs no name.
    return ObbTree.build(load_mesh(path, hashed=False))


def begins_as_tree(path: Path) -> bool:
    """Return whether a file claims to be a tree file; faults are left to its reader."""
    if path.suffix.lower() == ".obbt":
        return True
    try:
        with path.open("rb") as file:
            return treeheader.is_tree_file(file.read(len(treeheader.MAGIC)))
    except OSError:
        return False


def _ldexp_or_none(value: float, exponent: int) -> float | None:
    """Return value times 2^exponent, or None where it leaves the range of double."""
    try:
        result = math.ldexp(value, exponent)
    except OverflowError:
        return None
    return result if math.isfinite(result) else None
