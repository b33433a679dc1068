"""Boxes to be looked at: those of the tree, of one level or the last ones, against its file."""

from __future__ import annotations

import io
from collections import Counter
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import trimesh
from meshes.nasty import bumpy_grid, soup
from oracles import tree_files as tree_oracles
from tree_files.opened import data_blocks, flip

from obbcli import Mesh, ObbError, ObbTree, TreeFileError
from obbcli.view.boxes import boxes_of_level, last_boxes_under, tree_picture
from obbcli.view.gltf import glb_bytes
from obbcli.view.picture import Lines, Surface

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
MESHES = {
    "link": (SAMPLES / "robot_link.ply", {}),
    "soup": (Mesh(*soup(200, seed=3)), {"split": "median"}),
    "leaves": (Mesh(*bumpy_grid(12)), {"leaf_size": 5}),
    "shallow": (Mesh(*soup(300, seed=4)), {"max_depth": 4}),
    "tiny": (Mesh(1e-300 * soup(40)[0], soup(40)[1]), {}),
}


def made(name, **options):
    """Return the tree of a mesh."""
    mesh, given = MESHES[name]
    return ObbTree.build(mesh, **given, **options)


def whole(name):
    """Return the tree of a mesh as its file has it, read by nothing of the package."""
    return tree_oracles.parse(made(name, lazy=False).to_bytes())


def outside(box, points, unit):
    """Return by how much points stick out of a box, in shares of the largest coordinate."""
    center, axes, half = box
    local = np.abs(((points - center) / unit) @ axes.T)
    return float((local - half / unit).max())


@pytest.mark.parametrize("name", MESHES)
def test_boxes_of_a_level_are_those_of_the_file_and_hold_their_triangles(name):
    tree, file = made(name), whole(name)
    visits = [visit for visit in tree_oracles.walk(file) if visit.slot is not None]
    unit = float(np.abs(file.vertices).max())

    for level in range(max(visit.depth for visit in visits) + 1):
        boxes = boxes_of_level(tree, level)
        expected = [visit for visit in visits if visit.depth == level]
        counts = dict(zip(boxes.centers[:, 0].tolist(), boxes.triangle_counts, strict=True))
        assert len(boxes.nodes) == len(expected)
        assert set(boxes.depths.tolist()) == {level}
        for visit in expected:
            center = np.ldexp(file.nodes[visit.slot]["center"], file.scale_exponent)
            row = int(np.flatnonzero((boxes.centers == center).all(axis=1))[0])
            box = boxes.centers[row], boxes.axes[row], boxes.half_extents[row]
            corners = file.vertices[file.corners[visit.begin : visit.end]].reshape(-1, 3)
            assert counts[float(center[0])] == visit.end - visit.begin
            assert outside(box, corners, unit) < 1e-14


