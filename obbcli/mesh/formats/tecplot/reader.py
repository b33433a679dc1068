"""ASCII Tecplot files (.dat, .tec, .plt), read by our own reader: every zone.

meshio reads the first zone alone, and no ordered ones; its fork misplaces cell-centred values.
"""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING

from obbcli.mesh.formats.cells.parts import joined_surface
from obbcli.mesh.formats.tecplot.header import clean_text, read_zone, records, variables
from obbcli.mesh.formats.tecplot.zones import Zones
from obbcli.mesh.formats.text import counted, strip_mark
from obbcli.mesh.parts.placed import PlacedPart, UniquePaths

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.formats.tecplot.header import Zone
    from obbcli.mesh.source import MeshArrays, Source

#: What stands around the letter in the names of coordinates: units, the word itself.
_DECORATION = re.compile(r"[\[(<].*?[\])>]|coordinates?|coord|position|[\s_-]")

#: Tecplot itself takes no more.
_MOST_VARIABLES = 32_767


def read_tecplot(source: Source) -> MeshArrays:
    """Return the surfaces of all zones, in order: cells, or the boundary of those with volume.

    Ordered zones are grids of quadrilaterals or of hexahedra. Zones of points and lines are passed
    over, as are texts and drawings.

    Raises:
        MeshError: binary files, polygons and polyhedra, keys that are not known, counts that do not
            fit, a mesh that moves; with the line.
    """
    zones = _shown(source)
    return joined_surface(source, [zones.part(at) for at in zones.with_surface()])


def parts_tecplot(source: Source) -> Iterator[PlacedPart]:
    """Yield the zones that have a surface; the numbers of each are read when it is decoded.

    Raises:
        MeshError: as `read_tecplot`; what is wrong with a zone's own numbers, when it is decoded.
    """
    zones = _shown(source)
    paths = UniquePaths()
    for at in zones.with_surface():
        name = zones.headers[at].zone.name
        yield PlacedPart(paths.take(name), at, partial(_decoded, source, zones, at))


def _decoded(source: Source, zones: Zones, at: int) -> MeshArrays:
    return joined_surface(source, [zones.part(at)])


def _shown(source: Source) -> Zones:
    """Return the zones of a file, whose numbers are not read yet; notes tell what is left out."""
    if source.data[:64].lstrip().startswith((b"#!TDV", b"#!SZPLT")):
        remedy = "save it as ASCII Tecplot (.dat), or as VTK"
        raise source.error("is a binary Tecplot file, which is not read", remedy)
    text = clean_text(strip_mark(source.data))
    headers, names = _zones(source, text)
    zones = Zones(source, headers, len(names), _coordinates(source, headers, names))
    bare = counted(zones.bare_count, "zone")
    if not zones.with_surface():
        raise source.error(
            f"has no surface: {bare} of points and lines, no face",
            "a mesh is a surface of triangles",
        )
    if zones.bare_count:
        source.note(f"{bare} of points or lines passed over: no surface")
    if zones.repeat_count:
        count = counted(zones.repeat_count, "zone")
        source.note(f"{count} of other solution times with the same mesh taken once")
    return zones


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
