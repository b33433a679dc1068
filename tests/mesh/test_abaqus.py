"""Abaqus and CalculiX decks: values by hand from the definitions of the keywords."""

from __future__ import annotations

import math

import meshio
import numpy as np
import pytest
from mesh_files.abaqus_decks import PART, TETRA, TETRA_NODES, corners, deck, volume
from mesh_files.cell_files import POINTS, write

from obbcli.mesh import load_mesh


def test_flat_deck_gives_the_boundary_of_its_cells():
    mesh = deck(TETRA)

    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert len(mesh.triangles) == 4
    assert volume(mesh) == pytest.approx(1 / 6)
    assert mesh.notes == ("1 volume cell taken as its boundary",)


@pytest.mark.parametrize(
    "text",
    [
        TETRA.lower(),
        TETRA.replace("*NODE", "* Node").replace("*ELEMENT, TYPE=C3D4", "*Element , Type = c3d4"),
        TETRA.replace("\n", "\r\n"),
        TETRA.replace("\n", "\r"),
        "** first\n" + TETRA.replace("2, 1.", "**, a comment, in a block\n  ** another\n2, 1."),
        TETRA.replace("1, 1, 2, 3, 4", "1, 1, 2,\n** between\n 3, 4"),
        TETRA.replace("*ELEMENT, TYPE=C3D4", "*ELEMENT,\nTYPE=C3D4, ELSET=all"),
        TETRA.replace("3, 0., 1., 0.", "3, , 1.D0").replace("2, 1., 0., 0.", "2, 1."),
        TETRA.replace("1., 0., 0.\n", "1., 0., 0., 0., 0., 1.\n"),
        TETRA.replace("*ELEMENT", "*NSET, NSET=a\n1, 2\n*SOLID SECTION, ELSET=e\n,\n*ELEMENT"),
        "*HEADING\na title, 1\n" + TETRA + "*STEP\n*ANY THING, OF=A STEP\n1, 2\n*END STEP\n",
        "\ufeff\n\n" + TETRA,
        TETRA.replace("1, 1, 2, 3, 4", "1, 1, 2, 3, 4,"),
    ],
    ids=str,
)
def test_the_same_deck_may_be_written_in_many_ways(text):
    mesh = deck(text)

    np.testing.assert_array_equal(mesh.vertices, deck(TETRA).vertices)
    np.testing.assert_array_equal(mesh.triangles, deck(TETRA).triangles)


def test_comments_and_blank_lines_anywhere_change_nothing():
    whole = deck(PART + "*ASSEMBLY\n*INSTANCE, NAME=a, PART=tet\n1, 0, 0\n*END INSTANCE\n")
    lines = (PART + "*ASSEMBLY\n*INSTANCE, NAME=a, PART=tet\n1, 0, 0\n*END INSTANCE\n").splitlines()

    for at in range(len(lines) + 1):
        for more in ('** 1, 2, *NODE, "', "   ** x", ""):
            mesh = deck("\n".join([*lines[:at], more, *lines[at:]]))
            assert corners(mesh) == corners(whole)


def test_numbers_of_blocks_of_nodes_go_on():
    first = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n*NODE, NSET=more\n4, 0., 0., 1.\n"
    second = "*ELEMENT, TYPE=S3\n9, 1, 2, 3\n*NODE\n10, 5, 5, 5\n*ELEMENT, TYPE=R3D3\n4, 1, 2, 10\n"

    mesh = deck(first + second)

    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 1, 4]]
    assert mesh.vertices[4].tolist() == [5, 5, 5]


def test_nodes_may_come_after_the_elements_that_use_them():
    nodes, elements = TETRA.split("*ELEMENT")

    assert corners(deck(f"*ELEMENT{elements}{nodes}")) == corners(deck(TETRA))


# Two parts, whose numbers are their own; the instances are shifted, and turned by 90 degrees about
# the line along z through (1, 0, 0): (x, y, z) + (1, 0, 0) becomes (1 - y, x, z).
ASSEMBLY = """*HEADING
{part}*PART, NAME=Sheet
*NODE
1, 0, 0, 0
2, 2, 0, 0
3, 2, 2, 0
4, 0, 2, 0
*ELEMENT, TYPE=S4R
1, 1, 2, 3, 4
*END PART
*ASSEMBLY, NAME=all
*INSTANCE, NAME=one, PART=TET
*END INSTANCE
*INSTANCE, NAME=two, PART="Tet"
10., 0., 0.
*END INSTANCE
*INSTANCE, NAME=three, PART=Tet
1., 0., 0.
1., 0., 0., 1., 0., 5., 90.
*END INSTANCE
*INSTANCE, NAME=four, PART=Sheet
0., 0., 7.
*END INSTANCE
*NODE
1, 99, 99, 99
*ELEMENT, TYPE=MASS
1, one.1
*END ASSEMBLY
"""


