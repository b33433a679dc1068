"""The mesh, distance and rigid-motion oracles hold to closed forms and to all cases with truth."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
from oracles import distance as oracles_distance
from oracles import mesh as oracles_mesh
from oracles import moving as oracles_moving
from oracles import rigid as oracles_rigid
from oracles import still as oracles
from oracles.exact import Box
from scenes import cases

UNIT_BOX = Box((0.0, 0.0, 0.0), np.eye(3), (1.0, 1.0, 1.0))
CORNER = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))


def _case(record: dict[str, Any], key: str) -> Any:
    return pytest.param(record, id=record[key])


def _body(record: dict[str, Any]) -> tuple[Any, Any, tuple[Any, Any, Any]]:
    """Return posed vertices, faces and the motion (V, W, K) of either file's kind of body."""
    if "mesh" in record:
        mesh = cases.rigid_meshes()[record["mesh"]]
        scaled = np.array(mesh["vertices"]) * record["scale"]
        vertices = oracles_mesh.posed(scaled, record["R"], record["t"])
        return vertices, mesh["faces"], (record["V"], record["W"], record["K"])
    vertices = oracles_mesh.posed(record["vertices"], record["rotation0"], record["translation0"])
    names = ("linear_velocity", "angular_velocity", "rotation_centre_world")
    return vertices, record["faces"], tuple(record[name] for name in names)


def _meshes_at(a: Any, b: Any, t: Any) -> tuple[Any, Any, Any, Any]:
    (vertices_a, faces_a, motion_a), (vertices_b, faces_b, motion_b) = a, b
    moved_a = oracles_rigid.rigid_points(vertices_a, *motion_a, t)
    moved_b = oracles_rigid.rigid_points(vertices_b, *motion_b, t)
    return moved_a, faces_a, moved_b, faces_b


def _first_if_translating(a: Any, b: Any, duration: float) -> Fraction | None:
    found = oracles_mesh.mesh_first_contact(a[:2], b[:2], a[2][0], b[2][0], duration)
    return None if found is None else found[0]


@pytest.mark.parametrize("record", [_case(x, "name") for x in cases.rigid_ccd()])
def test_rigid_motion_meets_the_bracket_of_cases(record: dict[str, Any]) -> None:
    a, b, duration, truth = _body(record["A"]), _body(record["B"]), record["T"], record["truth"]
    # The file's poses are not rounded, and its bracket is rounded: 1e-14 s covers both.
    end = duration if truth["status"] == "none" else truth["t"] - 1e-14 * duration
    before = [Fraction(end) * k / 8 for k in range(9)] if truth["status"] != "initial" else []

    assert not any(oracles_mesh.mesh_pairs(*_meshes_at(a, b, t)) for t in before)
    if truth.get("t_hi") is not None:
        assert oracles_mesh.mesh_pairs(*_meshes_at(a, b, truth["t_hi"]))
    if not any(a[2][1]) and not any(b[2][1]):
        first = _first_if_translating(a, b, duration)
        assert (first is None) == (truth["status"] == "none")
        assert first is None or abs(first - Fraction(truth["t"])) <= Fraction(1e-14) * Fraction(
            duration
        )


@pytest.mark.parametrize("record", [_case(x, "id") for x in cases.third_party_ccd()])
def test_rigid_motion_meets_third_party_times(record: dict[str, Any]) -> None:
    a, b, expected = _body(record["body_a"]), _body(record["body_b"]), record["expected_toi"]
    end = record["t_max"] if expected is None else expected - record["abs_tol"]

    # What meets at the start has no time before.
    assert end < 0 or not any(
        oracles_mesh.mesh_pairs(*_meshes_at(a, b, Fraction(end) * k / 8)) for k in range(9)
    )
    if expected is not None:
        meshes = _meshes_at(a, b, expected)
        span = max(np.ptp(a[0]), np.ptp(b[0]), 1.0)
        speed = np.linalg.norm(a[2][0]) + np.linalg.norm(b[2][0]) + span
        distance = oracles.root(oracles_mesh.mesh_distance_squared(*meshes)[0])
        assert distance <= record["abs_tol"] * speed
    if not any(a[2][1]) and not any(b[2][1]):
        first = _first_if_translating(a, b, record["t_max"])
        assert (first is not None) == record["expected_hit"]
        assert first is None or float(first) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("record", [_case(x, "id") for x in cases.third_party_static()])
