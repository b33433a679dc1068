"""The parts of a VTK file: the blocks of an index (`.vtm`), by the names of all above them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from obbcli.mesh.formats.vtk.blocks import blocks_of
from obbcli.mesh.formats.vtk.reader import is_index, read_vtk, read_xml
from obbcli.mesh.parts.placed import PlacedPart, UniquePaths, whole

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.source import MeshArrays, Source


def parts_vtk(source: Source) -> Iterator[PlacedPart]:
    """Yield the blocks of an index that have a surface, or the whole of any other file.

    Raises:
        MeshError: as `read_vtk`; all blocks are read, so that their notes are told.
    """
    if not is_index(source):
        yield from whole(read_vtk, source)
        return
    paths = UniquePaths()
    for block, arrays in list(blocks_of(source, read_xml)):
        if len(arrays[1]):
            path = paths.take("/".join(block.path))
            yield PlacedPart(path, block.file, partial(_same, arrays))


def _same(arrays: MeshArrays) -> MeshArrays:
    return arrays
