"""`distance` against exact arithmetic and closed forms: bounds hold, are close, and say where."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from math import sqrt

import numpy as np
import pytest
from claims.distance import (
    assert_bounds_are_close,
    assert_bounds_hold,
    assert_points_say_it,
    extent_of,
)
from hypothesis import given
from hypothesis import strategies as st
from meshes.nasty import NASTY, needles, soup
from meshes.surfaces import sphere
from oracles.distance import triangle_distance_squared
from oracles.mesh import mesh_distance_squared, posed
from scenes.pairs import POSE_CLASSES, random_rotation
from strategies.meshes import grids, mesh_pairs
from strategies.still import examples, triangle_pairs, triangles

import obbcli

ONE = np.array([[0, 1, 2]])


def mesh_of(corners) -> obbcli.Mesh:
    """Return a mesh of one triangle."""
    return obbcli.Mesh(np.asarray(corners, dtype=np.float64), ONE)


def distance_of(a, b) -> obbcli.Distance:
    """Return the distance of two surfaces, each vertices and faces."""
    return obbcli.distance(obbcli.Mesh(*a), obbcli.Mesh(*b))


# Pairs of triangles


@given(triangle_pairs())
@examples(600)
def test_distance_of_triangles_is_bounded_as_exact_arithmetic_has_it(pair):
    answer = obbcli.distance(mesh_of(pair.a), mesh_of(pair.b))

    assert_bounds_hold(answer, triangle_distance_squared(pair.a, pair.b))
    assert_bounds_are_close(answer, extent_of(pair.a, pair.b))
    assert_points_say_it(answer, pair.a, pair.b)


@given(triangles(), triangles(), st.integers(1, 52), st.sampled_from(range(3)))
@examples(200)
def test_distance_of_triangles_a_hair_apart_is_exact_to_the_hair(a, b, bits, axis):
    # B is shifted until it lies beyond A along an axis, and then a hair further.
    hair = 2.0**-bits
    b = np.array(b)
    b[:, axis] += a[:, axis].max() - b[:, axis].min() + hair

    answer = obbcli.distance(mesh_of(a), mesh_of(b))

    assert_bounds_hold(answer, triangle_distance_squared(a, b))
    assert_bounds_are_close(answer, 0.0 if bits < 40 else extent_of(a, b))


@given(triangle_pairs(), st.integers(-60, 60))
@examples(200)
def test_distance_of_triangles_scales_with_powers_of_two_to_the_last_bit(pair, exponent):
    reach = max(np.abs(pair.a).max(), np.abs(pair.b).max())
    if not 2.0**-900 < reach < 2.0**900:
        exponent = 0  # what underflows or overflows is another triangle
    plain = obbcli.distance(mesh_of(pair.a), mesh_of(pair.b))

    scaled = obbcli.distance(
        mesh_of(np.ldexp(pair.a, exponent)), mesh_of(np.ldexp(pair.b, exponent))
    )

    if min(np.abs(x[x != 0]).min(initial=1.0) for x in (pair.a, pair.b)) > 2.0**-900:
        assert scaled.bounds == tuple(np.ldexp(plain.bounds, exponent))
        assert scaled.point_a == tuple(np.ldexp(plain.point_a, exponent))
        assert scaled.point_b == tuple(np.ldexp(plain.point_b, exponent))


@given(triangle_pairs())
@examples(200)
def test_distance_of_swapped_triangles_swaps_the_points(pair):
    a, b = mesh_of(pair.a), mesh_of(pair.b)

    one, other = obbcli.distance(a, b), obbcli.distance(b, a)

    assert one.bounds == other.bounds
    assert (one.point_a, one.point_b) == (other.point_b, other.point_a)


@pytest.mark.parametrize(
    ("a", "b", "wanted", "point_a", "point_b"),
    [
        # A vertex over a face, two edges crossed, an edge beside a vertex, two vertices.
        ([[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[1, 1, 2], [1, 2, 5], [2, 1, 5]], 2.0,
         (1, 1, 0), (1, 1, 2)),
        ([[-1, 0, 0], [1, 0, 0], [0, 0, -5]], [[0, -1, 3], [0, 1, 3], [0, 0, 9]], 3.0,
         (0, 0, 0), (0, 0, 3)),
        ([[0, -1, 0], [0, 1, 0], [-3, 0, 0]], [[4, 0, 0], [8, 1, 0], [8, -1, 0]], 4.0,
         (0, 0, 0), (4, 0, 0)),
        ([[0, 0, 0], [-1, 0, 0], [0, -1, -1]], [[3, 4, 12], [5, 5, 15], [9, 9, 19]], 13.0,
         (0, 0, 0), (3, 4, 12)),
        # Points and segments are shapes like any other.
        ([[0, 0, 0]] * 3, [[3, 4, 0]] * 3, 5.0, (0, 0, 0), (3, 4, 0)),
        ([[-1, 0, 0], [1, 0, 0], [0, 0, 0]], [[0, 2, 0], [0, 3, 0], [0, 4, 0]], 2.0,
         (0, 0, 0), (0, 2, 0)),
    ],
)  # fmt: skip
def test_distance_of_triangles_is_that_of_the_nearest_features(a, b, wanted, point_a, point_b):
    answer = obbcli.distance(mesh_of(a), mesh_of(b))

    assert answer.bounds[0] <= wanted <= answer.bounds[1]
    assert answer.distance == pytest.approx(wanted, rel=1e-15)
    assert answer.point_a == point_a
    assert answer.point_b == point_b


# Meshes


@given(mesh_pairs())
@examples(150)
def test_distance_of_meshes_is_bounded_as_exact_arithmetic_has_it(pair):
    a, b = pair
    square, nearest = mesh_distance_squared(*a, *b)

    answer = distance_of(a, b)

    assert_bounds_hold(answer, square)
    assert_bounds_are_close(answer, extent_of(a.vertices, b.vertices))
    assert_points_say_it(
        answer, a.vertices[a.faces[answer.triangle_a]], b.vertices[b.faces[answer.triangle_b]]
    )
    assert square > 0 or (answer.triangle_a, answer.triangle_b) in nearest


@given(grids(), grids(), st.integers(0, 40), st.floats(-3, 3), st.integers(0, 2**20))
@examples(60)
def test_distance_of_posed_meshes_is_that_of_their_rounded_vertices(a, b, far, gap, seed):
    random = np.random.default_rng(seed)
    poses = [
        obbcli.Pose(random_rotation(seed + k), random.normal(size=3) + 2.0**far * k * (far > 30))
        for k in range(2)
    ]
    # Both far away alike, B a little off A.
    shared = random.normal(size=3) * 2.0**far
    poses = [
        obbcli.Pose(p.rotation, shared + k * np.array([0, 0, 9 + gap])) for k, p in enumerate(poses)
    ]
    world_a, world_b = (
        posed(m.vertices, p.rotation, p.translation) for m, p in zip((a, b), poses, strict=True)
    )

    answer = obbcli.distance(
        *(obbcli.Body(obbcli.Mesh(*m), pose=p) for m, p in zip((a, b), poses, strict=True))
    )

    assert_bounds_hold(answer, mesh_distance_squared(world_a, a.faces, world_b, b.faces)[0])
    assert_bounds_are_close(answer, extent_of(world_a, world_b))


@pytest.mark.parametrize("name", NASTY)
def test_distance_of_nasty_meshes_is_bounded_as_exact_arithmetic_has_it(name):
    a, b = NASTY[name](), NASTY["soup"]()
    reach = float(np.abs(a[0]).max())
    # Beside the other, in its own scale.
    shifted = np.ldexp(b[0], int(np.frexp(reach)[1]) - 2), b[1]

    answer = distance_of(a, shifted)

    # The oracle's boxes want differences that a double holds.
    part = 0.25 if reach > 1e300 else 1.0
    faces = np.unique(a[1], axis=0)
    square = mesh_distance_squared(a[0] * part, faces, shifted[0] * part, shifted[1])[0]
    assert_bounds_hold(answer, square / Fraction(part) ** 2)


@pytest.mark.parametrize("name", [name for name in POSE_CLASSES if not name.startswith("random")])
def test_distance_of_scenes_is_what_they_were_made_with(name):
    pair = POSE_CLASSES[name](300)
    b = obbcli.Body(
        obbcli.Mesh(pair.b.vertices, pair.b.faces),
        pose=obbcli.Pose(pair.rotation, pair.translation),
    )

    answer = obbcli.distance(obbcli.Mesh(pair.a.vertices, pair.a.faces), b)

    truth = mesh_distance_squared(pair.a.vertices, pair.a.faces, pair.posed_b, pair.b.faces)[0]
    assert_bounds_hold(answer, truth)
    assert_bounds_are_close(answer, pair.size)
    if pair.distance is not None:
        assert pair.distance[0] <= answer.bounds[1]
        assert answer.bounds[0] <= pair.distance[1]
    assert pair.touches is None or pair.touches == (answer.distance == 0)


@pytest.mark.parametrize("apart", [3.0, 2.0 + 2.0**-20, 2.0 + 2.0**-44])
def test_distance_of_spheres_of_facets_lies_between_those_of_spheres(apart):
    ball = sphere(2000)
    corners = ball.vertices[ball.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inner = ((normals * corners[:, 0]).sum(1) / np.linalg.norm(normals, axis=1)).min()
    turned = obbcli.Pose(random_rotation(7), (apart / sqrt(3),) * 3)
    mesh = obbcli.Mesh(ball.vertices, ball.faces)

    answer = obbcli.distance(mesh, obbcli.Body(mesh, pose=turned))

    # Vertices lie on the spheres to the grid of 2**-24, facets reach in to the inner ones.
    assert apart - 2 - 2.0**-22 <= answer.bounds[1]
    assert answer.bounds[0] <= apart - 2 * inner + 2.0**-22


@pytest.mark.parametrize("surface", [soup(300), needles(150)])
def test_distance_by_trees_is_that_of_all_pairs(surface):
    vertices, faces = surface
    shift = (0.0, 0.0, 1.01 * float(np.ptp(vertices[:, 2])))

    answer = obbcli.distance(
        obbcli.Mesh(vertices, faces),
        obbcli.Body(obbcli.Mesh(vertices, faces), pose=obbcli.Pose(translation=shift)),
    )

    moved = posed(vertices, np.eye(3), shift)
    assert_bounds_hold(answer, mesh_distance_squared(vertices, faces, moved, faces)[0])


# Laws


@pytest.mark.parametrize("name", ["gap_1e-3", "gap_1e-1", "interlocked", "nested", "sheets"])
def test_distance_does_not_depend_on_the_trees(name):
    pair = POSE_CLASSES[name](600)
    pose = obbcli.Pose(pair.rotation, pair.translation)
    meshes = (
        obbcli.Mesh(pair.a.vertices, pair.a.faces),
        obbcli.Mesh(pair.b.vertices, pair.b.faces),
    )
    options = [
        {"fit": fit, "split": split, "leaf_size": size}
        for fit, split, size in product(
            ("triangles", "points", "axis-aligned"), ("median", "center"), (1, 7)
        )
    ]
    plain = obbcli.distance(meshes[0], obbcli.Body(meshes[1], pose=pose))

    for chosen in options:
        a, b = (obbcli.ObbTree.build(mesh, **chosen) for mesh in meshes)
        answer = obbcli.distance(a, obbcli.Body(b, pose=pose))

        assert answer.bounds[0] <= plain.bounds[1]
        assert plain.bounds[0] <= answer.bounds[1]
        assert answer.bounds[1] - answer.bounds[0] <= 8 * np.spacing(answer.distance)


@pytest.mark.parametrize("name", ["far", "gap_1e-1", "gap_1e-3", "interlocked", "nested"])
def test_distance_of_swapped_bodies_swaps_everything(name):
    pair = POSE_CLASSES[name](600)
    a = obbcli.Mesh(pair.a.vertices, pair.a.faces)
    b = obbcli.Body(
        obbcli.Mesh(pair.b.vertices, pair.b.faces),
        pose=obbcli.Pose(pair.rotation, pair.translation),
    )

    one, other = obbcli.distance(a, b), obbcli.distance(b, a)

    assert one.distance == other.distance
    assert one.bounds[0] == pytest.approx(other.bounds[0], rel=2.0**-48)
    if name.startswith(("far", "gap")):  # one nearest vertex each, of several triangles
        assert (one.point_a, one.point_b) == (other.point_b, other.point_a)
        assert (one.triangle_a, one.triangle_b) == (other.triangle_b, other.triangle_a)


def test_distance_of_a_mesh_to_itself_is_zero():
    mesh = obbcli.Mesh(*soup(40))

    answer = obbcli.distance(mesh, mesh)

    assert answer.bounds == (0.0, 0.0)
    assert answer.point_a == answer.point_b
    corners = mesh.vertices[mesh.triangles]
    assert_points_say_it(answer, corners[answer.triangle_a], corners[answer.triangle_b])


def test_distance_is_that_at_the_start_of_a_motion():
    a, b = (mesh_of([[0, 0, z], [1, 0, z], [0, 1, z]]) for z in (0.0, 2.0))
    motion = obbcli.Motion(linear_velocity=(0, 0, 1), angular_velocity=(1, 2, 3))

    answer = obbcli.distance(obbcli.Body(a, motion=motion), b)

    assert answer.bounds[0] <= 2.0 <= answer.bounds[1]
    assert answer.distance == pytest.approx(2.0, rel=1e-15)