def test_mesh_pairs_are_those_of_third_party_cases(record: dict[str, Any]) -> None:
    a, b = record["a"], record["b"]

    pairs = oracles_mesh.mesh_pairs(a["vertices"], a["faces"], b["vertices"], b["faces"])

    assert [list(pair) for pair in pairs] == record["exact_contact_pairs"]


def test_benchmark_queries_have_their_exact_times() -> None:
    for record in cases.rigid_translation_subset():
        v = record["vertices_t0"]
        a, b = ([v[0]] * 3, v[1:]) if record["kind"] == "vf" else ([*v[:2], v[1]], [*v[2:], v[3]])
        velocity_a, velocity_b = (
            [Fraction(n) for n in record.get(f"{name}_rational", record[name])]
            for name in ("displacement_a", "displacement_b")
        )
        first = oracles_moving.first_contact_triangles(a, b, velocity_a, velocity_b, 1)

        assert (first is not None) == record["upstream_collides"], record
        assert first == (record["toi_rational"] and Fraction(record["toi_rational"])), record


def test_triangle_distances_are_those_of_cases() -> None:
    for record in cases.tri_tri_static():
        square = oracles_distance.triangle_distance_squared(record["A"], record["B"])

        assert (square == 0) == record["intersect"], record["name"]
        if square:
            distance = float(oracles.root(square))
            assert distance == pytest.approx(record["distance"], rel=1e-14, abs=0.0), record["name"]


def test_boxes_are_at_least_as_far_apart_as_along_any_axis() -> None:
    for record in cases.obb_pairs()[::5]:
        a, b = cases.box(record["A"]), cases.box(record["B"])
        square = oracles_distance.box_distance_squared(a, b)

        assert (square == 0) == record["intersect"], record["name"]
        if square:
            separation = oracles.boxes_separation(a, b)
            assert oracles.root(square) * (1 + Fraction(1, 10**20)) >= separation, record["name"]


@pytest.mark.parametrize(
    ("point", "square"),
    [
        ((0.25, 0.25, 0.0), 0),
        ((1.0, 0.0, 0.0), 0),
        ((0.5, 0.5, 0.0), 0),
        ((0.25, 0.25, -3.0), 9),
        ((-1.0, -2.0, 0.0), 5),
        ((2.0, 0.0, 2.0), 5),
        ((0.5, -2.0, 1.0), 5),
        ((1.0, 1.0, 0.0), Fraction(1, 2)),
    ],
)
def test_point_triangle_distance_squared_is_exact(point: Any, square: Fraction) -> None:
    assert oracles_distance.point_triangle_distance_squared(point, CORNER) == square
    assert oracles_distance.point_in_triangle(point, CORNER) == (square == 0)


@pytest.mark.parametrize("half_extents", [(1.0, 2.0, 0.5), (1.0, 2.0, 0.0), (0.0, 0.0, 0.0)])
def test_point_box_distance_squared_is_the_clamped_offset(half_extents: Any) -> None:
    numbers = np.random.default_rng(3)
    box = Box((0.5, 0.0, -1.0), -np.eye(3)[[1, 2, 0]], half_extents)
    size = np.array([half_extents[i] for i in (2, 0, 1)])
    for point in np.round(numbers.uniform(-4, 4, (100, 3)) * 4) / 4:
        offset = np.maximum(np.abs(point - box.center) - size, 0.0)

        square = oracles_distance.point_box_distance_squared(point, box)

        assert square == Fraction(float(offset @ offset))
        assert oracles_distance.point_in_box(point, box) == (square == 0)


def test_a_flat_box_is_as_far_away_as_its_two_triangles() -> None:
    numbers = np.random.default_rng(5)
    for _ in range(30):
        center, u, v = numbers.integers(-3, 4, (3, 3)).astype(float)
        box = Box(center, [u, v, (1.0, 1.0, 1.0)], (1.0, 1.0, 0.0))
        halves = [
            (center + s * u + s * v, center - s * u + s * v, center + s * u - s * v)
            for s in (1, -1)
        ]
        triangle = numbers.integers(-6, 7, (3, 3)).astype(float)
        expected = min(oracles_distance.triangle_distance_squared(triangle, h) for h in halves)

        assert oracles_distance.triangle_box_distance_squared(triangle, box) == expected
        assert oracles.triangle_box_intersect(triangle, box) == (expected == 0)


