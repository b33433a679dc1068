"""Volume cells that a file holds twice: the body is there, and no face of it hides another."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.cell_files import POINTS, write
from mesh_files.nastran_decks import CUBE, TETRA

from obbcli.mesh import load_mesh, load_mesh_bytes
from obbcli.mesh.formats.cells.surface import Block, surface
from obbcli.mesh.source import Source

HEXAHEDRON = [0, 1, 2, 3, 4, 5, 6, 7]


def faces(blocks) -> tuple[list[list[int]], tuple[str, ...]]:
    """Return triangles and notes of cells of the unit cube's corners and a point above."""
    source = Source("a", "a", b"")
    triangles = surface(source, POINTS, [Block(kind, np.array(nodes)) for kind, nodes in blocks])
    return triangles.tolist(), tuple(source.notes)


@pytest.mark.parametrize(
    "again",
    [
        ("hexahedron", [HEXAHEDRON]),
        ("hexahedron", [[1, 2, 3, 0, 5, 6, 7, 4]]),
        ("hexahedron", [[0, 3, 2, 1, 4, 7, 6, 5], HEXAHEDRON]),
        ("hexahedron20", [[*HEXAHEDRON, *[-1] * 12]]),
    ],
)
def test_a_cell_that_stands_twice_counts_once(again):
    once, notes = faces([("hexahedron", [HEXAHEDRON])])

    found, told = faces([("hexahedron", [HEXAHEDRON]), again])

    assert found == once
    count = len(again[1])
    first = "1 volume cell repeats an earlier one and is left out"
    assert told == (
        first if count == 1 else f"{count} volume cells repeat earlier ones and are left out",
        *notes,
    )


def test_the_face_to_a_neighbour_stays_hidden():
    pyramid = ("pyramid", [[4, 5, 6, 7, 8]])
    once, _ = faces([("hexahedron", [HEXAHEDRON]), pyramid])

    found, _ = faces([("hexahedron", [HEXAHEDRON, HEXAHEDRON]), pyramid, pyramid])

    assert found == once
    assert len(once) == 10 + 4


def test_cells_that_share_some_corners_are_all_taken():
    pairs = [[0, 1, 2, 5], [0, 1, 2, 6], [0, 1, 5, 6]]

    _, told = faces([("tetra", pairs)])

    assert told == ("3 volume cells taken as their boundary",)


def test_surface_cells_that_stand_twice_are_rows_of_their_own():
    found, told = faces([("triangle", [[0, 1, 2], [0, 1, 2]])])

    assert found == [[0, 1, 2], [0, 1, 2]]
    assert told == ()


def test_a_nastran_deck_may_name_one_body_twice():
    deck = TETRA + "CTETRA,2,1,4,2,3,1\n"

    mesh = load_mesh_bytes(deck.encode(), ".bdf")

    assert mesh.is_watertight
    assert len(mesh.triangles) == 4


def test_other_formats_may_too(tmp_path):
    cells = [("hexahedron", np.array([HEXAHEDRON, HEXAHEDRON]))]
    path = write(tmp_path / "a.msh", cells, file_format="gmsh")

    assert load_mesh(path).is_watertight
    assert (
        len(load_mesh_bytes((CUBE + "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n").encode(), ".bdf").triangles)
        == 12
    )
