"""`TreeFacts`: what a tree tells of itself: its mesh, its options, what it is made of.

`ObbTree` in `tree` adds how it is built, opened, saved and proven.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from obbcli import kernels
from obbcli.errors import TreeFileError
from obbcli.mesh import measure
from obbcli.mesh.measure import diagonal
from obbcli.motion.pose import Pose

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from obbcli.mesh import Mesh, PartRows
    from obbcli.tree.header import Surface
    from obbcli.tree.options import Fit, Split
    from obbcli.tree.whole import AnyTree, TreeArrays


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
    """What is known of a tree, whether it grows, is whole, or is read from a file.

    Attributes:
        unit: the length of 1 that the mesh file states, such as `"m"`; None where it states none.
        parts: the parts of the mesh file that were selected, with their rows; as `mesh`.
    """

    def __init__(self, made: AnyTree, path: Path | None = None) -> None:
        self._made = made
        self._path = path
        # What questions ask; no property, as these cost more than a test of two boxes.
        self.kernel = made.kernel
        self.unit: str | None = made.description.unit
        self.parts: tuple[PartRows, ...] = made.description.parts
        # What questions to the kernels alone look at.
        self.kernel.unit = self.unit or ""
        self.kernel.has_parts = bool(self.parts)

    @cached_property
    def at_rest(self) -> kernels.Placed:
        """The tree as its file has it, as the kernels see it."""
        return kernels.Placed(self.kernel, Pose().kernel)

    @property
    def place(self) -> str:
        """What errors name: the tree's file, or that of its mesh."""
        return self._made.place

    @property
    def fault(self) -> str | None:
        """What questions last found wrong in the tree's file; None where nothing was."""
        return self._made.fault

    @property
    def _arrays(self) -> TreeArrays:
        """The whole tree."""
        return self._made.arrays()

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices as the mesh has them, float64 (V, 3), read-only."""
        return self._made.vertices

    def triangle(self, row: int) -> NDArray[np.float64]:
        """Return the corners of a triangle of the mesh, (3, 3); reads no more of a file.

        Raises:
            TreeFileError: the tree was opened from a file that is damaged.
        """
        return self._made.triangle(row)

    @property
    def mesh(self) -> Mesh:
        """The mesh, its triangles in file order; TreeFileError where a damaged tree holds none."""
        return self._made.mesh

    @property
    def _surface(self) -> Surface | None:
        """What the tree's file says of the mesh as a whole; None where the mesh is at hand."""
        return self._made.surface

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Lower and upper corner of the mesh's axis-aligned box, (2, 3), mesh units; as `mesh`."""
        return self._made.bounds

    @property
    def size(self) -> float:
        """Diagonal of `bounds`, mesh units; as `mesh`."""
        return diagonal(self.bounds)

    def size_bounds(self) -> tuple[float, float]:
        """Return two numbers that `size` lies between, which takes no pass over the surface.

        Rounding may put it outside by some units in the last place.
        """
        mesh = None if self._surface is not None else self.mesh
        if mesh is None or "bounds" in vars(mesh):
            return self.size, self.size
        # No coordinate is larger than the power of two that the boxes are scaled by.
        corner = _ldexp_or_none(1.0, self._made.scale_exponent)
        most = math.inf if corner is None else 2.0 * math.sqrt(3.0) * corner
        return measure.least_size(mesh.vertices, mesh.triangles), most

    @property
    def surface_centroid(self) -> NDArray[np.float64]:
        """Area-weighted centroid of the surface, (3,): the default pivot; as `mesh`."""
        return self._made.surface_centroid

    @property
    def triangle_count(self) -> int:
        """How many triangles the mesh has."""
        return self._made.triangle_count

    @property
    def vertex_count(self) -> int:
        """How many vertices the mesh has."""
        return self._made.vertex_count

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
        return self._made.loaded_counts()

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
    def sag(self) -> float | None:
        """How far triangles are from exact surfaces at most, mesh units; as `mesh`."""
        return self._made.description.sag

    def part_of(self, triangle: int | None) -> str | None:
        """Return the path of the selected part that a triangle is of.

        None where all of the file was taken, or of no triangle.
        """
        if triangle is None or not self.parts:
            return None
        place = bisect_right(self.parts, triangle, key=lambda rows: rows.first_triangle)
        return self.parts[place - 1].path

    @property
    def tool_version(self) -> str:
        """Version of the obbtree that built the tree."""
        return self._made.description.tool_version

    @property
    def nbytes(self) -> int:
        """Bytes of the tree as far as it is made, its triangles and vertices among them."""
        return self._made.nbytes


def _ldexp_or_none(value: float, exponent: int) -> float | None:
    """Return value times 2^exponent, or None where it leaves the range of double."""
    try:
        result = math.ldexp(value, exponent)
    except OverflowError:
        return None
    return result if math.isfinite(result) else None
