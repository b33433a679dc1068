"""Elements of Nastran decks: every card that is read, its corners and its middle nodes."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from mesh_files.nastran_decks import CUBE, CUBE_PLACES, grids

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats.nastran import cards as nastran_cards

#: Corners of a square, then the middles of its edges 1-2, 2-3, 3-4, 4-1, raised by 1, and a centre.
SQUARE = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0))
RAISED = ((1, 0, 1), (2, 1, 1), (1, 2, 1), (0, 1, 1), (1, 1, 2))

#: By the Quick Reference Guide: pairs of corners (from 1) with a middle node, in its order.
EDGES = {
    "CTETRA": ((1, 2), (2, 3), (3, 1), (1, 4), (2, 4), (3, 4)),
    "CPYRAM": ((1, 2), (2, 3), (3, 4), (4, 1), (1, 5), (2, 5), (3, 5), (4, 5)),
    "CPENTA": (
        *((1, 2), (2, 3), (3, 1), (1, 4), (2, 5), (3, 6)),
        *((4, 5), (5, 6), (6, 4)),
    ),
    "CHEXA": (
        *((1, 2), (2, 3), (3, 4), (4, 1), (1, 5), (2, 6), (3, 7), (4, 8)),
        *((5, 6), (6, 7), (7, 8), (8, 5)),
    ),
}
EDGES["CPYRA"] = EDGES["CPYRAM"]
EDGES["CGASK12"] = EDGES["CPENTA"][:3] + EDGES["CPENTA"][6:]
EDGES["CGASK16"] = EDGES["CHEXA"][:4] + EDGES["CHEXA"][8:]
SOLIDS = {
    "CTETRA": ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "CPYRAM": ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)),
    "CPENTA": ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)),
    "CHEXA": CUBE_PLACES,
}
SOLIDS["CPYRA"] = SOLIDS["CPYRAM"]
SOLIDS |= {"CGASK6": SOLIDS["CPENTA"], "CGASK12": SOLIDS["CPENTA"]}
SOLIDS |= {"CGASK8": SOLIDS["CHEXA"], "CGASK16": SOLIDS["CHEXA"]}
#: Surface and volume of each.
MEASURES = {
    "CTETRA": (1.5 + np.sqrt(3) / 2, 1 / 6),
    "CPYRAM": (1 + np.sqrt(5), 1 / 3),
    "CPENTA": (3 + np.sqrt(2), 0.5),
    "CHEXA": (6, 1),
}
MEASURES["CPYRA"] = MEASURES["CPYRAM"]
MEASURES |= {"CGASK6": MEASURES["CPENTA"], "CGASK12": MEASURES["CPENTA"]}
MEASURES |= {"CGASK8": MEASURES["CHEXA"], "CGASK16": MEASURES["CHEXA"]}


def load(deck: str):
    return load_mesh_bytes(deck.encode("ascii"), ".bdf")


def card(name: str, nodes, behind=()) -> str:
    """Return an element of property 1 in small fields, a line for eight fields."""
    fields = ["1", "1", *(str(node) for node in nodes), *behind]
    lines = []
    for first in range(0, len(fields), 8):
        cells = "".join(f"{field:<8}" for field in fields[first : first + 8])
        lines.append((name if not first else "+").ljust(8) + cells.ljust(64) + "+")
    return "\n".join(lines) + "\n"


def middle_nodes(name: str) -> list[tuple[float, ...]]:
    """Return the middles of a solid's edges in the order of its card."""
    ends = [(SOLIDS[name][a - 1], SOLIDS[name][b - 1]) for a, b in EDGES[name]]
    return [tuple((x + y) / 2 for x, y in zip(*pair, strict=True)) for pair in ends]


def area(mesh) -> float:
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def volume(mesh) -> float:
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return float((a * np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize(
    ("name", "count"),
    [
        *((name, 3) for name in ("CTRIA3", "CTRIAR", "CTRIA6", "CPLSTN3", "CPLSTS3", "CPLSTN6")),
        *((name, 4) for name in ("CQUAD4", "CQUADR", "CQUAD8", "CQUAD", "CSHEAR", "CPLSTN4")),
        *((name, 4) for name in ("CPLSTS4", "CPLSTN8", "CPLSTS8", "CQPSTN")),
        *((name, 3) for name in ("CPLSTS6", "CTPSTN")),
    ],
)
def test_a_surface_element_of_corners_alone_is_its_polygon(name, count):
    mesh = load(grids(SQUARE) + card(name, range(1, count + 1)))

    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]][: count - 2]


