"""Degenerate, duplicate and open triangles of a `Mesh`, against exact truth."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from obbcli.mesh import Mesh, topology

TRIANGLE = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]
TETRAHEDRON = (
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
)
LARGEST = np.finfo(float).max
TINIEST = 5e-324


def single(*corners):
    return Mesh(np.array(corners, dtype=float), [[0, 1, 2]])


def is_degenerate(corners):
    a, b, c = ([Fraction(x) for x in row] for row in corners)
    u = [q - p for p, q in zip(a, b, strict=True)]
    v = [q - p for p, q in zip(a, c, strict=True)]
    return all(u[i] * v[j] == u[j] * v[i] for i, j in itertools.combinations(range(3), 2))


coordinates = st.one_of(
    st.sampled_from(
        [0.0, -0.0, 1.0, -1.0, 0.1, 0.2, 0.3, 1e-300, 1e300, TINIEST, LARGEST, -LARGEST]
    ),
    st.floats(allow_nan=False, allow_infinity=False),
)


@given(hnp.arrays(np.float64, (9, 3), elements=coordinates), st.integers(0, 2**32 - 1))
def test_degenerate_count_agrees_with_rational_arithmetic(vertices, seed):
    triangles = np.random.default_rng(seed).integers(0, 9, (10, 3))
    mesh = Mesh(vertices, triangles)

    expected = sum(is_degenerate(mesh.vertices[row].tolist()) for row in triangles)

    assert mesh.degenerate_count == expected


@given(
    st.lists(st.integers(-(2**20), 2**20), min_size=6, max_size=6),
    st.integers(-8, 8),
    st.integers(-1000, 900),
    st.integers(-2, 2),
)
def test_degenerate_count_is_right_beside_a_line(six, factor, exponent, ulps):
    start, step = np.array(six[:3], float), np.array(six[3:], float)
    corners = np.ldexp([start, start + step, start + factor * step], exponent)
    for _ in range(abs(ulps)):
        corners[2, 0] = np.nextafter(corners[2, 0], math.copysign(math.inf, ulps))

    assert single(*corners).degenerate_count == is_degenerate(corners.tolist())


def test_degenerate_count_does_not_take_thin_for_degenerate():
    assert single([0, 0, 0], [1, 0, 0], [0, TINIEST, 0]).degenerate_count == 0
    assert single([0, 0, 0], [1e300, 0, 0], [1, 1e-300, 0]).degenerate_count == 0
    assert single([0, 0, 0], [1e300, 0, 0], [1, 0, 0]).degenerate_count == 1


def test_duplicate_count_compares_positions_in_any_order():
    vertices = [*TRIANGLE, [0, 0, 1], [0, -0.0, 0]]
    triangles = [[0, 1, 2], [2, 1, 0], [4, 1, 2], [0, 1, 3], [0, 0, 1], [1, 0, 0], [0, 1, 1]]

    assert Mesh(vertices, triangles).duplicate_count == 3


@given(
    hnp.arrays(np.float64, (8, 3), elements=st.sampled_from([0.0, -0.0, 1.0, 2.0])),
    hnp.arrays(np.int64, (9, 3), elements=st.integers(0, 7)),
)
def test_duplicate_count_agrees_with_counting_sets(vertices, triangles):
    seen = {tuple(sorted(tuple((vertices[i] + 0.0).tolist()) for i in row)) for row in triangles}

    assert Mesh(vertices, triangles).duplicate_count == len(triangles) - len(seen)


def test_position_ids_survive_hashes_that_collide(monkeypatch):
    vertices = np.random.default_rng(1).integers(0, 3, (50, 3)).astype(float)
    expected = np.unique(vertices, axis=0, return_inverse=True)[1].reshape(-1)

    monkeypatch.setattr(topology, "_MULTIPLIERS", (0, 0, 0))
    ids = topology.position_ids(vertices)

    pairs = set(zip(ids.tolist(), expected.tolist(), strict=True))
    assert len(pairs) == len(set(ids.tolist())) == len(set(expected.tolist()))


def unshared(mesh):
    """Return the same surface as STL would hold it: three vertices a triangle."""
    corners = mesh.vertices[mesh.triangles].reshape(-1, 3)
    return Mesh(corners, np.arange(len(corners)).reshape(-1, 3))


@pytest.mark.parametrize(
    "made",
    [
        trimesh.creation.box(),
        trimesh.creation.icosphere(subdivisions=2),
        trimesh.creation.torus(3, 1, major_sections=8, minor_sections=6),
    ],
)
def test_is_watertight_holds_for_closed_surfaces_shared_or_not(made):
    mesh = Mesh(made.vertices, made.faces)

    assert mesh.is_watertight
    assert unshared(mesh).is_watertight


def test_is_watertight_fails_for_an_opening():
    vertices, triangles = TETRAHEDRON

    assert Mesh(vertices, triangles).is_watertight
    assert not Mesh(vertices, triangles[1:]).is_watertight


def test_is_watertight_fails_for_a_triangle_turned_over():
    vertices, triangles = TETRAHEDRON

    assert not Mesh(vertices, [triangles[0][::-1], *triangles[1:]]).is_watertight


def test_is_watertight_fails_where_four_triangles_share_an_edge():
    vertices, triangles = TETRAHEDRON
    mirrored = [[1 - x, -y, z] for x, y, z in vertices]
    corners = np.array(triangles) + 4

    # Two tetrahedra that share the edge from (0, 0, 0) to (1, 0, 0).
    assert not Mesh(vertices + mirrored, [*triangles, *corners.tolist()]).is_watertight


def test_is_watertight_fails_for_a_surface_given_twice():
    vertices, triangles = TETRAHEDRON

    assert not Mesh(vertices, triangles * 2).is_watertight


def test_is_watertight_leaves_out_triangles_that_collapsed():
    vertices, triangles = TETRAHEDRON

    assert Mesh(vertices, [*triangles, [0, 0, 1], [2, 2, 2]]).is_watertight
    assert not Mesh(vertices, [[0, 0, 1]]).is_watertight


def test_is_watertight_sees_a_gap_of_one_ulp():
    vertices, triangles = TETRAHEDRON
    mesh = unshared(Mesh(vertices, triangles))
    moved = mesh.vertices.copy()
    moved[0, 0] = TINIEST

    assert not Mesh(moved, mesh.triangles).is_watertight
