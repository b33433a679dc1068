"""Trees that grow as questions reach their nodes are the whole trees, and answer as they do."""

from __future__ import annotations

import itertools
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.nasty import NASTY, bumpy_grid, needles, soup, staircase
from oracles import tree_files as tree_oracles
from scenes.pairs import POSE_CLASSES

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Pose, kernels
from obbcli.tree import growing as growth
from obbcli.tree.options import BuildOptions

if TYPE_CHECKING:
    from pathlib import Path

    from obbcli.tree.whole import TreeArrays

FITS = ("triangles", "points", "hull", "min-volume", "axis-aligned")
SPLITS = ("median", "center", "compact")
SHIFTS = [(0.0, 0.0, 0.0), (0.3, -0.2, 0.1), (1.9, 0.4, 0.3), (2.5, 2.5, 2.5), (40.0, 0.0, 0.0)]


def content(arrays: TreeArrays) -> tuple[bytes, ...]:
    parts = (arrays.nodes, arrays.corners, arrays.triangle_ids, arrays.vertices)
    return (*(part.tobytes() for part in parts), bytes(arrays.scale_exponent % 256))


def grown(tree: ObbTree, seed: int) -> TreeArrays:
    """Return the arrays of a tree after questions in some order have made a part of its nodes."""
    random = np.random.default_rng(seed)
    other = ObbTree.build(Mesh(*soup(30, seed)))
    for _ in range(6):
        at = Pose(
            translation=tree.bounds[0] + random.uniform(0, 1, 3) * np.ptp(tree.bounds, axis=0)
        )
        obbcli.triangle_pairs(tree, Body(other, pose=at))
    return tree._arrays


@pytest.mark.parametrize("name", [n for n in NASTY if n not in {"largest", "1e300", "all sizes"}])
def test_tree_grown_by_questions_is_the_whole_tree_bit_for_bit(name: str) -> None:
    mesh = Mesh(*NASTY[name]())

    for fit, split, leaf_size, depth in itertools.product(FITS, SPLITS, (1, 3), (None, 0, 4)):
        whole = ObbTree.build(mesh, fit, split, leaf_size, depth, lazy=False)
        lazy = ObbTree.build(mesh, fit, split, leaf_size, depth)
        assert content(grown(lazy, 1)) == content(whole._arrays)
        lazy.check()


@pytest.mark.parametrize("name", sorted(POSE_CLASSES))
def test_answers_are_the_same_whether_trees_are_whole_or_grow(name: str) -> None:
    pair = POSE_CLASSES[name](600)
    meshes = [Mesh(surface.vertices, surface.faces) for surface in (pair.a, pair.b)]
    pose = Pose(rotation=pair.rotation, translation=pair.translation)

    def answers(**options: Any) -> list[Any]:
        tree_a, tree_b = (ObbTree.build(mesh, **options) for mesh in meshes)
        a, b = Body(tree_a), Body(tree_b, pose=pose)
        turning = Body(tree_a, motion=Motion((0.5, 0.1, 0.0), (0.0, 0.0, 2.0)))
        return [
            replace(obbcli.collide(a, b), stats=None),
            replace(obbcli.collide(a, b, accuracy=Accuracy(leaves="boxes")), stats=None),
            replace(obbcli.distance(a, b), stats=None),
            replace(obbcli.distance(a, b, Accuracy(max_depth_a=3, max_depth_b=2)), stats=None),
            replace(obbcli.first_contact(turning, b), stats=None),
            replace(obbcli.first_contact(turning, b, accuracy=Accuracy(max_depth_a=2)), stats=None),
            obbcli.triangle_pairs(a, b).tolist(),
        ]

    for leaf_size, split in itertools.product((1, 4), SPLITS):
        options = {"leaf_size": leaf_size, "split": split}
        assert answers(lazy=True, **options) == answers(lazy=False, **options)


@pytest.mark.parametrize("shift", SHIFTS)
def test_distance_in_trees_that_grow_reads_the_triangles_of_the_whole_ones(shift: Any) -> None:
    # Small ranges are measured triangle by triangle, boxes at a limit by the first they hold.
    a, b = Mesh(*soup(200)), Mesh(*bumpy_grid(6))
    for depth, leaves in itertools.product((None, 0, 1, 5), ("triangles", "boxes")):
        found = [
            obbcli.distance(
                ObbTree.build(a, lazy=lazy, leaf_size=2),
                Body(ObbTree.build(b, lazy=lazy), pose=Pose(translation=shift)),
                Accuracy(max_depth_a=depth, max_depth_b=depth, leaves=leaves),  # type: ignore[arg-type]
            )
            for lazy in (True, False)
        ]

        assert replace(found[0], stats=None) == replace(found[1], stats=None)


