"""Trees in files are read as questions reach them, verified, and never trusted further."""

from __future__ import annotations

import itertools
import subprocess
import sys
import zlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.nasty import NASTY, bumpy_grid, soup
from oracles.tree_files import BLOCK
from scenes.pairs import POSE_CLASSES
from tree_files.opened import AT_REST, FAR, far_apart, loaded, save_sheet

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Pose, kernels

if TYPE_CHECKING:
    from pathlib import Path


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
    return save_sheet(tmp_path / "sheet.obbt")


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


@pytest.mark.parametrize("leaf_size", [1, 7, 1000])
def test_a_ray_reads_the_triangles_that_it_meets(leaf_size: int, tmp_path: Path) -> None:
    inside = POSE_CLASSES["nested"](300).a
    path = tmp_path / "tree.obbt"
    mesh = Mesh(inside.vertices, inside.faces)
    ObbTree.build(mesh, leaf_size=leaf_size).save(path)
    points = np.array([mesh.bounds[1] + 1, mesh.bounds.mean(axis=0)])
    tree = ObbTree.open(path)

    query = kernels.ContainmentQuery(tree.kernel, Pose().kernel, points)

    while not query.advance(10**6):
        pass
    assert query.inside == 1


def test_opening_and_a_far_question_read_one_block(sheet: Path) -> None:
    tree = ObbTree.open(sheet)

    assert far_apart(tree)
    assert loaded(tree) == BLOCK
    assert (tree.triangle_count, tree.vertex_count) == (2048, 33 * 33)
    assert tree.node_count == tree.possible_node_count == 2047
    assert loaded(tree) == BLOCK


def test_turning_about_the_centroid_reads_no_more_of_the_mesh(sheet: Path) -> None:
    tree = ObbTree.open(sheet)
    turning = Body(tree, motion=Motion((1.0, 0.0, 0.0), (0.0, 0.0, 7.0)))

    found = obbcli.first_contact(turning, Body(tree, pose=FAR))

    assert found.status is obbcli.Status.SEPARATED
    assert loaded(tree) <= 3 * BLOCK


@pytest.mark.parametrize("name", NASTY)
def test_measures_of_an_opened_tree_are_those_of_the_mesh(name: str, tmp_path: Path) -> None:
    mesh = Mesh(*NASTY[name]())
    path = tmp_path / "tree.obbt"
    ObbTree.build(mesh).save(path)

    for tree in (ObbTree.open(path), ObbTree.from_bytes(path.read_bytes())):
        assert tree.bounds.tobytes() == mesh.bounds.tobytes()
        assert tree.surface_centroid.tobytes() == mesh.surface_centroid.tobytes()
        assert tree.size == mesh.size
        assert not tree.bounds.flags.writeable
        assert not tree.surface_centroid.flags.writeable


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


def test_file_that_is_saved_over_leaves_the_opened_tree_as_it_was(sheet: Path) -> None:
    tree = ObbTree.open(sheet)
    wanted = ObbTree.open(sheet).mesh.vertices

    ObbTree.build(Mesh(*soup(9))).save(sheet)

    assert np.array_equal(tree.mesh.vertices, wanted)
    assert ObbTree.open(sheet).triangle_count == 9


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
