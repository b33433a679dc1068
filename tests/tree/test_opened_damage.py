"""Damage to the file of an opened tree is refused where a question reaches it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import pytest
from meshes.nasty import bumpy_grid, soup
from oracles import tree_files as tree_oracles
from oracles.tree_files import BLOCK
from tree_files.opened import data_blocks, far_apart, flip, save_sheet, touch_all

import obbcli
from obbcli import Body, Mesh, Motion, ObbTree, TreeFileError

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    """A file of some fifty blocks."""
    return save_sheet(tmp_path / "sheet.obbt")


def test_flipped_byte_is_refused_where_a_question_reaches_it(sheet: Path) -> None:
    whole = sheet.read_bytes()
    for start in data_blocks(sheet):
        end = min(start + BLOCK, len(whole))
        for position in (start, end - 1):
            flip(sheet, position)
            with pytest.raises(TreeFileError) as refused:
                touch_all(sheet)
            sheet.write_bytes(whole)

            assert refused.value.where == str(sheet)
            assert refused.value.fault == f"is damaged between bytes {start} and {end}"


def test_flipped_byte_that_no_question_reaches_waits_for_check(sheet: Path) -> None:
    for start in data_blocks(sheet)[1:]:
        flip(sheet, start + 100 if start + 100 < sheet.stat().st_size else start)
        tree = ObbTree.open(sheet)

        assert far_apart(tree)
        with pytest.raises(TreeFileError, match=f"is damaged between bytes {start} and "):
            tree.check()
        with pytest.raises(TreeFileError, match=f"is damaged between bytes {start} and "):
            _ = tree.mesh
        assert far_apart(tree)
        flip(sheet, start + 100 if start + 100 < sheet.stat().st_size else start)


def test_flipped_byte_is_read_without_verification(sheet: Path) -> None:
    vertices = Mesh(*bumpy_grid(32)).vertices
    flip(sheet, data_blocks(sheet)[-1])

    damaged = ObbTree.open(sheet, verify=False)

    assert (damaged.vertices != vertices).any(axis=1).sum() == 1
    with pytest.raises(TreeFileError):
        damaged.check()


def test_question_about_two_files_names_the_damaged_one(sheet: Path, tmp_path: Path) -> None:
    sound = tmp_path / "sound.obbt"
    sound.write_bytes(sheet.read_bytes())
    flip(sheet, data_blocks(sheet)[40])

    for asked in (
        lambda a, b: obbcli.triangle_pairs(a, b),
        lambda a, b: list(obbcli.contacts(a, Body(b, motion=Motion((0.0, 0.0, 1.0))))),
    ):
        for a, b in ((sheet, sound), (sound, sheet)):
            trees = ObbTree.open(a), ObbTree.open(b)
            with pytest.raises(TreeFileError) as refused:
                asked(*trees)

            assert refused.value.where == str(sheet)


@pytest.mark.parametrize("verify", [True, False])
def test_file_that_shrinks_while_open_gives_an_error(verify: bool, sheet: Path) -> None:
    whole = sheet.read_bytes()
    other = ObbTree.build(Mesh(*bumpy_grid(32)))
    wanted = obbcli.triangle_pairs(ObbTree.open(sheet), other).tolist()
    for length in (*range(0, len(whole), 30_011), len(whole) - 65):
        tree = ObbTree.open(sheet, verify=verify)
        os.truncate(sheet, length)

        assert far_apart(tree)
        with pytest.raises(TreeFileError, match="was cut short while it was in use"):
            obbcli.triangle_pairs(tree, other)
        with pytest.raises(TreeFileError):
            tree.check()
        sheet.write_bytes(whole)
        assert obbcli.triangle_pairs(tree, other).tolist() == wanted


@pytest.mark.parametrize("verify", [True, False])
def test_open_refuses_every_truncation_and_extra_bytes(verify: bool, tmp_path: Path) -> None:
    path = tmp_path / "small.obbt"
    ObbTree.build(Mesh(*soup(3))).save(path)
    whole = path.read_bytes()
    for data in (*(whole[:length] for length in range(len(whole))), whole + bytes(64)):
        path.write_bytes(data)

        with pytest.raises(TreeFileError, match=r"small\.obbt: "):
            ObbTree.open(path, verify=verify)


@pytest.mark.parametrize("verify", [True, False])
def test_open_refuses_every_flipped_byte_of_the_header(verify: bool, tmp_path: Path) -> None:
    path = tmp_path / "small.obbt"
    ObbTree.build(Mesh(*soup(3))).save(path)
    for position in range(data_blocks(path)[0]):
        flip(path, position)
        with pytest.raises(TreeFileError):
            ObbTree.open(path, verify=verify)
        flip(path, position)


@pytest.mark.parametrize("surface", [soup(1), soup(2)], ids=["triangle", "box"])
def test_open_verifies_what_every_question_needs(surface: Any, tmp_path: Path) -> None:
    path = tmp_path / "small.obbt"
    ObbTree.build(Mesh(*surface)).save(path)
    flip(path, data_blocks(path)[0])

    with pytest.raises(TreeFileError, match="is damaged between bytes"):
        ObbTree.open(path)


def test_links_of_an_unverified_file_lead_nowhere_else(sheet: Path) -> None:
    start = data_blocks(sheet)[0]
    whole = sheet.read_bytes()
    for place, value, fault in (
        (52, 2**31, "a split lies outside its range"),
        (56, 0, "a link leads backwards"),
        (56, 5000, "a link leads beyond the boxes"),
        (56, 1, "two nodes share a box"),
    ):
        data = bytearray(whole)
        data[start + place : start + place + 4] = value.to_bytes(4, "little")
        sheet.write_bytes(tree_oracles.forge(bytes(data)))
        for verify in (True, False):
            opened = ObbTree.open(sheet, verify=verify)
            with pytest.raises(TreeFileError, match=fault):
                obbcli.triangle_pairs(opened, opened)


@pytest.mark.parametrize("corner", [33 * 33, 2**32 - 1])
def test_corner_beyond_the_vertices_is_refused(corner: int, sheet: Path) -> None:
    data = bytearray(sheet.read_bytes())
    at = data_blocks(sheet)[0] + 2047 * 64 + 12 * 1000
    data[at : at + 4] = corner.to_bytes(4, "little")
    sheet.write_bytes(tree_oracles.forge(bytes(data)))
    tree = ObbTree.open(sheet)

    with pytest.raises(TreeFileError, match="a triangle uses a vertex that is not there"):
        obbcli.triangle_pairs(tree, tree)


def test_id_that_no_triangle_has_is_refused(sheet: Path) -> None:
    data = bytearray(sheet.read_bytes())
    at = data_blocks(sheet)[0] + 2047 * 64 + 12 * 2048
    lost = int.from_bytes(data[at : at + 4], "little")
    for other in ((lost + 1) % 2048, 2**31):
        data[at : at + 4] = other.to_bytes(4, "little")
        sheet.write_bytes(tree_oracles.forge(bytes(data)))

        with pytest.raises(TreeFileError, match=f"no triangle has the id {lost}"):
            ObbTree.open(sheet).triangle(lost)
