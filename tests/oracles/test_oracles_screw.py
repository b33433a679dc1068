from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest
from movers.cases import foreign_mover, rigid_mover
from movers.random_pairs import KINDS, Kind, random_pair
from oracles.gaps import gap_at, places_at
from oracles.mesh import mesh_distance_squared
from oracles.rigid import rigid_points
from oracles.screw import Mover, Truth, scaled, screw_first_contact
from oracles.screw_bounds import DOUBLE
from oracles.screw_features import feature_pairs
from oracles.screw_sampling import sampled_overlap
from oracles.still import root, triangles_intersect
from scenes import cases

WORDS = {"contact": "contact", "none": "separated", "initial": "overlap_at_start"}


def width(truth: Truth) -> float:
    assert truth.lo is not None
    assert truth.hi is not None
    return float(truth.hi - truth.lo)


@pytest.mark.parametrize("case", cases.rigid_ccd(), ids=lambda case: str(case["name"]))
def test_rigid_case_has_its_certified_bracket(case: dict[str, Any]) -> None:
    duration, truth = float(case["T"]), case["truth"]

    found = screw_first_contact(rigid_mover(case["A"]), rigid_mover(case["B"]), duration)

    if case["category"] == "grazing_exact":
        # An instant's contact at an irrational time: nothing after it proves it.
        assert found.status == "undecided"
        return
    assert found.status == WORDS[truth["status"]]
    if found.status == "contact":
        # The file's times are printed doubles.
        slack = 2e-16 * duration
        assert found.lo is not None
        assert found.hi is not None
        assert found.lo <= truth["t_hi"] + slack
        assert found.hi >= truth["t_lo"] - slack
        assert width(found) <= 1e-12 * duration


@pytest.mark.parametrize("case", cases.third_party_ccd(), ids=lambda case: str(case["id"]))
def test_third_party_case_has_its_time(case: dict[str, Any]) -> None:
    bodies = [foreign_mover(case[key]) for key in ("body_a", "body_b")]

    found = screw_first_contact(bodies[0], bodies[1], float(case["t_max"]))

    # A segment that turns onto another in its plane touches it for an instant: undecided.
    assert (found.status != "separated") == case["expected_hit"]
    if found.lo is not None:
        assert float(found.lo) == pytest.approx(case["expected_toi"], abs=case["abs_tol"])


@pytest.mark.parametrize("kind", KINDS)
def test_random_contact_is_proven_at_its_end_and_never_sampled_before(kind: Kind) -> None:
    statuses = []
    for seed in range(100, 112):
        a, b = random_pair(kind, seed)

        found = screw_first_contact(a, b, 1.0)

        statuses.append(found.status)
        free = 1.0 if found.lo is None else float(found.lo) * (1 - 1e-15)
        times = np.concatenate((np.linspace(0, free, 60), free * (1 - np.logspace(-14, -3, 12))))
        assert sampled_overlap(a, b, 1.0, times) is None
        if found.hi is not None:
            assert width(found) <= 1e-14
            soon = float(found.hi) + np.logspace(-14, -6, 9)
            assert kind == "translating" or sampled_overlap(a, b, 1.0, soon) is not None
    assert {"contact", "separated"} == set(statuses)


def test_features_stay_apart_as_long_as_proven() -> None:
    random = np.random.default_rng(1)
    a, b = random_pair("both_turning", 3)
    proven = 0
    for features in feature_pairs(a.faces, b.faces):
        chosen = random.integers(len(features.a), size=40)
        index_a, index_b = features.a[chosen], features.b[chosen]
        start = random.uniform(0.2, 0.8, len(chosen))

        before, after = scaled(a, b, 1.0, DOUBLE).apart(index_a, index_b, start)

        # The bounds hold within the question's interval.
        reach = np.minimum.reduce((before, after, start, 1 - start))
        for i, share in product(np.flatnonzero(reach > 0), (-1.0, -0.9, 0.0, 0.9, 1.0)):
            proven += 1
            time = Fraction(float(start[i])) + Fraction(share * reach[i])
            one, two = a.at(time, index_a[i]), b.at(time, index_b[i])
            assert not triangles_intersect(as_triangle(one), as_triangle(two))
    assert proven > 100


