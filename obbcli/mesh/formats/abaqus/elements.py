"""Abaqus' and CalculiX' names of elements: which cell each is, and which have no surface.

Names are a family, a count of nodes and letters that change the formulation, not the shape:
C3D8RH is C3D, 8, RH. Node orders are those of VTK ("Elements", Abaqus Analysis User's Guide).
"""

from __future__ import annotations

import re
from typing import NamedTuple

_SOLID = {
    4: "tetra",
    5: "pyramid",
    6: "wedge",
    8: "hexahedron",
    10: "tetra10",
    13: "pyramid13",
    15: "wedge15",
    20: "hexahedron20",
}
_LAYER = {6: "wedge", 8: "hexahedron"}
_FLAT = {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8", 9: "quad9"}
_FOUR = {4: "quad"}

#: Cells by their count of nodes, of each family.
_FAMILIES: dict[str, dict[int, str]] = {
    **dict.fromkeys(("C3D", "DC3D", "DCC3D", "AC3D", "EC3D", "EMC3D", "FC3D", "Q3D"), _SOLID),
    **dict.fromkeys(("SC", "CSS", "COH3D", "COD3D", "GK3D"), _LAYER),
    **dict.fromkeys(("S", "DS", "STRI", "US", "M3D", "SFM3D", "R3D"), _FLAT),
    # F3D4 is a quadrilateral of Abaqus and a tetrahedron of CalculiX: refused.
    "F3D": {3: "triangle", 6: "wedge", 8: "hexahedron"},
    **dict.fromkeys(("CPS", "CPE", "CPEG", "DC2D", "DCC2D", "AC2D", "EMC2D", "WARP2D"), _FLAT),
    **dict.fromkeys(("CAX", "CGAX", "DCAX", "DCCAX", "ACAX"), _FLAT),
    **dict.fromkeys(("COH2D", "COD2D", "COHAX", "CODAX", "GKPS", "GKPE", "GKAX"), _FOUR),
}
_NAME = re.compile(r"([A-Z]+(?:[23]D)?)(\d{1,2})([DEHILMNPRSTW]*)5?")
#: Families of which a letter adds nodes: those of pore pressure, and gaskets along a line.
_MORE_NODES = re.compile(r"(COH|COD)\w+P|GK\w+L")
#: A number that is no count of nodes.
_IRREGULAR = {"STRI65": "triangle6"}
#: Points, lines and what joins nodes: trusses, beams, springs, masses, connectors, gaps.
_BARE = re.compile(
    r"T[23]D\d\w*|B[23]\d\w*|PIPE\d\w*|ELBOW\d\w*|FRAME[23]D|SPRING\w+|DASHPOT\w+|MASS|ROTARYI|HEATCAP"
    r"|CONN[23]D2|GAP\w+|DGAP|ITT\w+|ITS\w+|IRS\w+|ISL\w+|DRAG[23]D|JOINT[23]D|JOINTC|LS\d\w*|PSI\d\w*"
    r"|D?SAX\d\w*|MG?AX\d\w*|RAX2|RB[23]D2|SFMG?AX\d\w*|FAX2|FLINK|F2D2|DC1D\d\w*|DCC1D\d\w*|AC1D\d|R2D2"
    r"|DCOUP[23]D|PC3D|GK2D2N?|GK3D2N?|GKAX2N?|ASI1|D"
)
_AXISYMMETRIC = re.compile(r"[A-Z]*AX\d\w*")


class Shape(NamedTuple):
    """Holds what an element's name tells.

    Args:
        cell: the cell's name in `CELLS`; None where it has no surface.
        nodes: how many nodes an element has; 0 where it has no surface.
        is_axisymmetric: whether it stands for what it would sweep about an axis.
    """

    cell: str | None
    nodes: int
    is_axisymmetric: bool


def shape_of(name: str) -> Shape | None:
    """Return the shape of elements of a type, or None for one that is not known.

    Args:
        name: in capitals.
    """
    axisymmetric = _AXISYMMETRIC.fullmatch(name) is not None
    if _BARE.fullmatch(name):
        return Shape(None, 0, axisymmetric)
    if name in _IRREGULAR:
        return Shape(_IRREGULAR[name], 6, axisymmetric)
    match = _NAME.fullmatch(name)
    if match is None or _MORE_NODES.fullmatch(name):
        return None
    cell = _FAMILIES.get(match[1], {}).get(int(match[2]))
    return Shape(cell, int(match[2]), axisymmetric) if cell else None
