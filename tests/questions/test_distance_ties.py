"""`distance` where very many pairs are as near, or nearly: flat faces that lie along each other."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from claims.distance import assert_bounds_are_close, assert_bounds_hold, assert_points_say_it
from oracles.mesh import mesh_distance_squared, posed
from scenes.pairs import random_rotation

import obbcli

# Whole numbers, at right angles to each other and 3 long: plates along the first two lie askew to
# all axes, and their distance is known without any rounding.
ALONG = np.array([[1.0, 2.0, 2.0], [2.0, 1.0, -2.0]])
ACROSS = np.array([2.0, -2.0, 1.0])
GAP = 2.0**-8


def plate(cells: int, start: float = 0.0, height: float = 0.0, turned: bool = False):
    """Return a lattice of 2 cells**2 triangles in the plane at 3 `height`, vertices and faces."""
    steps = np.arange(cells + 1)
    u, v = (grid.ravel() + start for grid in np.meshgrid(steps, steps, indexing="ij"))
    vertices = np.stack([u, v], axis=1) @ ALONG + height * ACROSS
    number = np.arange(u.size).reshape(cells + 1, cells + 1)
    a, b, c, d = (corner.ravel() for corner in (number[:-1, :-1], number[1:, :-1], number[1:, 1:],
                                                number[:-1, 1:]))  # fmt: skip
    halves = ((b, c, d), (b, d, a)) if turned else ((a, b, c), (a, c, d))
    return vertices, np.concatenate([np.stack(half, axis=1) for half in halves])


def distance_of(a, b, **options) -> obbcli.Distance:
    """Return the distance of two surfaces, each vertices and faces."""
    return obbcli.distance(*(obbcli.ObbTree.build(obbcli.Mesh(*s), **options) for s in (a, b)))


@pytest.mark.parametrize("cells", [1, 4, 12, 40])
@pytest.mark.parametrize("start", [0.0, 0.375])
@pytest.mark.parametrize("gap", [GAP, 3.0])
def test_distance_of_parallel_plates_is_their_gap(cells, start, gap):
    a, b = plate(cells), plate(cells, start, gap, turned=True)

    answer = distance_of(a, b)

    assert_bounds_hold(answer, Fraction(3 * gap) ** 2)
    assert_bounds_are_close(answer, 0.0)
    assert_points_say_it(answer, a[0][a[1][answer.triangle_a]], b[0][b[1][answer.triangle_b]])


@pytest.mark.parametrize("bits", [12, 24, 34, 40])
@pytest.mark.parametrize("lowered", [0, 7, 400, 1000])
@pytest.mark.parametrize("leaf_size", [1, 6])
def test_distance_of_plates_sees_a_vertex_that_is_a_hair_nearer(bits, lowered, leaf_size):
    hair = 2.0**-bits
    a, b = plate(36, start=-2.0), plate(32, start=0.25, height=GAP)
    b[0][lowered] -= hair * ACROSS

    answer = distance_of(a, b, leaf_size=leaf_size)

    assert_bounds_hold(answer, Fraction(3 * (GAP - hair)) ** 2)
    assert lowered in b[1][answer.triangle_b]


@pytest.mark.parametrize("bits", [20, 30])
def test_distance_of_plates_is_that_of_the_nearest_of_several_hairs(bits):
    hair = 2.0**-bits
    a, b = plate(36, start=-2.0), plate(32, start=0.25, height=GAP)
    for k in range(300):
        b[0][k] -= (hair + k * hair / 1024) * ACROSS

    answer = distance_of(a, b)

    assert_bounds_hold(answer, Fraction(3 * (GAP - hair - 299 * hair / 1024)) ** 2)
    assert 299 in b[1][answer.triangle_b]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("gap", [GAP, 1.0])
def test_distance_of_plates_turned_anyhow_is_bounded_as_exact_arithmetic_has_it(seed, gap):
    # Turning rounds every vertex: the ties are broken by what that leaves.
    a, b = plate(4), plate(4, start=0.375, height=gap)
    rotation, shift = random_rotation(seed), np.array([1.0, 2.0, 3.0])
    pose = obbcli.Pose(rotation, shift)

    answer = obbcli.distance(*(obbcli.Body(obbcli.Mesh(*s), pose=pose) for s in (a, b)))

    world_a, world_b = (posed(s[0], rotation, shift) for s in (a, b))
    assert_bounds_hold(answer, mesh_distance_squared(world_a, a[1], world_b, b[1])[0])
    assert_bounds_are_close(answer, float(np.ptp(world_a, axis=0).max()))


@pytest.mark.parametrize("exponent", [-300, 0, 300])
def test_distance_of_plates_is_the_same_by_lazy_and_whole_trees_in_any_unit(exponent):
    a, b = plate(20), plate(20, start=0.375, height=GAP)
    plain = distance_of(a, b)
    unit = 2.0**exponent

    lazy, whole = (
        distance_of((a[0] * unit, a[1]), (b[0] * unit, b[1]), lazy=lazy) for lazy in (True, False)
    )

    for answer in (lazy, whole):
        assert answer.bounds == tuple(np.ldexp(plain.bounds, exponent))
        assert answer.point_a == tuple(np.ldexp(plain.point_a, exponent))
        assert (answer.triangle_a, answer.triangle_b) == (plain.triangle_a, plain.triangle_b)


def test_distance_of_cells_face_to_face_ties_vertices_edges_and_faces():
    # The same lattice twice: every vertex, edge and face is as near its own copy.
    a, b = plate(5), plate(5, height=GAP)

    one, other = distance_of(a, b), distance_of(b, a)

    assert_bounds_hold(one, mesh_distance_squared(a[0], a[1], b[0], b[1])[0])
    assert one.distance == other.distance
    assert_points_say_it(one, a[0][a[1][one.triangle_a]], b[0][b[1][one.triangle_b]])
