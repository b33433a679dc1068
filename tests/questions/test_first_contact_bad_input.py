"""Input at the ends of what can be asked: refused clearly, or answered with what is proven."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from movers.answers import as_body, ask, assert_coherent, bounds
from movers.meshes import cube, octahedron
from oracles.screw import Mover
from scenes.screw import X, Y, Z

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, MotionError, Query, Status

if TYPE_CHECKING:
    from collections.abc import Callable

CUBE = Mesh(*cube())
AWAY = Mesh(cube()[0] + 5 * X, cube()[1])
POINT = np.zeros((3, 3)), np.array([(0, 1, 2)])

ASKS: dict[str, Callable[..., Any]] = {
    "first_contact": obbcli.first_contact,
    "collide": obbcli.collide,
    "Query": lambda *question: Query(*question).advance(),
}
asks = pytest.mark.parametrize("ask_for", ASKS.values(), ids=ASKS.keys())


@asks
@pytest.mark.parametrize(
    "duration", [-1.0, -5e-324, math.nan, math.inf, "1", [1.0], 10**400, -(10**400)]
)
def test_duration_that_is_none_is_refused_by_name(
    ask_for: Callable[..., Any], duration: Any
) -> None:
    with pytest.raises(MotionError, match=r"^duration: ") as refused:
        ask_for(Body(CUBE, motion=Motion(X)), AWAY, duration)
    assert refused.value.remedy


@asks
@pytest.mark.parametrize(
    ("motion", "duration"),
    [
        (Motion(1e308 * X), 100.0),
        (Motion(X), 1e308),
        (Motion(X, Z), 1e308),
        (Motion(None, Z, 1e308 * Y), 1.0),
        (Motion(np.full(3, 1.7e308), Z), 1.0),
    ],
    ids=["fast", "long", "long and turning", "far pivot", "beyond a norm"],
)
def test_positions_beyond_doubles_are_refused(
    ask_for: Callable[..., Any], motion: Motion, duration: float
) -> None:
    with pytest.raises(MotionError, match="exceed the range of double"):
        ask_for(Body(CUBE, motion=motion), AWAY, duration)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize(
    ("spin", "duration"),
    [(1e308 * X, 1.0), (1e308 * X, 1e308), (np.full(3, 1.7e308), 1.0), (1e20 * Z, 1e-3)],
)
def test_spin_that_no_double_can_follow_is_left_open(
    spin: Any, duration: float, swapped: bool
) -> None:
    bodies = [Body(CUBE, motion=Motion(None, spin)), Body(AWAY)]

    answer = obbcli.first_contact(*(bodies[::-1] if swapped else bodies), duration)

    assert answer.status is Status.UNRESOLVED
    assert answer.time_bounds == (0.0, None)
    assert (answer.point, answer.normal, answer.evidence) == (None, None, None)


@pytest.mark.parametrize("distance", [1e20, 1e300])
def test_pivot_so_far_that_nothing_is_left_of_the_body_proves_nothing(distance: float) -> None:
    far = Motion(None, Z, distance * Y)
    turning = Body(CUBE, motion=far)

    assert obbcli.first_contact(turning, AWAY).status is Status.UNRESOLVED
    assert obbcli.collide(turning, AWAY).status is Status.UNRESOLVED
    # What does not turn has no use for a pivot, and what turns alike does not move.
    assert obbcli.first_contact(turning, Body(AWAY, motion=far)).status is Status.SEPARATED
    straight = Body(CUBE, motion=Motion(X, None, distance * Y))
    assert obbcli.first_contact(straight, AWAY, 5.0).time == 3.0


@pytest.mark.parametrize("tolerance", [0.0, 5e-324, 1e-300, 1e-18])
def test_tolerance_below_what_coordinates_support_is_raised_and_said(tolerance: float) -> None:
    a = Mover(*cube(), velocity=X, spin=Z)
    b = Mover(AWAY.vertices, AWAY.triangles)

    answer = ask(a, b, 10.0, time_tolerance=tolerance, distance_tolerance=tolerance)

    assert_coherent(answer, a, b, 10.0)
    assert answer.status is Status.CONTACT
    assert answer.evidence == "within_tolerance"
    assert answer.distance is not None
    assert max(tolerance, 1e-16) < answer.distance < 1e-12


@pytest.mark.parametrize("spin", [0 * Z, Z, X + Y + 3 * Z], ids=["straight", "flat", "skew"])
def test_mesh_of_no_size_is_a_point_like_any_other(spin: Any) -> None:
    point = Mover(*POINT, velocity=X, spin=spin)
    wall = Mover(AWAY.vertices, AWAY.triangles)
    for pair in ((point, wall), (wall, point)):
        answer = ask(*pair, 10.0)

        assert_coherent(answer, *pair, 10.0)
        assert answer.status is Status.CONTACT
        lo, hi = bounds(answer)
        assert lo <= 4 <= hi + Fraction(1, 10**9)
        assert ask(*pair, 3.75).status is Status.SEPARATED


def test_two_meshes_of_no_size_meet_or_miss() -> None:
    point, other = Mover(*POINT, velocity=X), Mover(POINT[0] + 3 * X, POINT[1])
    beside = Mover(POINT[0] + 3 * X + 1e-9 * Y, POINT[1])

    assert ask(point, other, 10.0).time_bounds == (3.0, 3.0)
    assert ask(point, beside, 10.0).status is Status.SEPARATED
    assert ask(point, point, 10.0).status is Status.OVERLAP_AT_START
    turning = Mover(*POINT, velocity=X, spin=Z)
    assert ask(turning, beside, 10.0).status is Status.SEPARATED
    answer = ask(turning, other, 10.0)
    assert answer.status is not Status.SEPARATED
    assert answer.time is not None
    assert 3 - 1e-9 < answer.time <= 3


@pytest.mark.parametrize("clearance", [1e308, 4.0, 3.0 + 1e-9])
def test_clearance_larger_than_the_gap_is_contact_at_the_start(clearance: float) -> None:
    answer = obbcli.first_contact(
        Body(CUBE, motion=Motion(X)), AWAY, 1.0, Accuracy(clearance=clearance)
    )

    assert answer.status is Status.OVERLAP_AT_START
    # Of points near enough, not the nearest: of two cubes with sides of 2, with a gap of 3.
    assert answer.distance is not None
    assert 3 - 1e-12 < answer.distance <= min(clearance, 7 * 3**0.5)
    assert answer.distance == pytest.approx(math.dist(answer.point_a, answer.point_b))


def test_touching_points_far_apart_in_size_are_found() -> None:
    # A speck beside a boulder: the scale of the scene is that of the larger.
    speck = Mover(octahedron()[0] * 2.0**-40, octahedron()[1], velocity=X)
    for power in (0, 20, 40):
        k = 2.0**power
        boulder = Mover(cube()[0] * k + (k + 1) * X, cube()[1])

        answer = ask(speck, boulder, 2.0)

        assert_coherent(answer, speck, boulder, 2.0)
        assert answer.time == 1 - 2.0**-40


def test_bodies_are_asked_about_by_their_shapes_alone() -> None:
    moving = Mover(*cube(), velocity=X)

    with pytest.raises(MotionError, match="pass an ObbTree, a Mesh, a Part or a path"):
        obbcli.first_contact(as_body(moving), 42)  # type: ignore[arg-type]


def test_turning_point_that_runs_into_a_point_is_answered() -> None:
    here, there = Mesh([[0.0, 0, 0]] * 3, [[0, 1, 2]]), Mesh([[3.0, 0, 0]] * 3, [[0, 1, 2]])

    answer = obbcli.first_contact(Body(here, motion=Motion(X, 3 * Z)), there, 10.0)

    assert answer.status is Status.CONTACT
    assert answer.time == pytest.approx(3.0, abs=1e-13)
    assert answer.distance is not None
    assert answer.distance <= 1e-12
