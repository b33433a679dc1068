"""Shapes at rest: `intersects` is exact for triangles and for boxes taken literally."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from oracles import still as oracles
from oracles.exact import Box
from scenes import cases
from strategies.boxes import BoxPair, TriangleBox, box_pairs, triangle_boxes
from strategies.primitive_shapes import as_array, as_shape, hull_of
from strategies.still import TrianglePair, examples, triangle_pairs

from obbcli.primitives import first_contact, intersects

Pair = TrianglePair | BoxPair | TriangleBox


def truth(pair: Any) -> bool:
    return oracles.hulls_intersect(hull_of(pair[0]), hull_of(pair[1]))


def pairs() -> st.SearchStrategy[Any]:
    return st.one_of(triangle_pairs(), box_pairs(), triangle_boxes())


def _scaled(shape: Any, exponent: int) -> Any:
    with np.errstate(over="ignore"):
        if isinstance(shape, Box):
            half = np.ldexp(shape.half_extents, exponent)
            return Box(np.ldexp(shape.center, exponent), shape.axes, half)
        return np.ldexp(shape, exponent)


def test_intersects_agrees_with_triangle_cases() -> None:
    records = cases.tri_tri_static()

    verdicts = intersects(
        as_array([case["A"] for case in records]), as_array([case["B"] for case in records])
    )

    wrong = [
        case["name"]
        for case, verdict in zip(records, verdicts, strict=True)  # type: ignore[arg-type]
        if verdict != case["intersect"]
    ]
    assert not wrong


def test_intersects_agrees_with_box_cases() -> None:
    records = cases.obb_pairs()

    verdicts = intersects(
        as_array([cases.box(case["A"]) for case in records]),
        as_array([cases.box(case["B"]) for case in records]),
    )

    wrong = [
        case["name"]
        for case, verdict in zip(records, verdicts, strict=True)  # type: ignore[arg-type]
        if verdict != case["intersect"]
    ]
    assert not wrong


@examples(400)
@given(triangle_pairs())
def test_triangles_meet_exactly_when_they_do(pair: TrianglePair) -> None:
    assert intersects(*map(as_shape, pair)) == truth(pair)


@examples(250)
@given(box_pairs())
def test_boxes_meet_exactly_when_they_do(pair: BoxPair) -> None:
    assert intersects(*map(as_shape, pair)) == truth(pair)


@examples(250)
@given(triangle_boxes())
def test_triangle_and_box_meet_exactly_when_they_do(pair: TriangleBox) -> None:
    assert intersects(*map(as_shape, pair)) == truth(pair)


@examples(150)
@given(pairs())
def test_order_of_shapes_changes_no_verdict(pair: Pair) -> None:
    a, b = map(as_shape, pair)

    assert intersects(a, b) == intersects(b, a)


@examples(150)
@given(pairs())
def test_first_contact_at_rest_agrees_with_intersects(pair: Pair) -> None:
    a, b = map(as_shape, pair)

    contact = first_contact(a, b)

    assert (contact is not None) == intersects(a, b)
    assert contact is None or (contact.time, contact.last_time) == (0.0, 0.0)  # type: ignore[union-attr]


@examples(150)
@given(pairs(), st.sampled_from((-900, -100, 100, 900)))
def test_powers_of_two_change_no_verdict(pair: Pair, exponent: int) -> None:
    scaled = [_scaled(shape, exponent) for shape in pair]

    for shape, back in zip(pair, [_scaled(shape, -exponent) for shape in scaled], strict=True):
        assume(all(np.array_equal(x, y) for x, y in zip(shape, back, strict=True)))
    assert intersects(*map(as_shape, scaled)) == intersects(*map(as_shape, pair))


@pytest.mark.parametrize("exponent", [-1074, -1070, -1000, 0, 900, 1020])
def test_coplanar_triangles_touching_at_a_corner_meet_in_every_scale(exponent: int) -> None:
    a = np.ldexp([[0.0, 0, 0], [2, 0, 0], [0, 2, 0]], exponent)
    b = np.ldexp([[2.0, 0, 0], [3, 0, 0], [3, 2, 0]], exponent)
    gap = np.array([[np.ldexp(2.0, exponent - 52) or 5e-324, 0, 0]])

    assert intersects(as_shape(a), as_shape(b))
    if exponent > -1000:
        assert not intersects(as_shape(a), as_shape(b + gap))
