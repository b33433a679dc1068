"""SU2's native meshes (.su2), read by our own reader: every zone, with its markers.

meshio reads one zone of several. The format: https://su2code.github.io/docs_v7/Mesh-File/.
"""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.cells.parts import CellPart, joined_surface
from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.formats.number_rows import blank_rows, whole_numbers
from obbcli.mesh.formats.text import shown, strip_mark, whole
from obbcli.mesh.parts.placed import PlacedPart, UniquePaths

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.number_rows import Rows
    from obbcli.mesh.source import MeshArrays, Source

#: Cells by VTK's number of their type, with their counts of nodes; None for those without surface.
_CELLS: dict[int, tuple[str | None, int]] = {
    1: (None, 1),
    3: (None, 2),
    5: ("triangle", 3),
    9: ("quad", 4),
    10: ("tetra", 4),
    12: ("hexahedron", 8),
    13: ("wedge", 6),
    14: ("pyramid", 5),
}
#: What makes no part of the mesh: flow angles, periodic copies, boxes of free-form deformation.
_PASSED_OVER = re.compile(
    rb"AOA|AOS|NMARK|MARKER_TAG|SEND_RECV|NPERIODIC|PERIODIC_\w+|NCHUNK|CHUNK_\w+|FFD_\w+"
)
_KEYWORD = re.compile(rb"^[ \t]*([A-Za-z_]\w*)[ \t]*=[ \t]*([^\n]*)", re.MULTILINE)
_COMMENT = re.compile(rb"%[^\n]*")


class _Section(NamedTuple):
    """Holds a keyword, its value, and the lines that follow up to the next keyword."""

    keyword: bytes
    value: bytes
    line: int
    lines: list[bytes]


class _Zone:
    """Holds what a zone has so far; what is None has not come yet."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.dimension: int | None = None
        self.points: NDArray[np.float64] | None = None
        self.elements: list[Rows] = []
        self.sections: list[_Section] = []

    @property
    def is_begun(self) -> bool:
        """Return whether the file has keywords of it that make points or elements."""
        return any(not _PASSED_OVER.fullmatch(each.keyword) for each in self.sections)


def read_su2(source: Source) -> MeshArrays:
    """Return the surface of all zones: markers and flat cells, then what else bounds volumes.

    Raises:
        MeshError: an unknown keyword or cell, counts that do not fit, a point that is not there;
            with the line.
    """
    return joined_surface(source, [_part(source, zone) for zone in _zones(source)])


def parts_su2(source: Source) -> Iterator[PlacedPart]:
    """Yield the zones of a file by their numbers; what a zone holds is read when it is decoded.

    Raises:
        MeshError: as `read_su2`; what is wrong in a zone, when it is decoded.
    """
    paths = UniquePaths()
    for zone in _zones(source):
        yield PlacedPart(paths.take(zone.name), id(zone), partial(_decoded, source, zone))


def _decoded(source: Source, zone: _Zone) -> MeshArrays:
    return joined_surface(source, [_part(source, zone)])


def _zones(source: Source) -> list[_Zone]:
    """Return the zones of a file, each with its keywords, which are not read yet."""
    zones, claimed = [_Zone("")], None
    for section in _sections(source):
        if section.keyword == b"IZONE":
            _passed_over(source, section)
            zones.append(_Zone(section.value.decode("latin-1")))
        elif section.keyword == b"NZONE":
            claimed = section
        else:
            zones[-1].sections.append(section)
    # What is passed over before the first zone may be damaged, too.
    for zone in zones:
        for section in zone.sections if not zone.is_begun else ():
            _take(source, zone, section)
    found = [zone for zone in zones if zone.is_begun]
    if claimed is not None and _count(source, claimed) != len(found):
        raise _cut_short(source, claimed, f"{len(found)} zones")
    if not found:
        raise source.error("has no NDIME, which begins an SU2 mesh", "export it again")
    return found


def _sections(source: Source) -> list[_Section]:
    """Return a file's keywords in order."""
    data = strip_mark(source.data)
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if b"%" in data:
        data = _COMMENT.sub(b"", data)
    found = list(_KEYWORD.finditer(data))
    head = data[: found[0].start()] if found else data
    if head.strip():
        at = head[: len(head) - len(head.lstrip())].count(b"\n") + 1
        fault = f"'{shown(head.split()[0])}' before the first keyword"
        raise source.error(fault, "an SU2 mesh begins with NDIME= or NZONE=", at=str(at))
    sections, line, seen = [], 1, 0
    ends = [*(match.start() for match in found[1:]), len(data)]
    for match, end in zip(found, ends, strict=False):
        line += data.count(b"\n", seen, match.start())
        seen = match.start()
        lines = data[match.end() + 1 : end].split(b"\n")
        sections.append(_Section(match[1].upper(), match[2].strip(), line, lines))
    return sections


