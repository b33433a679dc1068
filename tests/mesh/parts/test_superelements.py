"""Superelements of Nastran are parts, which have numbers and cards of their own."""

from __future__ import annotations

import pytest
from claims.parts import require_whole
from mesh_files.nastran_decks import TETRA

from obbcli import MeshError, load_mesh, load_parts

SHEET = "GRID,1,,5.,0.,0.\nGRID,2,,6.,0.,0.\nGRID,3,,5.,1.,0.\nCTRIA3,1,1,1,2,3\n"
BAR = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCBAR,1,1,1,2,1.,0.,0.\n"


def deck(tmp_path, *sections):
    path = tmp_path / "a.bdf"
    path.write_text("CEND\n" + "".join(sections) + "ENDDATA\n")
    return path


def described(path):
    return [(part.path, len(part.mesh.triangles)) for part in load_parts(path)]


def test_superelements_are_parts_by_their_numbers(tmp_path):
    path = deck(
        tmp_path,
        f"BEGIN SUPER=3\n{TETRA}BEGIN BULK SUPER = 12\n{SHEET}",
        f"BEGIN SUPER=4\n{BAR}BEGIN BULK\n{SHEET}",
    )

    assert described(path) == [("SUPER=3", 4), ("SUPER=12", 1), ("", 1)]
    assert load_mesh(f"{path}#SUPER=12").bounds.tolist() == [[5, 0, 0], [6, 1, 0]]
    require_whole(path)


def test_deck_without_superelements_is_one_part_without_a_name(tmp_path):
    for text in (TETRA, SHEET):
        path = deck(tmp_path, f"BEGIN BULK\n{text}")
        assert [name for name, _ in described(path)] == [""]
        require_whole(path)


def test_damaged_superelement_beside_the_one_that_is_asked_about(tmp_path):
    damaged = SHEET.replace("GRID,3", "GRID,4")
    path = deck(tmp_path, f"BEGIN SUPER=1\n{damaged}BEGIN SUPER=2\n{TETRA}BEGIN BULK\n")

    assert len(load_mesh(f"{path}#SUPER=2").triangles) == 4
    for name in (path, f"{path}#SUPER=1"):
        with pytest.raises(MeshError, match=r"a\.bdf:6: CTRIA3 1 uses GRID 3, which is not in"):
            load_mesh(name)


@pytest.mark.parametrize("card", ["SELOC,2,1,2,3,4,5,6", "SEBULK,2,MIRROR,1", "CSUPER,2,1,1,2,3"])
def test_cards_that_place_superelements_are_refused_whatever_is_asked(tmp_path, card):
    path = deck(tmp_path, f"BEGIN SUPER=1\n{TETRA}BEGIN SUPER=2\n{SHEET}BEGIN BULK\n{card}\n")

    for name in (path, f"{path}#SUPER=1"):
        with pytest.raises(MeshError, match=card.partition(",")[0]):
            load_mesh(name)


def test_deck_without_surface_is_refused_as_a_whole_is(tmp_path):
    path = deck(tmp_path, f"BEGIN SUPER=1\n{BAR}BEGIN BULK\n")

    with pytest.raises(MeshError, match="has no surface") as whole:
        load_mesh(path)
    with pytest.raises(MeshError) as parts:
        load_parts(path)
    assert str(parts.value) == str(whole.value)
