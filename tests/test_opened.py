"""Trees in files are read as questions reach them, verified, and never trusted further."""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
import zlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import tree_oracles
from scenes import POSE_CLASSES
from tree_meshes import NASTY, bumpy_grid, soup
from tree_oracles import BLOCK, FIXED

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Pose, TreeFileError, kernels
from obbcli.opened import OpenedTree

if TYPE_CHECKING:
    from pathlib import Path

AT_REST = Motion()
FAR = Pose(translation=(1000.0, 0.0, 0.0))

FORK_AND_ASK = """
import os, sys
from obbcli import ObbTree, triangle_pairs
tree = ObbTree.open(sys.argv[1])
child = os.fork()
count = len(triangle_pairs(tree, tree))
if child == 0:
    os._exit(count % 251)
print(count % 251 == os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), count)
"""


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    """A file of some fifty blocks."""
    path = tmp_path / "sheet.obbt"
    ObbTree.build(Mesh(*bumpy_grid(32))).save(path)
    return path


def loaded(tree: ObbTree) -> int:
    assert isinstance(tree._made, OpenedTree)
    return tree._made.loaded_bytes


def data_blocks(path: Path) -> range:
    """Return where the blocks of data begin in a file."""
    return range(FIXED.unpack_from(path.read_bytes())[2], path.stat().st_size, BLOCK)


def flip(path: Path, position: int) -> None:
    data = bytearray(path.read_bytes())
    data[position] ^= 64
    path.write_bytes(data)


def touch_all(path: Path) -> None:
    """Ask what leaves nothing unread."""
    tree = ObbTree.open(path)
    obbcli.triangle_pairs(tree, ObbTree.build(Mesh(*bumpy_grid(32)), max_depth=0))


def far_apart(tree: ObbTree) -> bool:
    return not obbcli.collide(tree, Body(tree, pose=FAR)).collides


@pytest.mark.parametrize("name", sorted(POSE_CLASSES))
@pytest.mark.parametrize("verify", [True, False])
def test_answers_of_opened_trees_are_those_of_trees_in_memory(
    name: str, verify: bool, tmp_path: Path
) -> None:
    pair = POSE_CLASSES[name](300)
    meshes = [Mesh(surface.vertices, surface.faces) for surface in (pair.a, pair.b)]
    pose = Pose(rotation=pair.rotation, translation=pair.translation)

    def answers(open_or_keep: Any) -> list[Any]:
        def asked(motion: Motion = AT_REST) -> tuple[Body, Body]:
            a, b = (open_or_keep(tree, k) for k, tree in enumerate(trees))
            return Body(a, motion=motion), Body(b, pose=pose)

        turning = Motion((0.5, 0.1, 0.0), (0.0, 0.0, 2.0))
        coarse = Accuracy(leaves="boxes", max_depth_a=3)
        return [
            replace(obbcli.collide(*asked()), stats=None),
            replace(obbcli.collide(*asked(), accuracy=coarse), stats=None),
            replace(obbcli.distance(*asked()), stats=None),
            replace(obbcli.distance(*asked(), coarse), stats=None),
            replace(obbcli.first_contact(*asked()), stats=None),
            replace(obbcli.first_contact(*asked(turning)), stats=None),
            replace(obbcli.first_contact(*asked(turning), accuracy=coarse), stats=None),
            list(itertools.islice(obbcli.contacts(*asked(Motion((0.5, 0.0, 0.0)))), 3)),
            obbcli.triangle_pairs(*asked()).tolist(),
        ]

    def opened(tree: ObbTree, number: int) -> ObbTree:
        return ObbTree.open(tmp_path / f"{number}.obbt", verify=verify)

    for options in ({}, {"leaf_size": 5, "split": "center"}, {"max_depth": 0}):
        trees = [ObbTree.build(mesh, **options) for mesh in meshes]  # type: ignore[arg-type]
        for number, tree in enumerate(trees):
            tree.save(tmp_path / f"{number}.obbt")

        assert answers(opened) == answers(lambda tree, _: tree)


@pytest.mark.parametrize("leaf_size", [1, 7])
def test_solids_in_opened_trees_hold_what_those_in_memory_do(
    leaf_size: int, tmp_path: Path
) -> None:
    pair = POSE_CLASSES["nested"](300)
    meshes = [Mesh(surface.vertices, surface.faces) for surface in (pair.a, pair.b)]
    trees = [ObbTree.build(mesh, leaf_size=leaf_size) for mesh in meshes]
    for number, tree in enumerate(trees):
        tree.save(tmp_path / f"{number}.obbt")
    opened = [ObbTree.open(tmp_path / f"{number}.obbt") for number in range(2)]
    pose = Pose(rotation=pair.rotation, translation=pair.translation)

    found, wanted = (
        replace(obbcli.collide(a, Body(b, pose=pose), solid=True), stats=None)
        for a, b in (opened, trees)
    )

    assert found == wanted
    assert found.contained is not None


