"""Grazes: brackets hold the first time at which the distance is at most the clearance.

The truths are closed forms: of translations in radicals, of turning bodies in angles.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any, NamedTuple

import mpmath
import numpy as np
import pytest
from claims.brackets import assert_holds, bounds
from movers.meshes import box, octahedron
from oracles.distance import triangle_distance_squared

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, Pose, Scene, Status

X, Y, Z = np.eye(3)
BLOCK = Mesh(*box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)))
TIP = Mesh(*octahedron())
# The quarters of a plate whose top is z = 0, cut through its middle.
PLATE = Mesh(
    [[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0], [0, 0, 0]],
    [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
)


class Graze(NamedTuple):
    """A translating body that comes to a clearance of another.

    Attributes:
        a: moves.
        b: rests.
        start: where A is at t = 0, (3,).
        velocity: A's.
        clearance: what is asked for, mesh units.
        offset: s; the first time within the clearance is offset - sqrt(square).
        square: s^2.
    """

    a: Mesh
    b: Mesh
    start: Any
    velocity: Any
    clearance: float
    offset: Fraction
    square: Fraction = Fraction(0)


def above(gap: float, mesh: Mesh = BLOCK) -> Any:
    return np.array([-3.0, 0.0, 1.0 + gap]) if mesh is BLOCK else np.array([-3.0, 0.0, 2.0 + gap])


# Edge beside edge, face over face: near from the time on at which B's edge is above A's.
ROD = Mesh(*box((-0.0625, -4.0, 0.0), (0.0625, 4.0, 0.125)))
BEAM = Mesh(*box((-4.0, -0.0625, 0.0), (4.0, 0.0625, 0.125)))
GRAZES = {
    "faces slide, edge first": Graze(BLOCK, BLOCK, above(0.25), X, 0.25, Fraction(2)),
    "faces slide at a speed of 3": Graze(BLOCK, BLOCK, above(0.25), 3 * X, 0.25, Fraction(2, 3)),
    "faces slide, corner first": Graze(BLOCK, BLOCK, above(0.5) - 3 * Y, X + Y, 0.5, Fraction(2)),
    "edges slide": Graze(BLOCK, BLOCK, [-3.0, 1.25, 0.0], X, 0.25, Fraction(2)),
    "edges slide diagonally": Graze(BLOCK, BLOCK, [-3.0, 1.1875, 1.25], X, 0.3125, Fraction(2)),
    "vertex passes vertex": Graze(TIP, TIP, above(0.25, TIP), X, 0.25, Fraction(3)),
    "vertex passes vertex at a third": Graze(
        TIP, TIP, above(0.25, TIP), 9 * X, 0.25, Fraction(1, 3)
    ),
    "vertex passes vertex slantwise": Graze(
        TIP, TIP, above(0.25, TIP) - 6 * Y, 3 * X + 6 * Y, 0.25, Fraction(1)
    ),
    "vertex slides along face": Graze(TIP, PLATE, [-7.0, 0.5, 1.25], 2 * X, 0.25, Fraction(3, 2)),
    "crossing edges": Graze(ROD, BEAM, [-7.0, 0.0, 0.375], 2 * X, 0.25, Fraction(47, 32)),
    # Beyond the graze: nearer than the clearance for a while.
    "sloping edges come by each other": Graze(
        TIP, TIP, above(0.25, TIP), X, 0.5, Fraction(13, 4), Fraction(1, 2)
    ),
    "edge comes by an edge": Graze(
        BLOCK, BLOCK, above(0.25), 2 * X, 0.5, Fraction(1), Fraction(3, 64)
    ),
    "vertex lands on a face": Graze(TIP, PLATE, [0.25, 0.5, 4.0], -3 * Z, 0.5, Fraction(5, 6)),
    "face lands on a face": Graze(BLOCK, BLOCK, [0.25, 0.5, 4.0], -3 * Z, 0.5, Fraction(5, 6)),
}


def exactly(graze: Graze) -> mpmath.mpf:
    with mpmath.workdps(60):
        root = mpmath.sqrt(mpmath.mpf(graze.square.numerator) / graze.square.denominator)
        return mpmath.mpf(graze.offset.numerator) / graze.offset.denominator - root


def moving(graze: Graze) -> Body:
    return Body(graze.a, Pose(None, graze.start), Motion(graze.velocity))


@pytest.mark.parametrize("tolerance", [1e-3, None, 1e-15, 0.0])
@pytest.mark.parametrize("name", GRAZES)
def test_time_of_a_translation_lies_between_neighbouring_doubles(
    name: str, tolerance: float | None
) -> None:
    graze = GRAZES[name]
    accuracy = Accuracy(clearance=graze.clearance, time_tolerance=tolerance)

    for a, b in ((moving(graze), graze.b), (graze.b, moving(graze))):
        answer = obbcli.first_contact(a, b, 8.0, accuracy)

        low, high = assert_holds(answer, exactly(graze))
        assert high <= np.nextafter(low, 9)
        assert answer.evidence == "within_tolerance"
        assert answer.distance is not None
        assert answer.distance == pytest.approx(graze.clearance, abs=1e-12)


@pytest.mark.parametrize("name", GRAZES)
def test_least_bit_decides_whether_a_graze_is_contact(name: str) -> None:
    graze = GRAZES[name]
    if graze.square:
        return
    less = Accuracy(clearance=float(np.nextafter(graze.clearance, 0)))
    answer = obbcli.first_contact(moving(graze), graze.b, 8.0, less)

    if "lands" in name:
        assert bounds(answer)[1] >= graze.offset
    else:
        assert answer.status is Status.SEPARATED


@pytest.mark.parametrize("name", GRAZES)
def test_duration_that_ends_at_the_time_is_long_enough(name: str) -> None:
    graze = GRAZES[name]
    accuracy = Accuracy(clearance=graze.clearance)
    low, high = bounds(obbcli.first_contact(moving(graze), graze.b, 8.0, accuracy))

    assert obbcli.collide(moving(graze), graze.b, high, accuracy).collides
    before = float(np.nextafter(low, 0))
    assert not obbcli.collide(moving(graze), graze.b, before, accuracy).collides


@pytest.mark.parametrize("power", [-900, -300, 300, 900])
@pytest.mark.parametrize("name", ["faces slide, edge first", "vertex passes vertex at a third"])
def test_units_at_the_ends_of_the_doubles_change_no_bit(name: str, power: int) -> None:
    graze, k = GRAZES[name], 2.0**power
    a = Body(
        Mesh(k * graze.a.vertices, graze.a.triangles),
        Pose(None, k * np.asarray(graze.start)),
        Motion(k * np.asarray(graze.velocity)),
    )
    b = Mesh(k * graze.b.vertices, graze.b.triangles)

    answer = obbcli.first_contact(a, b, 8.0, Accuracy(clearance=k * graze.clearance))

    unscaled = obbcli.first_contact(
        moving(graze), graze.b, 8.0, Accuracy(clearance=graze.clearance)
    )
    assert answer.time_bounds == unscaled.time_bounds


def random_triangles(seed: int) -> tuple[Any, Any, Any, float]:
    """Return two triangles with random digits, a velocity and a clearance."""
    draw = np.random.default_rng(seed)
    a, b = draw.normal(size=(3, 3)), draw.normal(size=(3, 3))
    if seed % 3 == 0:  # on a grid: ties and degenerate triangles
        a, b = np.round(2 * a) / 2, np.round(2 * b) / 2
    b = b + 4 * X
    velocity = -draw.uniform(1, 3) * X + 0.4 * draw.normal(size=3)
    return a, b, velocity, float(draw.choice([0.25, 0.6, 1e-3, draw.uniform(0.1, 1)]))


@pytest.mark.parametrize("seed", range(60))
def test_random_triangles_are_within_the_clearance_at_the_time_and_not_before(seed: int) -> None:
    a, b, velocity, clearance = random_triangles(seed)
    body = Body(Mesh(b, [[0, 1, 2]]), motion=Motion(velocity))

    answer = obbcli.first_contact(Mesh(a, [[0, 1, 2]]), body, 4.0, Accuracy(clearance=clearance))

    def square_at(time: float) -> Fraction:
        at = [
            [Fraction(p) + Fraction(time) * Fraction(v) for p, v in zip(row, velocity, strict=True)]
            for row in b.tolist()
        ]
        return triangle_distance_squared(a, at)

    wanted = Fraction(clearance) ** 2
    end = 4.0 if answer.status is Status.SEPARATED else bounds(answer)[0]
    if answer.status is not Status.SEPARATED:
        low, high = bounds(answer)
        assert high <= np.nextafter(low, 9)
        assert square_at(high) <= wanted or answer.distance > clearance
        assert square_at(low) >= wanted or low == 0
    # The distance of two convex sets is convex in time.
    assert all(square_at(time) > wanted for time in np.linspace(0, end, 33)[:-1].tolist())


def test_bodies_at_rest_at_the_clearance_are_in_contact_and_a_bit_further_are_not() -> None:
    there = Body(BLOCK, Pose(None, [1.25, 0.5, 0.25]))

    assert obbcli.first_contact(BLOCK, there, accuracy=Accuracy(clearance=0.25)).status is (
        Status.OVERLAP_AT_START
    )
    less = Accuracy(clearance=float(np.nextafter(0.25, 0)))
    assert obbcli.first_contact(BLOCK, there, accuracy=less).status is Status.SEPARATED
    # Apart from the vertex at (1, 1, 1) along (2, 3, 6) / 7.
    corner = Body(BLOCK, Pose(None, [3.0, 4.0, 7.0]))
    assert obbcli.collide(BLOCK, corner, accuracy=Accuracy(clearance=7.0)).collides
    less = Accuracy(clearance=float(np.nextafter(7.0, 0)))
    assert not obbcli.collide(BLOCK, corner, accuracy=less).collides


@pytest.mark.parametrize("clearance", [0.0, 0.25])
@pytest.mark.parametrize("name", ["faces slide, edge first", "vertex passes vertex"])
def test_graze_on_a_path_through_poses_is_in_the_bracket(name: str, clearance: float) -> None:
    graze = GRAZES[name]
    start = np.asarray(graze.start) - (graze.clearance - clearance) * Z
    times = [0.0, 0.7, 1.9, 3.1, 8.0]
    poses = [Pose(None, start + time * graze.velocity) for time in times]
    walking = Body(graze.a, motion=Motion.through(times, poses))

    answer = obbcli.first_contact(walking, graze.b, 8.0, Accuracy(clearance=clearance))

    assert_holds(answer, exactly(graze))


def test_contacts_of_pairs_are_in_their_brackets() -> None:
    graze = GRAZES["faces slide, edge first"]
    accuracy = Accuracy(clearance=graze.clearance)

    found = list(obbcli.contacts(moving(graze), graze.b, 8.0, accuracy))

    first = obbcli.first_contact(moving(graze), graze.b, 8.0, accuracy)
    assert found[0].time_bounds == first.time_bounds == (2.0, 2.0)
    assert len(found) > 4
    for contact in found:
        a, b = (
            mesh.vertices[mesh.triangles[row]]
            for mesh, row in ((graze.a, contact.triangle_a), (graze.b, contact.triangle_b))
        )
        low, high = contact.time_bounds or (0, None)
        assert high is not None
        assert high <= np.nextafter(low, 9)
        path = [
            [
                [
                    Fraction(c) + Fraction(s) + Fraction(t) * Fraction(v)
                    for c, s, v in zip(row, graze.start, graze.velocity, strict=True)
                ]
                for row in a.tolist()
            ]
            for t in (high, low)
        ]
        at_high, at_low = (triangle_distance_squared(where, b) for where in path)
        assert at_high <= Fraction(graze.clearance) ** 2 <= at_low


def test_scenes_and_sweeps_have_the_brackets_of_first_contact() -> None:
    graze = GRAZES["faces slide at a speed of 3"]
    accuracy = Accuracy(clearance=graze.clearance)
    answer = obbcli.first_contact(moving(graze), graze.b, 8.0, accuracy)

    scene = Scene({"a": moving(graze), "b": Body(graze.b)}, duration=8.0, accuracy=accuracy)
    (found,) = scene.first_contacts()
    rows = obbcli.sweep(
        Body(graze.a, Pose(None, graze.start)),
        graze.b,
        [Motion(graze.velocity)],
        durations=8.0,
        accuracy=accuracy,
    )

    assert found.contact.time_bounds == answer.time_bounds
    assert (rows["time_lo"][0], rows["time_hi"][0]) == answer.time_bounds
    assert math.isclose(rows["distance"][0], graze.clearance, abs_tol=1e-12)
