"""Where and how shapes first meet: the point is in both, axis and normals mean something."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.exact import Box
from strategies.boxes import rotations
from strategies.moving import (
    Moving,
    moving_box_pairs,
    moving_triangle_boxes,
    moving_triangle_pairs,
)
from strategies.primitive_shapes import as_shape, distance, size_of
from strategies.still import examples

from obbcli.primitives import Obb, SeparatingAxis, Triangle, first_contact

# The point is rounded, and so is the time by which the shapes have moved.
ROUNDING = 2.0**-46

CUBE = Obb([0, 0, 0], np.eye(3), [1, 1, 1])
# Corner up, edge up: unit cubes turned about x and y.
ON_EDGE = np.array([[1, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]])


def moving_pairs() -> st.SearchStrategy[Moving]:
    return st.one_of(moving_triangle_pairs(), moving_box_pairs(), moving_triangle_boxes())


def ask(moving: Moving) -> Any:
    return first_contact(as_shape(moving.a), as_shape(moving.b), *moving[2:])


def reach(moving: Moving) -> float:
    """Return the largest coordinate that either shape can have until the end."""
    speeds = (np.abs(moving.velocity_a).max(), np.abs(moving.velocity_b).max())
    return max(size_of(moving.a), size_of(moving.b)) + moving.duration * float(max(speeds))


@examples(400)
@given(moving_pairs())
def test_point_is_in_both_shapes_to_rounding(moving: Moving) -> None:
    contact = ask(moving)
    if contact is None:
        return

    time = Fraction(contact.time)
    limit = ROUNDING * reach(moving) + 1e-320

    for shape, velocity in ((moving.a, moving.velocity_a), (moving.b, moving.velocity_b)):
        assert distance(contact.point, shape, velocity.tolist(), time) <= limit


@examples(200)
@given(moving_pairs())
def test_normal_supports_both_shapes_at_the_first_time(moving: Moving) -> None:
    """At the first time A lies behind the point along the normal, and B in front of it."""
    contact = ask(moving)
    if contact is None or contact.normal is None:
        return

    normal, limit = contact.normal, ROUNDING * reach(moving) + 1e-320
    assert np.linalg.norm(normal) == pytest.approx(1.0)
    ahead = _places(moving.a, moving.velocity_a, contact) @ normal
    behind = _places(moving.b, moving.velocity_b, contact) @ normal
    assert ahead.max() <= limit
    assert behind.min() >= -limit
    assert np.abs((ahead.max(), behind.min())).max() <= limit


def _places(shape: Any, velocity: Any, contact: Any) -> Any:
    """Return the corners at the time of contact, relative to the point."""
    if isinstance(shape, Box):
        signs = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, 8).T
        shape = shape.center + (signs * shape.half_extents) @ shape.axes
    return (shape - contact.point) + contact.time * np.asarray(velocity)


@examples(150)
@given(moving_pairs())
def test_feature_is_said_exactly_where_an_axis_is(moving: Moving) -> None:
    contact = ask(moving)
    if contact is None:
        return

    known = {f"{a}-{b}" for a in ("vertex", "edge", "face") for b in ("vertex", "edge", "face")}
    assert (contact.feature is None) == (contact.separating_axis is None)
    assert (contact.feature is None) == (contact.normal is None)
    assert contact.feature is None or contact.feature in known
    for normal in (contact.normal_a, contact.normal_b):
        assert normal is None or np.linalg.norm(normal) == pytest.approx(1.0)


CORNER_DOWN = Triangle([[0, 0, 3], [1, 0, 4], [0, 1, 4]])
FLAT = Triangle([[0, 0, 3], [1, 0, 3], [0, 1, 3]])
EDGE_DOWN = Triangle([[-1, 0.25, 3], [1, 0.25, 3], [0, 0.25, 4]])
ACROSS = Triangle([[3, 0, -2], [3, 0, 2], [4, 0, 0]])
CUBE_ON_EDGE = Obb([0, 0, 4.4], ON_EDGE, [1, 1, 1])


@pytest.mark.parametrize(
    ("shape_b", "velocity", "time", "feature", "axis", "point"),
    [
        (CORNER_DOWN, (0, 0, -1), 2.0, "face-vertex", ("face_a", (2,), 1), (0, 0, 1)),
        (FLAT, (0, 0, -1), 2.0, "face-face", ("face_a", (2,), 1), None),
        (EDGE_DOWN, (0, 0, -1), 2.0, "face-edge", ("face_a", (2,), 1), (0, 0.25, 1)),
        (ACROSS, (-1, 0, 0), 2.0, "face-edge", ("face_a", (0,), 1), (1, 0, 0)),
        (CUBE_ON_EDGE, (0, 0, -1), 2.0, "face-edge", ("face_a", (2,), 1), (0, None, 1)),
        (
            Obb([3, 0, 0], np.eye(3), [1, 1, 1]),
            (-1, 0, 0),
            1.0,
            "face-face",
            ("face_a", (0,), 1),
            (1, 0, 0),
        ),
        (
            Obb([3, 2, 0], np.eye(3), [1, 1, 1]),
            (-1, 0, 0),
            1.0,
            "edge-edge",
            ("face_a", (0,), 1),
            (1, 1, 0),
        ),
        (
            Obb([3, 2, 2], np.eye(3), [1, 1, 1]),
            (-1, 0, 0),
            1.0,
            "vertex-vertex",
            ("face_a", (0,), 1),
            (1, 1, 1),
        ),
        (
            Obb([-3, 0, 0], np.eye(3), [1, 1, 1]),
            (1, 0, 0),
            1.0,
            "face-face",
            ("face_a", (0,), -1),
            (-1, 0, 0),
        ),
        (
            Obb([3, 0, 0], -np.eye(3), [1, 0, 1]),
            (-1, 0, 0),
            1.0,
            "face-edge",
            ("face_a", (0,), 1),
            (1, 0, 0),
        ),
    ],
)
def test_first_contact_with_a_cube_is_what_a_drawing_says(
    shape_b: Any, velocity: Any, time: float, feature: str, axis: Any, point: Any
) -> None:
    contact: Any = first_contact(CUBE, shape_b, 0, velocity, 10.0)

    assert contact.time == pytest.approx(time, abs=1e-12)
    assert contact.feature == feature
    assert contact.separating_axis == SeparatingAxis(*axis)
    for found, wanted in zip(contact.point, point or (None,) * 3, strict=True):
        assert wanted is None or found == pytest.approx(wanted, abs=1e-12)


def test_crossed_edges_meet_where_they_cross() -> None:
    bar = Triangle([[0.25, -1, 2], [0.25, 1, 2], [0.25, 0, 3]])
    ridge = Triangle([[-1, 0.125, 1], [1, 0.125, 1], [0, 0.125, 0]])

    contact: Any = first_contact(ridge, bar, 0, [0, 0, -0.5], 3.0)

    assert contact.time == 2.0
    assert contact.feature == "edge-edge"
    assert contact.separating_axis.kind == "edge_edge"
    assert contact.separating_axis.indices == (0, 0)
    assert contact.point == pytest.approx([0.25, 0.125, 1.0], abs=1e-15)
    assert contact.normal.tolist() == [0.0, 0.0, 1.0]


def test_coplanar_triangles_that_slide_together_name_an_edge_of_the_plane() -> None:
    a = Triangle([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    b = Triangle([[3, 0, 0], [4, 0, 0], [3, 1, 0]])

    contact: Any = first_contact(a, b, 0, [-1, 0, 0], 10.0)

    assert contact.time == 2.0
    assert contact.last_time == 4.0
    assert contact.ends
    assert contact.feature == "vertex-vertex"
    assert contact.point.tolist() == [1.0, 0.0, 0.0]
    # Two axes end together; the first is the plane's normal x the slanted edge, inwards.
    assert contact.separating_axis == SeparatingAxis("edge_a", (1,), -1)
    assert contact.normal == pytest.approx([0.5**0.5, 0.5**0.5, 0.0])


def test_overlap_at_the_start_has_a_point_but_no_axis() -> None:
    inside = Triangle([[-0.5, 0, 0], [0.5, 0, 0], [0, 0.5, 0.25]])

    contact: Any = first_contact(CUBE, inside)

    assert contact.time == 0.0
    assert contact.separating_axis is None
    assert contact.normal is None
    assert contact.feature is None
    assert contact.normal_a is None
    assert contact.normal_b is not None


@examples(60)
@given(rotations(), st.tuples(*[st.floats(-0.9, 0.9)] * 2))
def test_smooth_normal_is_that_of_the_ellipsoid_and_face_normal_that_of_the_face(
    frame: Any, place: tuple[float, float]
) -> None:
    half = np.array([3.0, 2.0, 1.0])
    box = Obb([1, 2, 3], frame, half)
    y = np.array([*place * half[:2], half[2]])
    tip = box.center + y @ frame
    dart = Triangle([tip + frame[2], tip + 2 * frame[2] + frame[0], tip + 2 * frame[2] + frame[1]])

    contact: Any = first_contact(box, dart, 0, -frame[2], 2.0)

    gradient = (y / half**2) @ frame
    assert contact.time == pytest.approx(1.0)
    assert contact.normal_a == pytest.approx(frame[2], abs=1e-12)
    assert contact.smooth_normal_a == pytest.approx(gradient / np.linalg.norm(gradient), abs=1e-9)
    assert contact.smooth_normal_b == pytest.approx(contact.normal_b)


def test_contacts_of_arrays_are_those_of_their_rows() -> None:
    rng = np.random.default_rng(7)
    triangles = rng.normal(size=(3000, 3, 3))
    velocities = rng.normal(size=(3000, 3))

    many: Any = first_contact(CUBE, Triangle(triangles + 1.5), 0, velocities, 2.0, threads=3)

    assert 100 < len(many) < 2900
    assert not many.point.flags.writeable
    rows = set(many.rows.tolist())
    for k, row in enumerate(many.rows[:50]):
        one: Any = first_contact(CUBE, Triangle(triangles[row] + 1.5), 0, velocities[row], 2.0)
        assert one.time == many[k].time == many.time[k]
        assert one.separating_axis == many[k].separating_axis
        assert np.array_equal(one.point, many.point[k])
        assert one.feature == (many.feature[k] or None)
    for row in range(50):
        one = first_contact(CUBE, Triangle(triangles[row] + 1.5), 0, velocities[row], 2.0)
        assert (one is not None) == (row in rows)
