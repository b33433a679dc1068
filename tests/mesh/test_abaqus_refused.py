"""Abaqus decks that are refused: each error names the line, what was found, and what to do."""

from __future__ import annotations

import re

import pytest
from mesh_files.abaqus_decks import PART, TETRA, TETRA_NODES, corners, deck

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes
from obbcli.mesh.formats.abaqus import model as abaqus
from obbcli.mesh.formats.abaqus.keywords import PASSED_OVER, REFUSED

INSTANCE = f"{PART}*ASSEMBLY\n*INSTANCE, NAME=a, PART=Tet\n"
WRITE_NODES = "write the nodes where they end up"
EXPORT = "export the mesh that the analysis uses"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("*NMAP, NSET=a, TYPE=RECTANGULAR\n", rf":8: \*NMAP maps .*; {WRITE_NODES}"),
        ("*IMPERFECTION, FILE=f, STEP=1\n", rf":8: \*IMPERFECTION moves nodes.*; {WRITE_NODES}"),
        ("*IMPORT, STEP=1\n", rf":8: \*IMPORT takes the mesh of another analysis.*; {EXPORT}"),
        ("*SYMMETRIC MODEL GENERATION, REVOLVE\n", rf":8: \*SYMMETRICMODEL.*; {EXPORT}"),
        ("*RIGID SURFACE, TYPE=SEGMENTS\n", r":8: \*RIGIDSURFACE makes an analytical .*; mesh it"),
        (
            "*SURFACE, NAME=s, TYPE=REVOLUTION\n0, 0, 0\n",
            r":8: \*SURFACE of type REVOLUTION makes a surface by a formula.*; mesh it with",
        ),
        ("*SURFACE, TYPE=Cylinder, NAME=s\n", r":8: \*SURFACE of type CYLINDER"),
        ("*SURFACE, TYPE=USER, NAME=s\n", r":8: \*SURFACE of type USER"),
        ("*NEW KEYWORD\n", r":8: the keyword \*NEWKEYWORD is not known; write its name in full"),
        # Short for *ELEMENT, so that passing over it would lose surface.
        ("*ELEM, TYPE=S3\n2, 1, 2, 3\n", r":8: the keyword \*ELEM is not known; write its name"),
        ("*IMPERF, FILE=f, STEP=1\n", r":8: the keyword \*IMPERF is not known"),
        ("*NODE, SYSTEM=S\n5, 1, 2, 3\n", r":8: \*NODE with SYSTEM=S is not read; give rect"),
        ("*NODE, SCALE=2\n5, 1, 2, 3\n", r":8: \*NODE with the parameter SCALE is not read; w"),
        ("*ELEMENT, TYPE=COH3D8, OFFSET=9\n2, 1\n", r":8: \*ELEMENT with the parameter OFFSET"),
        ("*ELEMENT\n2, 1, 2, 3\n", r":8: \*ELEMENT without a TYPE is not read; convert them"),
        ("*NODE\n5, 1, x, 3\n", ":9: 'x' is not a number"),
        (
            "*NODE\n5, 1, <size>, 3\n",
            ":9: '<size>' is not a number; write the parameter's value in its place",
        ),
        ("*NODE\n5, 1, nan, 3\n", ":9: 'nan' is not finite; coordinates must be finite"),
        ("*NODE\n5, 1, 1e999, 3\n", ":9: '1e999' is not finite"),
        ("*NODE\n5, 1_0, 1, 3\n", ":9: '1_0' is not a number"),
        ("*NODE\n5, 1 2, 3\n", ":9: '1 2' is not a number"),
        ("*NODE\n5.5, 1, 2\n", ":9: the number of a node 5.5 is not a whole number"),
        ("*NODE\n, 1, 2\n", ":9: the number of a node is missing"),
        ("*NODE\n5, 1, 2, 3, 4, 5, 6, 7\n", ":9: a node with 8 fields, at most 7 wanted"),
        ("*ELEMENT, TYPE=S3\n2, 1, 2, 9\n", ":9: element 2 uses node 9, which is not defined"),
        ("*ELEMENT, TYPE=S3\n2, 1, 2\n", ":9: an element of type S3 with 2 nodes, 3 wanted"),
        ("*ELEMENT, TYPE=S3\n2, 1, 2, 3, 4\n", ":9: an element of type S3 with 4 nodes, 3 wanted"),
        ("*ELEMENT, TYPE=S3\n2, 1, 2, 3\n3, 1\n", ":10: an element of type S3 with 1 nodes"),
        ("*ELEMENT, TYPE=S3\n2, 1, 2, 3\n3, 1,\n2, 3, 1\n", ":10: .* S3 with 4 nodes, 3 wanted"),
        # Nine nodes are not two lines of four and one.
        ("*ELEMENT, TYPE=S9R5\n2, 1, 2, 3, 4\n1, 2, 3, 4, 1\n", ":9: .* S9R5 with 4 nodes, 9"),
        ("*ELEMENT, TYPE=S3\n2, 1, , 3\n", ":9: a number of an element or node is missing"),
        ("*ELEMENT, TYPE=S3\n2, 1, 2.5, 3\n", ":9: .* 2.5 is not a whole number"),
        ("*ELEMENT, TYPE=S3\n2, a.1, a.2, a.3\n", ":9: 'a.1' is not a number"),
        ("*SYSTEM\n0, 0, 0, 1\n0, 0, 0\n0, 1\n", r":8: \*SYSTEM: three points on at most two"),
        ("*SYSTEM\n0, 0, 0, 1, 0, 0\n2, 0, 0\n", r":8: \*SYSTEM: its points lie on a line"),
        ("*SYSTEM\n0, 0, 0\n2, 0, 0\n", r":8: \*SYSTEM: a second line needs a point on the X"),
        ("*SYSTEM\n0, 0, 0, 0, 0, 5\n", r":8: \*SYSTEM: its points lie on a line"),
        ("*END PART\n", r":8: \*ENDPART ends what did not begin; remove it"),
        ("*INCLUDE\n", r":8: \*INCLUDE names no file; add INPUT=FILE"),
        ("*INCLUDE, INPUT=a.inc\n", r":8: \*INCLUDE names 'a.inc'; name the deck's file instead"),
    ],
)
def test_decks_are_refused_with_line_and_remedy(text, fault):
    with pytest.raises(MeshError, match=rf"^<stdin>{fault}"):
        deck(TETRA + text.replace("\n", "\n"))


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (f"{INSTANCE}1, 2\n3, 4\n*END INSTANCE\n", r":13: \*INSTANCE wants a translation and"),
        (f"{INSTANCE}1, 2, 3, 4\n*END INSTANCE\n", r":12: \*INSTANCE wants a translation and"),
        (
            f"{INSTANCE}0, 0, 0\n1, 1, 1, 1, 1, 1, 90\n*END INSTANCE\n",
            r":13: \*INSTANCE wants two different points on the axis",
        ),
        (INSTANCE.replace("PART=Tet", "PART=Other"), r":11: \*INSTANCE of 'OTHER', which is no"),
        (INSTANCE.replace("PART=", "INSTANCE="), r":11: \*INSTANCE with the parameter INSTANCE"),
        (INSTANCE.replace("PART=T", "LIBRARY=l, PART=T"), ":11: .* parameter LIBRARY is not read"),
        (INSTANCE, "ends within the part or instance 'a'; it was cut short"),
        (PART + PART, r":10: \*PART 'TET' begins in another part, or a second time"),
        (PART.replace("*END PART\n", "") * 2, r":9: \*PART 'TET' begins in another part"),
        (PART.replace("*END PART\n", ""), "ends within the part or instance 'Tet'"),
        ("1, 0, 0, 0\n" + TETRA, ":1: '1,' before the first keyword; an Abaqus deck begins"),
        ("** x\n\n/PREP7\n", ":3: '/PREP7' before the first keyword"),
        (TETRA_NODES, "has no surface: 0 elements, none with a face"),
        ("** a comment\n", "has no surface: 0 elements, none with a face"),
    ],
)
def test_structure_of_decks_is_refused_with_the_place(text, fault):
    with pytest.raises(MeshError, match=rf"^<stdin>:? ?{fault}"):
        deck(text)


