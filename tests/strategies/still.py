"""Hypothesis strategies for shapes at rest, aimed at where floating point gives wrong answers.

Small integers and dyadic fractions make exact contact common; a nudge by one ulp parts or joins it.
Scales reach from subnormals to 2^1000. Boxes, motion and meshes have files of their own.
"""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Draw = Callable[..., Any]

# Small angles and lengths, as powers of ten: from visible to below an ulp of one.
TINY_EXPONENTS = st.integers(4, 16)
SCALES = st.sampled_from([0] * 12 + [-1072, -1060, -1000, -500, -300, -40, 40, 300, 500, 1000])


def examples(count: int) -> settings:
    """Return settings for `count` examples, the same on every machine, without a deadline."""
    return settings(
        max_examples=count,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
    )


class TrianglePair(NamedTuple):
    """Two triangles, (3, 3) each."""

    a: Any
    b: Any


# Strategies are made once: making them anew in every draw costs more than drawing.
ORDERS = st.sampled_from([list(order) for order in permutations(range(3))])
INTEGER_POINTS = st.tuples(*[st.integers(-4, 4)] * 3)
DYADIC_POINTS = st.tuples(*[st.integers(-32, 32)] * 3)
ANY_POINTS = st.tuples(*[st.floats(-4, 4)] * 3)


@st.composite
def points(draw: Draw) -> Floats:
    """Return a point: small integers, dyadic fractions or any doubles up to 4."""
    kind = draw(st.sampled_from(("integer", "integer", "dyadic", "any")))
    if kind == "any":
        return np.array(draw(ANY_POINTS))
    if kind == "dyadic":
        return np.array(draw(DYADIC_POINTS)) / 8.0
    return np.array(draw(INTEGER_POINTS), dtype=np.float64)


@st.composite
def triangles(draw: Draw) -> Floats:
    """Return a triangle (3, 3): general, collinear, coincident, or a needle."""
    kind = draw(st.sampled_from(("general",) * 9 + ("segment", "repeated", "point", "needle")))
    a, b = draw(points()), draw(points())
    if kind == "general":
        return np.array([a, b, draw(points())])
    if kind == "segment":
        c = a + (b - a) * draw(st.integers(-2, 6)) / 4
    elif kind == "needle":
        c = b + draw(points()) * 2.0 ** -draw(st.integers(8, 56))
    else:
        c, b = a, (b if kind == "repeated" else a)
    return np.array([a, b, c])[draw(ORDERS)]


@st.composite
def triangle_pairs(draw: Draw) -> TrianglePair:
    """Return two triangles: unrelated, touching, coplanar, nearly parallel, nudged, scaled."""
    a = draw(triangles())
    b = draw(_related_triangles(a))
    b = b[draw(ORDERS)]
    a, b = draw(rescaled((a, b)))
    if draw(st.integers(0, 3)) == 0:
        b = draw(nudged(b))
    return TrianglePair(*((b, a) if draw(st.booleans()) else (a, b)))


@st.composite
def _related_triangles(draw: Draw, a: Floats) -> Floats:
    relation = draw(st.sampled_from(list(_RELATIONS)))
    return _RELATIONS[relation](draw, a)


def _at_vertex(draw: Draw, a: Floats) -> Floats:
    """A vertex of b at a place of a: a vertex, on an edge, or in the face."""
    return np.array([place_in(draw, a), draw(points()), draw(points())])


def _across_edge(draw: Draw, a: Floats) -> Floats:
    """An edge of b through a place of a."""
    place, arm = place_in(draw, a), draw(points())
    return np.array([place - arm, place + arm, draw(points())])


def _coplanar(draw: Draw, a: Floats) -> Floats:
    return np.array([place_in_plane(draw, a) for _ in range(3)])


def _collinear(draw: Draw, a: Floats) -> Floats:
    steps = draw(st.tuples(*[st.integers(-8, 12)] * 3))
    return np.array([a[0] + (a[1] - a[0]) * n / 4 for n in steps])


def _sharing(draw: Draw, a: Floats) -> Floats:
    """One, two or three vertices in common."""
    b = np.array([draw(points()) for _ in range(3)])
    shared = draw(st.integers(1, 3))
    b[:shared] = a[:shared]
    return b


def _parallel(draw: Draw, a: Floats) -> Floats:
    offset = draw(points()) * draw(st.sampled_from((1.0, 2.0**-10, 2.0**-30, 2.0**-50)))
    return a + offset


def _nearly_parallel(draw: Draw, a: Floats) -> Floats:
    """Each vertex of a moved by 1e-4 to 1e-16: near-parallel planes and edges."""
    bend = np.array([draw(points()) for _ in range(3)])
    return place_in_plane(draw, a) - a[0] + a + bend * 10.0 ** -draw(TINY_EXPONENTS)


def _nearly_parallel_edge(draw: Draw, a: Floats) -> Floats:
    place, bend = place_in(draw, a), draw(points()) * 10.0 ** -draw(TINY_EXPONENTS)
    arm = (a[1] - a[0]) / 2 + bend
    return np.array([place - arm, place + arm, draw(points())])


_RELATIONS: dict[str, Callable[[Any, Any], Any]] = {
    "unrelated": lambda draw, _: draw(triangles()),
    "at vertex": _at_vertex,
    "across edge": _across_edge,
    "coplanar": _coplanar,
    "collinear": _collinear,
    "sharing": _sharing,
    "parallel": _parallel,
    "nearly parallel": _nearly_parallel,
    "nearly parallel edge": _nearly_parallel_edge,
}


def place_in(draw: Draw, a: Floats) -> Floats:
    """Return a point of the triangle with dyadic weights: exact where the triangle is dyadic."""
    weights = draw(
        st.sampled_from(((4, 0, 0), (0, 4, 0), (2, 2, 0), (0, 3, 1), (1, 1, 2), (2, 1, 1)))
    )
    return np.asarray(weights) @ a / 4


def place_in_plane(draw: Draw, a: Floats) -> Floats:
    i, j = draw(st.tuples(*[st.integers(-6, 8)] * 2))
    return a[0] + ((a[1] - a[0]) * i + (a[2] - a[0]) * j) / 4


@st.composite
def rescaled(draw: Draw, arrays: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return all arrays in another scale, or small and far from the origin."""
    if draw(st.integers(0, 5)) == 0:
        offset = draw(st.sampled_from((1e8, -1e8, 2.0**27)))
        return tuple(array * 2.0**-10 + (offset, 0.0, -offset) for array in arrays)
    exponent = draw(SCALES)
    return tuple(np.ldexp(array, exponent) for array in arrays)


@st.composite
def nudged(draw: Draw, array: Floats) -> Floats:
    """Return a copy with one number moved by an ulp."""
    moved = np.array(array, dtype=np.float64)
    flat = moved.reshape(-1)
    i = draw(st.integers(0, flat.size - 1))
    flat[i] = np.nextafter(flat[i], draw(st.sampled_from((-np.inf, np.inf))))
    return moved