@pytest.mark.parametrize("number", [0, 1, 2], ids=["world", "a", "b"])
def test_frames_bound_accelerations_and_not_by_far(number: int) -> None:
    random = np.random.default_rng(2)
    shares: list[list[float]] = [[], []]
    for seed in range(40):
        a, b = random_pair("both_turning", seed)
        if seed % 2:
            # One pivot for both, so that the turning alone counts.
            a, b = (replace(m, velocity=(0, 0, 0), pivot=(0, 0, 0)) for m in (a, b))
        frame = scaled(a, b, 1.0, DOUBLE).frames[number]
        i, j = (int(random.integers(len(body.start))) for body in (a, b))
        # The first and last times matter: there the pivots are farthest apart.
        time = random.choice([0.01, 0.5, 0.99])

        pull = acceleration(a, b, (i, j), frame.spin, time)

        bound = float(frame.reach_a[i] + frame.reach_b[j] + frame.pivots)
        unit = 2.0 ** np.floor(
            np.log2(max(np.abs(np.subtract(m.start, m.pivot)).max() for m in (a, b)))
        )
        shares[seed % 2].append(pull / unit / bound)
    assert all(0.5 < max(some) <= 1.0 for some in shares)


def acceleration(a: Mover, b: Mover, corners: tuple[int, int], spin: Any, time: float) -> float:
    """Return how fast vertex j of B accelerates past vertex i of A in a turning frame."""
    step = Fraction(1, 10**10)
    places = []
    for moment in (Fraction(time) + k * step for k in (-1, 0, 1)):
        (p,), (q,) = a.at(moment, corners[:1]), b.at(moment, corners[1:])
        apart = [y - x for x, y in zip(p, q, strict=True)]
        turned_back = [-w for w in spin.tolist()]
        places.append(rigid_points([apart], (0, 0, 0), turned_back, (0, 0, 0), moment)[0])
    before, now, after = places
    pull = [float((x - 2 * y + z) / step**2) for x, y, z in zip(before, now, after, strict=True)]
    return float(np.linalg.norm(pull))


def as_triangle(points: list[Any]) -> list[Any]:
    """Return one to three points as a triangle, degenerate where they are fewer."""
    return points + points[-1:] * (3 - len(points))


@pytest.mark.parametrize("power", [-30, 30])
def test_first_contact_scales_with_lengths_and_time(power: int) -> None:
    a, b = random_pair("both_turning", 100)
    k = 2.0**power
    large = [
        Mover(
            m.vertices * k, m.faces, m.rotation, m.translation * k, m.velocity, m.spin / k,
            m.pivot * k,
        )
        for m in (a, b)
    ]  # fmt: skip

    small, big = screw_first_contact(a, b, 1.0), screw_first_contact(*large, k)

    assert small.status == big.status
    assert small.lo is None or float(big.lo or 0) == pytest.approx(float(small.lo) * k, rel=1e-14)


@pytest.mark.parametrize("kind", KINDS)
def test_gap_is_the_distance_of_surfaces_that_are_apart(kind: Kind) -> None:
    for seed in range(4):
        a, b = random_pair(kind, seed)
        surfaces = [(places_at(body, 0.0), body.faces) for body in (a, b)]
        square, _ = mesh_distance_squared(*surfaces[0], *surfaces[1])

        assert gap_at(a, b, 0.0) == pytest.approx(float(root(square)), rel=1e-12)
        for body in (a, b):
            off = places_at(body, 0.375) - np.array(body.at(0.375), dtype=np.float64)
            assert np.abs(off).max() <= 1e-14
