"""`Mesh`: what it accepts, what it refuses with place, and its figures against exact truth."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from obbcli.errors import MeshError
from obbcli.mesh import Mesh

TRIANGLE = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]
LARGEST = np.finfo(float).max
TINIEST = 5e-324


def single(*corners):
    return Mesh(np.array(corners, dtype=float), [[0, 1, 2]])


@pytest.mark.parametrize("kind", ["i1", "u1", "<i2", ">i2", "u4", "i8", "u8", "f4", "f8"])
def test_mesh_takes_any_numbers_that_are_whole(kind):
    mesh = Mesh(TRIANGLE, np.array([[0, 1, 2]], dtype=kind))

    assert mesh.triangles.dtype == np.int32
    assert mesh.triangles.tolist() == [[0, 1, 2]]


def test_mesh_takes_lists_and_strided_arrays_and_makes_them_contiguous():
    vertices = np.asfortranarray(np.arange(24.0).reshape(6, 4))[::2, :3]

    mesh = Mesh(vertices, np.array([[0, 9, 1, 9, 2]])[:, ::2])

    assert mesh.vertices.flags.c_contiguous
    assert mesh.triangles.flags.c_contiguous
    assert mesh.vertices.tolist() == vertices.tolist()


def test_mesh_is_frozen_and_does_not_follow_its_callers_arrays():
    vertices = np.array(TRIANGLE)
    triangles = np.array([[0, 1, 2]], dtype=np.int32)
    mesh = Mesh(vertices, triangles)

    vertices[0, 0] = 9.0
    triangles[0, 0] = 2

    assert mesh.vertices.tolist() == TRIANGLE
    assert mesh.triangles.tolist() == [[0, 1, 2]]
    assert not mesh.vertices.flags.writeable
    assert not mesh.triangles.flags.writeable
    with pytest.raises(dataclasses.FrozenInstanceError):
        mesh.vertices = vertices


def test_mesh_does_not_follow_a_read_only_view_of_a_writable_array():
    vertices = np.array(TRIANGLE)
    view = vertices[:]
    view.setflags(write=False)
    mesh = Mesh(view, [[0, 1, 2]])

    vertices[0, 0] = 9.0

    assert mesh.vertices.tolist() == TRIANGLE


def test_mesh_made_in_code_has_no_source():
    mesh = Mesh(TRIANGLE, [[0, 1, 2]])

    assert mesh.source is None
    assert mesh.sha256 is None
    assert repr(mesh) == "Mesh(3 vertices, 1 triangles)"


@pytest.mark.parametrize(
    ("vertices", "triangles", "fault"),
    [
        ([*TRIANGLE, [0, np.nan, 0]], [[0, 1, 2]], "vertex 3: y is nan; coordinates must"),
        ([[0, 0, -np.inf], *TRIANGLE], [[0, 1, 2]], "vertex 0: z is -inf"),
        (TRIANGLE, [[0, 1, 2]] * 7 + [[0, 1, 3]], "triangle 7: uses vertex 3 of 3; indices"),
        (TRIANGLE, [[0, -1, 2]], "triangle 0: uses vertex -1 of 3"),
        (TRIANGLE, [[0, 1, 2**31]], "triangle 0: uses vertex 2147483648 of 3"),
        (TRIANGLE, np.array([[0, 1, 2**64 - 1]], "u8"), "triangle 0: uses vertex 184467440737"),
        (TRIANGLE, [[0, 1, 1.5]], "triangle 0: uses vertex 1.5 which is no whole number"),
        (TRIANGLE, [[0, 1, 2], [0, 1, np.nan]], "triangle 1: uses vertex nan"),
        (TRIANGLE, [[0, 1, np.inf]], "triangle 0: uses vertex inf"),
        (TRIANGLE, [["a", "b", "c"]], "triangles: have type"),
        (TRIANGLE, [[True, False, True]], "triangles: have type bool"),
        (TRIANGLE, [[0, 1, 2**70]], "triangles: have type object"),
        (TRIANGLE, [], "triangles: none found, at least one wanted"),
        (TRIANGLE, np.zeros((0, 3), int), "triangles: none found"),
        (TRIANGLE, [0, 1, 2], r"triangles: has shape \(3,\), expected \(N, 3\)"),
        (TRIANGLE, [[0, 1]], r"triangles: has shape \(1, 2\)"),
        (TRIANGLE, [[0, 1, 2], [0, 1]], r"triangles: is not an array of numbers of shape \(N, 3\)"),
        ([], [[0, 1, 2]], "triangle 0: uses vertex [012] of 0"),
        ([[0, 0]] * 3, [[0, 1, 2]], r"vertices: has shape \(3, 2\)"),
        ([["a"] * 3] * 3, [[0, 1, 2]], "vertices: have type"),
        (np.array(TRIANGLE) + 1j, [[0, 1, 2]], "vertices: have type complex128"),
    ],
)  # fmt: skip
def test_mesh_refuses_what_is_no_mesh_and_names_the_place(vertices, triangles, fault):
    with pytest.raises(MeshError, match=rf"^{fault}"):
        Mesh(vertices, triangles)
    with pytest.raises(MeshError, match=rf"^part\.stl: {fault}"):
        Mesh(vertices, triangles, source="part.stl")


def test_mesh_refuses_more_triangles_than_int32_can_number():
    triangles = np.broadcast_to(np.zeros(1, dtype=np.int8), (2**31, 3))

    with pytest.raises(MeshError, match="2147483648 triangles, at most 2147483647"):
        Mesh(TRIANGLE, triangles)
    with pytest.raises(MeshError, match="2147483648 vertices, at most 2147483647"):
        Mesh(np.broadcast_to(np.zeros(1), (2**31, 3)), [[0, 1, 2]])


def test_mesh_takes_vertices_whose_sum_overflows():
    mesh = single([LARGEST] * 3, [LARGEST] * 3, [-LARGEST] * 3)

    assert mesh.bounds.tolist() == [[-LARGEST] * 3, [LARGEST] * 3]


def test_bounds_leave_out_vertices_that_no_triangle_uses():
    mesh = Mesh([*TRIANGLE, [100, 100, 100]], [[0, 1, 2]])

    assert mesh.bounds.tolist() == [[0, 0, 0], [1, 1, 0]]
    assert mesh.size == math.sqrt(2)


@pytest.mark.parametrize(
    ("corner", "size"),
    [
        ([3, 4, 12], 13.0),
        ([3e300, 4e300, 12e300], 13e300),
        ([3e-310, 4e-310, 12e-310], 13e-310),
        ([TINIEST, 0, 0], TINIEST),
        ([1e308, 0, 0], 1e308),
        ([0, 0, 0], 0.0),
    ],
)
def test_size_is_the_diagonal_at_any_scale(corner, size):
    assert single([0, 0, 0], corner, corner).size == pytest.approx(size, rel=1e-13)


def test_size_of_a_box_wider_than_the_largest_double_can_say():
    half = LARGEST / 4

    assert single([-half, 0, 0], [half, 0, 0], [0, 0, 0]).size == pytest.approx(LARGEST / 2)
    assert single([-LARGEST, 0, 0], [LARGEST, 0, 0], [0, 0, 0]).size == math.inf


def exact_centroid(mesh):
    """Return the area-weighted centroid with areas to 60 digits."""
    from mpmath import mp, mpf

    with mp.workdps(60):
        total = mpf(0)
        moment = [mpf(0)] * 3
        for row in mesh.triangles.tolist():
            a, b, c = ([mpf(x) for x in mesh.vertices[i].tolist()] for i in row)
            u = [q - p for p, q in zip(a, b, strict=True)]
            v = [q - p for p, q in zip(a, c, strict=True)]
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            area = mp.sqrt(sum(x * x for x in n))
            total += area
            moment = [
                m + area * (p + q + r) / 3 for m, p, q, r in zip(moment, a, b, c, strict=True)
            ]
        return [float(m / total) for m in moment]


@given(st.integers(-900, 900), st.integers(0, 2**32 - 1))
def test_surface_centroid_agrees_with_high_precision_at_any_scale(exponent, seed):
    random = np.random.default_rng(seed)
    vertices = np.ldexp(random.normal(size=(8, 3)) + random.normal(size=3), exponent)
    mesh = Mesh(vertices, random.integers(0, 8, (12, 3)))

    size = mesh.size

    np.testing.assert_allclose(
        mesh.surface_centroid, exact_centroid(mesh), rtol=0, atol=size * 1e-14
    )


@given(st.integers(-900, 900), st.integers(0, 2**32 - 1))
def test_surface_centroid_and_size_scale_exactly_with_powers_of_two(exponent, seed):
    random = np.random.default_rng(seed)
    vertices, triangles = random.normal(size=(8, 3)), random.integers(0, 8, (12, 3))
    mesh = Mesh(vertices, triangles)
    scaled = Mesh(np.ldexp(vertices, exponent), triangles)

    expected = np.ldexp(mesh.surface_centroid, exponent).tolist()

    assert scaled.surface_centroid.tolist() == expected
    assert scaled.size == pytest.approx(math.ldexp(mesh.size, exponent), rel=1e-15)


def test_surface_centroid_is_not_the_mean_of_vertices():
    # Four small triangles in one corner and one large one.
    vertices = [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0.1, 0, 0], [0, 0.1, 0]]

    assert Mesh(vertices, [[0, 1, 2]]).surface_centroid.tolist() == [1, 1, 0]


def test_surface_centroid_far_from_the_origin_keeps_its_digits():
    offset = np.array([1e8, -1e8, 1e8])

    moved = Mesh(np.array(TRIANGLE) * 0.75 + offset, [[0, 1, 2]]).surface_centroid

    expected = offset + np.array([0.25, 0.25, 0])
    np.testing.assert_allclose(moved, expected, rtol=0, atol=3e-8)


@pytest.mark.parametrize(
    ("vertices", "triangles", "mean"),
    [
        ([[0, 0, 0], [1, 1, 1], [5, 5, 5]], [[0, 1, 2]], [2, 2, 2]),
        ([[4, 5, 6]] * 3, [[0, 1, 2]], [4, 5, 6]),
        ([[0, 0, 0], [1, 0, 0], [9, 9, 9]], [[0, 1, 1], [0, 0, 1]], [0.5, 0, 0]),
        # Rounding gives this line an area; exactly it has none.
        (
            np.array([[0.1, 0.2, 0.3]]) * [[1], [2], [4]],
            [[0, 1, 2]],
            np.array([0.1, 0.2, 0.3]) * 7 / 3,
        ),
    ],
)
def test_surface_centroid_is_the_mean_of_used_vertices_where_the_area_is_zero(
    vertices, triangles, mean
):
    centroid = Mesh(vertices, triangles).surface_centroid

    np.testing.assert_allclose(centroid, mean, rtol=1e-15)


def test_surface_centroid_at_the_ends_of_the_double_range():
    huge = single([-LARGEST, -LARGEST, 0], [LARGEST, -LARGEST, 0], [0, LARGEST, 0])
    tiny = single([0, 0, 0], [4 * TINIEST, 0, 0], [0, 4 * TINIEST, 0])

    np.testing.assert_allclose(huge.surface_centroid, [0, -LARGEST / 3, 0], atol=1e294)
    assert tiny.surface_centroid.tolist() == [TINIEST, TINIEST, 0]
