"""Nastran decks: fields, lines, sections. Values are written by hand from the cards."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.nastran_decks import CUBE, FORMS, TETRA, TETRA_GRIDS, TETRA_PLACES, grids

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes

#: The faces of a tetrahedron, each turned outwards.
OUTWARD = {(0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)}


def load(deck: str | bytes, suffix: str = ".bdf"):
    return load_mesh_bytes(deck if isinstance(deck, bytes) else deck.encode("utf-8"), suffix)


def turned(triangle) -> tuple[int, ...]:
    """Return a triangle from its least corner on."""
    first = int(np.argmin(triangle))
    return tuple(int(corner) for corner in np.roll(triangle, -first))


def same(mesh, places=TETRA_PLACES) -> bool:
    """Return whether a mesh is the tetrahedron with corners at these places."""
    faces = {turned(triangle) for triangle in mesh.triangles}
    return mesh.vertices.tolist() == [list(p) for p in places] and faces == {
        turned(face) for face in OUTWARD
    }


@pytest.mark.parametrize("form", FORMS)
def test_nastran_reads_every_form_of_a_deck(form):
    assert same(load(FORMS[form]))


@pytest.mark.parametrize("suffix", [".bdf", ".fem", ".nas"])
@pytest.mark.parametrize(
    "change",
    [
        lambda deck: deck.replace(b"\n", b"\r\n"),
        lambda deck: deck.replace(b"\n", b"\r"),
        lambda deck: b"\xef\xbb\xbf" + deck,
        lambda deck: deck.decode().encode("utf-16"),
        lambda deck: deck + b"\x1a",
        lambda deck: "$ Gehäuse\n".encode("latin-1") + deck,
        lambda deck: deck.rstrip(b"\n"),
        lambda deck: deck.replace(b"ENDDATA", b"ENDDATA 1f\nGRID,1,,9.,9.,9.\nCWHAT"),
        lambda deck: deck.replace(b"ENDDATA\n", b""),
        lambda deck: deck.replace(b"BEGIN BULK", b" begin   bulk  $ here"),
    ],
)
def test_nastran_reads_what_editors_make_of_a_deck(change, suffix):
    assert same(load(change(FORMS["small"].encode("ascii")), suffix))


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("1.5-3", 1.5e-3),
        ("1.5+3", 1500.0),
        ("-1.5-3", -1.5e-3),
        ("+.5D2", 50.0),
        ("1.5E-3", 1.5e-3),
        ("1.d+2", 100.0),
        ("7.-2", 0.07),
        ("-.7", -0.7),
        ("3", 3.0),
        ("2.5e1", 25.0),
        ("0.1", 0.1),
    ],
)
@pytest.mark.parametrize("form", ["GRID    1               {:<8}", "GRID,1,,{}", "GRID\t1\t\t{}"])
def test_nastran_reads_numbers_as_its_programs_write_them(word, value, form):
    deck = form.format(word) + "\n" + TETRA.split("\n", 1)[1]

    assert load(deck).vertices[0].tolist() == [value, 0, 0]


def test_numbers_become_the_nearest_double():
    digits = "0.1234567890123456789"

    mesh = load(f"GRID,1,,{digits},{digits}-5\n" + TETRA.split("\n", 1)[1])

    assert mesh.vertices[0].tolist() == [float(digits), float(digits + "e-5"), 0]


def test_comments_and_blank_lines_anywhere_change_nothing():
    deck = (
        "SOL 101\nCEND\nTITLE=GRID\nBEGIN BULK\nCORD2R,7,,1.,0.,0.,1.,0.,1.\n,2.,0.,0.\n"
        + FORMS["large"].replace(
            "               0            0.D0", "               7           -1.D0"
        )
        + "PSHELL,1,1\nENDDATA\n"
    )
    plain = load(deck)
    said = "".join(f"$ GRID,1\n{line} $ CTRIA3,1\n \n\t\n// so\n" for line in deck.splitlines())

    commented = load(said)

    assert commented.vertices.tolist() == plain.vertices.tolist()
    assert commented.triangles.tolist() == plain.triangles.tolist()
    assert commented.notes == plain.notes


def test_what_stands_behind_column_80_is_no_data():
    line = "GRID    2               1.".ljust(80) + "9.      77\n"

    assert same(load(TETRA.replace("GRID    2               1.      0.      0.\n", line)))


def test_serial_numbers_in_the_last_columns_are_no_data():
    lines = [line.ljust(72) + f"{k:08d}" for k, line in enumerate(FORMS["small"].splitlines())]

    assert same(load("\n".join(lines)))


def test_triangles_come_in_the_order_of_their_cards():
    deck = CUBE + "CQUAD4,9,1,1,2,3,4\nCTRIA3,3,1,5,6,7\nCQUAD4,1,1,5,6,7,8\nCTRIA3,2,1,1,2,3\n"

    assert load(deck).triangles.tolist() == [
        [0, 1, 2],
        [0, 2, 3],
        [4, 5, 6],
        [4, 5, 6],
        [4, 6, 7],
        [0, 1, 2],
    ]


def test_grids_keep_the_files_order_whatever_their_numbers():
    deck = "GRID,77,,1.\nGRID,5,,2.,0.5\nGRID,123456789,,3.\nCTRIA3,1,1,5,77,123456789\n"

    mesh = load(deck)

    assert mesh.vertices.tolist() == [[1, 0, 0], [2, 0.5, 0], [3, 0, 0]]
    assert mesh.triangles.tolist() == [[1, 0, 2]]


def test_cards_that_repeat_an_earlier_one_are_taken_once():
    assert same(load(TETRA + "GRID,3,,,1.0\nCTETRA,1,2,1,2,3,4\n"))


def test_superelements_stand_where_their_grids_do_and_have_numbers_of_their_own():
    deck = (
        f"CEND\nBEGIN SUPER=3\n{TETRA}BEGIN BULK SUPER = 12\n"
        + grids([(5.0, 0.0, 0.0), (6.0, 0.0, 0.0), (5.0, 1.0, 0.0)])
        + "CTRIA3,1,1,1,2,3\nBEGIN BULK\nSEBULK,3,PRIMARY\n"
        + "CORD2R,1,,10.,0.,0.,10.,0.,1.\n,11.,0.,0.\n"
        + grids([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], system=1)
        + "CTRIA3,1,1,1,2,3\nENDDATA\n"
    )

    mesh = load(deck)

    assert mesh.vertices[4:].tolist() == [
        *([5, 0, 0], [6, 0, 0], [5, 1, 0]),
        *([10, 0, 0], [11, 0, 0], [10, 1, 0]),
    ]
    assert mesh.triangles[4:].tolist() == [[4, 5, 6], [7, 8, 9]]
    assert {turned(triangle) for triangle in mesh.triangles[:4]} == {turned(f) for f in OUTWARD}


@pytest.mark.parametrize(
    "card",
    [
        "CTRIA3  1       1       1       2       3       30.     .25\n",
        "CTRIA3  1       1       1       2       3       7       .25\n",
        "CTRIA3,1,1,1,2,3,,2.5-1\n,,.1,.1,.1\n",
        "CTRIA3  1       1       1       2       3               .25     +\n+               .1\n",
    ],
)
def test_angles_and_thicknesses_change_nothing_and_offsets_are_told(card):
    mesh = load(TETRA_GRIDS + card)

    assert mesh.triangles.tolist() == [[0, 1, 2]]
    assert mesh.notes == ("1 shell stands off its GRIDs (ZOFFS), at which it is taken",)


def test_bodies_that_are_passed_over_are_told():
    deck = (
        TETRA
        + "CBAR,5,1,1,2\nCROD,6,1,1,2\nCROD,7,1,1,3\nPSHELL,1,1,.1\nCAERO1,1,1\nCYSYM,12,ROT\n"
    )

    assert load(deck).notes == (
        "1 CBAR, 2 CROD without surface passed over: bars and beams are lines",
        "1 CAERO1 passed over: aerodynamic panels are no structure",
        "1 CYSYM not applied: of a cyclic structure the deck holds one segment",
        "thickness of 1 PSHELL not applied: shells are taken at their GRIDs",
        "1 volume cell taken as its boundary",
    )


@pytest.mark.parametrize("name", ["deck.dat", "deck", "deck.nastran"])
@pytest.mark.parametrize("form", ["small", "punch", "large", "mixed"])
def test_a_deck_is_told_by_its_content(name, form, tmp_path):
    from obbcli.mesh import load_mesh

    (tmp_path / name).write_text(FORMS[form])

    assert same(load_mesh(tmp_path / name))


@pytest.mark.parametrize("begin", ["BEGIN,HYPRBEAM,Square", "BEGIN   HYPRBEAMSquare"])
def test_sections_of_beams_have_no_surface(begin):
    section = f"{begin}\nGRIDS,1,0.,0.\nGRIDS,2,1.,0.\nCSEC2,1,1,1,2\nEND,HYPRBEAM\n"

    assert same(load(section + TETRA))
    assert same(load(f"BEGIN BULK\n{TETRA}{section}ENDDATA\n"))


def test_bars_alone_have_no_surface():
    with pytest.raises(
        MeshError, match=r"no shell and no solid element; its cards are CBAR, GRID;"
    ):
        load("GRID,1\nGRID,2,,1.\nCBAR,1,1,1,2\n")
