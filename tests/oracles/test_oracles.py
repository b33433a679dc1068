"""The oracles agree with each other and with every case of known truth: what tests the tests."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest
from oracles import lp as oracles_lp
from oracles import moving as oracles_moving
from oracles import still as oracles
from oracles.exact import box_hull, triangle_hull
from scenes import cases


def _named(records: list[dict[str, Any]]) -> list[Any]:
    by_category: dict[str, list[dict[str, Any]]] = {}
    for record in records:
        by_category.setdefault(record["category"], []).append(record)
    return [pytest.param(group, id=name) for name, group in by_category.items()]


@pytest.mark.parametrize("records", _named(cases.tri_tri_static()))
def test_triangle_oracles_agree_with_cases(records: list[dict[str, Any]]) -> None:
    for case in records:
        a, b = case["A"], case["B"]
        verdicts = (
            oracles.triangles_intersect(a, b),
            oracles.triangles_intersect_by_features(a, b),
            oracles_lp.hulls_intersect_lp(triangle_hull(a), triangle_hull(b)),
        )

        assert verdicts == (case["intersect"],) * 3, case["name"]


@pytest.mark.parametrize("records", _named(cases.obb_pairs()))
def test_box_oracles_agree_with_cases(records: list[dict[str, Any]]) -> None:
    for case in records:
        a, b = cases.box(case["A"]), cases.box(case["B"])
        verdicts = (
            oracles.boxes_intersect(a, b),
            oracles_lp.hulls_intersect_lp(box_hull(a), box_hull(b)),
        )

        assert verdicts == (case["intersect"],) * 2, case["name"]


@pytest.mark.parametrize("records", _named(cases.obb_pairs()))
def test_boxes_separation_has_the_sign_and_size_of_cases(records: list[dict[str, Any]]) -> None:
    for case in records:
        a, b = cases.box(case["A"]), cases.box(case["B"])

        separation = oracles.boxes_separation(a, b)

        assert (separation <= 0) == case["intersect"], case["name"]
        assert (separation == 0) == case["touch"], case["name"]
        # Parallel rods and points: the file measures along their offset, the oracle does not.
        if sum(n > 0 for n in (*a.half_extents, *b.half_extents)) > 2:
            scale = case["scale"]
            expected = pytest.approx(case["separation"], rel=1e-9, abs=1e-14 * scale)
            assert float(separation) == expected, case["name"]


@pytest.mark.parametrize("records", _named(cases.tri_tri_linear_ccd()))
def test_moving_triangle_oracles_agree_with_cases(records: list[dict[str, Any]]) -> None:
    for case in records:
        a, b = case["A"], case["B"]
        motion = case["VA"], case["VB"], case["T"]
        interval = oracles_moving.contact_interval_triangles(a, b, *motion)
        second = oracles_lp.contact_interval_lp(triangle_hull(a), triangle_hull(b), *motion)

        assert interval == second, case["name"]
        assert (interval is not None) == case["hit"], case["name"]
        if interval is not None:
            assert interval[0] == Fraction(case["t_exact"]), case["name"]
            assert float(interval[1]) == case["t_last"], case["name"]


@pytest.mark.parametrize("records", _named(cases.obb_linear_ccd()))
def test_moving_box_oracles_agree_with_cases(records: list[dict[str, Any]]) -> None:
    for case in records:
        a, b = cases.box(case["A"]), cases.box(case["B"])
        motion = case["A"]["V"], case["B"]["V"], case["T"]
        interval = oracles_moving.contact_interval_boxes(a, b, *motion)
        second = oracles_lp.contact_interval_lp(box_hull(a), box_hull(b), *motion)

        assert interval == second, case["name"]
        assert (interval and float(interval[0])) == case["t"], case["name"]


@pytest.mark.parametrize("records", _named(cases.tri_obb()))
def test_triangle_box_oracles_agree_with_cases(records: list[dict[str, Any]]) -> None:
    for case in records:
        triangle, box = case["tri"], cases.box(case["box"])
        motion = case["V_tri"], case["box"]["V"], case["T"]
        interval = oracles_moving.contact_interval_triangle_box(triangle, box, *motion)
        second = oracles_lp.contact_interval_lp(triangle_hull(triangle), box_hull(box), *motion)

        assert interval == second, case["name"]
        assert (interval and float(interval[0])) == case["t"], case["name"]
        assert oracles.triangle_box_intersect(triangle, box) == case["intersect_t0"], case["name"]


@pytest.mark.parametrize("size", [1, 2, 3, 6])
def test_three_triangle_oracles_agree_on_small_integers(size: int) -> None:
    numbers = random.Random(size)
    verdicts = set()
    for _ in range(2000):
        a, b = ([[numbers.randint(-size, size) for _ in range(3)] for _ in range(3)] for _ in "ab")
        verdict = oracles.triangles_intersect(a, b)
        verdicts.add(verdict)

        assert oracles.triangles_intersect_by_features(a, b) == verdict, (a, b)
        assert oracles_lp.hulls_intersect_lp(triangle_hull(a), triangle_hull(b)) == verdict, (a, b)
    assert verdicts == {True, False}


@pytest.mark.parametrize("size", [1, 2, 4])
def test_moving_triangle_oracles_agree_on_small_integers(size: int) -> None:
    numbers = random.Random(size)
    for _ in range(700):
        shape = [[numbers.randint(-size, size) for _ in range(3)] for _ in range(8)]
        a, b = triangle_hull(shape[:3]), triangle_hull(shape[3:6])
        motion = shape[6], shape[7], numbers.randint(0, 3)

        assert oracles_moving.contact_interval(a, b, *motion) == oracles_lp.contact_interval_lp(
            a, b, *motion
        ), (shape, motion)


@pytest.mark.parametrize("size", [1, 2, 4])
def test_moving_box_oracles_agree_on_small_integers(size: int) -> None:
    """Literal axes need not be orthonormal, nor independent: skewed and flat boxes count."""
    numbers = random.Random(size)
    for _ in range(200):
        rows = [[numbers.randint(-size, size) for _ in range(3)] for _ in range(15)]
        a = box_hull((rows[0], rows[1:4], [abs(n) for n in rows[4]]))
        b = box_hull((rows[5], rows[6:9], [abs(n) for n in rows[9]]))
        triangle = triangle_hull(rows[10:13])
        motion = rows[13], rows[14], numbers.randint(0, 3)

        for p, q in ((a, b), (triangle, b)):
            expected = oracles_lp.contact_interval_lp(p, q, *motion)
            assert oracles_moving.contact_interval(p, q, *motion) == expected, (rows, motion)
            assert oracles.hulls_intersect(p, q) == oracles_lp.hulls_intersect_lp(p, q), rows