def test_removing_a_keyword_from_the_guard_is_seen():
    # Each keyword that is refused would else pass unseen: its deck reads without it.
    for keyword in REFUSED:
        with pytest.raises(MeshError, match=rf"\*{keyword}"):
            deck(f"{TETRA}*{keyword}\n")
    assert not set(REFUSED) & PASSED_OVER
    assert not {*abaqus._READERS, *abaqus._STRUCTURE, "INCLUDE"} & (PASSED_OVER | set(REFUSED))


@pytest.mark.parametrize("keyword", ["NMAP", "IMPERFECTION", "RIGIDSURFACE"])
def test_the_guard_does_what_its_list_says(monkeypatch, keyword):
    monkeypatch.delitem(REFUSED, keyword)

    with pytest.raises(MeshError, match=rf"the keyword \*{keyword} is not known"):
        deck(f"{TETRA}*{keyword}\n")


def test_every_keyword_that_is_passed_over_is_passed_over():
    keywords = "".join(f"*{keyword}, NAME=x\n1, 2\n" for keyword in sorted(PASSED_OVER))

    assert corners(deck(TETRA + keywords)) == corners(deck(TETRA))


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("../other.inc", "which is not below the deck's folder; move it"),
        ("/etc/passwd", "which is not below the deck's folder"),
        ("C:\\other.inc", "which is not below the deck's folder"),
        ("sub/../../other.inc", "which is not below the deck's folder"),
        ("missing.inc", "which is no file; put it beside the deck"),
        ("sub", "which is no file"),
        ("link.inc", "which is no file"),
        ("loop.inc", "which includes itself, or too many files"),
        ("deck.inp", "which includes itself, or too many files"),
    ],
)
@pytest.mark.parametrize("keyword", ["*INCLUDE", "*NODE", "*ELEMENT, TYPE=S3"])
def test_files_elsewhere_are_not_followed(tmp_path, name, fault, keyword):
    folder = tmp_path / "decks"
    (folder / "sub").mkdir(parents=True)
    (tmp_path / "other.inc").write_text(TETRA)
    (folder / "link.inc").symlink_to(tmp_path / "other.inc")
    (folder / "loop.inc").write_text("*INCLUDE, INPUT=loop.inc\n")
    path = folder / "deck.inp"
    path.write_text(f"{TETRA}{keyword}, INPUT={name}\n")
    if "itself" in fault and keyword != "*INCLUDE":
        fault = "a keyword in a file of the data of"

    with pytest.raises(MeshError, match=re.escape(fault)):
        load_mesh(path)


