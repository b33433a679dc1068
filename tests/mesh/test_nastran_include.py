"""INCLUDE of Nastran decks: which files are read, and which are not."""

from __future__ import annotations

import pytest
from mesh_files.nastran_decks import FORMS, TETRA, TETRA_GRIDS

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

ELEMENT = TETRA.removeprefix(TETRA_GRIDS)


def written(folder, **files: str):
    """Write files whose names have two underscores for a point, and return the deck `main.bdf`."""
    for name, text in files.items():
        path = folder / name.replace("__", ".").replace("_in_", "/")
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    return folder / "main.bdf"


@pytest.mark.parametrize(
    "statement",
    [
        "INCLUDE 'grids.inc'",
        'include "grids.inc"',
        "Include grids.inc $ the points",
        "  INCLUDE   'grids.inc' ",
        "INCLUDE 'gri\n   ds.i\nnc'",
        "INCLUDE './grids.inc'",
        "INCLUDE '.\\grids.inc'",
    ],
)
def test_an_included_file_stands_in_the_place_of_its_statement(statement, tmp_path):
    deck = written(
        tmp_path, main__bdf=f"BEGIN BULK\n{statement}\n{ELEMENT}ENDDATA\n", grids__inc=TETRA_GRIDS
    )

    mesh, whole = load_mesh(deck), load_mesh_bytes(TETRA.encode(), ".bdf")

    assert mesh.vertices.tolist() == whole.vertices.tolist()
    assert mesh.triangles.tolist() == whole.triangles.tolist()


def test_files_may_include_others_from_folders_below(tmp_path):
    deck = written(
        tmp_path,
        main__bdf="CEND\nINCLUDE 'case.inc'\nBEGIN BULK\nINCLUDE 'parts/all.inc'\nENDDATA\n",
        case__inc="TITLE = 'INCLUDE'\n",
        parts_in_all__inc="INCLUDE 'grids.inc'\nINCLUDE 'element.inc'\n",
        parts_in_grids__inc=TETRA_GRIDS,
        element__inc=ELEMENT,
    )

    assert len(load_mesh(deck).triangles) == 4


def test_begin_bulk_and_enddata_may_stand_in_included_files(tmp_path):
    deck = written(
        tmp_path, main__bdf="SOL 101\nINCLUDE 'all.inc'\n$ so\n", all__inc=FORMS["small"]
    )

    assert len(load_mesh(deck).triangles) == 4


def test_superelements_may_include_one_file_each(tmp_path):
    sections = "".join(f"BEGIN SUPER={k}\nINCLUDE 'same.inc'\n" for k in range(1, 4))

    deck = written(tmp_path, main__bdf=sections, same__inc=TETRA)

    assert len(load_mesh(deck).triangles) == 12


def test_includes_behind_comments_and_enddata_are_none(tmp_path):
    deck = written(tmp_path, main__bdf=f"$ INCLUDE 'no.inc'\n{TETRA}ENDDATA\nINCLUDE 'no.inc'\n")

    assert len(load_mesh(deck).triangles) == 4


@pytest.mark.parametrize(
    ("files", "fault"),
    [
        (
            {"main__bdf": f"{TETRA}INCLUDE 'no.inc'\n"},
            r"main.bdf:6: INCLUDE 'no.inc': there is no such file beside it; copy the file to ",
        ),
        (
            {"main__bdf": "INCLUDE '../a.inc'\n"},
            r"main.bdf:1: INCLUDE '../a.inc' is not a path at or",
        ),
        (
            {"main__bdf": "INCLUDE '/etc/passwd'\n"},
            r"main.bdf:1: INCLUDE '/etc/passwd' is not a path",
        ),
        ({"main__bdf": "INCLUDE 'C:\\a.inc'\n"}, r"main.bdf:1: INCLUDE 'C:\\a.inc' is not a path"),
        ({"main__bdf": "INCLUDE 'a\\..\\..\\b'\n"}, r"main.bdf:1: .* is not a path at or below"),
        (
            {"main__bdf": "INCLUDE 'link.inc'\n"},
            r"main.bdf:1: .*'link.inc' leads out of the deck's",
        ),
        ({"main__bdf": "INCLUDE\n"}, r"main.bdf:1: INCLUDE names no file"),
        ({"main__bdf": "INCLUDE 'a.inc\n"}, r"main.bdf:1: INCLUDE's name has no closing quote"),
        ({"main__bdf": "INCLUDE 'main.bdf'\n"}, r"main.bdf:1: INCLUDE 'main.bdf' includes itself"),
        (
            {"main__bdf": "INCLUDE 'a.inc'\n", "a__inc": "\nINCLUDE 'main.bdf'\n"},
            r"a.inc:2: INCLUDE 'main.bdf' includes itself; take it out",
        ),
        (
            {"main__bdf": "INCLUDE 'a.inc'\nGRID,9\n", "a__inc": f"{TETRA}ENDDATA\n"},
            r"a.inc:6: ENDDATA in an included file, but lines follow in the file that names it",
        ),
        (
            {"main__bdf": "\nINCLUDE 'a.inc'\nGRID,9\n", "a__inc": f"{TETRA}CWHAT,1\n"},
            r"a.inc:6: CWHAT is no card that is known here",
        ),
        (
            {"main__bdf": f"\nINCLUDE 'a.inc'\nCWHAT,9\n{ELEMENT}", "a__inc": TETRA_GRIDS},
            r"main.bdf:3: CWHAT is no card that is known here",
        ),
    ],
)
def test_includes_that_lead_astray_are_refused(files, fault, tmp_path):
    folder = tmp_path / "deck"
    folder.mkdir()
    (tmp_path / "a.inc").write_text(TETRA)
    (folder / "link.inc").symlink_to(tmp_path / "a.inc")

    with pytest.raises(MeshError, match=fault):
        load_mesh(written(folder, **files))


def test_a_stream_includes_nothing():
    with pytest.raises(
        MeshError, match=r":1: INCLUDE 'a.inc' names a file, and a stream lies in no"
    ):
        load_mesh_bytes(b"INCLUDE 'a.inc'\n", ".bdf")


def test_files_that_multiply_one_another_do_not_fill_the_memory(tmp_path):
    files = {f"f{k}__inc": f"INCLUDE 'f{k + 1}.inc'\n" * 10 for k in range(12)}
    files["f12__inc"] = TETRA_GRIDS * 100

    with pytest.raises(MeshError, match="INCLUDE repeats files until they fill the memory"):
        load_mesh(written(tmp_path, main__bdf="INCLUDE 'f0.inc'\n", **files))


def test_deep_chains_of_files_end(tmp_path):
    files = {f"f{k}__inc": f"INCLUDE 'f{k + 1}.inc'\n" for k in range(30)}

    with pytest.raises(MeshError, match="INCLUDE goes deeper than 20 files"):
        load_mesh(written(tmp_path, main__bdf="INCLUDE 'f0.inc'\n", f30__inc=TETRA, **files))
