"""The elements of a VTK XML file, each known or refused with its line; arrays are left packed."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple
from xml.parsers import expat

from obbcli.mesh.formats.text import shown
from obbcli.mesh.formats.vtk.arrays import KINDS, Coding

if TYPE_CHECKING:
    from obbcli.errors import MeshError
    from obbcli.mesh.source import Source

CUT = "it was cut short, or its counts are wrong"
#: Lists of cells with the attribute of a piece that counts them.
CELLS = {
    "Cells": "NumberOfCells",
    "Verts": "NumberOfVerts",
    "Lines": "NumberOfLines",
    "Strips": "NumberOfStrips",
    "Polys": "NumberOfPolys",
}
GRIDS = ("ImageData", "StructuredGrid", "RectilinearGrid")
DATA_SETS = ("UnstructuredGrid", "PolyData", *GRIDS)
#: What may stand in what. Attributes of points and cells may hold anything.
_INSIDE = {
    "": {"VTKFile"},
    "VTKFile": {*DATA_SETS, "AppendedData", "FieldData"},
    **{name: {"Piece", "FieldData"} for name in DATA_SETS},
    "Piece": {"PointData", "CellData", "FieldData", "Points", "Coordinates", *CELLS},
    **{name: {"DataArray"} for name in ("Points", "Coordinates", *CELLS)},
    "DataArray": {"InformationKey"},
    "InformationKey": {"Value"},
}
_ATTRIBUTES = ("PointData", "CellData", "FieldData")


class Array(NamedTuple):
    """One array of a piece that makes or places surface."""

    section: str
    attributes: dict[str, str]
    line: int
    text: bytes


class Piece(NamedTuple):
    """One piece of a data set."""

    attributes: dict[str, str]
    line: int
    arrays: list[Array]


class Walk:
    """Goes through the elements of a file.

    Attributes:
        data_set: its kind.
        coding: how it writes arrays.
        whole: what the file says of all pieces.
        pieces: its pieces with their arrays.
        appended: where appended values begin, and whether they are base64; None for none.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        self._data = source.data
        self._path: list[str] = []
        self._letters: list[str] = []
        self._fields: list[tuple[int, int]] = []
        self._parser = expat.ParserCreate()
        self.data_set = ""
        self.coding = Coding("<", "u4", "")
        self.whole = Piece({}, 1, [])
        self.pieces: list[Piece] = []
        self.appended: tuple[int, bool] | None = None

    def run(self) -> None:
        """Walk through all of it."""
        if re.search(rb"<!(DOCTYPE|ENTITY)", self._data):
            raise self._source.error("declares a document type", "remove the <!DOCTYPE ...>")
        parser = self._parser
        parser.buffer_text = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._take_letters
        place = self._data.find(b"<AppendedData")
        tag_end = self._data.find(b">", place) + 1 if place >= 0 else len(self._data)
        try:
            parser.Parse(self._data[:tag_end], place < 0)
        except expat.ExpatError as fault:
            words = expat.ErrorString(fault.code) if fault.code else "no XML"
            raise self._source.error(
                f"is no whole XML: {words}", "it was cut short or damaged", at=str(fault.lineno)
            ) from fault
        if not self.data_set:
            raise self._source.error("has no element <VTKFile> with a type", CUT)
        if place >= 0 and self.appended is not None:
            start = self._data.find(b"_", tag_end) + 1
            if start == 0 or self._data[tag_end : start - 1].strip():
                raise self._source.error("its appended data do not begin with '_'", CUT)
            self.appended = (start, self.appended[1])

    def text(self) -> bytes:
        """Return the file without its field data."""
        parts, at = [], 0
        for start, end in self._fields:
            parts.append(self._data[at:start])
            at = self._data.find(b">", end) + 1
        return b"".join([*parts, self._data[at:]])

    def error(self, fault: str, remedy: str, line: int) -> MeshError:
        """Return an error with its line."""
        return self._source.error(fault, remedy, at=str(line))

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        line = self._parser.CurrentLineNumber
        parent = self._path[-1] if self._path else ""
        self._path.append(name)
        if any(each in _ATTRIBUTES for each in self._path[:-1]):
            return
        if name not in _INSIDE.get(parent, ()):
            fault = f"<{shown(name.encode())}> is nothing that <{parent or 'the file'}> has"
            raise self.error(fault, "remove it if it is no part of the shape", line)
        if name == "VTKFile":
            self._take_root(attributes, line)
        elif name == "Piece":
            self.pieces.append(Piece(attributes, line, []))
        elif name == "AppendedData":
            self.appended = (0, attributes.get("encoding") == "base64")
        elif name == "DataArray":
            self.pieces[-1].arrays.append(Array(parent, attributes, line, b""))
            self._letters.clear()
        elif name == "FieldData":
            self._fields.append((self._parser.CurrentByteIndex, 0))
        elif parent == "VTKFile":
            if name != self.data_set:
                raise self.error(f"holds <{name}>, but says that it is {self.data_set}", "", line)
            self.whole = Piece(attributes, line, [])

    def _end(self, name: str) -> None:
        self._path.pop()
        if name == "FieldData" and not any(each in _ATTRIBUTES for each in self._path):
            self._fields[-1] = (self._fields[-1][0], self._parser.CurrentByteIndex)
        elif name == "DataArray" and not any(each in _ATTRIBUTES for each in self._path):
            arrays = self.pieces[-1].arrays
            arrays[-1] = arrays[-1]._replace(text="".join(self._letters).encode())

    def _take_letters(self, letters: str) -> None:
        """Keep what stands in an array itself, and not in what describes it."""
        if self._path and self._path[-1] == "DataArray":
            self._letters.append(letters)

    def _take_root(self, attributes: dict[str, str], line: int) -> None:
        self.data_set = attributes.get("type", "")
        if self.data_set not in DATA_SETS:
            fault = f"holds a '{shown(self.data_set.encode())}', which is not read"
            raise self.error(fault, "export its surface as PolyData (.vtp)", line)
        order = "<" if attributes.get("byte_order", "LittleEndian") == "LittleEndian" else ">"
        header = attributes.get("header_type", "UInt32")
        if header not in ("UInt32", "UInt64"):
            fault = f"header_type is '{shown(header.encode())}', expected UInt32 or UInt64"
            raise self.error(fault, "export it again", line)
        self.coding = Coding(order, KINDS[header], attributes.get("compressor", ""))
