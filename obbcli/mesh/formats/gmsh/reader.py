"""Gmsh (`.msh`), versions 2 and 4, text and binary of both byte orders, read by our own reader.

meshio takes node 0 for the last one, lists of wedges and pyramids of second order in another order,
and of several sections of one name the last.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from obbcli.mesh.formats.cells.surface import Block, surface
from obbcli.mesh.formats.gmsh.values import BinaryValues, GmshFault, TextValues, Values

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.source import MeshArrays, Source

    Ints = NDArray[np.int64]

Result = TypeVar("Result")


class _Element(NamedTuple):
    """A type of elements: its name in `cell_types`, and its nodes in VTK's order."""

    kind: str
    order: list[int]


#: By Gmsh's numbers. Those of third order and above are refused.
_ELEMENTS = {
    1: _Element("line", [*range(2)]),
    2: _Element("triangle", [*range(3)]),
    3: _Element("quad", [*range(4)]),
    4: _Element("tetra", [*range(4)]),
    5: _Element("hexahedron", [*range(8)]),
    6: _Element("wedge", [*range(6)]),
    7: _Element("pyramid", [*range(5)]),
    8: _Element("line3", [*range(3)]),
    9: _Element("triangle6", [*range(6)]),
    10: _Element("quad9", [*range(9)]),
    11: _Element("tetra10", [*range(8), 9, 8]),
    12: _Element(
        "hexahedron27",
        [*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26],
    ),
    13: _Element("wedge18", [*range(6), 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16]),
    14: _Element("pyramid14", [*range(5), 5, 8, 10, 6, 7, 9, 11, 12, 13]),
    15: _Element("vertex", [0]),
    16: _Element("quad8", [*range(8)]),
    17: _Element("hexahedron20", [*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15]),
    18: _Element("wedge15", [*range(6), 6, 9, 7, 12, 14, 13, 8, 10, 11]),
    19: _Element("pyramid13", [*range(5), 5, 8, 10, 6, 7, 9, 11, 12]),
    26: _Element("line4", [*range(4)]),
    27: _Element("line5", [*range(5)]),
    28: _Element("line6", [*range(6)]),
}
_SECTION = re.compile(rb"^[ \t]*\$(?!End)(\w+)[ \t\r]*\n", re.MULTILINE)
_HEADER = re.compile(rb"\s*(\d{1,4})(?:\.(\d{1,4}))?[ \t]+([01])[ \t]+(\d+)[ \t\r]*\n")
_CUT = "it was cut short, or its counts are wrong"


def read_gmsh(source: Source) -> MeshArrays:
    """Return points and triangles of a Gmsh file.

    Sections that the format does not know are comments, by its manual; so are names, entities,
    periodic links and results here.

    Raises:
        MeshError: another version, a count that does not fit, a node that is not there.
    """
    if not source.data.lstrip().startswith(b"$"):
        fault = "is no Gmsh file; Fluent's files of the same suffix are not read"
        raise source.error(fault, "export its surface, such as STL")
    return _Reader(source).read()


