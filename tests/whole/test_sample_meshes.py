"""The sample meshes are what their script says, byte for byte, triangle for triangle."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from fractions import Fraction
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from oracles.mesh import mesh_first_contact, mesh_pairs

from obbcli.mesh import load_mesh

SAMPLES = Path(__file__).parents[2] / "sample_meshes"
SCRIPT = SAMPLES / "make_sample_meshes.py"


def listed_triangle_counts():
    docstring = ast.get_docstring(ast.parse(SCRIPT.read_text(encoding="utf-8")))
    _, _, rows, _ = re.split(r"^[= ]+$", docstring, flags=re.MULTILINE)
    return {row.split()[0]: int(row.split()[-1]) for row in rows.strip().splitlines()}


TRIANGLE_COUNTS = listed_triangle_counts()
MESHES = sorted(TRIANGLE_COUNTS)
CLOSED = [name for name in MESHES if name != "degenerate.ply"]
STORIES = [
    ("gear.stl", "pinion.stl"),
    ("bolt.ply", "nut.obj"),
    ("chain_link_a.off", "chain_link_b.ply"),
    ("robot_link.ply", "gripper_palm.glb"),
    ("gripper_palm.glb", "finger_left.off"),
    ("gripper_palm.glb", "finger_right.off"),
    ("gripper_palm.glb", "workpiece.obj"),
    ("finger_left.off", "workpiece.obj"),
    ("finger_right.off", "workpiece.obj"),
    ("housing.stl", "board.vtk"),
]
MODULE, PINION_AXIS = 2.0, np.array([54.0, 0.0, 0.0])
WHEELS = [("gear.stl", 36, np.zeros(3)), ("pinion.stl", 18, PINION_AXIS)]
PITCH_ANGLE = 2.0 * np.pi / 36


@cache
def loaded(name):
    mesh = load_mesh(SAMPLES / name)
    return mesh.vertices, mesh.triangles


@cache
def welded(name):
    vertices, triangles = loaded(name)
    points, index = np.unique(vertices, axis=0, return_inverse=True)
    return points, index.reshape(-1)[triangles]


def turned(mesh, angle, axis=(0.0, 0.0, 0.0), lift=0.0):
    vertices, triangles = mesh
    rotation = np.eye(3)
    rotation[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return (vertices - axis) @ rotation.T + axis + [0.0, 0.0, lift], triangles


def touch(mesh_a, mesh_b):
    """Exact verdict; triangles outside the other mesh's box cannot matter."""
    (points_a, faces_a), (points_b, faces_b) = mesh_a, mesh_b

    def near(points, faces, other):
        corners = points[faces]
        inside = (corners.max(axis=1) >= other.min(axis=0)) & (
            corners.min(axis=1) <= other.max(axis=0)
        )
        used, index = np.unique(faces[inside.all(axis=1)], return_inverse=True)
        return points[used], index.reshape(-1, 3)

    near_a, near_b = near(points_a, faces_a, points_b), near(points_b, faces_b, points_a)
    if not len(near_a[1]) or not len(near_b[1]):
        return False
    return bool(mesh_pairs(*near_a, *near_b))


def linking_number(loop_a, loop_b):
    """Gauss's integral over two closed polygons, by the solid angle of each pair of edges."""

    def solid_angle(u, v, w):
        lengths = [np.linalg.norm(side, axis=-1) for side in (u, v, w)]
        cosines = [(v * w).sum(-1), (w * u).sum(-1), (u * v).sum(-1)]
        below = np.prod(lengths, axis=0) + sum(
            cosine * length for cosine, length in zip(cosines, lengths, strict=True)
        )
        return 2.0 * np.arctan2((u * np.cross(v, w)).sum(-1), below)

    start_a, end_a = loop_a[:, None], np.roll(loop_a, -1, axis=0)[:, None]
    start_b, end_b = loop_b[None], np.roll(loop_b, -1, axis=0)[None]
    corners = start_b - start_a, start_b - end_a, end_b - end_a, end_b - start_a
    first = solid_angle(corners[0], corners[1], corners[2])
    second = solid_angle(corners[2], corners[3], corners[0])
    return float((first + second).sum() / (4.0 * np.pi))


