"""`TreeHead`: what the header of a tree file tells, which is all that bounds need."""

from __future__ import annotations

import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from obbcli.errors import TreeFileError
from obbcli.tree.header import read_header
from obbcli.tree.tree import ObbTree

if TYPE_CHECKING:
    from numpy.typing import NDArray


class TreeHead:
    """A tree file that is closed again: a scene may have more of them than can be open at a time.

    Args:
        path: the file.
        verify: whether the checksums of its data are compared when it is opened again.

    Attributes:
        triangle_count: how many triangles its mesh has.
        node_count: how many boxes it holds.
        notes: what of the mesh file was taken with a change, a sentence each.
        unit: the length of 1 that the mesh file states, or None.
        parts: the parts of the mesh file that were selected, with their rows.
        sag: how far triangles are from exact surfaces at most, mesh units; None: there are none.

    Raises:
        TreeFileError: no tree file, another version, or damaged in its header.
        OSError: the file cannot be read.
    """

    def __init__(self, path: str | os.PathLike[str], *, verify: bool) -> None:
        self._path = path
        self._verify = verify
        with Path(path).open("rb") as file:
            header = read_header(file, os.fspath(path))
            self._identity = _identity(os.fstat(file.fileno()))
        self._surface = header.surface
        self.triangle_count = header.triangle_count
        self.node_count = header.node_count
        self.notes = header.description.notes
        self.unit = header.description.unit
        self.parts = header.description.parts
        self.sag = header.description.sag

    @cached_property
    def bounds(self) -> NDArray[np.float64]:
        """Lower and upper corner of the mesh's axis-aligned box, (2, 3), mesh units."""
        return np.array(self._surface.bounds)

    @cached_property
    def surface_centroid(self) -> NDArray[np.float64]:
        """Area-weighted centroid of the surface, (3,)."""
        return np.array(self._surface.surface_centroid)

    def open(self) -> ObbTree:
        """Return the tree.

        Raises:
            TreeFileError: the file is damaged, or another one than before.
            OSError: the file cannot be read.
        """
        tree = ObbTree.open(self._path, verify=self._verify)
        if _identity(Path(self._path).stat()) != self._identity:
            fault = "was written to since its bounds were read"
            raise TreeFileError(os.fspath(self._path), fault, "ask again")
        return tree


def _identity(status: os.stat_result) -> tuple[int, ...]:
    """Return what changes with a file's bytes."""
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns
