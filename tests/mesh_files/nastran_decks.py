"""Small Nastran decks, and the one tetrahedron or cube that most of them hold."""

from __future__ import annotations

#: GRIDs 1 to 4 of a tetrahedron with a corner in the origin, and its CTETRA.
TETRA_PLACES = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
TETRA_GRIDS = """\
GRID    1               0.      0.      0.
GRID    2               1.      0.      0.
GRID    3               0.      1.      0.
GRID    4               0.      0.      1.
"""
TETRA = TETRA_GRIDS + "CTETRA  1       1       1       2       3       4\n"

#: Corners of the unit cube as GRIDs 1 to 8, in the order in which a CHEXA names them.
CUBE_PLACES = (
    *((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)),
    *((0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (0.0, 1.0, 1.0)),
)


def grid(number: int, place: tuple[float, float, float], system: int | str = "") -> str:
    """Return a GRID in free fields."""
    return f"GRID,{number},{system},{place[0]!r},{place[1]!r},{place[2]!r}\n"


def grids(places, system: int | str = "", first: int = 1) -> str:
    """Return GRIDs numbered from `first`."""
    return "".join(grid(first + k, place, system) for k, place in enumerate(places))


CUBE = grids(CUBE_PLACES)

#: The same tetrahedron in every form in which a deck can stand.
FORMS = {
    "small": f"SOL 101\nCEND\nBEGIN BULK\n{TETRA}ENDDATA\n",
    "punch": TETRA,
    "lower": f"cend\nbegin bulk\n{TETRA}enddata\n".lower(),
    "super": f"BEGIN SUPER=1\n{TETRA}",
    "large": """\
GRID*                  1                              0.              0.
*                     0.
GRID*   2                               1.              0.
*       0.
GRID*                  3               0            0.D0           1.0+0*G3
*G3                0.E+0
GRID*   4                               0.              0.
*                .1E+1
CTETRA* 1               1               1               2
*       3               4
""",
    "free": """\
GRID,1,,0.,0.,0.
GRID, 2, , 1., 0., 0.
GRID,3,0,0.,1.
GRID,4,,,,1.
CTETRA,1,1,1,2,3,4
""",
    "large free": """\
GRID*,1,,0.,0.
*,0.
GRID*,2,,1.,0.
GRID*,3,,0.,1.
*,0.
GRID*,4,,0.,0.
*,1.
CTETRA*,1,1,1,2
*,3,4
""",
    "tabs": "GRID\t1\nGRID\t2\t\t1.\nGRID\t3\t\t\t1.\nGRID\t4\t\t\t\t1.\n"
    "CTETRA\t1\t1\t1\t2\t3\t4\n",
    "mixed": """\
$ a comment
GRID    1               0.      0.      0.      $ another

GRID,2,,1.0
$GRID,5,,9.,9.,9.
GRID*   3                               0.              1.
# one of OptiStruct
*       0.
GRID\t4\t\t0.\t0.\t1.
   $ blanks before it
CTETRA  1       1       1       2       3       4       $ the end
""",
    "continued": """\
GRID    1
GRID    2               1.
GRID    3                       1.
GRID    4                               1.
CTETRA*                1               1               1               2+T1
*T1                    3               4
""",
}

#: What readers of decks are given to begin with when they are fuzzed.
SEEDS = (
    *FORMS.values(),
    "CORD2C,1,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD1R,2,1,2,3\nGRDSET,,1\n"
    + TETRA
    + grids(TETRA_PLACES, 2, 11)
    + "CTRIA3,2,1,11,12,13,,0.5\nCQUAD8,3,1,1,2,3,4,11,0\n,13,\nCQUAD,4,1,1,2,3,4\n",
    CUBE + "CHEXA,1,1,1,2,3,4,5,6,+A\n+A,7,8\nCPENTA,2,1,1,2,4,5,6,8\nPSHELL,1,1,.1\nFORCE,1,2\n",
    f"BEGIN BULK\nSEBULK,1,PRIMARY\n{TETRA}BEGIN SUPER=1\n{TETRA}ENDDATA\n",
    "INCLUDE 'a\n b.inc'\n" + TETRA,
)
