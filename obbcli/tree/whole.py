"""What all kinds of trees answer, and those that are whole: in memory, all nodes made.

`growing` has trees whose nodes are made when questions reach them, `opened` those in files.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from obbcli import kernels
from obbcli.errors import MeshError, TreeFileError
from obbcli.mesh import Mesh

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.tree.header import Surface
    from obbcli.tree.options import Description

_REMEDY = "build it again from the mesh"


@dataclass(frozen=True, kw_only=True, eq=False)
class TreeArrays:
    """A tree as plain arrays, all read-only.

    Attributes:
        nodes: uint8 (N, 64), boxes in depth-first order (`kernels/tree/node.hpp`), aligned to 64.
        corners: uint32 (F, 3), vertices of the triangles in tree order.
        triangle_ids: uint32 (F,), their rows in the mesh file.
        vertices: float64 (V, 3), mesh units.
        scale_exponent: boxes are in mesh units times 2 to the minus this.
        description: how the tree was made.
        surface: of the mesh as a whole, as a file says it; None where it is for the mesh to say.
    """

    nodes: NDArray[np.uint8]
    corners: NDArray[np.uint32]
    triangle_ids: NDArray[np.uint32]
    vertices: NDArray[np.float64]
    scale_exponent: int
    description: Description
    surface: Surface | None = None


class AnyTree(Protocol):
    """What a tree answers, whether it grows, is whole, or is read from a file.

    Attributes:
        kernel: the tree as questions see it.
        description: how it was made.
    """

    kernel: kernels.Tree
    description: Description

    @property
    def place(self) -> str:
        """What errors name: the tree's file, or that of its mesh."""

    @property
    def fault(self) -> str | None:
        """What questions last found wrong in the tree's file; None where nothing was."""

    @property
    def surface(self) -> Surface | None:
        """What the tree's file says of the mesh as a whole; None where the mesh came first."""

    @property
    def mesh(self) -> Mesh:
        """The mesh, its triangles in file order; TreeFileError where a damaged tree holds none."""

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices as the mesh has them, (V, 3), read-only."""

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Corners of the mesh's axis-aligned box, (2, 3); the header of a file says them."""

    @property
    def surface_centroid(self) -> NDArray[np.float64]:
        """Area-weighted centroid of the surface, (3,); the header of a file says it."""

    @property
    def scale_exponent(self) -> int:
        """Boxes are in mesh units times 2 to the minus this, which no coordinate exceeds."""

    @property
    def triangle_count(self) -> int:
        """How many triangles the mesh has."""

    @property
    def vertex_count(self) -> int:
        """How many vertices the mesh has."""

    @property
    def nbytes(self) -> int:
        """Bytes of the tree as far as it is made, its triangles and vertices among them."""

    def arrays(self) -> TreeArrays:
        """Return the whole tree; what is missing is made or read first."""

    def triangle(self, row: int) -> NDArray[np.float64]:
        """Return the corners of a triangle of the mesh, (3, 3)."""

    def loaded_counts(self) -> tuple[int, int]:
        """Return how many triangles and boxes are at hand."""


class TreeInMemory(ABC):
    """What trees answer whose mesh is in memory, or can be had from what is."""

    kernel: kernels.Tree
    description: Description
    fault = None

    @property
    def place(self) -> str:
        """What errors name: the file of the mesh."""
        return self.description.source or "a tree"

    @property
    @abstractmethod
    def mesh(self) -> Mesh:
        """The mesh."""

    @property
    @abstractmethod
    def triangle_count(self) -> int:
        """How many triangles the mesh has."""

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Corners of the mesh's axis-aligned box, (2, 3)."""
        return self.mesh.bounds

    @property
    def surface_centroid(self) -> NDArray[np.float64]:
        """Area-weighted centroid of the surface, (3,)."""
        return self.mesh.surface_centroid

    def triangle(self, row: int) -> NDArray[np.float64]:
        """Return the corners of a triangle of the mesh, (3, 3)."""
        corners: NDArray[np.float64] = self.mesh.vertices[self.mesh.triangles[row]]
        return corners

    def loaded_counts(self) -> tuple[int, int]:
        """Return how many triangles and boxes there are by now."""
        return self.triangle_count, self.kernel.node_count


class WholeTree(TreeInMemory):
    """A tree of which everything is there.

    Args:
        arrays: the tree.

    Raises:
        TreeFileError: it is not what it claims to be.
    """

    def __init__(self, arrays: TreeArrays) -> None:
        self._arrays = arrays
        self.description = arrays.description
        self.kernel = kernel_of(arrays, self.place)

    def arrays(self) -> TreeArrays:
        """Return the tree."""
        return self._arrays

    @property
    def surface(self) -> Surface | None:
        """What the tree's file says of the mesh as a whole; None where the mesh came first."""
        return self._arrays.surface

    @property
    def scale_exponent(self) -> int:
        """Boxes are in mesh units times 2 to the minus this, which no coordinate exceeds."""
        return self._arrays.scale_exponent

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh; TreeFileError where a damaged tree holds none."""
        return mesh_of(self._arrays, self.place)

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices as the mesh has them, (V, 3), read-only."""
        return self._arrays.vertices

    @property
    def triangle_count(self) -> int:
        """How many triangles the mesh has."""
        return len(self._arrays.corners)

    @property
    def vertex_count(self) -> int:
        """How many vertices the mesh has."""
        return len(self._arrays.vertices)

    @property
    def nbytes(self) -> int:
        """Bytes of the tree, its triangles and vertices among them."""
        a = self._arrays
        return a.nodes.nbytes + a.corners.nbytes + a.triangle_ids.nbytes + a.vertices.nbytes


def kernel_of(arrays: TreeArrays, place: str) -> kernels.Tree:
    """Return a tree as questions see it.

    Raises:
        TreeFileError: its arrays do not go together.
    """
    try:
        return kernels.Tree(
            arrays.vertices,
            arrays.corners,
            arrays.triangle_ids,
            arrays.nodes,
            arrays.scale_exponent,
        )
    except ValueError as fault:
        raise TreeFileError(place, str(fault), "build it again") from fault


def mesh_of(arrays: TreeArrays, place: str) -> Mesh:
    """Return the mesh that a tree is over, its triangles in file order.

    Raises:
        TreeFileError: the tree is damaged: a triangle is missing, or they make no mesh.
    """
    ids, count = arrays.triangle_ids, len(arrays.corners)
    is_there = np.zeros(count, dtype=bool)
    is_there[ids[ids < count]] = True
    if not is_there.all():
        fault = f"no triangle has the id {int(np.argmin(is_there))}"
        raise TreeFileError(place, fault, _REMEDY)
    triangles = np.empty((count, 3), np.int32)
    triangles[ids] = arrays.corners.view(np.int32)
    about = arrays.description
    try:
        return Mesh(
            arrays.vertices,
            triangles,
            about.source,
            about.source_sha256,
            about.notes,
            unit=about.unit,
            parts=about.parts,
            sag=about.sag,
            spacing=about.spacing,
        )
    except MeshError as fault:
        raise TreeFileError(place, str(fault), _REMEDY) from fault
