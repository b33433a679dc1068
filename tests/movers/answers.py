"""Asking the package about movers, and what any of its answers must fulfil.

Evidence is held to exact arithmetic at the reported time; nothing here knows a true answer.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
from oracles.distance import point_triangle_distance_squared, triangle_distance_squared
from oracles.moving import contact_interval_triangles
from oracles.screw import Mover, triangles_touch
from oracles.still import root

import obbcli
from obbcli import Accuracy, Body, FirstContact, Motion, Pose, Status

# Points, distances and normals are rounded: so far, in shares of the pair's size or extent.
ROUNDING = 1e-12


def as_body(mover: Mover) -> Body:
    """Return a mover as the package takes it."""
    return Body(
        obbcli.Mesh(mover.vertices, mover.faces),
        Pose(mover.rotation, mover.translation),
        Motion(mover.velocity, mover.spin, mover.pivot),
    )


def ask(a: Mover, b: Mover, duration: float, **accuracy: Any) -> FirstContact:
    """Return the package's answer."""
    return obbcli.first_contact(as_body(a), as_body(b), duration, Accuracy(**accuracy))


def bounds(answer: FirstContact) -> tuple[Fraction, Fraction]:
    """Return the bracket of a contact."""
    assert answer.time_bounds is not None
    lo, hi = answer.time_bounds
    assert hi is not None
    return Fraction(lo), Fraction(hi)


def extent(a: Mover, b: Mover) -> float:
    """Return how large coordinates and the pair are."""
    return max(float(np.abs(np.subtract(m.start, m.pivot)).max()) for m in (a, b)) + size(a, b)


def size(a: Mover, b: Mover) -> float:
    """Return the contract's size of a pair."""
    return max(float(np.linalg.norm(np.ptp(m.vertices, axis=0))) for m in (a, b))


def assert_coherent(answer: FirstContact, a: Mover, b: Mover, duration: float) -> None:
    """Fail unless the answer's parts fit each other and its evidence holds exactly."""
    assert not answer.approximate
    assert answer.error_bound == 0
    if answer.status is Status.SEPARATED:
        for name in ("time", "time_bounds", "evidence", "point", "normal", "triangle_a", "feature"):
            assert getattr(answer, name) is None, name
        return
    lo, hi = bounds(answer)
    assert answer.time == lo
    assert 0 <= lo <= hi <= duration
    assert (answer.status is Status.OVERLAP_AT_START) == (hi == 0)
    _assert_evidence(answer, a, b, hi)


def _assert_evidence(answer: FirstContact, a: Mover, b: Mover, hi: Fraction) -> None:
    if answer.evidence == "within_tolerance":
        assert answer.distance is not None
        square = triangle_distance_squared(*corners(answer, a, b, hi))
        assert square <= Fraction(answer.distance) ** 2
        return
    assert answer.evidence == "intersecting"
    assert answer.triangle_a is not None
    assert answer.triangle_b is not None
    if not (a.turns or b.turns):
        # What touches for an instant does so at a rational time in the bracket.
        moving = (*corners(answer, a, b, Fraction(0)), a.velocity, b.velocity, hi)
        interval = contact_interval_triangles(*moving)
        assert interval is not None
        assert interval[0] >= bounds(answer)[0]
        return
    assert triangles_touch(a, b, ((answer.triangle_a,), (answer.triangle_b,)), hi)


def assert_place(answer: FirstContact, a: Mover, b: Mover) -> None:
    """Fail unless a contact's points lie on its triangles and its normal parts them before."""
    lo, hi = bounds(answer)
    slack = ROUNDING * extent(a, b) + (answer.distance or 0.0)
    slack += 4e-16 * max(float(np.abs(body.start).max()) for body in (a, b))
    # Between the bounds the surfaces go on: the place belongs to one of the two times.
    slack += float(hi - lo) * fastest(a, b)
    points = answer.point, answer.point_a, answer.point_b
    for point, triangle in product(points, corners(answer, a, b, hi)):
        assert point is not None
        assert float(root(point_triangle_distance_squared(point, triangle))) <= slack
    if answer.status is Status.OVERLAP_AT_START:
        return
    for normal in (answer.normal, answer.normal_a, answer.normal_b):
        assert normal is not None
        assert abs(np.linalg.norm(normal) - 1) <= ROUNDING
    one, two = (
        np.array(triangle, dtype=np.float64) - np.asarray(answer.point)
        for triangle in corners(answer, a, b, lo)
    )
    assert (one @ answer.normal).max() <= (two @ answer.normal).min() + slack


def corners(answer: FirstContact, a: Mover, b: Mover, time: Fraction) -> list[Any]:
    """Return the two triangles of a contact at a time."""
    assert answer.triangle_a is not None
    assert answer.triangle_b is not None
    return [
        body.at(time, np.asarray(body.faces)[row].tolist())
        for body, row in ((a, answer.triangle_a), (b, answer.triangle_b))
    ]


def fastest(a: Mover, b: Mover) -> float:
    """Return a bound of the speed at which the surfaces close."""
    total = 0.0
    for body in (a, b):
        arm = np.linalg.norm(np.subtract(body.start, body.pivot), axis=1).max()
        total += float(np.linalg.norm(body.velocity) + np.linalg.norm(body.spin) * arm)
    return total


def assert_bracket(answer: FirstContact, lo: Any, hi: Any) -> None:
    """Fail unless the answer is a contact whose bracket fits the true first time in [lo, hi]."""
    assert answer.status is Status.CONTACT
    first, last = bounds(answer)
    assert first <= hi
    assert last >= lo


def assert_width(answer: FirstContact, a: Mover, b: Mover, tolerance: float) -> None:
    """Fail if the bracket is wider than asked although the triangles move far in that time."""
    first, last = bounds(answer)
    if last - first > Fraction(tolerance) + Fraction(np.spacing(float(last))):
        before = corners(answer, a, b, first - Fraction(tolerance))
        gap = float(root(triangle_distance_squared(*before)))
        assert gap <= 4 * ROUNDING * extent(a, b)
