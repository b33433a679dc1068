from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from movers.answers import ask, assert_bracket, assert_coherent, bounds
from movers.random_pairs import KINDS, Kind, random_pair
from oracles.screw import Mover, Truth, screw_first_contact
from oracles.screw_sampling import sampled_overlap

from obbcli import Status

SEEDS = {"translating": 60, "one_turning": 40, "both_turning": 40}
MANY = 400


@cache
def true_answer(kind: Kind, seed: int) -> Truth:
    return screw_first_contact(*random_pair(kind, seed), 1.0)


@pytest.mark.parametrize("kind", KINDS)
def test_random_pair_has_the_oracles_answer(kind: Kind) -> None:
    statuses = []
    for seed in range(SEEDS[kind]):
        a, b = random_pair(kind, seed)
        truth = true_answer(kind, seed)

        answer = ask(a, b, 1.0)

        statuses.append(answer.status)
        assert answer.status == truth.status, seed
        assert_coherent(answer, a, b, 1.0)
        if truth.status == "contact":
            assert answer.evidence == "intersecting", seed
            assert_bracket(answer, truth.lo, truth.hi)
    assert min(statuses.count(one) for one in (Status.CONTACT, Status.SEPARATED)) > 8


@pytest.mark.parametrize("kind", KINDS)
def test_no_overlap_is_sampled_before_the_proven_time(kind: Kind) -> None:
    hits = 0
    for seed in range(1000, 1040):
        a, b = random_pair(kind, seed)

        answer = ask(a, b, 1.0)

        free = 1.0
        if answer.status is Status.CONTACT:
            hits += 1
            free = np.nextafter(float(bounds(answer)[0]), 0)
        times = np.concatenate((np.linspace(0, free, 60), free * (1 - np.logspace(-15, -3, 12))))
        assert sampled_overlap(a, b, 1.0, times) is None, seed
    assert 10 < hits < 36


def test_evidence_of_many_random_pairs_holds() -> None:
    for seed in range(2000, 2000 + MANY):
        kind = KINDS[seed % 3]
        a, b = random_pair(kind, seed)

        answer = ask(a, b, 1.0)

        assert answer.status in {Status.CONTACT, Status.SEPARATED}, (kind, seed)
        assert_coherent(answer, a, b, 1.0)


@pytest.mark.parametrize("kind", KINDS)
def test_limited_search_keeps_a_proven_bound(kind: Kind) -> None:
    unresolved = 0
    for seed in range(20):
        a, b = random_pair(kind, seed)
        truth = true_answer(kind, seed)
        last = 0.0
        for most in (1, 10, 40, 100):
            answer = ask(a, b, 1.0, max_iterations=most)

            if answer.status is not Status.UNRESOLVED:
                assert answer.status == truth.status, (seed, most)
                continue
            unresolved += 1
            assert answer.time_bounds is not None
            lo, hi = answer.time_bounds
            assert hi is None
            assert answer.evidence is None
            assert last <= lo <= (1 if truth.hi is None else truth.hi), (seed, most)
            last = lo
    assert unresolved > 20


@pytest.mark.parametrize("tolerance", [0.25, 1e-3, 1e-7])
@pytest.mark.parametrize("kind", KINDS)
def test_search_that_may_stop_near_keeps_its_bounds(kind: Kind, tolerance: float) -> None:
    near = 0
    for seed in range(20):
        a, b = random_pair(kind, seed)
        truth = true_answer(kind, seed)

        answer = ask(a, b, 1.0, distance_tolerance=tolerance)

        assert_coherent(answer, a, b, 1.0)
        if answer.status is Status.SEPARATED:
            assert truth.status == "separated", seed
            continue
        assert truth.hi is None or bounds(answer)[0] <= truth.hi, seed
        if answer.evidence == "within_tolerance":
            near += 1
            assert answer.distance is not None
            assert answer.distance <= tolerance, seed
    assert kind == "translating" or near > 0


@pytest.mark.parametrize("turns", [3, 30])
def test_fast_turning_pair_has_the_oracles_answer(turns: int) -> None:
    for seed in range(3000, 3006):
        a, b = (faster(body, turns) for body in random_pair("one_turning", seed))
        truth = screw_first_contact(a, b, 1.0)

        answer = ask(a, b, 1.0)

        assert answer.status == truth.status, seed
        assert_coherent(answer, a, b, 1.0)
        if truth.status == "contact":
            assert_bracket(answer, truth.lo, truth.hi)


def faster(body: Mover, turns: int) -> Mover:
    """Return a body that turns so often, where it turns at all."""
    speed = float(np.linalg.norm(body.spin))
    spin = body.spin * (2 * np.pi * turns / speed) if speed else body.spin
    pose = body.rotation, body.translation
    return Mover(body.vertices, body.faces, *pose, body.velocity, spin, body.pivot)
