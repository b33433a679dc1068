"""The kernel that tells whether a mesh overlaps itself: windings squared, by columns."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes.solids import joined, shifted, turned_over
from meshes.surfaces import geodesic
from movers.meshes import box, cube, octahedron, star, tetrahedron, tube
from oracles.volume import shared_volume, signed_volume
from scenes.pairs import random_rotation
from strategies.still import examples

from obbcli import Mesh, ObbTree, Pose, kernels

Bracket = tuple[float, float]


def overlap(mesh: Any, pose: Any = None, within: Any = None, steps: int = 2**40) -> Any:
    """Return the brackets of a mesh's volume and excess."""
    tree = ObbTree.build(Mesh(*mesh))
    query = kernels.SelfOverlap(tree.kernel, (pose or Pose()).kernel, within)
    while not query.advance(steps):
        pass
    return query.volume, query.excess


def holds(bracket: Bracket, truth: Any, width: float) -> bool:
    """Return whether a bracket holds a rational number and is no wider than that."""
    low, high = bracket
    return Fraction(low) <= Fraction(truth) <= Fraction(high) and high - low <= width


@pytest.mark.parametrize("make", [cube, octahedron, star, tetrahedron], ids=lambda f: f.__name__)
def test_simple_solid_has_no_excess(make):
    volume, excess = overlap(make())

    assert holds(volume, signed_volume(make()), 1e-10)
    assert holds(excess, 0, 1e-9)


def test_volume_of_a_surface_turned_inward_is_negative():
    volume, excess = overlap(turned_over(cube()))

    assert holds(volume, -8, 1e-10)
    assert holds(excess, 0, 1e-9)


def test_hollow_and_ring_and_apart_parts_have_no_excess():
    hollow = joined(cube(2.0), turned_over(cube(1.0)))
    parts = joined(cube(1.0), shifted(cube(1.0), (5, 0, 0)), tube(3.0, 4.0, -1.0, 1.0))

    for mesh, truth in ((hollow, 56), (parts, signed_volume(parts))):
        volume, excess = overlap(mesh)
        assert holds(volume, truth, 1e-9)
        assert holds(excess, 0, 1e-8)


def test_parts_that_share_a_face_have_no_excess():
    assert holds(overlap(joined(cube(), shifted(cube(), (2, 0, 0))))[1], 0, 1e-9)


def test_doubled_space_counts_twice():
    # Two cubes of side 2 that share half of each: w is 2 in a volume of 4, w^2 - w there too.
    volume, excess = overlap(joined(cube(), shifted(cube(), (1, 0, 0))))

    assert holds(volume, 16, 1e-9)
    assert holds(excess, 8, 1e-8)


def test_part_turned_the_other_way_is_excess():
    # w is 1 in one cube and -1 in the other, the smaller one: w^2 - w is 2 there.
    volume, excess = overlap(joined(cube(1.0), shifted(turned_over(cube(0.5)), (5, 0, 0))))

    assert holds(volume, 7, 1e-9)
    assert holds(excess, 2, 1e-8)


def test_only_columns_through_the_box_are_looked_at():
    mesh = joined(cube(), shifted(cube(), (1, 0, 0)), shifted(cube(), (20, 20, 20)))

    far = overlap(mesh, within=((19.5, 19.5, 19.5), (20.5, 20.5, 20.5)))
    near = overlap(mesh, within=((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)))

    assert far[1][1] <= 1e-9
    assert near[1][0] >= 1.0


@examples(100)
@given(st.lists(st.tuples(*[st.tuples(*[st.integers(-2, 2)] * 3)] * 4), min_size=1, max_size=3))
def test_tetrahedra_on_a_grid_agree_with_exact_sums(corners):
    vertices = np.array(corners, dtype=np.float64).reshape(-1, 3)
    faces = np.array([(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)])
    rows = (faces + 4 * np.arange(len(corners))[:, None, None]).reshape(-1, 3)
    mesh = vertices, rows
    volume = signed_volume(mesh)

    found = overlap(mesh)

    assert holds(found[0], volume, 1e-9)
    assert holds(found[1], shared_volume(mesh, mesh) - abs(volume), 1e-8)


@pytest.mark.parametrize("seed", range(3))
def test_bits_depend_on_neither_slices_nor_pose_of_the_question(seed):
    vertices, faces = geodesic(320)
    pose = Pose(random_rotation(seed), [1, 2, 3])

    found = overlap((vertices, faces), pose)

    assert overlap((vertices, faces), pose, steps=1) == found
    assert holds(found[1], 0, 1e-9)


def test_before_it_is_done_nothing_is_claimed():
    tree = ObbTree.build(Mesh(*box((0, 0, 0), (1, 1, 1))))
    query = kernels.SelfOverlap(tree.kernel, Pose().kernel)

    assert query.volume == (-np.inf, np.inf)
    assert query.excess == (0.0, np.inf)