def test_script_reproduces_the_committed_files_byte_for_byte(tmp_path):
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}

    subprocess.run([sys.executable, str(SCRIPT), str(tmp_path)], check=True, env=environment)

    assert sorted(path.name for path in tmp_path.iterdir()) == MESHES
    changed = [
        name for name in MESHES if (tmp_path / name).read_bytes() != (SAMPLES / name).read_bytes()
    ]
    assert changed == []


def test_sample_meshes_stay_under_three_megabytes():
    assert sum((SAMPLES / name).stat().st_size for name in MESHES) < 3_000_000


@pytest.mark.parametrize("name", MESHES)
def test_script_docstring_counts_the_triangles_right(name):
    assert len(loaded(name)[1]) == TRIANGLE_COUNTS[name]


@pytest.mark.parametrize("name", CLOSED)
def test_closed_mesh_has_each_edge_once_in_either_direction(name):
    _, triangles = welded(name)

    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])

    there = np.unique(edges, axis=0)
    assert len(there) == len(edges)
    assert np.array_equal(there, np.unique(edges[:, ::-1], axis=0))


@pytest.mark.parametrize("name", CLOSED)
def test_closed_mesh_has_its_normals_outside(name):
    points, triangles = welded(name)

    a, b, c = np.moveaxis(points[triangles] - points.mean(axis=0), 1, 0)

    assert (a * np.cross(b, c)).sum() / 6.0 > 1000.0


@pytest.mark.parametrize(("name_a", "name_b"), STORIES)
def test_parts_of_a_story_do_not_touch_at_rest(name_a, name_b):
    assert not touch(welded(name_a), welded(name_b))


@pytest.mark.parametrize(("name", "teeth", "axis"), WHEELS)
def test_wheel_turned_by_one_pitch_is_the_same_outline(name, teeth, axis):
    points, _ = welded(name)
    upper = points[points[:, 2] > 0.0]
    outline = upper[np.hypot(*(upper - axis)[:, :2].T) > MODULE * (teeth / 2.0 - 1.25) - 1e-5]

    def worst(angle):
        there, _ = turned((outline, None), angle, axis)
        gaps = np.abs(there[:, None] - outline[None]).max(axis=2)
        return gaps.min(axis=1).max()

    assert worst(2.0 * np.pi / teeth) < 1e-5
    assert worst(np.pi / teeth) > 0.1


@pytest.mark.parametrize(("name", "teeth", "axis"), WHEELS)
def test_wheel_has_its_surface_centroid_on_its_axis(name, teeth, axis):
    points, triangles = welded(name)
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)

    centroid = ((a + b + c) / 3.0 * areas[:, None]).sum(axis=0) / areas.sum()

    assert np.abs(centroid - axis).max() < 1e-6


@pytest.mark.parametrize(("name", "teeth", "axis"), WHEELS)
def test_wheel_flanks_are_involutes_of_the_base_circle(name, teeth, axis):
    points, _ = welded(name)
    x, y = (points - axis)[:, :2].T
    radii, base = np.hypot(x, y), MODULE * teeth / 2.0 * np.cos(np.radians(20.0))
    flank = (radii > base + 1e-4) & (radii < MODULE * (teeth / 2.0 + 1.0) + 1e-5)

    pressure = np.arccos(base / radii[flank])
    pitch, first = 2.0 * np.pi / teeth, 0.0 if name == "gear.stl" else np.pi / teeth
    from_middle = (np.arctan2(y, x)[flank] - first + pitch / 2.0) % pitch - pitch / 2.0
    sides = np.abs(from_middle) > 1e-5
    unwound = np.abs(from_middle[sides]) + (np.tan(pressure) - pressure)[sides]

    thickness = (np.pi * MODULE - 0.2) / 2.0 / (MODULE * teeth)
    involute_20 = np.tan(np.radians(20.0)) - np.radians(20.0)
    assert len(unwound) == 2 * 2 * 9 * teeth
    assert np.allclose(unwound, thickness + involute_20, rtol=0.0, atol=1e-5)


