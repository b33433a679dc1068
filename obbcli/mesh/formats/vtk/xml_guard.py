"""What of a VTK XML file (`.vtu`, `.vtp`, ...) is understood: walked before VTK reads it.

VTK believes counts and offsets, and ends the process where memory is short; meshio drops pieces and
cells. Each element is known or refused with its line, and every array that makes or places surface
is unpacked and held against the counts of its piece.
"""

from __future__ import annotations

import re
from math import prod
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from obbcli.mesh.formats.text import shown
from obbcli.mesh.formats.vtk.arrays import KINDS, ArrayFault, binary_values, text_values
from obbcli.mesh.formats.vtk.xml_walk import CELLS, CUT, GRIDS, Array, Piece, Walk

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.source import Source

#: Arrays of polyhedra, whose lengths no count tells.
_OF_FACES = (
    *("faces", "faceoffsets", "face_connectivity", "face_offsets"),
    *("polyhedron_to_faces", "polyhedron_offsets"),
)
_LARGEST_GRID = 1 << 24
_FLOAT = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?")


class Xml(NamedTuple):
    """What a VTK XML file says it holds.

    Attributes:
        data_set: its kind, as VTK spells it.
        piece_count: of how many pieces it is made.
        point_count: how many points all pieces have.
        cell_count: how many cells, points and lines among them.
        text: the file without its field data, which VTK would read and no surface needs.
    """

    data_set: str
    piece_count: int
    point_count: int
    cell_count: int
    text: bytes


def walk_xml(source: Source) -> Xml:
    """Return what a VTK XML file holds, once every count in it fits its arrays.

    Raises:
        MeshError: no XML, an element that is not understood, a count or offset that does not fit.
    """
    walk = Walk(source)
    walk.run()
    points = cells = 0
    for piece in walk.pieces:
        checked = _PieceCheck(source, walk, piece)
        points += checked.points()
        cells += checked.cells()
    if walk.data_set in GRIDS:
        _PieceCheck(source, walk, walk.whole).whole_grid(cells)
    return Xml(walk.data_set, len(walk.pieces), points, cells, walk.text())


