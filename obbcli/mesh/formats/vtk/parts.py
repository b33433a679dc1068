"""The parts of a VTK file: the blocks of an index (`.vtm`), by the names of all above them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from obbcli.mesh.formats.vtk.blocks import Blocks
from obbcli.mesh.formats.vtk.reader import is_index, read_vtk, read_xml
from obbcli.mesh.parts.placed import PlacedPart, UniquePaths, whole

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.source import Source


def parts_vtk(source: Source) -> Iterator[PlacedPart]:
    """Yield the blocks of an index, or the whole of any other file.

    Raises:
        MeshError: as `read_vtk`; what is wrong with a block's own file, when it is decoded.
    """
    if not is_index(source):
        yield from whole(read_vtk, source)
        return
    blocks = Blocks(source, read_xml)
    paths = UniquePaths()
    for block in blocks.files:
        path = paths.take("/".join(block.path))
        # Only the file itself says whether it has a surface.
        yield PlacedPart(path, block.file, partial(blocks.of, block), None, True, "block")
