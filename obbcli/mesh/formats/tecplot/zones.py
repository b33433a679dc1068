"""The zones of a Tecplot file, which may take variables and cells from those before them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.cells.parts import CellPart
from obbcli.mesh.formats.cells.structured import grid_surface
from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.formats.tecplot.zone import Numbers, layout_of, numbers_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.tecplot.header import Zone
    from obbcli.mesh.formats.tecplot.zone import Layout
    from obbcli.mesh.source import Source

_EMPTY = Numbers({}, None)


class Header(NamedTuple):
    """Holds what a zone's header says.

    Args:
        zone: its words.
        layout: what they say of its numbers.
    """

    zone: Zone
    layout: Layout


class Zones:
    """Holds all zones of a file; their numbers are read when they are asked for.

    Args:
        source: the file.
        zones: in order.
        width: how many variables there are.
        places: the variables that are X, Y and Z; None for a Z that is not there.

    Attributes:
        headers: of all zones, in order.
        bare_count: how many zones are of points and lines.
        repeat_count: how many stand there already, at another solution time.

    Raises:
        MeshError: a header is not read, or the numbers of a zone without surface do not fit it.
    """

    def __init__(
        self, source: Source, zones: list[Zone], width: int, places: list[int | None]
    ) -> None:
        self._source = source
        self._places = places
        self._width = width
        self._numbers: dict[int, Numbers] = {}
        self.headers = [Header(zone, layout_of(source, zone, width)) for zone in zones]
        self.bare_count = sum(header.layout.cell is None for header in self.headers)
        self._repeats = self._find_repeats()
        for at, header in enumerate(self.headers):
            if header.layout.cell is None:
                self._own(at)
        self.repeat_count = sum(len(later) for later in self._repeats.values())

    def with_surface(self) -> list[int]:
        """Return the numbers, from 0, of the zones that have a surface and are no repeats."""
        again = {at for later in self._repeats.values() for at in later}
        has_cells = [header.layout.cell is not None for header in self.headers]
        return [at for at, has in enumerate(has_cells) if has and at not in again]

    def part(self, at: int) -> CellPart:
        """Return the cells of a zone.

        Raises:
            MeshError: its numbers do not fit, or its mesh is another at a later solution time; with
                the line.
        """
        part = self._part(at)
        for later in self._repeats.get(at, ()):
            other, zone = self._part(later), self.headers[later].zone
            same = np.array_equal(part.points, other.points)
            if not (same and np.array_equal(part.blocks[0].nodes, other.blocks[0].nodes)):
                strand = zone.keys.get("STRANDID", "")[:20]
                fault = f"the mesh of strand {strand} differs between solution times"
                raise self._refused(zone, fault, "save one solution time")
        return part

    def _part(self, at: int) -> CellPart:
        zone, layout = self.headers[at]
        points = self._points(at)
        if layout.is_ordered:
            blocks = [Block("quad", grid_surface(layout.shape, points))]
        else:
            blocks = [Block(str(layout.cell), self._cells(at))]
        return CellPart(zone.name, points, blocks)

    def _find_repeats(self) -> dict[int, list[int]]:
        """Return, by the first zone of each strand, those of the strand at other solution times."""
        first: dict[str, int] = {}
        found: dict[int, list[int]] = {}
        for at, (zone, layout) in enumerate(self.headers):
            strand = zone.keys.get("STRANDID", "0")
            has_time = strand.strip("-+0") != "" and "SOLUTIONTIME" in zone.keys
            if layout.cell is None or not has_time:
                continue
            start = first.setdefault(strand, at)
            if zone.keys["SOLUTIONTIME"] != self.headers[start].zone.keys["SOLUTIONTIME"]:
                found.setdefault(start, []).append(at)
        return found

    def _own(self, at: int) -> Numbers:
        """Return the numbers that stand in a zone."""
        if at not in self._numbers:
            zone, layout = self.headers[at]
            shares = layout.cell is None and layout.points is None
            found = _EMPTY if shares else numbers_of(self._source, zone, layout, self._width)
            self._numbers[at] = found
        return self._numbers[at]

    def _points(self, at: int) -> NDArray[np.float64]:
        """Return the points of a zone; those of flat files lie at z = 0."""
        zone, layout = self.headers[at]
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
        zone = self.headers[at].zone
        while variable in zone.shared:
            at = zone.shared[variable]
            zone = self.headers[at].zone
        numbers = self._own(at)
        if variable not in numbers.variables:
            raise self._refused(
                zone, "shares a variable that is not there", "export the file again"
            )
        return numbers.variables[variable]

    def _cells(self, at: int) -> NDArray[np.int64]:
        """Return the connectivity of a zone, or of the zone that it is taken from."""
        first = self.headers[at]
        zone, layout = first
        while "CONNECTIVITYSHAREZONE" in zone.keys:
            word = zone.keys["CONNECTIVITYSHAREZONE"]
            wanted = int(word) - 1 if word.isdecimal() and len(word) < 10 else -1
            if not 0 <= wanted < at:
                fault = f"CONNECTIVITYSHAREZONE={word[:20]} is no zone before it"
                raise self._refused(zone, fault, "export the file again")
            at = wanted
            zone, layout = self.headers[at]
        numbers = self._own(at)
        same = (layout.cell, layout.points) == (first.layout.cell, first.layout.points)
        if numbers.cells is None or not same or layout.cells != first.layout.cells:
            fault = "a zone shares the connectivity of one of another size or type"
            raise self._refused(first.zone, fault, "export the file again")
        return numbers.cells

    def _refused(self, zone: Zone, fault: str, remedy: str) -> MeshError:
        return self._source.error(fault, remedy, at=str(zone.line))
