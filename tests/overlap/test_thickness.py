"""The kernel behind the thickness of an overlap, against closed forms and its own laws."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from meshes import surfaces
from meshes.solids import joined, shifted, turned_over
from movers.meshes import box, cube, disc, tube
from scenes.pairs import random_rotation

from obbcli import Mesh, ObbTree, Pose, kernels

TOLERANCE = 0.01


def size_of(*meshes: Any) -> float:
    """Return the larger diagonal of the meshes' own boxes."""
    return max(float(np.linalg.norm(np.ptp(np.asarray(v), axis=0))) for v, _ in meshes)


def query(a: Any, b: Any, pose_a: Pose | None = None, pose_b: Pose | None = None, **options: Any):
    """Return the kernels' query about two meshes, not yet advanced."""
    trees = [ObbTree.build(Mesh(np.asarray(v, dtype=np.float64), f)).kernel for v, f in (a, b)]
    poses = [(pose or Pose()).kernel for pose in (pose_a, pose_b)]
    asked = {"tolerance": TOLERANCE, "max_cells": 200_000} | options
    if "floor" not in asked:
        asked["floor"] = 1e-9 * size_of(a, b)
    return kernels.ThicknessQuery(trees[0], poses[0], trees[1], poses[1], **asked)


def answer(*bodies: Any, **options: Any) -> kernels.ThicknessQuery:
    """Return a query that is advanced to its end."""
    asked = query(*bodies, **options)
    while not asked.advance(1000):
        pass
    return asked


def turned(mesh: Any, seed: int = 1) -> Any:
    """Return a mesh in another frame."""
    rotation = random_rotation(np.random.default_rng(seed))
    return np.asarray(mesh[0]) @ rotation.T, mesh[1]


def fine_box(low: Any, high: Any, triangles: int) -> Any:
    """Return the box between two corners in about so many triangles."""
    sides = tuple(float(x) for x in np.subtract(high, low))
    surface = surfaces.box(triangles, sides)
    return surface.vertices + np.asarray(low, dtype=np.float64), surface.faces


def ring(corners: int, inner: float, outer: float, low: float, high: float) -> Any:
    """Return a prism over a regular polygon about the z axis with a hole of as many corners."""
    angle = np.arange(corners) * (2 * np.pi / corners)
    circle = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    vertices = [(*(r * xy), z) for z in (low, high) for r in (inner, outer) for xy in circle]
    faces = []
    for i in range(corners):
        j = (i + 1) % corners
        hole, wall, top_hole, top_wall = (np.array((i, j)) + k * corners for k in range(4))
        for (p, q), (r, s) in (
            (wall, top_wall),
            (hole[::-1], top_hole[::-1]),
            (top_wall, top_hole),
            (hole, wall),
        ):
            faces += [(p, q, s), (p, s, r)]
    return np.array(vertices), np.array(faces)


SLABS = box((0, 0, 0), (100, 100, 1)), box((3, 2, 0.9), (103, 102, 2))
FINE_SLABS = tuple(fine_box(v[0], v[-1], 3000) for v, _ in SLABS)
CASES = {
    "boxes": (cube(), shifted(cube(), (0.5, 0.25, 1.25)), 0.75),
    "beam in a block": (box((0, 0, 0), (1, 1, 10)), box((-2, -2, 8.5), (3, 3, 20)), 1.0),
    "slabs": (*SLABS, 0.1),
    "slabs, fine": (*FINE_SLABS, 0.1),
    "slab of 50 um": (box((0, 0, 0), (1, 1, 1)), box((0, 0, 1 - 5e-5), (1, 1, 2)), 5e-5),
    "contained": (cube(0.5), cube(3), 1.0),
    "identical": (cube(), cube(), 2.0),
    "half, faces shared": (box((0, 0, 0), (1, 2, 2)), box((0, 0, 0), (2, 2, 2)), 1.0),
    "flush": (cube(), shifted(cube(), (2, 0, 0)), 0.0),
    "apart": (cube(), shifted(cube(), (3, 3, 3)), 0.0),
    "far apart": (cube(), shifted(cube(), (1e9, 0, 0)), 0.0),
    "inward": (turned_over(cube()), shifted(cube(), (1.5, 0, 0)), 0.5),
    "both inward": (turned_over(cube()), turned_over(shifted(cube(), (1.5, 0, 0))), 0.5),
    "in the hole of a tube": (box((-1, -1, -5), (1, 1, 5)), tube(1, 2, -1, 1), 0.0),
    "through a tube": (
        box((-1.25, -1.25, -5), (1.25, 1.25, 5)),
        tube(1, 2, -1, 1),
        0.5 * 2**0.5 / (1 + 2**0.5),
    ),
    "in a hollow": (cube(0.5), joined(cube(2), turned_over(cube(1))), 0.0),
    "larger than a hollow": (
        cube(1.125),
        joined(cube(2), turned_over(cube(1))),
        0.25 * 3**0.5 / (1 + 3**0.5),
    ),
    "two parts": (joined(cube(0.5), shifted(cube(), (5, 0, 0))), cube(10), 2.0),
    "spike through a sheet": (box((0, 0, -1), (1, 1, 1)), box((-9, -9, 0), (9, 9, 0.05)), 0.05),
}