class _Reader:
    """Reads one file, section by section."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._data = source.data
        self._sections = self._find_sections()
        self._version, self._is_binary, self._order = self._header()

    def read(self) -> MeshArrays:
        """Return points and triangles."""
        (tags, points), line = self._taken("Nodes", self._nodes)
        rows = np.argsort(tags, kind="stable")
        ordered = tags[rows]
        twice = np.flatnonzero(ordered[1:] == ordered[:-1])
        if len(twice):
            raise self._error(f"node {ordered[twice[0]]} is there twice", line)
        elements, line = self._taken("Elements", self._elements)
        blocks = [self._block(block, ordered, rows, line) for block in elements]
        return points, surface(self._source, points, blocks)

    def _taken(self, name: str, take: Callable[[Values], Result]) -> tuple[Result, str]:
        """Return what a section holds, and its line."""
        values, line = self._section(name)
        try:
            return take(values), line
        except GmshFault as fault:
            raise self._source.error(f"${name} {fault}", _CUT, at=line) from fault

    def _find_sections(self) -> dict[str, int]:
        """Return where the content of each section begins; a section's end is its own."""
        found: dict[str, int] = {}
        at = 0
        while (start := _SECTION.search(self._data, at)) is not None:
            name = start[1].decode("ascii", "replace")
            if name in found and name in ("MeshFormat", "Nodes", "Elements"):
                fault = f"has a second section ${name}"
                raise self._source.error(fault, "merge the sections", at=self._line(start.start()))
            found[name] = start.end()
            end = re.compile(rb"\$End%b\b" % start[1]).search(self._data, start.end())
            if end is None:
                fault = f"section ${name} does not end"
                remedy = "it was cut short"
                raise self._source.error(fault, remedy, at=self._line(start.start()))
            at = end.end()
        return found

    def _header(self) -> tuple[tuple[int, int], bool, str]:
        """Return version, whether values are binary, and their byte order."""
        if "NOD" in self._sections or "MeshFormat" not in self._sections:
            known = "NOD" in self._sections
            fault = "is of Gmsh's version 1" if known else "has no section $MeshFormat"
            raise self._source.error(fault, "save it again as version 4.1", at="1")
        start = self._sections["MeshFormat"]
        found = _HEADER.match(self._data, start)
        if found is None:
            what = "has no version, file type and data size after $MeshFormat"
            raise self._source.error(what, _CUT, at=self._line(start))
        version = int(found[1]), int(found[2] or (0 if found[1] == b"2" else 1))
        if version[0] not in (2, 4) or (version[0] == 4 and version[1] > 1):
            shown = f"{found[1].decode()}.{version[1]}"
            fault = f"is of version {shown}, 2 and 4.0 to 4.1 are read"
            raise self._source.error(fault, "save it again as version 4.1", at=self._line(start))
        one = self._data[found.end() : found.end() + 4]
        if found[3] == b"0" or one == b"\1\0\0\0":
            return version, found[3] == b"1", "<"
        if one != b"\0\0\0\1":
            fault = "has no number 1 that tells the order of its bytes"
            raise self._source.error(fault, _CUT, at=self._line(start))
        return version, True, ">"

    def _section(self, name: str) -> tuple[Values, str]:
        """Return the values of a section, and its line."""
        start = self._sections.get(name)
        if start is None:
            raise self._source.error(f"has no section ${name}", "it was cut short, or is no mesh")
        end = self._data.index(b"$End" + name.encode(), start)
        line = self._line(start - 1)
        if self._is_binary:
            # Version 2 has its counts as text.
            return BinaryValues(self._data, start, self._order, self._version), line
        try:
            return TextValues(self._data[start:end], self._version), line
        except GmshFault as fault:
            raise self._source.error(f"${name} {fault}", _CUT, at=line) from fault

    def _nodes(self, values: Values) -> tuple[Ints, NDArray[np.float64]]:
        """Return the nodes' tags and places."""
        if self._version[0] == 2:
            count = values.first_count()
            return values.tagged_points(count)
        block_count, count = values.totals()
        tags, points = [np.zeros(0, np.int64)], [np.zeros((0, 3))]
        for _ in range(block_count):
            dimension, _, parametric = values.ints(3).tolist()
            size = values.size()
            if self._version[1] == 0:
                if parametric:
                    raise GmshFault("has parametric nodes, which are not read in version 4.0")
                some, places = values.tagged_points(size)
            else:
                some = values.sizes(size)
                width = 3 + (dimension if parametric else 0)
                places = values.doubles(width * size).reshape(-1, width)[:, :3]
            tags.append(some)
            points.append(places)
        if sum(map(len, tags)) != count:
            raise GmshFault(f"claims {count} nodes, and {sum(map(len, tags))} follow")
        return np.concatenate(tags), np.concatenate(points)

    def _elements(self, values: Values) -> list[tuple[int, Ints]]:
        """Return the elements, of one type at a time: its number and their nodes."""
        blocks = []
        if self._version[0] == 2:
            count = left = values.first_count()
            while left:
                kind, rows = values.run(left, self._width)
                blocks.append((kind, rows))
                left -= len(rows)
        else:
            block_count, count = values.totals()
            for _ in range(block_count):
                kind = int(values.ints(3)[2])
                size = values.size()
                width = 1 + self._width(kind)
                rows = values.tags(width * size).reshape(size, width)
                blocks.append((kind, rows[:, 1:]))
        found = sum(len(rows) for _, rows in blocks)
        if found != count or not values.is_at_end():
            more = "" if found != count else " and something more"
            raise GmshFault(f"claims {count} elements, and {found}{more} follow")
        return blocks

    def _width(self, kind: int) -> int:
        """Return how many nodes an element of a type has."""
        if kind not in _ELEMENTS:
            raise GmshFault(f"elements of Gmsh's type {kind} are not read (third order or above)")
        return len(_ELEMENTS[kind].order)

    def _block(self, block: tuple[int, Ints], ordered: Ints, rows: Ints, line: str) -> Block:
        """Return elements with rows of points instead of tags."""
        kind, tags = block
        places = np.minimum(np.searchsorted(ordered, tags), max(0, len(ordered) - 1))
        if len(ordered) == 0 or (missing := ordered[places] != tags).any():
            tag = tags.ravel()[0] if len(ordered) == 0 else tags[missing][0]
            raise self._error(f"an element uses node {tag}, which the file does not have", line)
        element = _ELEMENTS[kind]
        return Block(element.kind, rows[places][:, element.order])

    def _error(self, fault: str, line: str) -> MeshError:
        return self._source.error(fault, "export it again", at=line)

    def _line(self, position: int) -> str:
        return str(self._data.count(b"\n", 0, position) + 1)
