"""Bodies that do not turn: the first contact is that of the exact question about every pair."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import islice
from typing import Any

import numpy as np
import pytest
from meshes.hostile import HOSTILE
from movers.straight import KINDS, Straight
from oracles.moving import first_contact_triangles

from obbcli import (
    Body,
    Mesh,
    Motion,
    ObbTree,
    Pose,
    Query,
    Status,
    collide,
    contacts,
    first_contact,
)
from obbcli.primitives import Triangle
from obbcli.primitives import first_contact as first_contact_of_pairs

# Scenes whose scaled copies have the same times to the bit; some leave the range of normal numbers.
EXPONENTS = (0, 0, 0, -300, 300)
SEEDS = 150


def body(triangles: Any, rng: Any, velocity: Any = (0, 0, 0)) -> Body:
    """Return a body whose tree is lazy or whole, with few or many triangles a leaf."""
    mesh = Mesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))
    size, lazy = int(rng.choice([1, 1, 3, 8, 1000])), bool(rng.integers(2))
    return Body(ObbTree.build(mesh, leaf_size=size, lazy=lazy), motion=Motion(velocity))


def pair_by_pair(straight: Straight, duration: float) -> dict[tuple[int, int], float]:
    """Return of all pairs that meet the largest double that is no later, by exact arithmetic."""
    i, j = np.divmod(np.arange(len(straight.a) * len(straight.b)), len(straight.b))
    found = first_contact_of_pairs(
        Triangle(straight.a[i]), Triangle(straight.b[j]), 0, straight.velocity, duration
    )
    rows = found.rows.tolist()
    return {(int(i[r]), int(j[r])): t for r, t in zip(rows, found.time_below.tolist(), strict=True)}


def scaled(straight: Straight, exponent: int) -> Straight:
    return Straight(*(np.ldexp(part, exponent) for part in straight))


@pytest.mark.parametrize("kind", KINDS)
def test_first_contact_is_the_first_of_all_pairs(kind: str) -> None:
    hits = 0
    for seed in range(SEEDS):
        rng = np.random.default_rng(seed)
        straight = scaled(KINDS[kind](rng), int(rng.choice(EXPONENTS)))
        duration = float(rng.choice([1.0, 1.0, 0.75, 3.0]))
        a, b = body(straight.a, rng), body(straight.b, rng, straight.velocity)

        found = first_contact(a, b, duration)

        truth = pair_by_pair(straight, duration)
        assert collide(a, b, duration).collides == bool(truth), seed
        if not truth:
            assert found.status is Status.SEPARATED, seed
            continue
        hits += 1
        low, high = found.time_bounds
        assert low == min(truth.values()), seed
        assert high in (low, math.nextafter(low, math.inf)), seed
        assert truth[found.triangle_a, found.triangle_b] == low, seed
    assert hits > SEEDS // 10


@pytest.mark.parametrize("kind", KINDS)
def test_brackets_hold_the_fraction_that_the_pair_meets_at(kind: str) -> None:
    for seed in range(SEEDS, SEEDS + 25):
        rng = np.random.default_rng(seed)
        straight = KINDS[kind](rng)
        found = first_contact(body(straight.a, rng), body(straight.b, rng, straight.velocity), 1.0)
        if found.status is not Status.CONTACT:
            continue
        low, high = map(Fraction, found.time_bounds)

        a, b = straight.a[found.triangle_a], straight.b[found.triangle_b]
        time = first_contact_triangles(a, b, (0, 0, 0), straight.velocity, 1.0)

        assert time is not None
        assert low <= time <= high
        assert (low == high) == (Fraction(float(time)) == time)


@pytest.mark.parametrize("kind", KINDS)
def test_list_has_every_pair_once_in_order(kind: str) -> None:
    for seed in range(2 * SEEDS, 2 * SEEDS + 40):
        rng = np.random.default_rng(seed)
        straight = KINDS[kind](rng)
        a, b = body(straight.a, rng), body(straight.b, rng, straight.velocity)
        truth = sorted((time, *pair) for pair, time in pair_by_pair(straight, 1.0).items())

        found = [(c.time_bounds[0], c.triangle_a, c.triangle_b) for c in contacts(a, b, 1.0)]

        assert found == truth, seed
        some = islice(contacts(a, b, 1.0), 3)
        assert [(c.triangle_a, c.triangle_b) for c in some] == [(i, j) for _, i, j in found[:3]]


def test_contact_less_than_an_ulp_before_another_bounds_the_time() -> None:
    # Over a floor, at a speed of 2.5: one tip comes at 0.75 to the bit, the other a little earlier,
    # by less than from one double to the next. Both times round up to 0.75.
    floor = np.array([[[-9.0, -9, 0], [9, -9, 0], [0, 9, 0]]])
    heights = 1.875, 1.875 - 2.0**-52
    places = zip((-3, 3), heights, strict=True)
    tips = np.array([[[x, 0, z], [x, 1, 3], [x + 1, 0, 3]] for x, z in places])
    for order in ([0, 1], [1, 0]):
        mesh = Mesh(tips[order].reshape(-1, 3), [[0, 1, 2], [3, 4, 5]])
        mover = Body(mesh, motion=Motion((0, 0, -2.5)))

        found = first_contact(Mesh(floor[0], [[0, 1, 2]]), mover)

        assert found.time_bounds == (math.nextafter(0.75, 0), 0.75)
        assert order[found.triangle_b] == 1


@pytest.mark.parametrize("kind", ["soup", "lattice", "sheets"])
def test_bound_is_proven_after_every_pop_and_slices_change_nothing(kind: str) -> None:
    for seed in range(20):
        rng = np.random.default_rng(seed)
        straight = KINDS[kind](rng)
        a, b = body(straight.a, rng), body(straight.b, rng, straight.velocity)
        whole = first_contact(a, b, 1.0)
        first = min(pair_by_pair(straight, 1.0).values(), default=1.0)
        query, bound = Query(a, b, 1.0), 0.0

        while not query.is_finished:
            query.advance(1)
            assert bound <= query.lower_bound <= first
            bound = query.lower_bound

        answer = query.advance()
        assert {**vars(answer), "stats": None} == {**vars(whole), "stats": None}
        assert answer.stats[:4] == whole.stats[:4]


def test_bound_of_a_long_question_grows() -> None:
    # Thousands of triangles around one tip: no box is apart from another until late.
    pair = HOSTILE["bowl and spike"](2000)
    a, b = (Mesh(s.vertices, s.faces) for s in (pair.a, pair.b))
    mover = Body(b, Pose(translation=(0, 0, 0.125)), Motion((0, 0, -0.25)))
    query, bounds = Query(a, mover), []
    for pops in (2**13, 2**13, 2**15):
        query.advance(pops)
        bounds.append(query.lower_bound)

    assert not query.is_finished
    assert 0.25 < bounds[1] < bounds[2] <= 0.5


@pytest.mark.parametrize(
    ("velocity", "duration"),
    [(5e-324, 1.0), (2.0**-1000, 2.0**999), (1e300, 1e-300), (1.0, 1e300), (1.0, 5e-324)],
)
def test_speeds_and_durations_of_any_size_are_exact(velocity: float, duration: float) -> None:
    straight = KINDS["lattice"](np.random.default_rng(5))
    a, b = straight.a, straight.b + np.array([9.0, 0, 0])
    moved = Straight(a, b, np.array([-velocity, 0, 0]))
    rng = np.random.default_rng(1)
    truth = pair_by_pair(moved, duration)

    found = first_contact(body(a, rng), body(b, rng, moved.velocity), duration)

    assert (found.status is Status.CONTACT) == bool(truth)
    if truth:
        assert found.time_bounds[0] == min(truth.values())