def test_last_level_is_taken_where_asked_for():
    tree = ObbTree.build(Mesh(np.eye(4, 3), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
    last = len(tree.levels) - 1
    while not tree.levels[last].box_count:
        last -= 1
    single = ObbTree.build(Mesh(np.eye(3), [[0, 1, 2]]))

    boxes = boxes_of_level(tree, 9, or_last=True)

    np.testing.assert_array_equal(boxes.nodes, boxes_of_level(tree, last).nodes)
    assert set(boxes_of_level(tree, 1, or_last=True).depths.tolist()) == {1}
    with pytest.raises(ObbError, match="a single triangle needs none"):
        boxes_of_level(single, 3, or_last=True)


def test_lazy_tree_makes_no_box_below_the_level():
    tree = ObbTree.build(SAMPLES / "gear.stl")

    boxes_of_level(tree, 5)

    levels = ObbTree.build(SAMPLES / "gear.stl").levels
    assert tree.node_count == sum(level.box_count for level in levels[:6])


@pytest.mark.parametrize("name", MESHES)
def test_last_boxes_stand_above_every_triangle(name):
    tree, file = made(name, lazy=False), whole(name)
    visits = list(tree_oracles.walk(file))
    # Of each triangle, the smallest box over it.
    above = {}
    for visit in visits:
        if visit.slot is not None:
            above |= dict.fromkeys(range(visit.begin, visit.end), visit.slot)

    boxes = last_boxes_under(tree, 0)

    assert sorted(boxes.nodes.tolist()) == sorted(set(above.values()))


def test_last_boxes_under_a_node_hold_its_triangles_alone():
    tree, file = made("leaves", lazy=False), whole("leaves")
    inner = [visit for visit in tree_oracles.walk(file) if visit.depth == 3 and visit.slot]
    for visit in inner:
        inside = [
            other.slot
            for other in tree_oracles.walk(file)
            if other.is_leaf and visit.begin <= other.begin and other.end <= visit.end
        ]

        boxes = last_boxes_under(tree, visit.slot)

        assert sorted(boxes.nodes.tolist()) == sorted(inside)
        assert boxes.triangle_counts.sum() == visit.end - visit.begin


def test_opened_tree_has_the_same_boxes(tmp_path):
    tree = made("link")
    tree.save(tmp_path / "link.obbt")

    opened = boxes_of_level(ObbTree.open(tmp_path / "link.obbt"), 6)

    for one, other in zip(opened, boxes_of_level(tree, 6), strict=True):
        np.testing.assert_array_equal(one, other)


def test_level_or_node_that_is_not_there_is_refused():
    tree = ObbTree.build(SAMPLES / "robot_link.ply")
    single = ObbTree.build(Mesh(np.eye(3), [[0, 1, 2]]))

    with pytest.raises(ObbError, match=r"level 14: .* its last level is 13"):
        boxes_of_level(tree, 14)
    with pytest.raises(ObbError, match=r"node 1603: .* no box has this number$"):
        last_boxes_under(tree, 1603)
    with pytest.raises(ObbError, match=r"level 0: .* a single triangle needs none"):
        boxes_of_level(single, 0)
    with pytest.raises(ObbError, match=r"node 0: .* a single triangle needs none"):
        last_boxes_under(single, 0)


@pytest.mark.parametrize("ask", [boxes_of_level, last_boxes_under])
def test_damaged_tree_file_is_refused(tmp_path, ask):
    path = tmp_path / "link.obbt"
    made("link").save(path)
    flip(path, data_blocks(path)[0])

    with pytest.raises(TreeFileError, match=r"link\.obbt"):
        ask(ObbTree.open(path), 0)


def test_picture_shows_mesh_boxes_and_edges():
    tree = made("link")
    boxes = boxes_of_level(tree, 4)

    picture = tree_picture(tree, boxes, "a title")

    mesh, *others = picture.parts
    solids = [part for part in others if isinstance(part, Surface)]
    edges = [part for part in others if isinstance(part, Lines)]
    assert len(mesh.triangles) == tree.triangle_count
    assert sum(len(part.triangles) for part in solids) == 12 * len(boxes.nodes)
    assert sum(len(part.segments) for part in edges) == 12 * len(boxes.nodes)
    assert len({part.color for part in solids}) == len(solids) == 3


def test_faces_of_boxes_close_and_look_outwards():
    picture = tree_picture(made("soup"), boxes_of_level(made("soup"), 0), "")
    solid = picture.parts[1]
    corners = solid.vertices[solid.triangles]
    middle = solid.vertices.mean(axis=0)
    sides = Counter()
    for face in solid.triangles.tolist():
        sides.update(zip(face, [*face[1:], face[0]], strict=True))

    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    assert (np.einsum("ij,ij->i", normals, corners.mean(axis=1) - middle) > 0).all()
    assert all(sides[b, a] == count == 1 for (a, b), count in sides.items())


def test_colors_of_depths_differ_from_their_neighbours():
    tree = ObbTree.build(SAMPLES / "gripper_palm.glb")
    picture = tree_picture(tree, last_boxes_under(tree, 0), "")
    colors = {}
    for part in picture.parts[1:]:
        if isinstance(part, Surface):
            colors.setdefault(int(part.name.split()[1].rstrip(",")), []).append(part.color)

    firsts = [np.array(found[0], float) for _, found in sorted(colors.items())]

    assert len(firsts) > 4
    assert all(np.abs(a - b).max() > 60 for a, b in pairwise(firsts))


@pytest.mark.parametrize("level", [0, 4, 9])
def test_glb_holds_the_boxes_of_the_level_around_their_triangles(level):
    tree, file = made("link"), whole("link")
    picture = tree_picture(tree, boxes_of_level(tree, level), "")
    visits = [v for v in tree_oracles.walk(file) if v.slot is not None and v.depth == level]
    centers = np.ldexp(file.nodes["center"][[v.slot for v in visits]], file.scale_exponent)

    scene = trimesh.load(io.BytesIO(glb_bytes(picture)), file_type="glb", process=False)

    solids = [g for name, g in scene.geometry.items() if "shade" in name]
    boxes = np.concatenate([solid.vertices.reshape(-1, 8, 3) for solid in solids])
    nearest = np.linalg.norm(boxes.mean(axis=1)[:, None] - centers, axis=2).argmin(axis=1)
    assert sorted(nearest.tolist()) == list(range(len(visits)))
    assert sum(len(solid.faces) for solid in solids) == 12 * len(visits)
    for corners, number in zip(boxes, nearest.tolist(), strict=True):
        visit = visits[number]
        points = file.vertices[file.corners[visit.begin : visit.end]].reshape(-1, 3)
        sides = corners[[4, 2, 1]] - corners[0]
        lengths = np.linalg.norm(sides, axis=1)
        half = np.ldexp(file.nodes["half_extents"][visit.slot].astype(float), file.scale_exponent)
        np.testing.assert_allclose(lengths, 2 * half, rtol=1e-5, atol=1e-4)
        axes = tree_oracles.axes_of(file.nodes["rotation"][visit.slot])
        local = np.abs((points - corners.mean(axis=0)) @ np.array(axes).T)
        assert (local <= lengths / 2 + 1e-4).all()
    assert len(scene.geometry["mesh"].faces) == tree.triangle_count
