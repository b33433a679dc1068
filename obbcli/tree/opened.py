"""`OpenedTree`: a tree in a file, of which questions read what they reach."""

from __future__ import annotations

import os
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from obbcli import kernels
from obbcli.errors import TreeFileError
from obbcli.tree.header import read_header
from obbcli.tree.whole import TreeArrays, mesh_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.mesh import Mesh


class OpenedTree:
    """A tree file that is open. Safe to share between threads; each block is read once.

    What was read stays as it was, whatever becomes of the file; what was not can be missed.

    Args:
        path: the file.
        verify: whether blocks are compared with their checksums when they are read; the header
            always is.

    Raises:
        TreeFileError: no tree file, another version, truncated, or damaged in its header or root.
        OSError: the file cannot be read.
    """

    def __init__(self, path: str | os.PathLike[str], *, verify: bool = True) -> None:
        self._name = os.fspath(path)
        self.place = str(Path(path))
        with Path(path).open("rb") as file:
            header = read_header(file, self._name)
            self.description = header.description
            self.surface = header.surface
            self.node_count = header.node_count
            self.triangle_count = header.triangle_count
            self.vertex_count = header.vertex_count
            self.nbytes = sum(header.section_bytes)
            self.scale_exponent = header.scale_exponent
            with self._named_faults():
                self._file = kernels.FileTree(
                    os.dup(file.fileno()),
                    header.header_bytes,
                    header.node_count,
                    header.triangle_count,
                    header.vertex_count,
                    header.scale_exponent,
                    header.checksums if verify else header.checksums[:0],
                )
        self.kernel = self._file.tree()

    def arrays(self) -> TreeArrays:
        """Read what is missing, and return the whole tree as arrays.

        Raises:
            TreeFileError: the file is damaged, or was cut short since it was opened.
        """
        with self._named_faults():
            nodes, corners, triangle_ids, vertices = self._file.arrays()
        return TreeArrays(
            nodes=nodes,
            corners=corners,
            triangle_ids=triangle_ids,
            vertices=vertices,
            scale_exponent=self.scale_exponent,
            description=self.description,
            surface=self.surface,
        )

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh, its triangles in file order.

        Raises:
            TreeFileError: as `arrays`, or the triangles make no mesh.
        """
        return mesh_of(self.arrays(), self.place)

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices as the mesh has them, (V, 3), read-only."""
        return self.arrays().vertices

    @cached_property
    def bounds(self) -> NDArray[np.float64]:
        """Corners of the mesh's axis-aligned box, (2, 3), as the header says."""
        return _read_only(self.surface.bounds)

    @cached_property
    def surface_centroid(self) -> NDArray[np.float64]:
        """Area-weighted centroid of the surface, (3,), as the header says."""
        return _read_only(self.surface.surface_centroid)

    def triangle(self, row: int) -> NDArray[np.float64]:
        """Return the corners of one triangle, (3, 3); `row` counts as in the mesh file.

        Raises:
            TreeFileError: as `arrays`, or no triangle has this id.
        """
        places = self._places
        if places[row] < 0:
            raise self._damaged(f"no triangle has the id {row}")
        with self._named_faults():
            return self._file.triangle(int(places[row]))

    @cached_property
    def _places(self) -> NDArray[np.int32]:
        """Where the triangles of the mesh file stand in the tree; -1 for those that do not."""
        with self._named_faults():
            ids = self._file.triangle_ids()
        places = np.full(self.triangle_count, -1, np.int32)
        is_there = ids < self.triangle_count
        places[ids[is_there]] = np.flatnonzero(is_there)
        return places

    @property
    def loaded_bytes(self) -> int:
        """How many bytes of the data were read so far."""
        return self._file.loaded_bytes

    def loaded_counts(self) -> tuple[int, int]:
        """Return how many triangles and boxes were read so far."""
        return self._file.loaded_counts()

    @property
    def fault(self) -> str | None:
        """What was found wrong last; None where nothing was."""
        return self._file.fault or None

    @contextmanager
    def _named_faults(self) -> Iterator[None]:
        try:
            yield
        except kernels.TreeError as fault:
            raise self._damaged(str(fault)) from fault

    def _damaged(self, fault: str) -> TreeFileError:
        return TreeFileError(self._name, fault, "build it again from the mesh")


def _read_only(values: tuple[object, ...]) -> NDArray[np.float64]:
    array = np.array(values, np.float64)
    array.setflags(write=False)
    return array