def _take(source: Source, zone: _Zone, section: _Section) -> None:
    """Take one keyword of a zone."""
    keyword, line = section.keyword, str(section.line)
    if keyword == b"NDIME":
        zone.dimension = _count(source, section)
        if zone.dimension not in (2, 3):
            raise source.error(f"NDIME= {zone.dimension}", "2 or 3 dimensions are read", at=line)
        _passed_over(source, section)
    elif keyword == b"NPOIN":
        if zone.points is not None or zone.dimension is None:
            fault = "NPOIN before NDIME, or a second time"
            raise source.error(fault, "begin each zone with IZONE= and NDIME=", at=line)
        zone.points = _points(source, section, zone.dimension)
    elif keyword in (b"NELEM", b"MARKER_ELEMS"):
        if zone.dimension is None:
            raise source.error(f"{keyword.decode()} before NDIME", "write NDIME first", at=line)
        zone.elements.append(_rows(source, section))
    elif _PASSED_OVER.fullmatch(keyword):
        if not keyword.startswith((b"FFD_", b"PERIODIC_", b"CHUNK_")):
            _passed_over(source, section)
    else:
        fault = f"the keyword {shown(keyword)} is not known"
        raise source.error(fault, "remove it if it makes no part of the mesh", at=line)


def _passed_over(source: Source, section: _Section) -> None:
    """Refuse lines after a keyword that has none: they belong to something not understood."""
    for number, content in enumerate(section.lines, start=section.line + 1):
        if content.strip():
            fault = f"'{shown(content.strip())}' after {shown(section.keyword)}, which has no lines"
            raise source.error(fault, "write the file again", at=str(number))


def _count(source: Source, section: _Section) -> int:
    """Return a count; a second number (points without halo) is another's."""
    words = section.value.split() or [b""]
    return whole(source, words[0], section.line, f"{shown(section.keyword)}=")


def _rows(source: Source, section: _Section) -> Rows:
    """Return the lines of a keyword, which are as many as it says."""
    rows = blank_rows(source, section.lines, section.line + 1)
    if len(rows.counts) != _count(source, section):
        raise _cut_short(source, section, f"{len(rows.counts)} lines")
    return rows


def _cut_short(source: Source, section: _Section, found: str) -> MeshError:
    fault = f"{shown(section.keyword)}= {shown(section.value)}, but {found} follow"
    return source.error(fault, "it was cut short, or its counts are wrong", at=str(section.line))


def _points(source: Source, section: _Section, dimension: int) -> NDArray[np.float64]:
    """Return the points of a zone, (V, 3); flat zones lie at z = 0.

    A number after the coordinates is the point's own; SU2 counts points as they come.
    """
    rows = _rows(source, section)
    wrong = (rows.counts != dimension) & (rows.counts != dimension + 1)
    if wrong.any():
        at = int(np.argmax(wrong))
        fault = f"a point of {rows.counts[at]} numbers, {dimension} wanted"
        raise source.error(fault, "write the file again", at=str(int(rows.lines[at])))
    table = rows.table(dimension + 1)
    numbered = rows.counts == dimension + 1
    other = numbered & (table[:, dimension] != np.arange(len(table)))
    if other.any():
        at = int(np.argmax(other))
        fault = f"point {at} is numbered {table[at, dimension]:.17g}"
        raise source.error(fault, "number points from 0 in order", at=str(int(rows.lines[at])))
    points = np.zeros((len(table), 3))
    points[:, :dimension] = table[:, :dimension]
    if not np.isfinite(points).all():
        at = int(np.argmin(np.isfinite(points).all(axis=1)))
        fault = f"point {at} is not finite"
        raise source.error(fault, "coordinates must be finite", at=str(int(rows.lines[at])))
    return points


def _part(source: Source, zone: _Zone) -> CellPart:
    """Return the cells of a zone, markers first.

    Raises:
        MeshError: as `read_su2`.
    """
    while zone.sections:
        _take(source, zone, zone.sections[0])
        del zone.sections[0]
    if zone.points is None:
        raise source.error(f"zone '{zone.name}' has no NPOIN", "it was cut short")
    blocks: list[Block] = []
    count = 0
    for rows in [*zone.elements[1:], *zone.elements[:1]]:
        blocks += _blocks(source, rows, count, len(zone.points))
        count += len(rows.counts)
    return CellPart(zone.name, zone.points, blocks)


def _blocks(source: Source, rows: Rows, first: int, point_count: int) -> Iterator[Block]:
    """Yield elements by type: each line has type, points, and the element's number or none."""
    values = whole_numbers(source, rows, rows.values, "a number of an element")
    starts = rows.starts
    types = values[starts]
    for kind in np.unique(types).tolist():
        chosen = np.flatnonzero(types == kind)
        name, width = _CELLS.get(kind, (None, 0))
        _check_widths(source, rows, chosen, kind, width)
        points = values[starts[chosen][:, np.newaxis] + np.arange(1, width + 1)]
        outside = (points < 0) | (points >= point_count)
        if outside.any():
            row = int(np.argmax(outside.any(axis=1)))
            fault = f"an element uses point {points[row][outside[row]][0]} of {point_count}"
            line = str(int(rows.lines[chosen[row]]))
            raise source.error(fault, "points are counted from 0 in each zone", at=line)
        if name is not None:
            yield Block(name, points, first + chosen)


def _check_widths(
    source: Source, rows: Rows, chosen: NDArray[np.int64], kind: int, width: int
) -> None:
    """Refuse elements of an unknown type, or with other counts of numbers than theirs."""
    counts = rows.counts[chosen] - 1
    wrong = ~((counts == width) | (counts == width + 1)) | (width == 0)
    if wrong.any():
        at = int(np.argmax(wrong))
        found = f"with {counts[at]} numbers, {width} points wanted" if width else "is not known"
        remedy = (
            "lines, triangles, quadrilaterals, tetrahedra, hexahedra, prisms, pyramids are read"
        )
        line = str(int(rows.lines[chosen[at]]))
        raise source.error(f"an element of type {kind} {found}", remedy, at=line)
