"""Hypothesis strategies for boxes at rest, alone, in pairs and beside triangles.

Axes are orthonormal to rounding; left-handed and permuted ones are boxes like any other. Flat boxes
are common, and so are boxes that touch exactly or miss by 1e-4 to 1e-16.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from hypothesis import strategies as st
from oracles.exact import Box
from strategies.still import (
    ORDERS,
    SCALES,
    TINY_EXPONENTS,
    nudged,
    place_in,
    points,
    triangles,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Draw = Callable[..., Any]

UNIT = st.sampled_from((-1.0, 1.0))
UNITS = st.tuples(UNIT, UNIT, UNIT)
FRACTIONS = st.tuples(*[st.sampled_from((-1.0, -0.5, 0.0, 0.5, 1.0))] * 3)
INTEGER_LENGTHS = st.tuples(*[st.integers(1, 4)] * 3)
ANY_LENGTHS = st.tuples(*[st.floats(0, 4)] * 3)
EXPONENTS = st.tuples(*[st.integers(-12, 6)] * 3)
EIGHTHS = st.tuples(*[st.integers(1, 32)] * 3)
FLAT_AXES = st.sets(st.integers(0, 2), min_size=1)
QUATERNIONS = st.tuples(*[st.floats(-1, 1)] * 4)
SMALL_AXES = st.tuples(*[st.integers(-3, 3)] * 3)
PLANE_STEPS = st.tuples(*[st.integers(-8, 8)] * 6)


class BoxPair(NamedTuple):
    """Two boxes."""

    a: Box
    b: Box


class TriangleBox(NamedTuple):
    """A triangle (3, 3) and a box."""

    triangle: Any
    box: Box


@st.composite
def boxes(draw: Draw) -> Box:
    """Return a box with arrays for center (3,), axes (3, 3) in rows and half extents (3,)."""
    return Box(draw(points()), draw(rotations()), draw(half_extents()))


@st.composite
def half_extents(draw: Draw) -> Floats:
    """Return three half extents: integers, dyadic, flat, rods and plates, any doubles."""
    kind = draw(st.sampled_from(("integer", "dyadic", "flat", "extreme", "any")))
    if kind == "integer":
        return np.array(draw(INTEGER_LENGTHS), dtype=np.float64)
    if kind == "any":
        return np.array(draw(ANY_LENGTHS))
    if kind == "extreme":
        return np.ldexp(1.0, np.array(draw(EXPONENTS)))
    numbers = np.array(draw(EIGHTHS)) / 8
    if kind == "flat":
        numbers[list(draw(FLAT_AXES))] = 0.0
    return numbers


@st.composite
def box_pairs(draw: Draw) -> BoxPair:
    """Return two boxes: unrelated, touching, inside, parallel or nearly, nudged, scaled."""
    a = draw(boxes())
    b = Box(draw(points()), draw(_related_axes(a.axes)), draw(half_extents()))
    kind = draw(
        st.sampled_from(("unrelated", "beside", "beside", "gap", "meeting", "inside", "same"))
    )
    if kind == "same":
        b = Box(a.center, a.axes[draw(ORDERS)], a.half_extents)
    elif kind == "inside":
        b = Box(a.center, b.axes, b.half_extents * 2.0**-5)
    elif kind == "meeting":
        b = Box(a.center + draw(_surface_offset(a)) - draw(_surface_offset(b)), *b[1:])
    elif kind != "unrelated":
        gap = draw(UNIT) * 10.0 ** -draw(TINY_EXPONENTS) if kind == "gap" else 0.0
        b = draw(_beside(a, b, gap))
    a, b = draw(_rescaled_boxes((a, b)))
    if draw(st.integers(0, 3)) == 0:
        b = draw(_nudged_box(b))
    return BoxPair(*((b, a) if draw(st.booleans()) else (a, b)))


@st.composite
def triangle_boxes(draw: Draw) -> TriangleBox:
    """Return a triangle and a box: unrelated, or with a vertex, edge or face on its surface."""
    box = draw(boxes())
    triangle = draw(triangles())
    place = box.center + draw(_surface_offset(box))
    kind = draw(st.sampled_from(("unrelated", "vertex", "edge", "face", "in face plane", "gap")))
    if kind == "in face plane":
        i, j, _ = draw(ORDERS)
        steps = draw(PLANE_STEPS)
        arms = np.array(steps).reshape(3, 2) @ box.axes[[i, j]] / 2
        triangle = place + arms
    elif kind == "edge":
        triangle = triangle + (place - (triangle[0] + triangle[1]) / 2)
    elif kind != "unrelated":
        held = triangle[0] if kind == "vertex" else place_in(draw, triangle)
        triangle = triangle + (place - held)
    if kind == "gap":
        step = draw(UNIT) * 10.0 ** -draw(TINY_EXPONENTS) * draw(st.sampled_from(list(box.axes)))
        triangle = triangle + step
    triangle, box = draw(_rescaled_with_box(triangle, box))
    if draw(st.integers(0, 3)) == 0:
        triangle = draw(nudged(triangle))
    return TriangleBox(triangle, box)


@st.composite
def _related_axes(draw: Draw, axes: Floats) -> Floats:
    kind = draw(st.sampled_from(("unrelated", "same", "permuted", "nearly")))
    if kind == "unrelated":
        return draw(rotations())
    if kind == "nearly":
        return axes @ draw(small_rotations())
    if kind == "permuted":
        return axes[draw(ORDERS)] * draw(UNIT)
    return axes


@st.composite
def _surface_offset(draw: Draw, box: Box) -> Floats:
    """Return a step from the center to a corner or to a dyadic place of an edge or a face."""
    weights = np.array(draw(FRACTIONS))
    weights[draw(st.integers(0, 2))] = draw(UNIT)
    return (weights * box.half_extents) @ box.axes


@st.composite
def _beside(draw: Draw, a: Box, b: Box, gap: float) -> Box:
    """Return b moved outside a face of a: touching it, or at a small gap, with its nearest corner.

    Where an axis of b is parallel to the face, any place along it will do: edge and face contacts.
    """
    i, side = draw(st.integers(0, 2)), draw(UNIT)
    normal = side * a.axes[i]
    place, corner = np.array(draw(FRACTIONS) + draw(FRACTIONS)).reshape(2, 3)
    place[i] = side
    towards = b.axes @ normal
    corner = np.where(np.abs(towards) > 1e-12, -np.sign(towards), corner)
    face = a.center + (place * a.half_extents) @ a.axes + gap * normal
    return Box(face - (corner * b.half_extents) @ b.axes, b.axes, b.half_extents)


@st.composite
def _rescaled_boxes(draw: Draw, pair: tuple[Box, Box]) -> tuple[Box, ...]:
    """Return the boxes in another scale, or small and far from the origin."""
    exponent, offset = draw(_scale_and_offset())
    return tuple(
        Box(np.ldexp(box.center, exponent) + offset, box.axes, np.ldexp(box.half_extents, exponent))
        for box in pair
    )


@st.composite
def _rescaled_with_box(draw: Draw, triangle: Floats, box: Box) -> tuple[Floats, Box]:
    exponent, offset = draw(_scale_and_offset())
    half = np.ldexp(box.half_extents, exponent)
    moved = Box(np.ldexp(box.center, exponent) + offset, box.axes, half)
    return np.ldexp(triangle, exponent) + offset, moved


@st.composite
def _scale_and_offset(draw: Draw) -> tuple[int, Floats]:
    if draw(st.integers(0, 5)) == 0:
        offset = draw(st.sampled_from((1e8, -1e8, 2.0**27)))
        return -10, np.array([offset, 0.0, -offset])
    return draw(SCALES), np.zeros(3)


@st.composite
def _nudged_box(draw: Draw, box: Box) -> Box:
    if draw(st.booleans()):
        return Box(draw(nudged(box.center)), box.axes, box.half_extents)
    return Box(box.center, box.axes, np.abs(draw(nudged(box.half_extents))))


@st.composite
def rotations(draw: Draw) -> Floats:
    """Return a matrix (3, 3) with rows orthonormal to rounding, right- or left-handed."""
    kind = draw(st.sampled_from(("aligned", "aligned", "tiny", "any", "any")))
    signs = np.array(draw(UNITS))
    aligned = np.eye(3)[draw(ORDERS)] * signs
    if kind == "aligned":
        return aligned
    return aligned @ draw(small_rotations() if kind == "tiny" else proper_rotations())


@st.composite
def proper_rotations(draw: Draw) -> Floats:
    """Return a right-handed rotation by any angle, orthonormal to rounding."""
    quaternion = np.array(draw(QUATERNIONS))
    largest = np.abs(quaternion).max()
    # Divided first: the squares of subnormals are zero.
    return _rotation(quaternion / largest if largest > 1e-300 else np.array([1.0, 0.0, 0.0, 0.0]))


@st.composite
def small_rotations(draw: Draw) -> Floats:
    """Return a rotation by 1e-4 to 1e-16 about any axis."""
    angle = 10.0 ** -draw(TINY_EXPONENTS)
    axis = draw(SMALL_AXES)
    return _rotation(np.array([1.0, *(angle / 2 * n for n in axis)]))


def _rotation(quaternion: Floats) -> Floats:
    w, x, y, z = quaternion / np.sqrt(quaternion @ quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