@pytest.mark.parametrize("share", np.arange(12) / 12)
def test_wheels_in_the_right_ratio_never_touch(share):
    angle = share * PITCH_ANGLE

    gear = turned(welded("gear.stl"), angle)
    pinion = turned(welded("pinion.stl"), -2.0 * angle, PINION_AXIS)

    assert not touch(gear, pinion)


@pytest.mark.parametrize(("angle", "expected"), [(0.0027, False), (0.0029, True)])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_gear_alone_touches_once_its_backlash_is_used_up(angle, expected, sense):
    gear = turned(welded("gear.stl"), sense * angle)

    assert touch(gear, welded("pinion.stl")) is expected


@pytest.mark.parametrize("turns", [-1.25, 4.6])
def test_nut_on_its_screw_path_does_not_touch_the_bolt(turns):
    nut = turned(welded("nut.obj"), 2.0 * np.pi * turns, lift=2.0 * turns)

    assert not touch(welded("bolt.ply"), nut)


@pytest.mark.parametrize(("lift", "expected"), [(-6.0, True), (-5.999, False)])
def test_nut_reaches_the_bolt_head_after_three_turns(lift, expected):
    nut = turned(welded("nut.obj"), np.pi * lift, lift=lift)

    assert touch(welded("bolt.ply"), nut) is expected


@pytest.mark.parametrize("lift", [-0.1, 0.1])
def test_nut_pushed_along_the_bolt_touches_its_flanks(lift):
    assert touch(welded("bolt.ply"), turned(welded("nut.obj"), 0.0, lift=lift))


def test_chain_links_are_linked_once():
    cores = [
        loaded(name)[0].reshape(38, 16, 3).mean(axis=1)
        for name in ("chain_link_a.off", "chain_link_b.ply")
    ]

    assert abs(linking_number(*cores)) == pytest.approx(1.0, abs=1e-9)
    assert linking_number(cores[0], cores[1] + [40.0, 0.0, 0.0]) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("name_a", "name_b", "velocity", "expected"),
    [
        ("chain_link_a.off", "chain_link_b.ply", (1, 0, 0), 2),
        ("workpiece.obj", "finger_left.off", (0, -10, 0), Fraction(1, 2)),
        ("workpiece.obj", "finger_right.off", (0, 10, 0), Fraction(1, 2)),
        ("workpiece.obj", "gripper_palm.glb", (0, 0, -10), Fraction(3, 2)),
        ("housing.stl", "board.vtk", (0, 0, -1), Fraction(1, 20)),
        ("housing.stl", "board.vtk", (100, 0, 0), Fraction(1, 2000)),
    ],
)
def test_translating_part_first_touches_when_its_gap_is_closed(name_a, name_b, velocity, expected):
    contact = mesh_first_contact(loaded(name_a), loaded(name_b), (0, 0, 0), velocity, 2)

    assert contact is not None
    assert abs(contact[0] - expected) < Fraction(1, 10**12)


def test_housing_walls_are_a_fifth_of_a_millimetre():
    points, _ = welded("housing.stl")

    middle = points[(points[:, 2] == 10.0) & (points[:, 1] == 0.0)]

    assert np.unique(middle[:, 0]).tolist() == [-30.0, -29.8, 29.8, 30.0]
    assert np.unique(points[:, 2])[:2].tolist() == [0.0, 0.2]


def test_degenerate_collection_holds_two_points_and_two_segments():
    vertices, triangles = loaded("degenerate.ply")
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    sides = np.linalg.norm(np.stack([b - a, c - b, a - c]), axis=2)

    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0

    assert np.flatnonzero(areas == 0.0).tolist() == [3, 4, 5, 6]
    assert np.flatnonzero(sides.max(axis=0) == 0.0).tolist() == [3, 4]
    assert np.flatnonzero((areas > 0.0) & (areas < 1e-4)).tolist() == [8, 13]
