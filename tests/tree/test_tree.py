"""Trees are built over anything, hold what they claim by exact arithmetic, and never change."""

from __future__ import annotations

import itertools
import os
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from meshes.nasty import NASTY, bumpy_grid, soup, staircase
from oracles import tree_files as tree_oracles
from strategies.meshes import meshes
from strategies.still import examples

from obbcli import Mesh, MeshError, ObbTree

if TYPE_CHECKING:
    from pathlib import Path

FITS = ("triangles", "points", "hull", "min-volume", "axis-aligned")
SPLITS = ("median", "center", "compact")
LEAF_SIZES = (1, 2, 3, 7, 64)
DEPTHS = (None, 0, 1, 4)


@pytest.fixture(autouse=True)
def _no_fsync(monkeypatch: pytest.MonkeyPatch) -> None:
    """Spare the disk: what reaches it after a power cut is no matter here."""
    monkeypatch.setattr(os, "fsync", lambda _: None)


def saved(tree: ObbTree, folder: Path) -> bytes:
    path = folder / "tree.obbt"
    tree.save(path)
    return path.read_bytes()


def proven_faults(tree: ObbTree, mesh: Mesh, folder: Path) -> list[str]:
    return tree_oracles.faults(
        tree_oracles.parse(saved(tree, folder)), mesh.vertices, mesh.triangles
    )


@pytest.mark.parametrize("name", NASTY)
def test_tree_of_any_mesh_holds_its_triangles_with_every_option(name: str, tmp_path: Path) -> None:
    mesh = Mesh(*NASTY[name]())

    for options in itertools.product(FITS, SPLITS, LEAF_SIZES, DEPTHS):
        tree = ObbTree.build(mesh, *options)
        tree.check()
        assert (tree.fit, tree.split, tree.leaf_size, tree.max_depth) == options
        assert proven_faults(tree, mesh, tmp_path) == []


@given(soup=meshes(max_vertices=20, max_faces=30))
@examples(150)
def test_tree_of_degenerate_soups_holds_its_triangles(
    soup: Any, tmp_path_factory: pytest.TempPathFactory
) -> None:
    mesh = Mesh(soup.vertices, soup.faces)
    folder = tmp_path_factory.getbasetemp()

    for fit, split in itertools.product(FITS, SPLITS):
        tree = ObbTree.build(mesh, fit, split)
        tree.check()
        assert proven_faults(tree, mesh, folder) == []


def test_tree_of_single_leaves_has_one_box_less_than_triangles() -> None:
    for split in SPLITS:
        tree = ObbTree.build(Mesh(*soup(300)), split=split, lazy=False)

        assert tree.node_count == tree.possible_node_count == 299
        assert sum(level.box_count for level in tree.levels) == 299
        assert sum(level.leaf_count for level in tree.levels) == 300


def test_median_split_halves_even_where_all_triangles_coincide() -> None:
    tree = ObbTree.build(Mesh(*NASTY["coincident"]()))

    assert len(tree.levels) == 11  # 2^10 > 1000


def test_root_volume_of_a_box_is_that_of_the_box() -> None:
    corners = np.array(list(itertools.product((0.0, 3.0), (0.0, 5.0), (0.0, 7.0))))
    faces = [(0, 1, 3), (0, 3, 2), (4, 5, 7), (4, 7, 6), (0, 1, 5), (2, 3, 7), (1, 3, 7), (0, 2, 6)]
    for fit in FITS:
        root = ObbTree.build(Mesh(corners, faces), fit=fit, max_depth=0).levels[0]

        assert root.volume is not None
        # The smallest box is the box itself; any other orientation only adds.
        assert root.volume >= 105.0
        if fit == "axis-aligned":
            assert root.volume == pytest.approx(105.0, rel=1e-6)


@pytest.mark.parametrize("name", ["1e300", "largest", "1e-300"])
def test_levels_beyond_the_range_of_double_say_none_without_a_warning(name: str) -> None:
    levels = ObbTree.build(Mesh(*NASTY[name]())).levels

    assert (levels[0].volume is None) == (name != "1e-300")


def test_turned_flat_box_is_flat() -> None:
    # A sheet turned by a rotation: fitted boxes stay thin to the rounding of a float32 quaternion.
    vertices, faces = soup(200)
    flat = vertices * (1.0, 1.0, 0.0)
    turn = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0
    for fit in ("triangles", "points"):
        tree = ObbTree.build(Mesh(flat @ turn.T, faces), fit=fit, max_depth=0)
        root = tree.levels[0].volume
        aligned = ObbTree.build(Mesh(flat, faces), "axis-aligned", max_depth=0)

        assert root is not None
        assert root < 1e-5 * aligned.size**3