@pytest.mark.parametrize("frame", range(5))
@pytest.mark.parametrize("case", CASES)
def test_bracket_holds_the_closed_form(case, frame):
    a, b, truth = CASES[case]
    if frame:
        a, b = turned(a, frame), turned(b, frame)
    asked = answer(a, b)
    (low, high), noise = asked.bounds, 1e-13 * max(size_of(a, b), np.abs(a[0]).max())
    assert asked.is_answered
    assert low <= truth + noise
    assert high >= truth - noise
    assert high - low <= max(TOLERANCE * high, 1e-9 * size_of(a, b))


@pytest.mark.parametrize("case", CASES)
def test_decisions_beside_the_closed_form(case):
    a, b, truth = CASES[case]
    for factor, deeper in ((0.9, True), (1.1, False)):
        limit = truth * factor if truth else 1e-3
        asked = answer(a, b, deeper_than=limit)
        assert asked.deeper is (deeper and truth > 0)
        low, high = asked.bounds
        assert low > limit if asked.deeper else high <= limit + 1e-9 * size_of(a, b)


def test_tie_is_not_deeper():
    a, b = box((0, 0, 0), (1, 1, 1)), box((0, 0, 0.75), (1, 1, 2))
    asked = answer(a, b, deeper_than=0.25)
    assert asked.deeper is False
    assert asked.cells <= 100
    assert answer(a, b, deeper_than=np.nextafter(0.25, 0) - 1e-12).deeper is True


def test_point_is_the_centre_of_a_ball_in_both():
    a, b = disc(64, 1, 0, 3), shifted(disc(64, 1, 0, 3), (0.5, 0.25, 1))
    asked = answer(a, b)
    radius = asked.bounds[0] / 2
    for shift, origin in ((asked.point, (0, 0, 0)), (asked.point, (0.5, 0.25, 1))):
        x, y, z = np.subtract(shift, origin)
        facet = np.cos(np.pi / 64)  # the facets' own distance from the axis
        directions = (np.arange(64) + 0.5) * (2 * np.pi / 64)
        assert (x * np.cos(directions) + y * np.sin(directions)).max() + radius <= facet + 1e-12
        assert radius - 1e-12 <= z <= 3 - radius + 1e-12
    assert isinstance(asked.triangle_a, int)
    assert isinstance(asked.triangle_b, int)


def test_answer_does_not_depend_on_slices():
    a, b = turned(disc(32, 1.005, 0, 3)), turned(ring(48, 1, 2, 1, 2))
    whole, slices = answer(a, b), query(a, b)
    brackets = [slices.bounds]
    while not slices.advance(1):
        brackets.append(slices.bounds)
    assert (slices.bounds, slices.point, slices.cells) == (whole.bounds, whole.point, whole.cells)
    lows, highs = np.array(brackets).T
    assert (np.diff(lows) >= 0).all()
    assert (np.diff(highs) <= 0).all()
    assert whole.cells > 10


def test_limit_widens_the_bracket():
    a, b = turned(disc(32, 1.005, 0, 3)), turned(ring(48, 1, 2, 1, 2))
    whole = answer(a, b)
    assert whole.cells > 64
    before = (0.0, np.inf)
    for limit in (1, 2, 4, 8, 16, 32, 64):
        asked = answer(a, b, max_cells=limit)
        assert asked.cells <= limit
        assert before[0] <= asked.bounds[0] <= whole.bounds[1]
        assert before[1] >= asked.bounds[1] >= whole.bounds[0]
        before = asked.bounds


@pytest.mark.parametrize("exponent", [-900, -300, -30, 30, 300, 900])
def test_units_change_no_digit(exponent):
    a, b = turned(disc(32, 1, 0, 3)), turned(tube(0.95, 2, 1, 2))
    unit = 2.0**exponent
    asked = answer(a, b, floor=1e-9)
    scaled = answer((a[0] * unit, a[1]), (b[0] * unit, b[1]), floor=1e-9 * unit)
    assert scaled.bounds == tuple(x * unit for x in asked.bounds)
    assert scaled.cells == asked.cells


def test_pose_is_that_of_the_vertices_posed():
    rotation = random_rotation(np.random.default_rng(3))
    pose = Pose(rotation=rotation, translation=(1, 2, 3))
    a, b = disc(32, 1, 0, 3), tube(0.95, 2, 1, 2)
    placed = answer(a, b, pose, pose)
    plain = answer(a, b)
    assert placed.bounds[0] <= plain.bounds[1]
    assert placed.bounds[1] >= plain.bounds[0]
