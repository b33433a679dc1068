"""Where and how shapes first meet: the point is in both, the axis and the normals mean something."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles_exact import Box
from primitive_shapes import as_shape, distance, size_of
from strategies import examples
from strategies_boxes import rotations
from strategies_moving import (
    Moving,
    moving_box_pairs,
    moving_triangle_boxes,
    moving_triangle_pairs,
)

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