def test_bodies_far_apart_need_root_boxes_alone() -> None:
    tree_a, tree_b = (ObbTree.build(Mesh(*soup(1000, seed))) for seed in (1, 2))

    stats = obbcli.collide(tree_a, Body(tree_b, pose=Pose(translation=(100, 0, 0)))).stats

    assert (stats.nodes_built_a, stats.nodes_built_b) == (1, 1)
    assert (stats.nodes_possible_a, stats.nodes_possible_b) == (999, 999)


def test_depth_limits_build_no_deeper_than_questions_go() -> None:
    for depth in range(5):
        tree_a, tree_b = (ObbTree.build(Mesh(*soup(1000, seed))) for seed in (1, 2))
        accuracy = Accuracy(max_depth_a=depth, max_depth_b=0)

        stats = obbcli.collide(tree_a, tree_b, accuracy=accuracy).stats

        assert stats.nodes_built_a <= 2 ** (depth + 1) - 1
        assert stats.nodes_built_b == 1


def test_a_question_builds_few_of_the_nodes_and_the_same_again_none() -> None:
    tree = ObbTree.build(Mesh(*bumpy_grid(60)))
    other = ObbTree.build(Mesh(*soup(1)))

    first = obbcli.collide(tree, Body(other, pose=Pose(translation=(30, 30, 1.5)))).stats
    again = obbcli.collide(tree, Body(other, pose=Pose(translation=(30, 30, 1.5)))).stats

    assert 1 < first.nodes_built_a < 0.05 * first.nodes_possible_a
    assert again.nodes_built_a == first.nodes_built_a == tree.node_count


@pytest.mark.parametrize("split", SPLITS)
def test_possible_nodes_are_those_of_the_whole_tree_or_at_most_more(split: Any) -> None:
    for name, leaf_size, depth in itertools.product(NASTY, (1, 2, 5), (None, 0, 3, 40)):
        tree = ObbTree.build(Mesh(*NASTY[name]()), "triangles", split, leaf_size, depth)
        possible = tree.possible_node_count
        whole = len(tree._arrays.nodes)

        assert possible == whole or (split != "median" and possible > whole)
        assert tree.possible_node_count == tree.node_count == whole


@pytest.mark.parametrize("leaf_size", [1, 4])
def test_saving_completes_a_tree(leaf_size: int, tmp_path: Path) -> None:
    lazy = ObbTree.build(Mesh(*soup(500)), leaf_size=leaf_size)
    obbcli.collide(lazy, ObbTree.build(Mesh(*soup(20))))

    lazy.save(tmp_path / "lazy.obbt")
    ObbTree.build(Mesh(*soup(500)), leaf_size=leaf_size, lazy=False).save(tmp_path / "whole.obbt")

    assert (tmp_path / "lazy.obbt").read_bytes() == (tmp_path / "whole.obbt").read_bytes()


def test_list_like_tree_grows_without_running_out_of_stack() -> None:
    tree = ObbTree.build(Mesh(*staircase(2000)), split="center")

    pairs = obbcli.triangle_pairs(tree, ObbTree.build(Mesh(*staircase(2000)), split="center"))

    assert len(pairs) >= 2000
    tree.check()


