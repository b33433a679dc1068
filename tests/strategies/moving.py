"""Hypothesis strategies for shapes under constant velocity, aimed at contact at an exact instant.

A pair in contact is taken back in time by a dyadic step; with small numbers it then lands exactly:
at t = 0, inside the interval, at its end, or grazing where the velocity lies in a face plane.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from hypothesis import strategies as st
from oracles.exact import Box, Hull, box_hull, triangle_hull
from oracles.moving import contact_interval
from strategies.boxes import box_pairs, triangle_boxes
from strategies.still import points, triangle_pairs

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Draw = Callable[..., Any]


# Above this, velocities are not made larger than the shapes: their sums would overflow.
LARGE = 2.0**800


class Moving(NamedTuple):
    """Two shapes, their velocities (3,) and the end of the interval: the oracles' arguments."""

    a: Any
    b: Any
    velocity_a: Any
    velocity_b: Any
    duration: float


def moving_triangle_pairs() -> st.SearchStrategy[Moving]:
    """Return two moving triangles (3, 3)."""
    return triangle_pairs().flatmap(lambda pair: _moving(*pair, _face_edges(pair.a)))


def moving_box_pairs() -> st.SearchStrategy[Moving]:
    """Return two moving boxes."""
    return box_pairs().flatmap(lambda pair: _moving(*pair, _box_edges(pair.a)))


def moving_triangle_boxes() -> st.SearchStrategy[Moving]:
    """Return a moving triangle and a moving box, in this order."""
    return triangle_boxes().flatmap(lambda pair: _moving(*pair, _face_edges(pair.triangle)))


def durations() -> st.SearchStrategy[float]:
    """Return a finite duration: zero, dyadic, tiny, long or any."""
    dyadic = st.integers(0, 40).map(lambda n: n / 8)
    extreme = st.sampled_from((0.0, 1.0, 2.0**-60, 2.0**60, 1e-9, 1e9))
    return st.one_of(dyadic, extreme, st.floats(0, 100, allow_subnormal=False))


@st.composite
def _moving(draw: Draw, a: Any, b: Any, edges: Floats) -> Moving:
    size = float(np.abs(edges).max(initial=0.0)) or 1.0
    velocity_a, velocity_b = draw(_velocities(edges, _inside(a) - _inside(b), size))
    landing = draw(st.sampled_from((0.5, 1.0, 0.125, 3.0, 0.5, 1.0, 3.0, 0.0)))
    # Taken back to time 0 from where they were drawn; exact for small numbers, else merely close.
    b = _shifted(b, (velocity_a - velocity_b) * landing)
    ends = (landing, landing, landing, landing + 1.0, 2 * landing, landing / 2, None)
    duration = draw(st.sampled_from(ends))
    if duration is None:
        duration = draw(durations())
    if size < LARGE and draw(st.integers(0, 7)) == 0:
        exponent = draw(st.sampled_from((-100, 100)))
        velocity_a, velocity_b = (np.ldexp(v, -exponent) for v in (velocity_a, velocity_b))
        duration = float(np.ldexp(duration, exponent))
    moving = Moving(a, b, velocity_a, velocity_b, duration)
    return draw(_ending_at_contact(moving)) if draw(st.booleans()) else moving


@st.composite
def _ending_at_contact(draw: Draw, moving: Moving) -> Moving:
    """Return the same motion ended at its first contact, or at a double beside it."""
    interval = contact_interval(_hull(moving.a), _hull(moving.b), *moving[2:])
    if interval is None:
        return moving
    end = float(interval[0])
    beside = draw(st.sampled_from((end, end, np.nextafter(end, 0.0), np.nextafter(end, np.inf))))
    return moving._replace(duration=float(beside))


@st.composite
def _velocities(draw: Draw, edges: Floats, approach: Floats, size: float) -> tuple[Floats, Floats]:
    """Return two velocities of about `size`: head on, in the plane of the edges, equal, any."""
    kind = draw(
        st.sampled_from(
            ("any",) * 4 + ("head on",) * 3 + ("in plane", "in plane", "huge", "equal", "resting")
        )
    )
    rest = np.zeros(3)
    if kind == "resting":
        return rest, rest
    common = draw(st.sampled_from((rest, np.array(draw(points())) * size)))
    if kind == "equal":
        return common, common
    if kind == "huge" and size < LARGE:
        # A power of two: the sums below stay exact for small numbers.
        common = np.array([2.0**27, -(2.0**26), 2.0**25]) * size
    if kind == "head on":
        relative = approach * draw(st.sampled_from((1.0, 0.5, 4.0)))
    elif kind == "in plane":
        i, j = draw(st.tuples(st.integers(-4, 4), st.integers(-4, 4)))
        relative = (edges[0] * i + edges[1] * j) / 2
    else:
        relative = np.array(draw(points())) * size
    if not relative.any():
        relative = np.array([1.0, -2.0, 0.5]) * size
    return common, common + relative


def _hull(shape: Any) -> Hull:
    return box_hull(shape) if isinstance(shape, Box) else triangle_hull(shape)


def _inside(shape: Any) -> Floats:
    return np.asarray(shape.center if isinstance(shape, Box) else (shape[0] + shape[1]) / 2)


def _face_edges(triangle: Any) -> Floats:
    return np.array([triangle[1] - triangle[0], triangle[2] - triangle[0]])


def _box_edges(box: Box) -> Floats:
    return np.asarray(box.axes * box.half_extents[:, None])[:2]


def _shifted(shape: Any, offset: Floats) -> Any:
    if isinstance(shape, Box):
        return Box(shape.center + offset, shape.axes, shape.half_extents)
    return shape + offset