def test_instances_stand_where_they_are_placed():
    mesh = deck(ASSEMBLY.format(part=PART))

    assert len(mesh.triangles) == 4 + 4 + 4 + 2
    one, two, three, four = np.split(mesh.vertices[:16], 4)
    tetra = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    np.testing.assert_array_equal(one, tetra)
    np.testing.assert_array_equal(two, tetra + np.array([10, 0, 0]))
    np.testing.assert_array_equal(three, [[1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 0, 1]])
    np.testing.assert_array_equal(four, [[0, 0, 7], [2, 0, 7], [2, 2, 7], [0, 2, 7]])
    assert mesh.triangles[12:].tolist() == [[12, 13, 14], [12, 14, 15]]


def test_an_instance_may_turn_by_any_angle_about_any_axis():
    turned = PART + "*ASSEMBLY\n*INSTANCE, NAME=a, PART=Tet\n0,0,1\n{}\n*END INSTANCE\n"

    # A third of a turn about (1, 1, 1) through the origin takes x to y, y to z, z to x.
    third = deck(turned.format("0, 0, 0, 2, 2, 2, 120"))
    sixth = deck(turned.format("0, 0, 0, 0, 0, 1, 30"))

    moved = np.array([[0, 0, 1], [1, 0, 1], [0, 1, 1], [0, 0, 2.0]])
    np.testing.assert_allclose(third.vertices, moved[:, [2, 0, 1]], atol=1e-15)
    half = math.sqrt(3) / 2
    expected = [[0, 0, 1], [half, 0.5, 1], [-0.5, half, 1], [0, 0, 2]]
    np.testing.assert_allclose(sixth.vertices, expected, atol=1e-15)


def test_what_an_instance_defines_itself_stands_where_it_does():
    own = "*PART, NAME=empty\n*END PART\n*ASSEMBLY\n*INSTANCE, NAME=a, PART=empty\n0, 0, 3\n"

    mesh = deck(own + TETRA + "*END INSTANCE\n*END ASSEMBLY\n")

    assert mesh.bounds.tolist() == [[0, 0, 3], [1, 1, 4]]


def test_parts_without_an_assembly_are_taken_where_they_are_written():
    mesh = deck(PART)

    assert len(mesh.triangles) == 4
    assert "1 part taken where written: no *INSTANCE places any" in mesh.notes


def test_parts_without_an_instance_are_told():
    left = PART.replace("Tet", "Left")

    mesh = deck(PART + left + "*ASSEMBLY\n*INSTANCE, NAME=a, PART=Tet\n*END INSTANCE\n")

    assert len(mesh.triangles) == 4
    assert "1 part without an instance left out: 'Left'" in mesh.notes


@pytest.mark.parametrize(
    ("system", "expected"),
    [
        ("1, 2, 3", [[1, 2, 3], [2, 2, 3], [1, 3, 3], [1, 2, 4]]),
        # X along y, the plane of X and Y holds z: Y is z, Z is x.
        ("0, 0, 0, 0, 1, 0\n0, 0, 1", [[0, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 0]]),
        ("5, 0, 0, 5, 2, 0\n5, 3, 1", [[5, 0, 0], [5, 1, 0], [5, 0, 1], [6, 0, 0]]),
        # Without a second line Z stays and X is projected onto the plane of x and y.
        ("0, 0, 1, 0, 4, 9", [[0, 0, 1], [0, 1, 1], [-1, 0, 1], [0, 0, 2]]),
    ],
)
def test_nodes_stand_in_the_system_before_them(system, expected):
    mesh = deck(f"*SYSTEM\n{system}\n{TETRA}*SYSTEM\n*NODE\n5, 1, 2, 3\n")

    np.testing.assert_allclose(mesh.vertices[:4], expected, atol=1e-15)
    assert mesh.vertices[4].tolist() == [1, 2, 3]


def test_a_system_ends_with_its_part():
    other = PART.replace("Tet", "Other")
    placed = "".join(
        f"*INSTANCE, NAME={name}, PART={name}\n*END INSTANCE\n" for name in ("Tet", "Other")
    )

    mesh = deck(PART.replace("*NODE", "*SYSTEM\n5,0,0\n*NODE") + other + "*ASSEMBLY\n" + placed)

    assert mesh.bounds.tolist() == [[0, 0, 0], [6, 1, 1]]


def test_cylindrical_nodes_are_radius_angle_and_height():
    nodes = "*NODE, SYSTEM=C\n1, 2., 0., 5.\n2, 2., 90., 5.\n3, 2., 180., 6.\n4, 2, 30, 0\n"

    mesh = deck(nodes + "*ELEMENT, TYPE=S4\n1, 1, 2, 3, 4\n")

    expected = [[2, 0, 5], [0, 2, 5], [-2, 0, 6], [math.sqrt(3), 1, 0]]
    np.testing.assert_allclose(mesh.vertices, expected, atol=1e-15)
    np.testing.assert_array_equal(mesh.vertices[:3], expected[:3])


