"""Clearance is one notion: at rest, under motion and in `distance` surfaces are as far apart."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from movers.answers import as_body, ask, bounds
from movers.meshes import cube
from movers.random_pairs import KINDS, Kind, random_pair
from oracles.gaps import gap_at
from scenes.screw import X, Z

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, Status

if TYPE_CHECKING:
    from oracles.screw import Mover

STILL = {"velocity": (0.0, 0.0, 0.0), "spin": (0.0, 0.0, 0.0)}
# What rounding leaves open on either side, as a share of the gap and the size together.
ROUNDING = 1e-12


def at_rest(kind: Kind, seed: int) -> tuple[Mover, Mover]:
    a, b = (replace(body, **STILL) for body in random_pair(kind, seed))
    return a, b


@pytest.mark.parametrize("kind", KINDS)
def test_bodies_at_rest_are_in_contact_if_their_distance_is_within_the_clearance(
    kind: Kind,
) -> None:
    for seed in range(8000, 8040):
        a, b = at_rest(kind, seed)
        bodies = as_body(a), as_body(b)
        low, high = obbcli.distance(*bodies).bounds
        margin = ROUNDING * (1 + high)
        for clearance, within in (
            (0.5 * low, False),
            (low - margin, False),
            (high + margin, True),
            (2 * high, True),
        ):
            accuracy = Accuracy(clearance=clearance)

            answer = obbcli.first_contact(*bodies, None, accuracy)
            verdict = obbcli.collide(*bodies, None, accuracy)

            wanted = Status.OVERLAP_AT_START if within else Status.SEPARATED
            assert answer.status is wanted, (seed, clearance)
            assert verdict.status is wanted
            if within:
                assert answer.distance is not None
                assert low <= answer.distance <= clearance + margin
                assert (verdict.witness, verdict.approximate) == (
                    (answer.triangle_a, answer.triangle_b),
                    False,
                )


@pytest.mark.parametrize("clearance", [1e-6, 0.03125, 0.5])
@pytest.mark.parametrize("kind", KINDS)
def test_moving_bodies_are_a_clearance_apart_when_they_first_come_that_near(
    kind: Kind, clearance: float
) -> None:
    met = 0
    for seed in range(8100, 8125):
        a, b = random_pair(kind, seed)

        answer = ask(a, b, 1.0, clearance=clearance)
        verdict = obbcli.collide(as_body(a), as_body(b), 1.0, Accuracy(clearance=clearance))

        assert verdict.collides == (answer.status is not Status.SEPARATED)
        free = 1.0
        if answer.status is Status.CONTACT:
            met += 1
            lo, hi = (float(time) for time in bounds(answer))
            assert gap_at(a, b, hi) <= clearance + 1e-8
            assert gap_at(a, b, lo) >= clearance - ROUNDING * 16
            free = lo
        elif answer.status is Status.OVERLAP_AT_START:
            assert gap_at(a, b, 0.0) <= clearance + ROUNDING * 16
            continue
        times = np.linspace(0, free, 9)
        assert min(gap_at(a, b, time) for time in times) >= clearance - ROUNDING * 16, seed
    assert 5 < met < 25


@pytest.mark.parametrize("kind", KINDS)
def test_larger_clearance_is_reached_no_later(kind: Kind) -> None:
    for seed in range(8200, 8230):
        a, b = random_pair(kind, seed)
        last = 1.0
        for clearance in (0.0, 1e-9, 1e-3, 0.25, 1.0):
            answer = ask(a, b, 1.0, clearance=clearance)

            assert last == 1.0 or answer.status is not Status.SEPARATED, seed
            if answer.status is not Status.SEPARATED:
                lo, hi = bounds(answer)
                assert lo <= last
                last = float(hi)


@pytest.mark.parametrize("spin", [0 * X, 2 * X], ids=["straight", "turning about the way"])
@pytest.mark.parametrize("clearance", [2.0**-30, 0.25, 1.0])
def test_faces_that_close_in_are_a_clearance_apart_at_the_time_of_the_rest(
    clearance: float, spin: np.ndarray
) -> None:
    a = Body(Mesh(*cube()), motion=Motion(2 * X, spin))
    b = Mesh(cube()[0] + 5 * X, cube()[1])

    answer = obbcli.first_contact(a, b, 2.0, Accuracy(clearance=clearance))

    true = (3 - clearance) / 2
    lo, hi = bounds(answer)
    assert answer.status is Status.CONTACT
    assert lo <= true <= hi + 1e-9
    assert float(lo) == pytest.approx(true, abs=1e-8)
    assert obbcli.first_contact(a, b, true * (1 - 1e-9), Accuracy(clearance=clearance)).status is (
        Status.SEPARATED
    )


def test_spin_within_the_clearance_of_a_wall_is_told_from_one_beyond() -> None:
    # The cube's edges pass the wall at 2^0.5 from its axis, and at 0.5 from the wall.
    wall = Mesh(cube()[0] * (1, 4, 4) + (1.5 + 2**0.5) * X, cube()[1])
    spinning = Body(Mesh(*cube()), motion=Motion(None, 40 * Z))

    near = obbcli.first_contact(spinning, wall, 1.0, Accuracy(clearance=0.5 + 1e-9))
    beyond = obbcli.first_contact(spinning, wall, 1.0, Accuracy(clearance=0.5 - 1e-9))

    assert near.status is Status.CONTACT
    assert near.time == pytest.approx(np.pi / 160, abs=1e-5)
    assert beyond.status is Status.SEPARATED
