"""What of a legacy VTK file (`.vtk`) is understood: walked keyword by keyword before VTK reads it.

VTK believes counts, follows lists of cells out of their arrays, and ends the process where memory
is short: each count is held against the file first. meshio drops what it does not know. Anything
that is not understood and could carry geometry is refused with its line; attributes of points and
cells come last and are cut off.
"""

from __future__ import annotations

import re
from math import prod
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.text import shown
from obbcli.mesh.formats.vtk.legacy_values import KINDS, Cursor

if TYPE_CHECKING:
    from obbcli.mesh.source import Source

_GRIDS = ("structured_points", "structured_grid", "rectilinear_grid")
_DATA_SETS = ("unstructured_grid", "polydata", *_GRIDS)
#: Lists of cells, and which data sets have them.
_CELLS = {"vertices", "lines", "polygons", "triangle_strips", "cells"}
_COORDINATES = ("x_coordinates", "y_coordinates", "z_coordinates")
#: Three numbers or six, which say nothing about counts but for the extent's.
_NUMBERS = {"origin": 3, "spacing": 3, "aspect_ratio": 3, "extent": 6}
#: Attributes of points and cells, which are all that may follow.
_ATTRIBUTES = ("point_data", "cell_data")
_EMPTY_LINE = re.compile(rb"\n[ \t\r]*\n")
_GHOSTS = b"vtkGhostType"
_LARGEST_GRID = 1 << 24


class Legacy(NamedTuple):
    """What a legacy file says it holds.

    Attributes:
        data_set: its kind, in small letters.
        version: of the format, such as (5, 1).
        point_count: how many points.
        cell_count: how many cells, points and lines among them.
        end: where the attributes begin.
        has_ghosts: whether cells are marked as copies or hidden.
    """

    data_set: str
    version: tuple[int, int]
    point_count: int
    cell_count: int
    end: int
    has_ghosts: bool


def walk_legacy(source: Source) -> Legacy:
    """Return what a legacy file holds, once every count in it fits the file.

    Raises:
        MeshError: no header, a keyword that is not understood, a count that does not fit.
    """
    return _Walk(source).run()