def test_errors_in_included_files_name_these(tmp_path):
    (tmp_path / "nodes.inc").write_text("\n1, 0, 0, zero\n")
    (tmp_path / "deck.inp").write_text("*NODE, INPUT=nodes.inc\n")

    with pytest.raises(MeshError, match=r"nodes\.inc:2: 'zero' is not a number"):
        load_mesh(tmp_path / "deck.inp")


def test_data_may_not_stand_here_and_in_a_file(tmp_path):
    (tmp_path / "nodes.inc").write_text("1, 0, 0, 0\n")
    (tmp_path / "deck.inp").write_text("*NODE, INPUT=nodes.inc\n2, 0, 0, 0\n")

    with pytest.raises(MeshError, match=r"deck\.inp:1: \*NODE has data here and in 'nodes\.inc'"):
        load_mesh(tmp_path / "deck.inp")


def test_decks_called_otherwise_are_known_by_their_content():
    mesh = load_mesh_bytes(TETRA.encode(), ".msh")

    assert "is an Abaqus deck by its content, and is read as such" in mesh.notes
    assert corners(mesh) == corners(deck(TETRA))


@pytest.mark.parametrize("size", range(1, len(INSTANCE) + 60, 3))
def test_a_deck_cut_short_is_refused_or_has_whole_elements(size):
    whole = f"{INSTANCE}5., 0., 0.\n*END INSTANCE\n*INSTANCE, NAME=b, PART=Tet\n*END INSTANCE\n"
    try:
        mesh = deck(whole[:size])
    except MeshError:
        return
    assert len(mesh.triangles) in (4, 8)