def test_interrupted_completion_keeps_what_was_made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(growth, "_TRIANGLES_A_SLICE", 1000)
    tree = growth.Growth(Mesh(*soup(3000)), BuildOptions())

    def interrupt(share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tree.arrays(interrupt)
    built = tree.node_count

    assert 1 < built < 2999
    whole = ObbTree.build(Mesh(*soup(3000)), lazy=False)
    assert content(tree.arrays()) == content(whole._arrays)


def test_threads_that_share_a_growing_tree_get_the_answers_of_one(tmp_path: Path) -> None:
    mesh_a, mesh_b = Mesh(*bumpy_grid(50)), Mesh(*soup(400))
    random = np.random.default_rng(7)
    poses = [Pose(translation=random.uniform(0, 50, 3) * (1, 1, 0.02)) for _ in range(24)]

    def ask(tree_a: ObbTree, tree_b: ObbTree, pose: Pose) -> Any:
        a, b = Body(tree_a), Body(tree_b, pose=pose)
        nearest = obbcli.distance(a, b)
        return obbcli.triangle_pairs(a, b).tolist(), replace(nearest, stats=None)

    whole = [ObbTree.build(mesh, lazy=False) for mesh in (mesh_a, mesh_b)]
    wanted = [ask(*whole, pose) for pose in poses]
    for _ in range(5):
        trees = [ObbTree.build(mesh) for mesh in (mesh_a, mesh_b)]
        with ThreadPoolExecutor(8) as pool:
            saved = pool.submit(trees[0].save, tmp_path / "saved.obbt")
            found = list(pool.map(lambda pose, pair=trees: ask(*pair, pose), poses))
            saved.result()

        assert found == wanted
        for tree, same in zip(trees, whole, strict=True):
            assert content(tree._arrays) == content(same._arrays)


# Ranges of more than 512 triangles are treated otherwise than small ones.
LARGE = {name: make for name, make in NASTY.items() if name not in {"one", "two", "three"}} | {
    "large soup": lambda: soup(1500),
    "large needles": lambda: needles(1500),
    "large sheet": lambda: bumpy_grid(30),
    "large staircase": lambda: staircase(600),
}


def far_from(surface: Any, size: float) -> Any:
    """Return a surface with one triangle more, so far away that floats cannot tell the others."""
    vertices, triangles = surface
    stray = np.array([[size, 0, 0], [size, size / 2, 0], [size, 0, size / 3]])
    return np.vstack([vertices, stray]), np.vstack([triangles, len(vertices) + np.arange(3)])


@pytest.mark.parametrize("name", LARGE)
def test_large_ranges_hold_their_triangles_whatever_they_are(name: str, tmp_path: Path) -> None:
    vertices, triangles = LARGE[name]()
    mesh = Mesh(vertices, np.tile(triangles, (1 + 599 // len(triangles), 1)))

    for fit, split in itertools.product(FITS, SPLITS):
        whole = ObbTree.build(mesh, fit, split, lazy=False)
        whole.check()
        lazy = ObbTree.build(mesh, fit, split)
        lazy.kernel.levels()  # a walk from node to node
        assert lazy.node_count == len(mesh.triangles) - 1
        assert content(lazy._arrays) == content(whole._arrays)
    whole.save(tmp_path / "whole.obbt")
    read = tree_oracles.parse((tmp_path / "whole.obbt").read_bytes())
    assert tree_oracles.faults(read, mesh.vertices, mesh.triangles) == []


def all_pairs_counts(a: Body, b: Body) -> Any:
    return kernels.triangle_pairs(a.placed, b.placed, 2**64 - 1, 1, 2**64 - 1)[1]


@pytest.mark.parametrize("split", SPLITS)
@pytest.mark.parametrize("size", [1e3, 1e6, 1e12])
def test_a_stray_triangle_leaves_the_boxes_of_the_others_as_tight(size: float, split: Any) -> None:
    other = ObbTree.build(Mesh(*soup(200)))

    def box_tests(surface: Any) -> int:  # of all pairs, as which is found first is chance
        tree = ObbTree.build(Mesh(*surface), split=split)
        spots = [(5.0 * x, 5.0 * y, 1.5) for x in range(8) for y in range(8)]
        counts = [all_pairs_counts(Body(tree), Body(other, Pose(translation=at))) for at in spots]
        tree.check()
        return sum(count[0] for count in counts)

    assert box_tests(far_from(bumpy_grid(40), size)) < 1.75 * box_tests(bumpy_grid(40))


def test_any_number_of_threads_makes_the_same_tree() -> None:
    surfaces = [soup(150_000), bumpy_grid(300), far_from(bumpy_grid(280), 1e9)]
    for surface, split in itertools.product(surfaces, SPLITS):
        mesh = Mesh(*surface)

        made = [
            content(growth.Growth(mesh, BuildOptions(split=split), **options).arrays())
            for options in (
                {"on_demand": False, "threads": 1},
                {"on_demand": False, "threads": 2},
                {"on_demand": False, "threads": 5},
                {"on_demand": True, "threads": 3},
            )
        ]

        assert all(one == made[0] for one in made)