def test_opening_and_a_far_question_read_one_block(sheet: Path) -> None:
    tree = ObbTree.open(sheet)

    assert far_apart(tree)
    assert loaded(tree) == BLOCK
    assert (tree.triangle_count, tree.vertex_count) == (2048, 33 * 33)
    assert tree.node_count == tree.possible_node_count == 2047
    assert loaded(tree) == BLOCK


def test_a_contact_reads_few_blocks_and_everything_reads_all(sheet: Path) -> None:
    tree = ObbTree.open(sheet)
    small = ObbTree.build(Mesh([[10.2, 10.2, -9], [10.3, 10.2, 9], [10.2, 10.3, 9]], [[0, 1, 2]]))

    assert obbcli.first_contact(tree, small).triangle_a is not None
    assert loaded(tree) < 0.4 * tree.nbytes
    tree.levels  # noqa: B018
    assert loaded(tree) > 0.9 * tree.nbytes
    whole = sum(-(-size // 64) * 64 for size in (2047 * 64, 2048 * 12, 2048 * 4, 33 * 33 * 24))
    assert len(tree.mesh.vertices) == 33 * 33
    assert loaded(tree) == whole


@pytest.mark.parametrize("name", NASTY)
def test_triangles_of_an_opened_tree_are_those_of_the_mesh(name: str, tmp_path: Path) -> None:
    mesh = Mesh(*NASTY[name]())
    path = tmp_path / "tree.obbt"
    ObbTree.build(mesh, leaf_size=3).save(path)
    tree = ObbTree.open(path)

    for row, corners in enumerate(mesh.triangles):
        assert np.array_equal(tree.triangle(row), mesh.vertices[corners])


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


def test_file_that_is_saved_over_leaves_the_opened_tree_as_it_was(sheet: Path) -> None:
    tree = ObbTree.open(sheet)
    wanted = ObbTree.open(sheet).mesh.vertices

    ObbTree.build(Mesh(*soup(9))).save(sheet)

    assert np.array_equal(tree.mesh.vertices, wanted)
    assert ObbTree.open(sheet).triangle_count == 9


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


def test_corner_beyond_the_vertices_is_refused(sheet: Path) -> None:
    data = bytearray(sheet.read_bytes())
    at = data_blocks(sheet)[0] + 2047 * 64 + 12 * 1000
    data[at : at + 4] = (33 * 33).to_bytes(4, "little")
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


def test_threads_that_share_an_opened_tree_get_the_answers_of_one(sheet: Path) -> None:
    other = ObbTree.build(Mesh(*soup(400)))
    random = np.random.default_rng(7)
    poses = [Pose(translation=random.uniform(0, 32, 3) * (1, 1, 0.02)) for _ in range(24)]

    def ask(tree: ObbTree, pose: Pose) -> Any:
        asked = Body(other, pose=pose)
        pairs = obbcli.triangle_pairs(tree, asked).tolist()
        return pairs, replace(obbcli.distance(tree, asked), stats=None)

    whole = ObbTree.build(Mesh(*bumpy_grid(32)))
    wanted = [ask(whole, pose) for pose in poses]
    for _ in range(5):
        tree = ObbTree.open(sheet)
        with ThreadPoolExecutor(8) as pool:
            everything = pool.submit(lambda tree=tree: tree._arrays)
            found = list(pool.map(lambda pose, tree=tree: ask(tree, pose), poses))

        assert found == wanted
        for name in ("nodes", "corners", "triangle_ids", "vertices"):
            read = getattr(everything.result(), name)
            assert np.array_equal(read, getattr(whole._arrays, name))


def test_forked_processes_read_the_file_each_for_itself(sheet: Path) -> None:
    ended = subprocess.run(
        [sys.executable, "-c", FORK_AND_ASK, str(sheet)], capture_output=True, text=True, check=True
    )

    tree = ObbTree.open(sheet)
    assert ended.stdout == f"True {len(obbcli.triangle_pairs(tree, tree))}\n"


def test_arrays_outlive_the_tree(sheet: Path) -> None:
    vertices = ObbTree.open(sheet).vertices

    assert not vertices.flags.writeable
    assert np.array_equal(vertices, Mesh(*bumpy_grid(32)).vertices)


def test_checksums_are_those_of_zlib_at_every_length() -> None:
    random = np.random.default_rng(0)
    for length in (*range(400), 4095, 4096, 4097, 70_000):
        data = random.integers(0, 256, length, dtype=np.uint8)
        wanted = zlib.crc32(data.tobytes())

        assert kernels.crc32(data) == kernels.crc32_by_tables(data) == wanted