def test_separations_of_axis_aligned_shapes_are_the_gaps() -> None:
    beside = Box((4.0, 0.0, 0.0), np.eye(3), (1.0, 1.0, 1.0))

    assert oracles.boxes_separation(UNIT_BOX, beside) == 2.0
    assert oracles.boxes_separation(UNIT_BOX, UNIT_BOX) == -2.0
    assert oracles.triangle_box_separation(np.add(CORNER, (0.0, 0.0, 1.5)), UNIT_BOX) == 0.5
    assert oracles.triangles_separation(CORNER, np.add(CORNER, (0.0, 0.0, -0.25))) == 0.25


def test_posed_rounds_each_product_and_sum_in_the_contracts_order() -> None:
    numbers = np.random.default_rng(7)
    vertices, rotation = numbers.normal(size=(50, 3)), numbers.normal(size=(3, 3))
    translation = numbers.normal(size=3) * 1e3

    def exactly(p: Any, row: Any, s: float) -> float:
        products = [float(Fraction(q) * Fraction(x)) for q, x in zip(row, p, strict=True)]
        total = float(Fraction(products[0]) + Fraction(products[1]))
        total = float(Fraction(total) + Fraction(products[2]))
        return float(Fraction(total) + Fraction(s))

    expected = [
        [exactly(p, row, s) for row, s in zip(rotation.tolist(), translation.tolist(), strict=True)]
        for p in vertices.tolist()
    ]
    assert oracles_mesh.posed(vertices, rotation, translation).tolist() == expected
    assert np.array_equal(oracles_mesh.posed(vertices, np.eye(3), np.zeros(3)), vertices)


def test_mesh_distance_names_every_nearest_pair() -> None:
    vertices = [*CORNER, (1.0, 1.0, 0.0)]
    faces = [(0, 1, 2), (3, 2, 1), (0, 0, 0)]

    square, pairs = oracles_mesh.mesh_distance_squared(
        vertices, faces, np.add(CORNER, (0.0, 0.0, 2.0)), [(0, 1, 2)]
    )

    assert square == 4
    assert pairs == [(0, 0), (1, 0), (2, 0)]


def test_rotation_matrix_is_a_right_handed_turn_to_50_digits() -> None:
    with mpmath.workdps(60):
        w = (0.5, -2.0, 1.25)
        quarter = oracles_rigid.rotation_matrix((0.0, 0.0, 1.0), mpmath.pi / 2)
        matrix = mpmath.matrix(oracles_rigid.rotation_matrix(w, 1e6))
        axis = mpmath.matrix(w)
        halves = mpmath.matrix(oracles_rigid.rotation_matrix(w, 5e5)) ** 2

        assert (
            mpmath.mnorm(mpmath.matrix(quarter) - mpmath.matrix([[0, -1, 0], [1, 0, 0], [0, 0, 1]]))
            < 1e-50
        )
        assert mpmath.mnorm(matrix * matrix.T - mpmath.eye(3)) < 1e-50
        assert mpmath.mnorm(matrix * axis - axis) < 1e-50
        assert mpmath.mnorm(halves - matrix) < 1e-50
        assert mpmath.det(matrix) > 0
        assert oracles_rigid.rotation_matrix((0.0, 0.0, 0.0), 7.0) == mpmath.eye(3).tolist()


def test_rigid_point_solves_the_equation_of_motion_with_a_travelling_pivot() -> None:
    x0, v, w, k, t = (1.0, 2.0, 3.0), (1.0, 0.5, -2.0), (0.3, 1.0, -0.7), (0.25, 0.0, 4.0), 1.5

    with mpmath.workdps(60):
        place = oracles_rigid.rigid_point(x0, v, w, k, t)
        step = mpmath.mpf(10) ** -20
        ahead = oracles_rigid.rigid_point(x0, v, w, k, t + step)
        behind = oracles_rigid.rigid_point(x0, v, w, k, t - step)
        arm = [x - c - t * s for x, c, s in zip(place, k, v, strict=True)]
        turning = (
            w[1] * arm[2] - w[2] * arm[1],
            w[2] * arm[0] - w[0] * arm[2],
            w[0] * arm[1] - w[1] * arm[0],
        )
        for i in range(3):
            slope = (ahead[i] - behind[i]) / (2 * step)
            assert abs(slope - v[i] - turning[i]) < 1e-30
    assert oracles_rigid.rigid_points([x0], v, w, k, 0) == [tuple(Fraction(n) for n in x0)]
