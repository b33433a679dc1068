"""What of the formats that meshio reads is understood, and how many cells a file lists.

Each keyword is known or refused with its line, so that nothing that makes or places surface is
passed over; the cells that meshio takes are then held against those listed here.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING
from xml.parsers import expat

from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from collections.abc import Callable

    from obbcli.errors import MeshError
    from obbcli.mesh.source import Source

_CUT = "it was cut short, or its counts are wrong"
#: Sections of Netgen that list cells, and those of names, colours and links, which have no surface.
_NETGEN_CELLS = {
    *("pointelements", "edgesegments", "edgesegmentsgi", "edgesegmentsgi2"),
    *("surfaceelements", "surfaceelementsgi", "surfaceelementsuv", "volumeelements"),
}
_NETGEN_OTHERS = {
    *("mesh3d", "dimension", "geomtype", "points", "surf1", "endmesh", "materials", "bcnames"),
    *("cd2names", "cd3names", "identifications", "identificationtypes", "face_colours"),
    *("singular_edge_left", "singular_edge_right", "singular_points"),
    *("singular_face_inside", "singular_face_outside"),
}
#: Lines of FLAC3D: grid points, zones, faces, and groups of these.
_FLAC3D = {"G", "Z", "F", "ZGROUP", "FGROUP"}
#: Elements of DOLFIN's XML that make a mesh, and those of values, which have no surface.
_DOLFIN_CELLS = {"triangle", "tetrahedron"}
_DOLFIN = {"dolfin", "mesh", "vertices", "vertex", "cells", *_DOLFIN_CELLS}
_DOLFIN_VALUES = {"data", "domains"}


def listed_cells(source: Source, kind: str) -> int:
    """Return how many cells a file lists, once all of its keywords are known.

    Args:
        source: the file.
        kind: meshio's module of its format.

    Raises:
        MeshError: a keyword that is not known, or a count that the file cannot hold.
    """
    return _LISTS[kind](source)


def _netgen_cells(source: Source) -> int:
    cells = 0
    lines = source.data.splitlines()
    for number, line in enumerate(lines, start=1):
        word = line.split(None, 1)[0].decode("latin-1") if line.strip() else "#"
        if word.startswith("#") or not word[0].isalpha():
            continue
        if word not in _NETGEN_CELLS | _NETGEN_OTHERS:
            raise _unknown(source, word, number)
        if word == "endmesh":
            break
        if word in _NETGEN_CELLS or word == "points":
            count = lines[number].strip() if number < len(lines) else b""
            if not count.isdigit() or len(count) > 18 or int(count) > len(source.data):
                fault = f"{word} claims {shown(count)} of something, but the file has "
                raise source.error(f"{fault}{len(source.data)} bytes", _CUT, at=str(number + 1))
            cells += int(count) * (word in _NETGEN_CELLS)
    return cells


def _flac3d_cells(source: Source) -> int:
    if b"\0" in source.data[:8]:
        raise source.error("is a binary FLAC3D grid, which is not read", "export it as text")
    points = Counter[bytes]()
    cells = 0
    for number, line in enumerate(source.data.splitlines(), start=1):
        words = line.split(None, 2)
        if not words or words[0].startswith(b"*") or words[0].isdigit():
            continue
        word = words[0].decode("latin-1")
        if word not in _FLAC3D:
            raise _unknown(source, word, number)
        cells += word in ("Z", "F")
        if word == "G" and len(words) > 1:
            points[words[1]] += 1
            if points[words[1]] > 1:
                fault = f"grid point {shown(words[1])} is there twice"
                raise source.error(fault, "write the file again", at=str(number))
    return cells


def _dolfin_cells(source: Source) -> int:
    if re.search(rb"<!(DOCTYPE|ENTITY)", source.data):
        raise source.error("declares a document type", "remove the <!DOCTYPE ...>")
    walk = _DolfinWalk(source)
    try:
        walk.parser.Parse(source.data, True)
    except expat.ExpatError as fault:
        words = expat.ErrorString(fault.code) if fault.code else "no XML"
        remedy = "it was cut short or damaged"
        raise source.error(f"is no whole XML: {words}", remedy, at=str(fault.lineno)) from fault
    return walk.counts["cells"]


class _DolfinWalk:
    """Goes through the elements of a DOLFIN file; each list is numbered from 0, without gaps."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._path: list[str] = []
        self.counts = Counter[str]()
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self._path.append(name)
        if _DOLFIN_VALUES.intersection(self._path):
            return
        line = self.parser.CurrentLineNumber
        if name not in _DOLFIN:
            raise _unknown(self._source, name, line)
        place = {"vertex": "vertices"}.get(name, "cells" if name in _DOLFIN_CELLS else "")
        if place:
            if attributes.get("index") != str(self.counts[place]):
                fault = f"{name} {self.counts[place]} of the file has another index"
                raise self._source.error(fault, "write the file again", at=str(line))
            self.counts[place] += 1
        elif name in ("vertices", "cells"):
            size = attributes.get("size", "")
            if not (size.isascii() and size.isdigit()) or len(size) > 18:
                fault = f"size of {name} is '{shown(size.encode())}', expected a whole number"
                raise self._source.error(fault, _CUT, at=str(line))
            self.counts[f"claimed {name}"] = int(size)

    def _end(self, name: str) -> None:
        self._path.pop()
        claimed = self.counts[f"claimed {name}"]
        if name in ("vertices", "cells") and claimed != self.counts[name]:
            fault = f"claims {claimed} {name}, and {self.counts[name]} follow"
            raise self._source.error(fault, _CUT, at=str(self.parser.CurrentLineNumber))


def _unknown(source: Source, word: str, line: int) -> MeshError:
    fault = f"'{shown(word.encode())}' is no keyword that is read"
    return source.error(fault, "remove it if it is no part of the shape", at=str(line))


_LISTS: dict[str, Callable[[Source], int]] = {
    "netgen": _netgen_cells,
    "flac3d": _flac3d_cells,
    "dolfin": _dolfin_cells,
}
