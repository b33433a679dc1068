"""Shapes under constant velocities: verdicts exact, times the nearest doubles to exact ones."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scenes import cases
from strategies.moving import (
    Moving,
    moving_box_pairs,
    moving_triangle_boxes,
    moving_triangle_pairs,
)
from strategies.primitive_shapes import as_array, as_shape, contact_interval
from strategies.still import examples

from obbcli.primitives import PrimitiveContacts, first_contact, intersects


def moving_pairs() -> st.SearchStrategy[Moving]:
    return st.one_of(moving_triangle_pairs(), moving_box_pairs(), moving_triangle_boxes())


def ask(moving: Moving) -> Any:
    """Return `first_contact`, having seen that `intersects` agrees."""
    arguments = (as_shape(moving.a), as_shape(moving.b), *moving[2:])
    contact = first_contact(*arguments)
    assert intersects(*arguments) == (contact is not None)
    return contact


def check_times(moving: Moving) -> None:
    """Assert that verdict and times are those of exact arithmetic."""
    truth = contact_interval(moving)
    contact = ask(moving)
    assert (contact is not None) == (truth is not None)
    if truth is None:
        return
    first, last = truth
    assert contact.time == min(float(first), moving.duration)
    assert (
        Fraction(contact.time_below)
        <= first
        < Fraction(math.nextafter(contact.time_below, math.inf))
    )
    assert contact.last_time == float(last)
    assert contact.ends == (last < moving.duration)


@examples(300)
@given(moving_triangle_pairs())
def test_times_of_triangles_are_nearest_doubles(moving: Moving) -> None:
    check_times(moving)


@examples(200)
@given(moving_box_pairs())
def test_times_of_boxes_are_nearest_doubles(moving: Moving) -> None:
    check_times(moving)


@examples(200)
@given(moving_triangle_boxes())
def test_times_of_triangle_and_box_are_nearest_doubles(moving: Moving) -> None:
    check_times(moving)


@examples(100)
@given(moving_triangle_boxes())
def test_box_and_triangle_are_triangle_and_box_swapped(moving: Moving) -> None:
    a, b, velocity_a, velocity_b, duration = moving

    contact = ask(moving)
    mirrored = ask(Moving(b, a, velocity_b, velocity_a, duration))

    assert (contact is None) == (mirrored is None)
    if contact is not None:
        assert contact.time == mirrored.time
        assert contact.last_time == mirrored.last_time
        assert np.array_equal(contact.point - mirrored.point, np.zeros(3)) or np.allclose(
            contact.point, mirrored.point, rtol=1e-12
        )
        assert (contact.normal is None) == (mirrored.normal is None)
        assert contact.normal is None or np.array_equal(contact.normal, -mirrored.normal)


@examples(100)
@given(moving_pairs(), st.sampled_from((0.0, 0.25, 1.0)))
def test_zero_duration_or_equal_velocities_ask_about_shapes_at_rest(
    moving: Moving, duration: float
) -> None:
    a, b = as_shape(moving.a), as_shape(moving.b)
    still = intersects(a, b)

    assert intersects(a, b, moving.velocity_a, moving.velocity_b, 0.0) == still
    assert intersects(a, b, moving.velocity_a, moving.velocity_a, duration) == still


@examples(100)
@given(moving_pairs())
def test_longer_duration_never_moves_the_first_contact(moving: Moving) -> None:
    contact = ask(moving)
    longer = ask(moving._replace(duration=2 * moving.duration))

    assert contact is None or longer.time == contact.time


@pytest.mark.parametrize(
    ("records", "keys"),
    [
        (cases.tri_tri_linear_ccd(), ("A", "B", "VA", "VB")),
        (cases.tri_obb(), ("tri", "box", "V_tri", None)),
        (cases.obb_linear_ccd(), ("A", "B", None, None)),
    ],
    ids=["triangles", "triangle and box", "boxes"],
)
def test_first_contact_agrees_with_cases(
    records: list[dict[str, Any]], keys: tuple[str | None, ...]
) -> None:
    a, b, rate_a, rate_b = keys
    shapes_a = [_shape(case[a]) for case in records]
    shapes_b = [_shape(case[b]) for case in records]
    velocities_a = [case[rate_a] if rate_a else case[a]["V"] for case in records]
    velocities_b = [case[rate_b] if rate_b else case[b]["V"] for case in records]
    durations = [case["T"] for case in records]

    contacts = first_contact(
        as_array(shapes_a), as_array(shapes_b), velocities_a, velocities_b, durations
    )

    assert isinstance(contacts, PrimitiveContacts)
    hits = [k for k, case in enumerate(records) if case["hit"]]
    assert contacts.rows.tolist() == hits
    assert contacts.time.tolist() == [records[k]["t"] for k in hits]


def _shape(record: Any) -> Any:
    return cases.box(record) if isinstance(record, dict) else record


def test_first_contact_agrees_with_public_benchmark_of_translations() -> None:
    records = cases.rigid_translation_subset()
    for case in records:
        check_benchmark_case(case)


def check_benchmark_case(case: dict[str, Any]) -> None:
    """Assert the exact time of a vertex and a face, or of two edges, as degenerate triangles."""
    p, q, r, s = case["vertices_t0"]
    a, b = ([p, p, p], [q, r, s]) if case["kind"] == "vf" else ([p, q, q], [r, s, s])
    truth = case["toi_rational"]

    contact = first_contact(
        as_shape(a), as_shape(b), case["displacement_a"], case["displacement_b"], 1.0
    )

    assert (contact is None) == (truth is None), case["source"]
    assert contact is None or contact.time == float(Fraction(truth))  # type: ignore[union-attr]


TRANSLATIONS = [
    case
    for case in cases.third_party_ccd()
    if not any(case["body_a"]["angular_velocity"] + case["body_b"]["angular_velocity"])
]


@pytest.mark.parametrize("case", TRANSLATIONS, ids=[case["id"] for case in TRANSLATIONS])
def test_first_contact_agrees_with_reports_of_other_projects(case: dict[str, Any]) -> None:
    a, b = (_world_triangles(case[name]) for name in ("body_a", "body_b"))
    i, j = (grid.ravel() for grid in np.meshgrid(range(len(a)), range(len(b)), indexing="ij"))
    velocities = [case[name]["linear_velocity"] for name in ("body_a", "body_b")]

    contacts = first_contact(as_shape(a[i]), as_shape(b[j]), *velocities, case["t_max"])

    assert isinstance(contacts, PrimitiveContacts)
    assert (len(contacts) > 0) == case["expected_hit"]
    if case["expected_hit"]:
        assert contacts.time.min() == pytest.approx(case["expected_toi"], abs=case["abs_tol"])


def _world_triangles(body: dict[str, Any]) -> Any:
    turned = np.array(body["vertices"]) @ np.array(body["rotation0"]).T
    return (turned + body["translation0"])[np.array(body["faces"])]
