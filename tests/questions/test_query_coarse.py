"""Boxes that stand for triangles: separated stays a proof, and the gap is bounded."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.nasty import bumpy_grid, needles, soup
from oracles import still as oracles
from oracles import tree_files as tree_oracles
from oracles.exact import Box
from oracles.mesh import mesh_distance_squared, mesh_pairs, posed
from scenes import pairs as scenes

import obbcli
from obbcli import (
    Accuracy,
    Body,
    Mesh,
    ObbTree,
    Pose,
    Status,
)

if TYPE_CHECKING:
    from collections.abc import Iterator


STRIP = (soup(12, 8)[0] * (1.0, 1e-3, 1e-6), soup(12, 8)[1])
SURFACES = {
    "soups": (soup(12, 1), soup(12, 2)),
    "sheet and soup": (bumpy_grid(3), soup(12, 3)),
    "needles": (needles(8), soup(8, 4)),
    "strips": (STRIP, STRIP),
}


def _posed_pairs(name: str) -> Iterator[tuple[Any, Any, Any]]:
    """Yield two surfaces and a pose of the second: crossing, near, apart, nearly orthonormal."""
    a, b = SURFACES[name]
    for seed in range(6):
        rotation = scenes.random_rotation(seed)
        if seed % 2:
            rotation = rotation + 1e-10 * np.random.default_rng(seed).uniform(-1, 1, (3, 3))
        direction = np.random.default_rng(seed + 9).normal(size=3)
        reach = 0.3 * seed * np.ptp(a[0], axis=0).max()
        center = a[0].mean(axis=0) - rotation @ b[0].mean(axis=0)
        yield a, b, (rotation, center + direction / np.linalg.norm(direction) * reach)


def _coarse() -> Iterator[Accuracy]:
    for depth_a, depth_b in ((0, 0), (1, 1), (2, 2), (3, 3), (0, None), (None, 0), (1, 3), (4, 1)):
        yield Accuracy(max_depth_a=depth_a, max_depth_b=depth_b)
    yield Accuracy(leaves="boxes")
    yield Accuracy(leaves="boxes", max_depth_a=2)


@pytest.mark.parametrize("leaf_size", [1, 3])
@pytest.mark.parametrize("name", SURFACES)
def test_coarse_answers_keep_separated_a_proof_and_bound_the_gap(name: str, leaf_size: int) -> None:
    seen = set()
    for a, b, (rotation, translation) in _posed_pairs(name):
        world = posed(b[0], rotation, translation)
        touches = bool(mesh_pairs(a[0], a[1], world, b[1]))
        square = mesh_distance_squared(a[0], a[1], world, b[1])[0]
        tree_a = ObbTree.build(Mesh(*a), leaf_size=leaf_size)
        tree_b = ObbTree.build(Mesh(*b), leaf_size=leaf_size)
        for accuracy in _coarse():
            answer = obbcli.collide(
                tree_a, Body(tree_b, Pose(rotation, translation)), accuracy=accuracy
            )
            seen.add((answer.status, answer.approximate))
            if answer.status is Status.SEPARATED:
                assert not touches
                assert (answer.approximate, answer.error_bound) == (False, 0.0)
            elif answer.approximate:
                assert answer.witness is None
                assert square <= Fraction(answer.error_bound) ** 2
            else:
                assert touches

    assert (Status.SEPARATED, False) in seen
    assert (Status.OVERLAP_AT_START, True) in seen


@pytest.mark.parametrize("name", SURFACES)
def test_depth_limits_below_the_tree_change_nothing(name: str) -> None:
    for a, b, pose in _posed_pairs(name):
        tree_a, body_b = ObbTree.build(Mesh(*a)), Body(ObbTree.build(Mesh(*b)), Pose(*pose))
        exact = obbcli.collide(tree_a, body_b)
        depths = len(tree_a.levels), len(ObbTree.build(Mesh(*b)).levels)

        limited = obbcli.collide(
            tree_a, body_b, accuracy=Accuracy(max_depth_a=depths[0], max_depth_b=depths[1])
        )

        assert (limited.status, limited.witness) == (exact.status, exact.witness)
        assert (limited.approximate, limited.error_bound) == (False, 0.0)


def _root_box(tree: ObbTree) -> Box:
    node = tree._arrays.nodes.view(tree_oracles.NODE)[0, 0]
    unit = 2.0**tree._arrays.scale_exponent
    halves = node["half_extents"].astype(np.float64) * unit
    return Box(node["center"] * unit, tree_oracles.axes_of(node["rotation"]), halves)


@pytest.mark.parametrize("fit", ["triangles", "points", "hull", "min-volume", "axis-aligned"])
def test_depth_0_compares_the_root_boxes(fit: Any) -> None:
    roots = Accuracy(max_depth_a=0, max_depth_b=0)
    said = []
    for seed in range(40):
        a, (vertices, faces) = soup(5, seed), soup(5, seed + 50)
        trees = [
            ObbTree.build(Mesh(*surface), fit)
            for surface in (a, (vertices + np.array([1.5 + seed / 40, 1.0, 0.5]), faces))
        ]
        boxes = [_root_box(tree) for tree in trees]

        answer = obbcli.collide(*trees, accuracy=roots)

        gap = oracles.boxes_separation(*boxes)
        if gap <= 0 or gap > 1e-9:
            said.append(answer.status)
            assert answer.status is (Status.OVERLAP_AT_START if gap <= 0 else Status.SEPARATED)
    assert set(said) == {Status.OVERLAP_AT_START, Status.SEPARATED}


@pytest.mark.parametrize("exponent", [0, -200, -600, -850])
def test_error_bound_covers_a_corner_of_a_box_far_from_what_it_holds(exponent: int) -> None:
    # Specks at two corners of a square; the other surface lies at a third one, 1 away from both.
    # It also has a triangle of size 1 far away, which sets the scale at which boxes are tested.
    speck = np.array([[0.0, 0.0, 0.0], [1e-9, 0.0, 0.0], [0.0, 1e-9, 0.0]])
    faces = [(0, 1, 2), (3, 4, 5)]
    unit = 2.0**exponent
    specks = np.concatenate((speck, speck + np.array([1.0, 1.0, 0.0]))) * unit
    a = ObbTree.build(Mesh(specks, faces), "axis-aligned")
    third = (np.concatenate((speck, speck)) + np.array([1.0, 0.0, 0.0])) * unit
    b = Mesh(np.concatenate((third, speck * 1e9 + 100.0)), [*faces, (6, 7, 8)])
    coarse = Accuracy(max_depth_a=0)

    answer = obbcli.collide(a, ObbTree.build(b, split="center"), accuracy=coarse)

    assert (answer.status, answer.approximate) == (Status.OVERLAP_AT_START, True)
    assert 1.0 - 1e-8 <= answer.error_bound / unit <= 1.5
    assert obbcli.collide(a, b).status is Status.SEPARATED


def test_error_bound_counts_how_far_a_pose_is_from_orthonormal() -> None:
    # A speck beside a needle whose pose is skewed by 6e-10, which widens what boxes call contact.
    speck = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * 1e-9
    specks = ObbTree.build(Mesh(speck, [(0, 1, 2), (0, 1, 3)]), "axis-aligned")
    corners = [[-0.2571, 0.8779, 0.0712], [0.1223, -0.4184, -0.034], [0.0007, -0.0015, 0.0002]]
    needle = Mesh(np.array(corners), [(0, 1, 2)])
    turn = [[0.4879, 0.8702, -0.0688], [0.0224, 0.0663, 0.9975], [0.8726, -0.4882, 0.0128]]
    left, _, right = np.linalg.svd(turn)
    rotation = left @ right @ (np.eye(3) + 3e-10 * (1 - np.eye(3)))
    away = np.array([-3.733, -1.0611, 0.0635])
    widest = 0.0
    for gap in np.geomspace(1e-6, 1e-3, 60):
        pose = Pose(rotation, gap * away)

        answer = obbcli.collide(specks, Body(needle, pose), accuracy=Accuracy(max_depth_a=0))

        if answer.approximate:
            world = posed(needle.vertices, rotation, pose.translation)
            square = mesh_distance_squared(speck, specks.mesh.triangles, world, [(0, 1, 2)])[0]
            assert square <= Fraction(answer.error_bound) ** 2
            widest = float(square) ** 0.5
    assert 1e-4 < widest < 1e-3