@pytest.mark.parametrize("name", SOLIDS)
@pytest.mark.parametrize("is_mirrored", [False, True])
def test_a_solid_is_its_boundary_turned_outwards(name, is_mirrored):
    places = [(x, y, -z) if is_mirrored else (x, y, z) for x, y, z in SOLIDS[name]]

    mesh = load(grids(places) + card(name, range(1, len(places) + 1)))

    assert mesh.is_watertight
    assert area(mesh) == pytest.approx(MEASURES[name][0], rel=1e-15)
    assert volume(mesh) == pytest.approx(MEASURES[name][1], rel=1e-15)


@pytest.mark.parametrize("name", EDGES)
def test_each_middle_node_of_a_solid_stands_on_its_own_edge(name):
    corners = SOLIDS[name]
    middles = middle_nodes(name)
    nodes = range(1, len(corners) + len(middles) + 1)

    mesh = load(grids([*corners, *middles]) + card(name, nodes))

    # A middle node that were taken for another edge's would fold faces.
    assert mesh.is_watertight
    assert set(mesh.triangles.ravel().tolist()) == {node - 1 for node in nodes}
    assert area(mesh) == pytest.approx(MEASURES[name][0], rel=1e-15)
    assert volume(mesh) == pytest.approx(MEASURES[name][1], rel=1e-15)


@pytest.mark.parametrize("name", EDGES)
def test_each_middle_node_of_a_solid_may_be_missing(name):
    corners = SOLIDS[name]
    for missing in range(len(EDGES[name])):
        middles = middle_nodes(name)
        nodes = list(range(1, len(corners) + len(middles) + 1))
        nodes[len(corners) + missing] = ("", 0)[missing % 2]

        mesh = load(grids([*corners, *middles]) + card(name, nodes))

        used = set(mesh.triangles.ravel().tolist())
        assert used == {node - 1 for node in nodes if node}
        assert area(mesh) == pytest.approx(MEASURES[name][0], rel=1e-15)
        assert volume(mesh) == pytest.approx(MEASURES[name][1], rel=1e-15)


@pytest.mark.parametrize("name", ["CQUAD8", "CPLSTN8", "CPLSTS8", "CQPSTN", "CQUAD"])
@pytest.mark.parametrize("kept", list(itertools.product([False, True], repeat=4)))
def test_a_quad_goes_through_the_middle_nodes_it_has(name, kept):
    middles = [5 + k if there else "" for k, there in enumerate(kept)]

    mesh = load(grids(SQUARE + RAISED) + card(name, [1, 2, 3, 4, *middles]))

    used = set(mesh.triangles.ravel().tolist())
    assert used == {0, 1, 2, 3, *(4 + k for k, there in enumerate(kept) if there)}
    assert mesh.bounds[1, 2] == any(kept)


def test_a_quad_of_nine_nodes_goes_through_its_middle():
    mesh = load(grids(SQUARE + RAISED) + card("CQUAD", range(1, 10)))

    assert set(mesh.triangles.ravel().tolist()) == set(range(9))
    assert mesh.bounds.tolist() == [[0, 0, 0], [2, 2, 2]]
    assert mesh.notes == ("1 quadratic quad cut into 8 flat pieces through its nodes",)


