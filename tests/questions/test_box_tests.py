"""Boxes never part what touches, and do part what is clearly apart.

Each pair of surfaces shares one point exactly and lies on two sides of a plane through it, so that
any box test that is off by a rounding error would call it separated.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from oracles.mesh import posed
from scenes import pairs as scenes

import obbcli
from obbcli import Accuracy, Body, Mesh, ObbTree, Pose, Status

FITS = ("triangles", "points", "hull", "min-volume", "axis-aligned")
COARSE = (
    Accuracy(),
    Accuracy(max_depth_a=0, max_depth_b=0),
    Accuracy(max_depth_a=1, max_depth_b=0),
    Accuracy(max_depth_b=1),
    Accuracy(leaves="boxes"),
)


def _half(random: Any, normal: Any, sign: float, thin: Any) -> Any:
    """Return 2 to 5 triangles on one side of the plane through 0, flat or thin in any direction."""
    count = int(random.integers(2, 6))
    turn = scenes.random_rotation(int(random.integers(2**32)))
    points = (random.normal(size=(3 * count, 3)) * thin) @ turn.T
    heights = points @ normal
    return points + np.outer(sign * np.abs(heights) - heights, normal)


def _thin(random: Any) -> Any:
    """Return three lengths, some of them down to 1e-18 of the longest: sheets, needles, specks."""
    return 10.0 ** -np.where(random.random(3) < 0.5, 0, random.integers(0, 19, 3))


def _faces(points: Any) -> Any:
    return np.arange(len(points)).reshape(-1, 3)


def _with(points: Any, random: Any, point: Any) -> Any:
    """Return the points with one of them replaced."""
    points = points.copy()
    points[random.integers(len(points))] = point
    return points


def _rotation(random: Any) -> Any:
    """Return a rotation: any, nearly none, exact, or orthonormal only to 1e-9."""
    kind = random.integers(4)
    if kind == 0:
        return scenes.THIRD_TURN
    rotation = scenes.random_rotation(int(random.integers(2**32)))
    if kind == 1:
        angle = 10.0 ** -random.integers(1, 17)
        rotation = np.array([[1, -angle, 0], [angle, 1, 0], [0, 0, 1]])
        rotation[:2, :2] /= np.hypot(1, angle)
    return rotation + (kind == 2) * random.uniform(-2e-10, 2e-10, (3, 3))


def touch(a: Any, pose_a: Pose, b: Any, pose_b: Pose, random: Any) -> None:
    """Ask in every coarseness, either way round, whether surfaces that touch are said to."""
    options = [
        {"fit": FITS[random.integers(5)], "leaf_size": int(random.integers(1, 4))} for _ in range(2)
    ]
    body_a = Body(ObbTree.build(Mesh(a, _faces(a)), **options[0]), pose_a)
    body_b = Body(ObbTree.build(Mesh(b, _faces(b)), **options[1]), pose_b)
    for accuracy in COARSE:
        for pair in ((body_a, body_b), (body_b, body_a)):
            assert obbcli.collide(*pair, accuracy=accuracy).status is Status.OVERLAP_AT_START


@pytest.mark.parametrize("far", [0.0, 1.0, 1e4, 1e10])
@pytest.mark.parametrize("unit", [1.0, 2.0**-700, 2.0**700])
def test_touching_surfaces_as_loaded_are_never_separated(far: float, unit: float) -> None:
    random = np.random.default_rng([int(far), int(np.log2(unit)) + 1000])
    for _ in range(60):
        normal = scenes.random_rotation(int(random.integers(2**32)))[0]
        point = far * random.normal(size=3)
        a, b = (_half(random, normal, side, _thin(random)) + point for side in (-1.0, 1.0))

        touch(
            _with(a, random, point) * unit, Pose(), _with(b, random, point) * unit, Pose(), random
        )


@pytest.mark.parametrize("far", [0.0, 1.0, 1e4, 1e10])
@pytest.mark.parametrize("back", [False, True], ids=["far away", "far center"])
def test_touching_surfaces_of_which_one_is_posed_are_never_separated(
    far: float, back: bool
) -> None:
    random = np.random.default_rng([int(far), back])
    for _ in range(120):
        normal = scenes.random_rotation(int(random.integers(2**32)))[0]
        offset = far * random.normal(size=3)
        rotation = _rotation(random)
        # Far away in the world, or far from its own origin and brought back.
        shift = random.normal(size=3) - (rotation @ offset if back else 0.0)
        a = _with(_half(random, normal, -1.0, _thin(random)) + offset, random, offset)
        touching = posed(offset[None], rotation, shift)[0]
        b = _half(random, normal, 1.0, _thin(random)) @ rotation.T + touching

        touch(a, Pose(rotation, shift), _with(b, random, touching), Pose(), random)


@pytest.mark.parametrize("far", [0.0, 1.0, 1e4, 1e10])
def test_touching_surfaces_under_one_pose_are_never_separated(far: float) -> None:
    random = np.random.default_rng(int(far))
    for _ in range(120):
        normal = scenes.random_rotation(int(random.integers(2**32)))[0]
        point = random.normal(size=3)
        a, b = (_half(random, normal, side, _thin(random)) + point for side in (-1.0, 1.0))
        pose = Pose(_rotation(random), far * random.normal(size=3))

        touch(_with(a, random, point), pose, _with(b, random, point), pose, random)


def test_surfaces_that_only_rounding_brings_together_are_not_separated() -> None:
    # Apart as loaded, but posed so far away that two vertices round to one point.
    random = np.random.default_rng(2)
    met = 0
    for _ in range(200):
        normal = scenes.random_rotation(int(random.integers(2**32)))[0]
        point = random.normal(size=3)
        gap = 1e-7 * normal
        a, b = (_half(random, normal, side, _thin(random)) + point for side in (-1.0, 1.0))
        a, b = _with(a, random, point), _with(b + gap, random, point + gap)
        pose = Pose(_rotation(random), 1e10 * random.normal(size=3))
        ends = posed(np.array([point, point + gap]), pose.rotation, pose.translation)
        if np.array_equal(*ends):
            met += 1
            touch(a, pose, b, pose, random)
    assert met > 50


def test_dyadic_vertex_on_face_and_edge_on_edge_are_never_separated() -> None:
    random = np.random.default_rng(0)
    for _ in range(60):
        a, b = (random.integers(-8, 9, (6, 3)).astype(float) for _ in range(2))
        on_edge, in_face = (a[0] + a[1]) / 2, (a[0] + a[0] + a[1] + a[2]) / 4
        for point in (on_edge, in_face):
            moved = b.copy()
            moved[3] = point
            touch(a, Pose(), moved, Pose(), random)
        moved = b.copy()
        moved[3], moved[4] = on_edge - b[0] / 4, on_edge + b[0] / 4
        touch(a, Pose(), moved, Pose(), random)


def test_touching_specks_far_smaller_than_the_scene_are_never_separated() -> None:
    # The second surface also has a triangle 2^300 times as large, which sets its unit.
    random = np.random.default_rng(1)
    large = np.array([[100.0, 100, -100], [101, 100, -100], [100, 101, -100]])
    for exponent in (-100, -149, -300, -358, -532, -540, -1000):
        for _ in range(40):
            a, b = (random.integers(-3, 4, (6, 3)) * 2.0**exponent for _ in range(2))
            b = np.concatenate((_with(b, random, a[0]), large))

            touch(a, Pose(), b, Pose(), random)


def test_speck_that_touches_is_not_separated_by_products_that_underflow() -> None:
    # Twice a length of 2^-532 times another vanishes, and with it the bound on its rounding.
    a = [[3, -1, -2], [-1, 3, 0], [2, 1, 1], [-2, 1, 0], [3, -2, -2], [1, 2, 3]]
    b = [[-3, 3, 0], [2, -1, 1], [0, 3, 3]]
    large = np.array([[100.0, 100, -100], [101, 100, -100], [100, 101, -100]])
    faces = [(0, 1, 2), (3, 4, 5)]
    specks = Mesh(np.ldexp(np.array(a, float), -532), faces)
    mixed = Mesh(np.concatenate((np.ldexp(np.array(b, float), -532), large)), faces)
    trees = [ObbTree.build(mesh, split="center") for mesh in (specks, mixed)]

    assert obbcli.triangle_pairs(*trees).tolist() == [[1, 0]]


@pytest.mark.parametrize("turn", range(4))
def test_large_plates_a_little_apart_are_separated_by_their_root_boxes(turn: int) -> None:
    # Tolerances relative to the size of the plates would leak into the direction across them.
    rotation = scenes.random_rotation(turn) if turn else np.eye(3)
    corners = np.array(list(itertools.product((-500.0, 500.0), repeat=2)))
    plate = np.column_stack((corners, np.zeros(4)))
    faces = [(0, 1, 2), (1, 3, 2)]
    a = Body(Mesh(plate, faces), Pose(rotation))
    b = Body(Mesh(plate[:, [1, 0, 2]], faces), Pose(rotation, rotation @ (30.0, 20.0, 1e-6)))

    answer = obbcli.collide(a, b, accuracy=Accuracy(max_depth_a=0, max_depth_b=0))

    assert answer.status is Status.SEPARATED
    assert (answer.stats.box_tests, answer.stats.triangle_tests) == (1, 0)


@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-6])
def test_crossing_rods_a_little_apart_are_separated_by_their_root_boxes(gap: float) -> None:
    # Only the axis across both rods parts them.
    rod = np.array([[-1.0, 0, 0], [1, 0, 0], [1, gap / 8, 0], [-1, 0, gap / 8]])
    faces = [(0, 1, 2), (0, 1, 3)]
    for seed in range(20):
        rotation = scenes.random_rotation(seed)
        across = np.cross([1.0, 0, 0], rotation[:, 0])
        across /= np.linalg.norm(across)
        b = Body(Mesh(rod, faces), Pose(rotation, across * gap))

        answer = obbcli.collide(
            Mesh(rod, faces), b, accuracy=Accuracy(max_depth_a=0, max_depth_b=0)
        )

        assert answer.status is Status.SEPARATED