class _Walk(Cursor):
    """Goes through a file keyword by keyword."""

    def __init__(self, source: Source) -> None:
        super().__init__(source)
        self._version, self.is_binary = self._header()
        self._cells: dict[str, int] = {}
        self._types: int | None = None
        self._points: int | None = None
        self._dimensions: list[int] | None = None
        self._coordinates: dict[str, int] = {}

    def run(self) -> Legacy:
        """Walk to the attributes or the end."""
        data_set = ""
        while (keyword := self.keyword()) not in ("", *_ATTRIBUTES):
            if keyword == "dataset" and not data_set:
                data_set = self._data_set()
            elif keyword == "field":
                self._field()
            elif keyword == "metadata":
                self._skip_metadata()
            else:
                self._part(keyword, data_set)
        if not data_set:
            raise self.error("has no DATASET: it holds tables or fields, no mesh")
        return Legacy(
            data_set,
            self._version,
            self._point_count(data_set),
            self._cell_count(data_set),
            self.start if keyword else len(self.data),
            _GHOSTS in self.data,
        )

    def _header(self) -> tuple[tuple[int, int], bool]:
        """Return version and whether values are binary; pass over the title."""
        found = re.match(rb"\s*#\s*vtk\s+datafile\s+version\s+(\d{1,3})\.(\d{1,3})[^\n]*\n[^\n]*\n",
                         self.data, re.IGNORECASE)  # fmt: skip
        if found is None:
            fault = "does not begin with '# vtk DataFile Version' and a title"
            raise self.source.error(fault, "it was cut short", at="1")
        self.at = found.end()
        word = self.keyword()
        if word not in ("ascii", "binary"):
            raise self.error(f"found '{word}', expected ASCII or BINARY")
        return (int(found[1]), int(found[2])), word == "binary"

    def _data_set(self) -> str:
        name = self.keyword()
        if name not in _DATA_SETS:
            raise self.error(f"DATASET {name.upper()} is not read", "export its surface")
        return name

    def _part(self, keyword: str, data_set: str) -> None:
        """Take one part of a data set: points, cells, or what makes a grid."""
        if keyword == "points" and data_set:
            self._points = self.count()
            self.values(3 * self._points, self.kind())
        elif keyword in _CELLS and (keyword == "cells") == (data_set == "unstructured_grid"):
            self._take_cells(keyword)
        elif keyword == "cell_types" and data_set == "unstructured_grid":
            self._types = self.count()
            self.values(self._types, "int")
        elif keyword in _COORDINATES and data_set == "rectilinear_grid":
            self._coordinates[keyword] = self.count()
            self.values(self._coordinates[keyword], self.kind())
        elif keyword == "dimensions" and data_set in _GRIDS:
            self._dimensions = [self.count() for _ in range(3)]
            if prod(self._dimensions) > _LARGEST_GRID:
                x, y, z = self._dimensions
                fault = f"is a grid of {x} x {y} x {z} points, at most {_LARGEST_GRID} are read"
                raise self.error(fault, "extract its surface")
        elif keyword in _NUMBERS and data_set in _GRIDS:
            for _ in range(_NUMBERS[keyword]):
                self.keyword()
        elif keyword == "blanking" and data_set == "structured_grid":
            self.values(self.count(), "int")
        else:
            where = data_set.upper() or "a file without DATASET"
            fault = f"'{shown(keyword.encode())}' is nothing that {where} has"
            raise self.error(fault, "remove it if it is no part of the shape")

    def _take_cells(self, keyword: str) -> None:
        """Take a list of cells: each a count and its points; since version 5 offsets and points."""
        first, second = self.count(), self.count()
        if self._version >= (5, 0):
            self._cells[keyword] = self._take_offsets(keyword, first, second)
            return
        values = self.values(second, "int")
        lengths = values.tolist()
        place = 0
        for _ in range(first):
            if place >= second or not 0 <= lengths[place] < second - place:
                place = -1
                break
            place += int(lengths[place]) + 1
        if place != second:
            fault = f"{keyword.upper()} claims {first} cells of {second} numbers, which do not fit"
            raise self.error(fault, "it was cut short, or its counts are wrong")
        self._cells[keyword] = first

    def _take_offsets(self, keyword: str, offset_count: int, point_count: int) -> int:
        """Take where each cell begins, and the points of all."""
        offsets = np.zeros(0)
        for word, count in (("offsets", offset_count), ("connectivity", point_count)):
            found = self.keyword()
            if found != word:
                raise self.error(f"found '{found}', expected {word.upper()}")
            values = self.values(count, self.kind())
            offsets = values if word == "offsets" else offsets
        if offset_count and (
            offsets[0] != 0 or offsets[-1] != point_count or (np.diff(offsets) < 0).any()
        ):
            raise self.error(f"offsets of {keyword.upper()} do not fit its {point_count} points")
        return max(0, offset_count - 1)

    def _field(self) -> None:
        """Pass over arrays of a field."""
        self.keyword()
        for _ in range(self.count()):
            name = self.keyword()
            if name == "metadata":
                self._skip_metadata()
                name = self.keyword()
            if name == "null_array":
                continue
            count = self.count() * self.count()
            kind = self.keyword()
            if kind not in KINDS:
                raise self.error(f"a field of type {shown(kind.encode())} is not read")
            self.values(count, kind)

    def _skip_metadata(self) -> None:
        """Pass over what ends with an empty line."""
        found = _EMPTY_LINE.search(self.data, self.at)
        self.at = found.end() if found else len(self.data)

    def _point_count(self, data_set: str) -> int:
        if data_set in ("unstructured_grid", "polydata"):
            return self._points or 0
        if self._dimensions is None:
            raise self.error("is a grid without DIMENSIONS")
        given = list(self._coordinates.values()) if self._coordinates else None
        points = prod(self._dimensions)
        if given not in (None, self._dimensions) or self._points not in (None, points):
            raise self.error("the grid's DIMENSIONS do not fit its points")
        return points

    def _cell_count(self, data_set: str) -> int:
        if data_set in _GRIDS:
            assert self._dimensions is not None
            return prod(max(1, side - 1) for side in self._dimensions) * (min(self._dimensions) > 0)
        count = sum(self._cells.values())
        if data_set == "unstructured_grid" and count != (self._types or 0):
            raise self.error(f"claims {count} cells and {self._types or 0} types of them")
        return count