@pytest.mark.parametrize("name", ["CTRIA6", "CPLSTN6", "CPLSTS6", "CTPSTN"])
@pytest.mark.parametrize("kept", list(itertools.product([False, True], repeat=3)))
def test_a_triangle_goes_through_the_middle_nodes_it_has(name, kept):
    places = [(0, 0, 0), (2, 0, 0), (0, 2, 0), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    middles = [4 + k if there else 0 for k, there in enumerate(kept)]

    mesh = load(grids(places) + card(name, [1, 2, 3, *middles]))

    used = set(mesh.triangles.ravel().tolist())
    assert used == {0, 1, 2, *(3 + k for k, there in enumerate(kept) if there)}


@pytest.mark.parametrize(
    ("name", "corners", "middles", "field"),
    [
        *(("CTRIA3", 3, 0, 6), ("CTRIAR", 3, 0, 6), ("CTRIA6", 3, 3, 9)),
        *(("CQUAD4", 4, 0, 7), ("CQUADR", 4, 0, 7), ("CQUAD8", 4, 4, 15)),
    ],
)
def test_the_offset_is_read_from_its_own_field(name, corners, middles, field):
    nodes = [*range(1, corners + 1), *[""] * middles]
    told = "1 shell stands off its GRIDs (ZOFFS), at which it is taken"
    for place in range(2 + len(nodes), 18):
        behind = [""] * (place - 2 - len(nodes)) + ["1.5"]

        mesh = load(grids(SQUARE) + card(name, nodes, behind))

        assert (told in mesh.notes) == (place == field)


@pytest.mark.parametrize(
    ("name", "with_middles"),
    [*((name, False) for name in SOLIDS), *((name, True) for name in EDGES)],
)
def test_a_material_system_behind_a_solid_is_no_grid(name, with_middles):
    middles = middle_nodes(name) if with_middles else []
    nodes = range(1, len(SOLIDS[name]) + len(middles) + 1)
    deck = grids([*SOLIDS[name], *middles])
    line = card(name, nodes)

    mesh = load(deck + line + "+       CORDM   7\n")

    assert mesh.triangles.tolist() == load(deck + line).triangles.tolist()


def test_every_element_that_is_read_is_tried_here():
    tried = {
        *("CTRIA3", "CTRIAR", "CTRIA6", "CPLSTN3", "CPLSTS3", "CPLSTN6", "CPLSTS6"),
        *("CQUAD4", "CQUADR", "CQUAD8", "CQUAD", "CSHEAR", "CPLSTN4", "CPLSTS4"),
        *("CPLSTN8", "CPLSTS8", "CQPSTN", "CTPSTN", *SOLIDS),
    }

    assert {name.decode() for name in nastran_cards.ELEMENTS} == tried


def test_neighbours_hide_the_face_between_them_and_a_skin_counts_once():
    upper = grids([(x, y, z + 1) for x, y, z in CUBE_PLACES[4:]], first=9)
    deck = CUBE + upper + "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\nCHEXA,2,1,5,6,7,8,9,10,+\n+,11,12\n"

    mesh, skinned = load(deck), load(deck + "CQUAD4,3,1,4,3,2,1\n")

    assert (len(mesh.triangles), area(mesh), volume(mesh)) == (20, 10, 2)
    assert len(skinned.triangles) == 20
    assert skinned.triangles[:2].tolist() == [[3, 2, 1], [3, 1, 0]]


@pytest.mark.parametrize(
    ("cards", "fault"),
    [
        ("CQUAD4,1,1,1,2,3\n", r":5: CQUAD4 has '', expected the GRID of corner 4"),
        ("CTRIA3,1,1,1,2,0\n", r":5: CTRIA3 has '0', expected the GRID of corner 3"),
        ("CTRIA3,1,1,1,2,3.\n", r":5: CTRIA3 has '3.', expected the GRID of corner 3"),
        ("CTRIA3,1,1,1,2,-3\n", r":5: CTRIA3 has '-3', expected"),
        ("CTRIA3,1,1,1,2,1 3\n", r":5: CTRIA3 has '1 3', expected"),
        ("CTRIA3,0,1,1,2,3\n", r":5: CTRIA3 has '0', expected a number above 0"),
        ("CTRIA3,,1,1,2,3\n", r":5: CTRIA3 has '', expected a number above 0"),
        ("CTRIA6,1,1,1,2,3,x\n", r":5: CTRIA6 has 'X', expected a GRID or nothing"),
        (
            "CTRIA3,8,1,1,2,99\n",
            r":5: CTRIA3 8 uses GRID 99, which is not in the deck; add the GRID, or the INCLUDE",
        ),
        (
            "CTRIA3,8,1,1,2,3\nCTRIA3,8,1,1,2,4\n",
            r":6: element 8 is another one than at <stdin>:5; give each element a number",
        ),
        ("CTRIA3,8,1,1,2,3\nCTRIAR,8,1,1,2,3\n", r":6: element 8 is another one than at"),
        ("GRID,3,,2.,2.5\nCTRIA3,8,1,1,2,3\n", r":5: GRID 3 stands elsewhere than at <stdin>:3"),
        ("GRID,x\nCTRIA3,8,1,1,2,3\n", r":5: GRID has 'X', expected a number above 0"),
        ("GRID,9,,1..2\nCTRIA3,8,1,1,2,3\n", r":5: GRID has '1..2', expected a coordinate"),
        ("GRID,9,,1.+999\nCTRIA3,8,1,1,2,3\n", r":5: GRID has '1.+999', expected a coordinate"),
        ("GRID,9,,nan\nCTRIA3,8,1,1,2,3\n", r":5: GRID has 'NAN', expected a coordinate"),
        ("GRID,9,,1_0.\nCTRIA3,8,1,1,2,3\n", r":5: GRID has '1_0.', expected a coordinate"),
        ("GRID,9,c\nCTRIA3,8,1,1,2,3\n", r":5: GRID has 'C', expected the number of a system"),
    ],
)
def test_fields_that_are_not_what_they_should_be_are_refused(cards, fault):
    with pytest.raises(MeshError, match=fault):
        load(grids(SQUARE) + cards)
