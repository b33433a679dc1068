"""ASCII Tecplot files (.dat, .tec, .plt), read by our own reader: every zone.

meshio reads the first zone alone, and no ordered ones; its fork misplaces cell-centred values.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.cells.parts import CellPart, joined_surface
from obbcli.mesh.formats.cells.structured import grid_surface
from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.formats.tecplot.header import clean_text, read_zone, records, variables
from obbcli.mesh.formats.tecplot.zone import Numbers, layout_of, numbers_of
from obbcli.mesh.formats.text import counted, strip_mark

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.tecplot.header import Zone
    from obbcli.mesh.formats.tecplot.zone import Layout
    from obbcli.mesh.source import MeshArrays, Source

#: What stands around the letter in the names of coordinates: units, the word itself.
_DECORATION = re.compile(r"[\[(<].*?[\])>]|coordinates?|coord|position|[\s_-]")

#: Tecplot itself takes no more.
_MOST_VARIABLES = 32_767
_EMPTY = Numbers({}, None)


class _Read(NamedTuple):
    """Holds a zone with what its header and its numbers say."""

    zone: Zone
    layout: Layout
    numbers: Numbers


def read_tecplot(source: Source) -> MeshArrays:
    """Return the surfaces of all zones, in order: cells, or the boundary of those with volume.

    Ordered zones are grids of quadrilaterals or of hexahedra. Zones of points and lines are passed
    over, as are texts and drawings.

    Raises:
        MeshError: binary files, polygons and polyhedra, keys that are not known, counts that do not
            fit, a mesh that moves; with the line.
    """
    if source.data[:64].lstrip().startswith((b"#!TDV", b"#!SZPLT")):
        remedy = "save it as ASCII Tecplot (.dat), or as VTK"
        raise source.error("is a binary Tecplot file, which is not read", remedy)
    text = clean_text(strip_mark(source.data))
    zones, names = _zones(source, text)
    places = _coordinates(source, zones, names)
    whole = _Zones(source, zones, names, places)
    parts = [part for at in range(len(zones)) if (part := whole.part(at)) is not None]
    bare = sum(each.layout.cell is None for each in whole.read)
    if not parts:
        fault = f"has no surface: {counted(bare, 'zone')} of points and lines, no face"
        raise source.error(fault, "a mesh is a surface of triangles")
    if bare:
        source.note(f"{counted(bare, 'zone')} of points or lines passed over: no surface")
    if whole.repeated:
        count = counted(whole.repeated, "zone")
        source.note(f"{count} of other solution times with the same mesh taken once")
    return joined_surface(source, parts)


def _zones(source: Source, text: bytes) -> tuple[list[Zone], list[str]]:
    """Return the headers of all zones, and the names of the variables."""
    zones: list[Zone] = []
    names: list[str] = []
    for record in records(text):
        if record.kind == "VARIABLES":
            if zones and names != variables(text, record):
                fault = "VARIABLES change after the first zone, which is not read"
                raise source.error(fault, "put them into files of their own", at=str(record.line))
            names = variables(text, record)
        elif record.kind == "ZONE":
            zones.append(read_zone(source, text, record, len(zones), len(names)))
        elif record.kind == "FILETYPE" and b"SOLUTION" in text[record.start : record.end].upper():
            fault = "is a Tecplot solution, whose grid lies in another file"
            raise source.error(fault, "save grid and solution in one file", at=str(record.line))
    if len(names) > _MOST_VARIABLES:
        fault = f"has {len(names)} variables, at most {_MOST_VARIABLES} are read"
        raise source.error(fault, "save the coordinates alone")
    if not zones:
        remedy = "a Tecplot file has VARIABLES and a ZONE; other formats have other suffixes"
        raise source.error("has no ZONE, which a mesh in a Tecplot file has", remedy)
    return zones, names


def _coordinates(source: Source, zones: list[Zone], names: list[str]) -> list[int | None]:
    """Return the variables that are X, Y and Z; None for a Z that is not there."""
    bare = [_DECORATION.sub("", name.lower()) for name in names]
    found: list[int | None] = []
    for letter in "xyz":
        exact = [at for at, name in enumerate(names) if name.lower() == letter]
        likely = exact or [at for at, name in enumerate(bare) if name == letter]
        alike = [at for at, name in enumerate(bare) if name.startswith(letter) and len(name) < 4]
        if len(likely) > 1 or (not likely and (alike or letter != "z")):
            fault = f"no variable or more than one is {letter.upper()}, of {', '.join(names)[:80]}"
            remedy = 'call the coordinates "X", "Y" and "Z"'
            if all(_is_curve(zone) for zone in zones):
                fault, remedy = f"has no surface: a curve, no face, of {', '.join(names)[:80]}", ""
            raise source.error(fault, remedy, at=str(zones[0].line))
        found.append(likely[0] if likely else None)
    return found


def _is_curve(zone: Zone) -> bool:
    """Return whether a zone is ordered along one index alone."""
    keys = zone.keys.keys()
    return not keys & {"N", "E", "NODES", "ELEMENTS", "J", "K", "ET", "ZONETYPE"}


class _Zones:
    """Holds all zones, whose variables and cells may be those of zones before them."""

    def __init__(
        self, source: Source, zones: list[Zone], names: list[str], places: list[int | None]
    ) -> None:
        self._source = source
        self._places = places
        self._width = len(names)
        self._strands: dict[str, tuple[str, CellPart]] = {}
        self.repeated = 0
        self.read: list[_Read] = []
        for zone in zones:
            layout = layout_of(source, zone, self._width)
            shares = layout.cell is None and layout.points is None
            numbers = None if shares else numbers_of(source, zone, layout, self._width)
            self.read.append(_Read(zone, layout, numbers or _EMPTY))

    def part(self, at: int) -> CellPart | None:
        """Return the cells of a zone; None where it has no surface, or stands there already."""
        zone, layout, _ = self.read[at]
        if layout.cell is None:
            return None
        points = self._points(at)
        if layout.is_ordered:
            blocks = [Block("quad", grid_surface(layout.shape, points))]
        else:
            blocks = [Block(layout.cell, self._cells(at))]
        part = CellPart(zone.name, points, blocks)
        return self._first_of_strand(zone, part)

    def _points(self, at: int) -> NDArray[np.float64]:
        """Return the points of a zone; those of flat files lie at z = 0."""
        zone, layout, _ = self.read[at]
        points = np.zeros((layout.points or 0, 3))
        for axis, variable in enumerate(self._places):
            if variable is None:
                if layout.cell in ("tetra", "hexahedron"):
                    remedy = 'call a coordinate "Z"'
                    raise self._refused(zone, "a zone of volumes has no variable Z", remedy)
                self._source.note("no variable is Z: taken at z = 0")
                continue
            if variable in zone.cell_centred or variable in zone.passive:
                raise self._refused(zone, "coordinates are not given at the points", "export again")
            values = self._variable(at, variable)
            if len(values) != len(points):
                fault = f"a zone of {len(points)} points shares {len(values)} coordinates"
                raise self._refused(zone, fault, "export the file again")
            points[:, axis] = values
        if not np.isfinite(points).all():
            row = int(np.argmin(np.isfinite(points).all(axis=1)))
            raise self._refused(
                zone, f"point {row + 1} is not finite", "coordinates must be finite"
            )
        return points

    def _variable(self, at: int, variable: int) -> NDArray[np.float64]:
        """Return a variable of a zone, or of the zone that it is taken from."""
        zone, _, numbers = self.read[at]
        while variable in zone.shared:
            zone, _, numbers = self.read[zone.shared[variable]]
        if variable not in numbers.variables:
            raise self._refused(
                zone, "shares a variable that is not there", "export the file again"
            )
        return numbers.variables[variable]

    def _cells(self, at: int) -> NDArray[np.int64]:
        """Return the connectivity of a zone, or of the zone that it is taken from."""
        first = self.read[at]
        zone, layout, numbers = first
        while "CONNECTIVITYSHAREZONE" in zone.keys:
            word = zone.keys["CONNECTIVITYSHAREZONE"]
            wanted = int(word) - 1 if word.isdecimal() and len(word) < 10 else -1
            if not 0 <= wanted < at:
                fault = f"CONNECTIVITYSHAREZONE={word[:20]} is no zone before it"
                raise self._refused(zone, fault, "export the file again")
            at = wanted
            zone, layout, numbers = self.read[at]
        same = (layout.cell, layout.points) == (first.layout.cell, first.layout.points)
        if numbers.cells is None or not same or layout.cells != first.layout.cells:
            fault = "a zone shares the connectivity of one of another size or type"
            raise self._refused(first.zone, fault, "export the file again")
        return numbers.cells

    def _first_of_strand(self, zone: Zone, part: CellPart) -> CellPart | None:
        """Return a part unless it is one before it at another time; refuse one that has moved."""
        strand, time = zone.keys.get("STRANDID", "0"), zone.keys.get("SOLUTIONTIME", "0")
        if strand.strip("-+0") == "" or "SOLUTIONTIME" not in zone.keys:
            return part
        first_time, first = self._strands.setdefault(strand, (time, part))
        if first_time == time:
            return part
        same = np.array_equal(first.points, part.points)
        if not (same and np.array_equal(first.blocks[0].nodes, part.blocks[0].nodes)):
            fault = f"the mesh of strand {strand[:20]} differs between solution times"
            raise self._refused(zone, fault, "save one solution time")
        self.repeated += 1
        return None

    def _refused(self, zone: Zone, fault: str, remedy: str) -> MeshError:
        return self._source.error(fault, remedy, at=str(zone.line))
