"""Counts claimed in mesh files, checked against their length before a library believes them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from obbcli.mesh.source import Source

_LINE = re.MULTILINE | re.IGNORECASE
#: Each group is a count of things that take at least one byte each.
_CLAIMS = {
    "vtk": re.compile(
        rb"^[ \t]*(?:POINTS|CELLS|CELL_TYPES|POINT_DATA|CELL_DATA|[XYZ]_COORDINATES)"
        rb"[ \t]+(-?\d+)(?:[ \t]+(-?\d+))?",
        _LINE,
    ),
    "vtu": re.compile(rb"\bNumberOf(?:Points|Cells)\s*=\s*[\"'](-?\d+)[\"']"),
    "gmsh": re.compile(rb"^\$(?:Nodes|Elements)\s*^[ \t]*(\d+)(?:[ \t]+(\d+))?", _LINE),
    "medit": re.compile(
        rb"^[ \t]*(?:Vertices|Edges|Triangles|Quadrilaterals|Tetrahedra|Hexahedra|Prisms|Pyramids)"
        rb"\s+(-?\d+)",
        _LINE,
    ),
    "netgen": re.compile(
        rb"^[ \t]*(?:surfaceelements|volumeelements|edgesegmentsgi2|points)\w*\s+(-?\d+)", _LINE
    ),
}
#: Images and other grids whose points are implied by three numbers.
_GRID = re.compile(rb"^[ \t]*DIMENSIONS[ \t]+(-?\d+)[ \t]+(-?\d+)[ \t]+(-?\d+)", _LINE)
_LARGEST_GRID = 1 << 24
#: A longer number counts nothing in any file, and takes Python long to read, or too long.
_MOST_DIGITS = 30


def check_claims(source: Source, kind: str) -> None:
    """Refuse counts that are negative or above the file's size.

    Args:
        source: the file.
        kind: meshio's name of its format.

    Raises:
        MeshError: with the line.
    """
    data = source.data
    pattern = _CLAIMS.get(kind)
    for match in pattern.finditer(data) if pattern else ():
        for group in match.groups(b"0"):
            count = _number(source, group, match.start(1))
            if not 0 <= count <= len(data):
                raise source.error(
                    f"claims {count} of something, but the file has {len(data)} bytes",
                    "it was cut short, or its counts are wrong",
                    at=_line_at(source, match.start(1)),
                )
    for match in _GRID.finditer(data) if kind == "vtk" else ():
        x, y, z = (_number(source, group, match.start(1)) for group in match.groups())
        if min(x, y, z) < 0 or x * y * z > _LARGEST_GRID:
            raise source.error(
                f"is a grid of {x} x {y} x {z} points, at most {_LARGEST_GRID} are read",
                "extract its surface",
                at=_line_at(source, match.start(1)),
            )


def _line_at(source: Source, position: int) -> str:
    return str(source.data.count(b"\n", 0, position) + 1)


def _number(source: Source, digits: bytes, position: int) -> int:
    if len(digits) > _MOST_DIGITS:
        raise source.error(
            f"claims a count of {len(digits)} digits",
            "its counts are wrong",
            at=_line_at(source, position),
        )
    return int(digits)
