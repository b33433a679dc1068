"""Names of Abaqus' and CalculiX' elements, and the surface of each shape."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.abaqus_decks import deck, volume

from obbcli.errors import MeshError
from obbcli.mesh.formats.abaqus.elements import shape_of
from obbcli.mesh.formats.cells.types import CELLS

#: The unit cube, an apex above it, and the middle of each of its edges, as VTK numbers them.
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
EDGES += [(0, 4), (1, 5), (2, 6), (3, 7)]


def element(kind, nodes):
    """Return a deck of one element with nodes at these places."""
    lines = [f"{at}, {x}, {y}, {z}" for at, (x, y, z) in enumerate(nodes, start=1)]
    words = [str(at) for at in range(len(nodes) + 1)]
    words[0] = "7"
    rows = [", ".join(words[at : at + 10]) for at in range(0, len(words), 10)]
    return deck("\n".join(["*NODE", *lines, f"*ELEMENT, TYPE={kind}", ",\n".join(rows), ""]))


def with_middles(corners, edges):
    return [*corners, *(np.mean([corners[a], corners[b]], axis=0).tolist() for a, b in edges)]


WEDGE = [CORNERS[0], CORNERS[1], CORNERS[3], CORNERS[4], CORNERS[5], CORNERS[7]]
TETRA = [CORNERS[0], CORNERS[1], CORNERS[3], CORNERS[4]]
PYRAMID = [*CORNERS[:4], (0.5, 0.5, 1)]
TRIANGLE_EDGES = [(0, 1), (1, 2), (2, 0)]
TETRA_EDGES = [*TRIANGLE_EDGES, (0, 3), (1, 3), (2, 3)]
WEDGE_EDGES = [*TRIANGLE_EDGES, (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
PYRAMID_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]


@pytest.mark.parametrize(
    ("kinds", "nodes", "expected"),
    [
        ("C3D4 C3D4H DC3D4 AC3D4 C3D4E C3D4T EC3D4 Q3D4 FC3D4 C3D4P", TETRA, 1 / 6),
        ("C3D5 FC3D5", PYRAMID, 1 / 3),
        ("C3D6 C3D6H F3D6 SC6R COH3D6 GK3D6 DC3D6 AC3D6 C3D6T", WEDGE, 1 / 2),
        (
            "C3D8 F3D8 C3D8R C3D8RH C3D8H C3D8I C3D8IH C3D8RT C3D8PT SC8R SC8RT CSS8 COH3D8 COD3D8 "
            "GK3D8 GK3D8N DC3D8 DCC3D8D AC3D8R EC3D8R EMC3D8 C3D8S C3D8HS FC3D8",
            CORNERS,
            1.0,
        ),
        ("C3D10 C3D10M C3D10MH C3D10HS C3D10I C3D10MPT", with_middles(TETRA, TETRA_EDGES), 1 / 6),
        ("C3D13", with_middles(PYRAMID, PYRAMID_EDGES), 1 / 3),
        ("C3D15 C3D15H DC3D15", with_middles(WEDGE, WEDGE_EDGES), 1 / 2),
        ("C3D20 C3D20R C3D20RH C3D20RHT AC3D20 DC3D20E", with_middles(CORNERS, EDGES), 1.0),
    ],
)
def test_solids_close_and_hold_their_volume(kinds, nodes, expected):
    for kind in kinds.split():
        mesh = element(kind, nodes)

        assert mesh.is_watertight, kind
        assert volume(mesh) == pytest.approx(expected), kind


def test_middle_nodes_are_points_of_the_surface():
    nodes = with_middles(CORNERS, EDGES)
    # The middle of the edge between the first two corners, pulled out.
    nodes[8] = (0.5, -0.25, -0.25)

    mesh = element("C3D20R", nodes)

    assert mesh.bounds.tolist() == [[0, -0.25, -0.25], [1, 1, 1]]
    assert mesh.is_watertight
    assert any("flat pieces through their nodes" in note for note in mesh.notes)


SQUARE = CORNERS[:4]
SQUARE_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]


@pytest.mark.parametrize(
    ("kinds", "nodes", "expected"),
    [
        ("S3 S3R S3RS S3RT STRI3 DS3 M3D3 SFM3D3 R3D3 F3D3 US3 CPS3 CPE3 CPE3H", SQUARE[:3], 0.5),
        ("CPEG3 CAX3 CGAX3H DC2D3 DCAX3 AC2D3 ACAX3 WARP2D3", SQUARE[:3], 0.5),
        ("S4 S4R S4RS S4RSW S4R5 S4T S4RT DS4 M3D4 M3D4R SFM3D4 SFM3D4R R3D4", SQUARE, 1.0),
        ("CPS4 CPS4R CPS4I CPE4RH CPEG4IH CAX4P CAX4RHT CGAX4 DC2D4 DCC2D4 DCAX4E", SQUARE, 1.0),
        ("COH2D4 COHAX4 AC2D4R ACAX4 GKPS4 GKPE4 GKAX4N WARP2D4", SQUARE, 1.0),
        ("STRI65 S6 M3D6 SFM3D6 DS6 CPS6 CPS6M CPE6MH CAX6 DC2D6 AC2D6", "6", 0.5),
        ("S8 S8R S8R5 S8RT DS8 M3D8R SFM3D8 CPS8 CPE8RP CAX8RH CGAX8 DC2D8 AC2D8", "8", 1.0),
        ("S9R5 M3D9 M3D9R", "9", 1.0),
    ],
)
def test_flat_elements_are_surface_as_they_stand(kinds, nodes, expected):
    shapes = {
        "6": with_middles(SQUARE[:3], TRIANGLE_EDGES),
        "8": with_middles(SQUARE, SQUARE_EDGES),
        "9": [*with_middles(SQUARE, SQUARE_EDGES), (0.5, 0.5, 0.0)],
    }
    for kind in kinds.split():
        mesh = element(kind, shapes.get(str(nodes), nodes))

        a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
        assert np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 == expected, kind


BARE = """
T2D2 T3D3H B21 B22H B31 B31R B31OS B32OSH B33 PIPE31H ELBOW31B FRAME3D SPRINGA SPRING1 DASHPOT2
DASHPOTA MASS ROTARYI HEATCAP CONN3D2 CONN2D2 GAPUNI GAPCYL DCOUP3D JOINTC DRAG3D LS3S PSI34 SAX1
DSAX2 MAX1 MGAX2 RAX2 RB2D2 RB3D2 SFMAX1 FAX2 FLINK F2D2 DC1D2 DC1D3 AC1D3 R2D2 PC3D ITSCYL ITT31
D GK3D2 DGAP
"""


@pytest.mark.parametrize("kind", BARE.split())
def test_points_and_lines_have_no_surface(kind):
    shape = shape_of(kind)

    assert shape is not None
    assert shape.cell is None
    with pytest.raises(MeshError, match="has no surface: 1 element, none with a face"):
        element(kind, SQUARE[:2])


OTHERS = """
F3D4
C3D27 C3D15V CIN3D8 CINPE4 ACIN3D4 COH3D8P COD3D8P GK3D18 GK3D12M GK3D4L CCL12 MCL6 SFMCL9 CAXA8R2
SAXA11 U1 VU2 Z1 PD3D US6X S5 C3D9 S44 CPS C3D S4R55 CPE10 QUAD4
"""


@pytest.mark.parametrize("kind", OTHERS.split())
def test_other_types_are_refused_with_their_line(kind):
    with pytest.raises(MeshError, match=rf":6: elements of type '{kind}' are not read; convert"):
        element(kind, SQUARE)


def test_every_shape_has_as_many_nodes_as_its_cell():
    names = [f"{family}{count}" for family in ("C3D", "S", "CPS", "COH3D") for count in range(30)]
    shapes = [shape for name in names if (shape := shape_of(name)) is not None]

    assert len(shapes) == 8 + 5 + 5 + 2
    assert all(CELLS[shape.cell].node_count == shape.nodes for shape in shapes)
