"""Spheres of facets: between the spheres through their vertices and those within their faces."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from meshes.surfaces import sphere
from movers.answers import as_body, ask, assert_bracket, assert_coherent, assert_place, bounds
from movers.meshes import cube
from oracles.screw import Mover
from scenes.pairs import random_rotation
from scenes.planes import plane_time
from scenes.screw import X, Y, Z, against_plane

import obbcli
from obbcli import Status

BALL = sphere(320)
GRID = 2.0**-23  # vertices lie this near the unit sphere


def inner_radius() -> float:
    """Return the radius of the largest sphere about 0 that no face reaches into."""
    corners = BALL.vertices[BALL.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(((normals * corners[:, 0]).sum(1) / np.linalg.norm(normals, axis=1)).min())


def ball(place: Any, velocity: Any, spin: Any, seed: int) -> Mover:
    """Return a ball that spins about its centre."""
    pose = random_rotation(seed), np.asarray(place)
    return Mover(BALL.vertices, BALL.faces, *pose, velocity, spin, place)


def near_time(offset: Any, velocity: Any, reach: float) -> float | None:
    """Return when a point that moves straight is first so near to 0, or None."""
    b, c = float(np.dot(offset, velocity)), float(np.dot(offset, offset)) - reach**2
    square = float(np.dot(velocity, velocity))
    root = b * b - square * c
    return None if root < 0 or b > 0 else c / (-b + math.sqrt(root))


@pytest.mark.parametrize(
    "spin", [0 * Z, 3 * Z, X - 2 * Y, 25 * X + 60 * Z], ids=["still", "upright", "rolling", "fast"]
)
def test_ball_of_facets_lands_when_its_lowest_vertex_does(spin: Any) -> None:
    falling = ball((0.25, -0.5, 0.0), (0.5, 0.25, -1.0), spin, 3)
    scene = against_plane("ball", falling, -Z, 2.0, 2.0)

    answer = ask(scene.a, scene.b, 2.0)

    time = plane_time(falling, -Z, 2.0, 2.0)
    assert time is not None
    assert_bracket(answer, *[Fraction(*time.as_integer_ratio())] * 2)
    assert_coherent(answer, scene.a, scene.b, 2.0)
    assert_place(answer, scene.a, scene.b)
    assert answer.normal == pytest.approx(-Z, abs=1e-6)
    assert 1 - GRID <= float(bounds(answer)[1]) <= 2 - inner_radius() + GRID


def test_balls_of_facets_meet_between_the_spheres_inside_and_around_them() -> None:
    low = inner_radius()
    random = np.random.default_rng(11)
    met = 0
    for seed in range(40):
        heading, aside = random.normal(size=(2, 3))
        heading /= np.linalg.norm(heading)
        aside -= (aside @ heading) * heading
        start = 4 * heading + aside * random.uniform(0, 2.4) / np.linalg.norm(aside)
        common, spins = random.normal(size=3), random.normal(size=(2, 3)) * 4
        a = ball((0.0, 0.0, 0.0), common, spins[0], seed)
        b = ball(start, common - 3 * heading, spins[1], seed + 100)

        answer = ask(a, b, 2.0)

        around = near_time(start, -3 * heading, 2 * (1 + GRID))
        inside = near_time(start, -3 * heading, 2 * low)
        if around is None:
            assert answer.status is Status.SEPARATED, seed
        elif answer.status is Status.CONTACT:
            met += 1
            assert_coherent(answer, a, b, 2.0)
            assert around <= float(bounds(answer)[1]), seed
            assert inside is None or float(bounds(answer)[0]) <= inside, seed
        else:
            assert inside is None, seed
    assert 20 < met < 40


@pytest.mark.parametrize(("gap", "turns"), [(1e-2, 1.0), (1e-4, 0.25)])
def test_ball_spins_free_in_a_box_with_little_clearance(gap: float, turns: float) -> None:
    axis = np.array([1.0, 2.0, 3.0]) / math.sqrt(14)
    spinning = ball((0.0, 0.0, 0.0), 0 * X, 2 * math.pi * turns * axis, 5)
    hole = Mover(cube(1 + GRID + gap)[0], cube()[1])

    answer = ask(spinning, hole, 1.0)
    tight = ask(spinning, Mover(cube(inner_radius() - 1e-9)[0], cube()[1]), 1.0)

    assert answer.status is Status.SEPARATED
    assert tight.status is Status.OVERLAP_AT_START


def test_ball_in_a_box_touches_the_side_it_drifts_to() -> None:
    drift, spin = 0.125 * X, np.array([3.0, 2.0, -1.0])
    spinning = ball((0.0, 0.0, 0.0), drift, spin, 5)
    hole = Mover(cube(1.0625)[0], cube()[1])

    answer = ask(spinning, hole, 4.0)

    # As slowly as it drifts, it meets no other side.
    time = plane_time(spinning, X, 1.0625, 4.0)
    assert time is not None
    assert_bracket(answer, *[Fraction(*time.as_integer_ratio())] * 2)
    assert answer.normal == pytest.approx(X, abs=1e-6)
    out = ask(replace(spinning, velocity=-np.asarray(drift)), hole, 4.0)
    assert out.normal == pytest.approx(-X, abs=1e-6)
    assert obbcli.collide(as_body(spinning), as_body(hole), 0.5).status is Status.SEPARATED