def test_the_last_of_several_definitions_counts_and_is_told():
    again = TETRA + "*NODE\n4, 0, 0, 3\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 4, 3\n"

    mesh = deck(again)

    assert mesh.bounds.tolist() == [[0, 0, 0], [1, 1, 3]]
    assert len(mesh.triangles) == 4
    assert "1 node defined more than once taken where defined last" in mesh.notes
    told = "1 element left out: defined again later, and the last definition counts"
    assert told in mesh.notes


def test_an_element_without_surface_takes_the_place_of_one_of_its_number():
    mesh = deck(TETRA + "*ELEMENT, TYPE=S3\n2, 1, 2, 3\n*ELEMENT, TYPE=T3D2\n2, 1, 2\n")

    assert len(mesh.triangles) == 4
    assert any(note.startswith("1 element left out") for note in mesh.notes)


def test_includes_and_inputs_below_the_folder_are_followed(tmp_path):
    (tmp_path / "sub" / "deep").mkdir(parents=True)
    (tmp_path / "sub" / "nodes.txt").write_text(
        "** a comment\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n"
    )
    (tmp_path / "sub" / "mesh.inc").write_text(
        '*NODE, INPUT="sub/nodes.txt"\n*INCLUDE, INPUT=sub\\deep\\elements.inc\n'
    )
    (tmp_path / "sub" / "deep" / "elements.inc").write_text("*ELEMENT, TYPE=S3\n1, 1, 2, 3\n")
    (tmp_path / "deck.inp").write_text("*INCLUDE, INPUT=sub/mesh.inc\n*NODE\n4, 9, 9, 9\n")

    mesh = load_mesh(tmp_path / "deck.inp")

    assert mesh.triangles.tolist() == [[0, 1, 2]]
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [9, 9, 9]]
    names = r"sub/mesh.inc, sub/nodes.txt, sub\deep\elements.inc"
    assert mesh.notes == (f"3 files that the deck names read with it: {names}",)


def test_axisymmetric_elements_are_flat_sections_and_told():
    mesh = deck(TETRA_NODES + "*ELEMENT, TYPE=CAX3\n1, 1, 2, 3\n")

    assert mesh.triangles.tolist() == [[0, 1, 2]]
    told = "axisymmetric elements taken as the flat section that they are, not turned"
    assert told in mesh.notes


@pytest.mark.parametrize(
    ("keyword", "told"),
    [
        ("*TIE, NAME=t", "*TIE may move nodes"),
        ("*CONTACT PAIR, ADJUST=0.1, INTERACTION=i", "*CONTACT PAIR may move nodes"),
        ("*CYCLIC SYMMETRY MODEL, N=7, NGRAPH=7, TIE=a", "taken as the one sector"),
        ("*STEP\n*MODEL CHANGE, REMOVE", "that *MODEL CHANGE removes in a step are taken"),
    ],
)
def test_what_gives_the_analysis_another_shape_is_told(keyword, told):
    notes = deck(f"{TETRA}{keyword}\na, b\n").notes

    assert any(told in note for note in notes)


@pytest.mark.parametrize("keyword", ["*TIE, ADJUST=NO, NAME=t", "*CONTACT PAIR, INTERACTION=i"])
def test_what_moves_no_node_is_not_told(keyword):
    assert deck(f"{TETRA}{keyword}\na, b\n").notes == deck(TETRA).notes


def test_keywords_may_be_abbreviated_where_they_are_passed_over():
    mesh = deck(TETRA + "*MEMBRANE, ELSET=e\n0.1\n*ORIENT, NAME=o\n1, 0, 0, 0, 1, 0\n")

    assert corners(mesh) == corners(deck(TETRA))


@pytest.mark.parametrize("cells", [[("tetra", [[0, 1, 2, 5]]), ("triangle", [[0, 1, 2]])], None])
def test_decks_that_meshio_writes_are_read_as_it_reads_them(tmp_path, cells):
    cells = cells or [("hexahedron", [list(range(8))]), ("quad", [[0, 1, 2, 3]])]
    path = write(tmp_path / "a.inp", [(kind, np.array(rows)) for kind, rows in cells])

    mesh, other = load_mesh(path), meshio.read(path)

    np.testing.assert_array_equal(mesh.vertices, other.points)
    np.testing.assert_array_equal(mesh.vertices, POINTS)
    flat = other.cells[1].data
    assert mesh.triangles[: len(flat)].tolist() == flat[:, :3].tolist()
