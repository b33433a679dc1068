"""Files called .inp: Abaqus and CalculiX decks, or AVS UCD meshes, told by how they begin."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.mesh.formats.abaqus.reader import parts_abaqus, read_abaqus
from obbcli.mesh.formats.ucd import begins_as_ucd, read_ucd
from obbcli.mesh.parts.placed import whole

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.mesh.parts.placed import PlacedPart
    from obbcli.mesh.source import MeshArrays, Source


def read_inp(source: Source) -> MeshArrays:
    """Return the surface of a deck or of a UCD mesh.

    Raises:
        MeshError: as in `read_abaqus` and `read_ucd`.
    """
    if begins_as_ucd(source.data):
        return read_ucd(source)
    return read_abaqus(source)


def parts_inp(source: Source) -> Iterable[PlacedPart]:
    """Return the parts of a deck, or all of a UCD mesh.

    Raises:
        MeshError: as in `parts_abaqus` and `read_ucd`.
    """
    if begins_as_ucd(source.data):
        return whole(read_ucd, source)
    return parts_abaqus(source)