@pytest.mark.parametrize("count", [100, 2000])
def test_center_split_that_degenerates_to_a_list_builds(count: int, tmp_path: Path) -> None:
    # 2000 halvings span all of double's range from 1 to the subnormals and beyond: the last ones
    # coincide at zero.
    mesh = Mesh(*staircase(count))

    tree = ObbTree.build(mesh, split="center")

    assert len(tree.levels) > min(count, 1000) / 2
    tree.check()
    assert np.array_equal(tree.mesh.triangles, mesh.triangles)
    if count == 100:
        assert proven_faults(tree, mesh, tmp_path) == []


@pytest.mark.parametrize("options", list(itertools.product(FITS, SPLITS, (1, 7))))
def test_same_mesh_and_options_give_the_same_bytes(
    options: tuple[Any, ...], tmp_path: Path
) -> None:
    mesh, again = Mesh(*soup(500)), Mesh(*soup(500))

    assert saved(ObbTree.build(mesh, *options), tmp_path) == saved(
        ObbTree.build(again, *options), tmp_path
    )


@pytest.mark.parametrize("exponent", [-960, -300, -1, 1, 300, 960])
def test_power_of_two_scaling_changes_no_bit_of_a_box(exponent: int, tmp_path: Path) -> None:
    vertices, faces = soup(200)
    for fit, split in itertools.product(FITS, SPLITS):
        plain, scaled = (
            tree_oracles.parse(saved(ObbTree.build(Mesh(v, faces), fit, split), tmp_path))
            for v in (vertices, np.ldexp(vertices, exponent))
        )

        assert scaled.nodes.tobytes() == plain.nodes.tobytes()
        assert scaled.scale_exponent == plain.scale_exponent + exponent
        assert scaled.triangle_ids.tolist() == plain.triangle_ids.tolist()


def test_tree_gives_its_mesh_back() -> None:
    mesh = Mesh(*bumpy_grid(8), source="sheet.stl", sha256="ab" * 32)

    tree = ObbTree.build(mesh, leaf_size=3)

    assert np.array_equal(tree.mesh.triangles, mesh.triangles)
    assert np.array_equal(tree.vertices, mesh.vertices)
    assert (tree.source, tree.source_sha256) == ("sheet.stl", "ab" * 32)
    assert np.array_equal(tree.bounds, mesh.bounds)
    assert tree.size == mesh.size
    assert (tree.triangle_count, tree.vertex_count) == (128, 81)


def test_tree_keeps_triangles_when_the_callers_arrays_change() -> None:
    vertices, faces = soup(20)
    tree = ObbTree.build(Mesh(vertices, faces))

    vertices[:] = 0.0

    tree.check()
    assert tree.vertices.any()
    with pytest.raises(ValueError, match="read-only"):
        tree.vertices[0, 0] = 1.0


@pytest.mark.parametrize(
    "options",
    [
        {"fit": "best"},
        {"fit": None},
        {"fit": ["triangles"]},
        {"split": "middle"},
        {"split": {}},
        {"leaf_size": 0},
        {"leaf_size": -1},
        {"leaf_size": 1.0},
        {"leaf_size": True},
        {"leaf_size": "3"},
        {"max_depth": -1},
        {"max_depth": 2.0},
        {"max_depth": True},
    ],
    ids=repr,
)
def test_build_refuses_an_option_and_names_it(options: dict[str, Any]) -> None:
    (name,) = options

    with pytest.raises(MeshError, match=f"^{name}: "):
        ObbTree.build(Mesh(*soup(3)), **options)


def test_build_takes_numpy_integers_and_limits_beyond_32_bits() -> None:
    mesh = Mesh(*soup(10))

    tree = ObbTree.build(mesh, leaf_size=np.int64(2), max_depth=np.int32(3))

    assert (tree.leaf_size, tree.max_depth) == (2, 3)
    assert ObbTree.build(mesh, leaf_size=2**40, max_depth=2**40).node_count == 1


@pytest.mark.parametrize("share", [False, True], ids=["soup", "shared vertices"])
def test_tree_takes_at_most_200_bytes_a_triangle(share: bool, tmp_path: Path) -> None:
    mesh = Mesh(*(bumpy_grid(40) if share else soup(3000)))
    for fit, split in itertools.product(FITS, SPLITS):
        tree = ObbTree.build(mesh, fit, split, lazy=False)

        assert tree.nbytes <= 200 * tree.triangle_count
        assert len(saved(tree, tmp_path)) <= 200 * tree.triangle_count
