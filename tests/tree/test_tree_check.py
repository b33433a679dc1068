"""`ObbTree.check` proves trees: whatever exact arithmetic finds wrong with one, it refuses."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.nasty import bumpy_grid, needles, soup
from oracles import tree_files as tree_oracles
from oracles.tree_files import NODE

from obbcli import Body, Mesh, ObbTree, TreeFileError
from obbcli.tree.whole import WholeTree

if TYPE_CHECKING:
    from obbcli.tree.whole import TreeArrays
from tree_files.changes import (
    _aligned,
    arrays_of,
    as_read,
    inner_slot,
    refuses,
    set_field,
    with_nodes,
)


@pytest.mark.parametrize(
    "surface", [soup(40), bumpy_grid(4), needles(25)], ids=["soup", "grid", "needles"]
)
def test_check_refuses_every_extent_that_is_provably_too_small(surface: Any) -> None:
    arrays = arrays_of(surface)
    shrunk = 0
    for slot in range(len(arrays.nodes)):
        for axis in range(3):
            for steps in (1, 4, 64):
                damaged = _shrink(arrays, slot, axis, steps)
                if tree_oracles.faults(as_read(damaged), *surface):
                    refuses(damaged, rf"does not contain its triangles \(box {slot}, ")
                    shrunk += 1
                    break
    # Boxes are tight: nearly every extent is needed to the last few places of its float32.
    assert shrunk > 2.5 * len(arrays.nodes)


def _shrink(arrays: TreeArrays, slot: int, axis: int, steps: int) -> TreeArrays:
    def change(nodes: Any) -> None:
        bits = nodes["half_extents"][slot : slot + 1].view("<u4")
        bits[0, axis] -= np.uint32(min(steps, int(bits[0, axis])))

    return with_nodes(arrays, change)


def test_check_refuses_a_shrunk_extent_of_a_flat_box() -> None:
    vertices, faces = bumpy_grid(4)
    arrays = arrays_of((vertices * (1.0, 1.0, 0.0), faces), fit="axis-aligned")

    refuses(with_nodes(arrays, set_field("half_extents", 0, (2.0, 2.0, 0.0))), "not contain")
    refuses(_shrink(arrays, 0, 0, 1), "does not contain its triangles")


def test_check_refuses_swapped_and_repeated_ids() -> None:
    arrays = arrays_of(soup(40))
    ids = arrays.triangle_ids.copy()
    ids[3] = ids[7]
    refuses(replace(arrays, triangle_ids=ids), f"triangle id {ids[7]} is out of range or stands")
    ids[3] = 40
    refuses(replace(arrays, triangle_ids=ids), "triangle id 40 is out of range")


def _with_value(arrays: TreeArrays, name: str, place: Any, value: float) -> TreeArrays:
    """Return the arrays with one number of one of them changed in a copy."""
    changed = getattr(arrays, name).copy()
    changed[place] = value
    return replace(arrays, **{name: changed})


@pytest.mark.parametrize(
    ("name", "place", "value", "fault"),
    [
        ("triangle_ids", 0, 40, "no triangle has the id"),
        ("triangle_ids", 3, None, "no triangle has the id"),
        ("corners", (9, 1), 120, "uses vertex 120 of 120"),
        ("corners", (9, 1), 2**32 - 1, "uses vertex -1 of 120"),
        ("vertices", (5, 2), np.nan, "vertex 5: z is nan"),
        ("vertices", (5, 2), np.inf, "vertex 5: z is inf"),
    ],
)
def test_damaged_tree_gives_no_mesh(name: str, place: Any, value: Any, fault: str) -> None:
    arrays = arrays_of(soup(40))
    value = arrays.triangle_ids[7] if value is None else value
    tree = ObbTree(WholeTree(_with_value(arrays, name, place, value)))

    for figure in ("mesh", "bounds", "size", "surface_centroid"):
        with pytest.raises(TreeFileError, match=fault):
            getattr(tree, figure)


def test_body_of_a_tree_asks_it_for_no_mesh() -> None:
    tree = ObbTree(WholeTree(_with_value(arrays_of(soup(40)), "triangle_ids", 3, 40)))

    assert Body(tree).shape is tree


def test_check_refuses_triangles_under_boxes_that_do_not_hold_them() -> None:
    arrays = arrays_of(soup(40))
    corners = arrays.corners.copy()
    corners[[0, -1]] = corners[[-1, 0]]

    refuses(replace(arrays, corners=corners), "does not contain its triangles")


def test_check_refuses_a_vertex_moved_out_and_one_that_is_not_there() -> None:
    arrays = arrays_of(soup(40))
    vertices = arrays.vertices.copy()
    vertices[5] *= 3.0
    refuses(replace(arrays, vertices=vertices), "does not contain its triangles")
    vertices[5] = np.nan
    refuses(replace(arrays, vertices=vertices), "does not contain its triangles")
    corners = arrays.corners.copy()
    corners[9, 1] = len(arrays.vertices)
    refuses(replace(arrays, corners=corners), "uses a vertex that is not there")


@pytest.mark.parametrize("corner", range(3))
@pytest.mark.parametrize("axis", range(3))
def test_check_refuses_the_only_triangle_where_it_is_nowhere(corner: int, axis: int) -> None:
    arrays = arrays_of(soup(1))
    vertices = arrays.vertices.copy()
    vertices[corner, axis] = np.nan
    refuses(replace(arrays, vertices=vertices), "a vertex is not made of usable numbers")
    corners = arrays.corners.copy()
    corners[0, corner] = 3
    refuses(replace(arrays, corners=corners), "uses a vertex that is not there")


@pytest.mark.parametrize("where", ["first", "last", "beyond", "one less", "one more", "leaf"])
def test_check_refuses_a_moved_split(where: str) -> None:
    arrays = arrays_of(soup(40))
    slot = inner_slot(arrays)
    begin, end = next(
        (v.begin, v.end) for v in tree_oracles.walk(as_read(arrays)) if v.slot == slot
    )
    split = int(arrays.nodes.view(NODE)[slot, 0]["split"])
    value = {
        "first": begin,
        "last": end,
        "beyond": end + 1,
        "one less": split - 1,
        "one more": split + 1,
        "leaf": 0,
    }[where]

    refuses(with_nodes(arrays, set_field("split", slot, value)), r"split|contain|leaf|depth-first")


@pytest.mark.parametrize("step", [-1, 1, 1000, None])
def test_check_refuses_a_moved_right_link(step: int | None) -> None:
    arrays = arrays_of(soup(40))
    slot = inner_slot(arrays)
    right = int(arrays.nodes.view(NODE)[slot, 0]["right"])
    value = slot if step is None else right + step

    refuses(with_nodes(arrays, set_field("right", slot, value)), r"link|depth-first|beyond")


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, -1.0])
def test_check_refuses_an_extent_that_is_no_length(value: float) -> None:
    arrays = arrays_of(soup(10))

    refuses(with_nodes(arrays, set_field("half_extents", 4, value)), r"usable numbers \(box 4,")


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_check_refuses_a_center_that_is_no_place(value: float) -> None:
    arrays = arrays_of(soup(10))

    refuses(with_nodes(arrays, set_field("center", 4, value)), r"usable numbers \(box 4,")


@pytest.mark.parametrize(
    "rotation",
    [(0, 0, 0, 0), (np.nan, 0, 0, 0), (np.inf, 0, 0, 0), (1e-30, 0, 0, 0), (1e30, 0, 0, 0)],
)
def test_check_refuses_a_quaternion_that_gives_no_axes(rotation: Any) -> None:
    arrays = arrays_of(soup(10))

    refuses(with_nodes(arrays, set_field("rotation", 0, rotation)), r"usable numbers \(box 0,")


def test_check_refuses_a_turned_box() -> None:
    arrays = arrays_of(soup(40))

    refuses(with_nodes(arrays, set_field("rotation", 0, (3, 1, 2, 0))), "does not contain")


def test_check_refuses_reserved_bits() -> None:
    arrays = arrays_of(soup(10))

    refuses(with_nodes(arrays, set_field("reserved", 8, 1)), r"usable numbers \(box 8,")


def test_check_refuses_boxes_that_nothing_reaches() -> None:
    arrays = arrays_of(soup(10), leaf_size=3)
    nodes = np.concatenate((arrays.nodes, arrays.nodes[-1:]))

    refuses(replace(arrays, nodes=_aligned(nodes)), "more boxes than the tree reaches")


def test_check_refuses_missing_boxes() -> None:
    arrays = arrays_of(soup(10))

    refuses(replace(arrays, nodes=arrays.nodes[:-1]), "beyond the boxes")


@pytest.mark.parametrize(("name", "value"), [("leaf_size", 2), ("leaf_size", 5), ("max_depth", 2)])
def test_check_refuses_other_limits_than_the_tree_keeps(name: str, value: int) -> None:
    arrays = arrays_of(soup(40), leaf_size=3)
    description = replace(arrays.description, **{name: value})

    refuses(replace(arrays, description=description), "contradicts the leaf size or the depth")


@pytest.mark.parametrize("exponent", [-1, 1, 30])
def test_check_refuses_another_scale(exponent: int) -> None:
    arrays = arrays_of(soup(10))
    # Boxes are too small for triangles scaled up, and lie elsewhere than triangles scaled down.
    other = replace(arrays, scale_exponent=arrays.scale_exponent + exponent)

    refuses(other, "does not contain its triangles")


def test_tree_refuses_arrays_that_do_not_belong_together() -> None:
    arrays = arrays_of(soup(10))
    with pytest.raises(TreeFileError, match="do not belong together"):
        ObbTree(WholeTree(replace(arrays, triangle_ids=arrays.triangle_ids[:-1])))
    with pytest.raises(TreeFileError, match="do not belong together"):
        ObbTree(WholeTree(replace(arrays, nodes=_aligned(np.repeat(arrays.nodes, 2, axis=0)))))
    with pytest.raises(TreeFileError, match="do not belong together"):
        ObbTree(WholeTree(replace(arrays, nodes=arrays.nodes[:0])))


@pytest.mark.parametrize("seed", range(4))
def test_check_never_passes_what_exact_arithmetic_refuses(seed: int) -> None:
    surface = soup(6, seed)
    mesh = Mesh(*surface)
    arrays = arrays_of(surface)
    random = np.random.default_rng(seed)
    refused = passed = 0
    for _ in range(250):
        nodes = _aligned(arrays.nodes)
        flat = nodes.reshape(-1)
        flat[random.integers(flat.size)] ^= 1 << int(random.integers(8))
        damaged = replace(arrays, nodes=nodes)
        try:
            ObbTree(WholeTree(damaged)).check()
        except TreeFileError:
            refused += 1
        else:
            passed += 1
            assert tree_oracles.faults(as_read(damaged), mesh.vertices, mesh.triangles) == []

    # Larger boxes and links that nothing follows are no lies.
    assert refused > passed > 0