class _PieceCheck:
    """Holds the arrays of one piece against its counts."""

    def __init__(self, source: Source, walk: Walk, piece: Piece) -> None:
        self._source = source
        self._walk = walk
        self._piece = piece

    def points(self) -> int:
        """Return how many points the piece has."""
        if self._walk.data_set in GRIDS:
            sides = self._sides()
            for section, wanted in (("Points", [3 * prod(sides)]), ("Coordinates", sides)):
                arrays = [each for each in self._piece.arrays if each.section == section]
                if arrays and len(arrays) != len(wanted):
                    raise self._error(f"{len(arrays)} arrays in {section}, not {len(wanted)}")
                for array, count in zip(arrays, wanted, strict=bool(arrays)):
                    self._values(array, count)
            return prod(sides)
        count = self._count("NumberOfPoints")
        for array in self._piece.arrays:
            if array.section == "Points":
                self._values(array, 3 * count)
        return count

    def cells(self) -> int:
        """Return how many cells the piece has."""
        if self._walk.data_set in GRIDS:
            return prod(max(1, side - 1) for side in self._sides())
        names = ("Cells",) if self._walk.data_set == "UnstructuredGrid" else tuple(CELLS)[1:]
        return sum(self._cells_of(name) for name in names)

    def whole_grid(self, cell_count: int) -> None:
        """Hold what is said of a whole grid against the cells of its pieces."""
        for name, count in (("Origin", 3), ("Spacing", 3), ("Direction", 9)):
            words = self._piece.attributes.get(name, "0 " * count).split()
            if len(words) != count or not all(map(_FLOAT.fullmatch, words)):
                raise self._error(f"{name} is not {count} numbers")
        whole = self.cells()
        if whole != cell_count:
            raise self._error(f"WholeExtent has {whole} cells, and its pieces {cell_count}")

    def _cells_of(self, section: str) -> int:
        count = self._count(CELLS[section])
        arrays = {
            each.attributes.get("Name"): each
            for each in self._piece.arrays
            if each.section == section
        }
        if not count and not arrays:
            return 0
        if "connectivity" not in arrays or "offsets" not in arrays:
            raise self._error(f"<{section}> lacks its connectivity or offsets")
        connectivity = self._values(arrays.pop("connectivity"), None)
        offsets = self._values(arrays.pop("offsets"), count).astype(np.float64)
        ends = np.concatenate([[0.0], offsets])
        if (np.diff(ends) < 0).any() or ends[-1] > len(connectivity):
            raise self._error(f"offsets of <{section}> do not fit {len(connectivity)} points")
        for name, array in arrays.items():
            if name == "types":
                self._values(array, count)
            elif name in _OF_FACES:
                self._values(array, None)
            else:
                raise self._error(f"<{section}> has an array '{name}', which is not read")
        return count

    def _values(self, array: Array, count: int | None) -> NDArray[Any]:
        """Return an array's values; `count` is how many there must be, None for any number."""
        kind = KINDS.get(array.attributes.get("type", ""))
        form = array.attributes.get("format", "ascii")
        components = array.attributes.get("NumberOfComponents", "1").strip()
        try:
            if components != ("3" if array.section == "Points" else "1"):
                raise ArrayFault(f"has {shown(components.encode())} components")
            if kind is None:
                raise ArrayFault("is of a type that is not read")
            if form == "ascii":
                values = text_values(array.text, kind)
            elif form == "binary":
                values = binary_values(array.text.strip(), self._walk.coding, kind, is_base64=True)
            else:
                data, is_base64 = self._appended(array)
                values = binary_values(data, self._walk.coding, kind, is_base64=is_base64)
            if count is not None and len(values) != count:
                raise ArrayFault(f"has {len(values)} values, not {count}")
        except ArrayFault as fault:
            name = shown(array.attributes.get("Name", array.section).encode())
            raise self._walk.error(f"array '{name}' {fault}", CUT, array.line) from fault
        return values

    def _appended(self, array: Array) -> tuple[memoryview, bool]:
        if self._walk.appended is None:
            raise ArrayFault("lies in appended data, and there are none")
        start, is_base64 = self._walk.appended
        offset = array.attributes.get("offset", "")
        if not (offset.isascii() and offset.isdigit()) or len(offset) > 18:
            raise ArrayFault("has no offset in the appended data")
        return memoryview(self._source.data)[start + int(offset) :], is_base64

    def _count(self, name: str) -> int:
        text = self._piece.attributes.get(name, "0").strip()
        most = 1100 * len(self._source.data)
        if not (text.isascii() and text.isdigit()) or len(text) > 18 or int(text) > most:
            raise self._error(f"{name} is '{shown(text.encode())}', which the file cannot hold")
        return int(text)

    def _sides(self) -> list[int]:
        """Return how many points a grid has along each axis."""
        name = "WholeExtent" if self._piece is self._walk.whole else "Extent"
        words = self._piece.attributes.get(name, "").split()
        if len(words) != 6 or not all(re.fullmatch(r"-?\d{1,9}", word) for word in words):
            raise self._error(f"has no {name} of six whole numbers")
        ends = list(map(int, words))
        sides = [1 + high - low for low, high in zip(ends[::2], ends[1::2], strict=True)]
        if min(sides) < 1 or prod(sides) > _LARGEST_GRID:
            x, y, z = sides
            fault = f"is a grid of {x} x {y} x {z} points, at most {_LARGEST_GRID} are read"
            raise self._walk.error(fault, "extract its surface", self._piece.line)
        return sides

    def _error(self, fault: str) -> MeshError:
        return self._walk.error(fault, CUT, self._piece.line)
