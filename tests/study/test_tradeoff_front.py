"""The front, the recommendations and the timings of a trade, against brute force."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from obbcli import Accuracy, FirstContact, QueryStats, Status, Tradeoff
from obbcli.study.tradeoff.trials import Timing, Trial, front_of

# Few values, so that many points are equal in one coordinate or both.
ERRORS = (None, 0.0, 1e-9, 1e-3, 0.1, 0.5, math.inf)
POINTS = st.lists(st.sampled_from([(e, t) for e in ERRORS for t in (1.0, 2.0, 3.0, 4.0)]))
STATS = QueryStats(1, 1, 0, 1, 0, 1, 1, 1, 1, {})
ANSWER = FirstContact(status=Status.CONTACT, time=0.5, time_bounds=(0.5, 0.5), stats=STATS)


def beats(p, q) -> bool:
    """Return whether one point makes another useless."""
    return p[0] <= q[0] and p[1] <= q[1] and p != q


def trial(error, median: float, *, proven: bool = True, gap=None) -> Trial:
    """Return a row of given error and time."""
    wrong = error == math.inf
    return Trial(
        build={}, accuracy=Accuracy(), answer=replace(ANSWER, approximate=not proven),
        is_verdict_wrong=wrong, time_error=None if wrong or error is None else -error, gap=gap,
        claims_checked=1, faults=(), warm=Timing.of([median], median), build_seconds=1.0,
        tree_bytes=1,
    )  # fmt: skip


def trade(rows) -> Tradeoff:
    """Return a study that measured some rows."""
    return Tradeoff(
        reference=ANSWER, reference_accuracy=Accuracy(), duration=1.0, rows=tuple(rows),
        unreached=(), budget=1.0, seconds=1.0,
    )  # fmt: skip


@given(POINTS)
def test_front_is_what_brute_force_says(points):
    known = [p for p in points if p[0] is not None and p[0] < math.inf]

    chosen = front_of(points)

    assert chosen == [p in known and not any(beats(q, p) for q in known) for p in points]


@given(POINTS, st.floats(0, 1), st.integers(0, 2**32))
def test_recommendations_are_the_best_of_what_fits(points, limit, seed):
    dice = random.Random(seed)
    rows = [trial(*point, proven=dice.random() < 0.5) for point in points]
    found = trade(rows)
    for proven in (False, True):
        fit = [r for r in rows if r.error is not None and r.error < math.inf]
        fit = [r for r in fit if r.is_proof or not proven]

        cheap = found.cheapest(limit, proven=proven)
        exact = found.most_accurate(4 * limit, proven=proven)

        cheaper = [(r.warm.median, r.error) for r in fit if r.error <= limit]
        assert cheap is None if not cheaper else (cheap.warm.median, cheap.error) == min(cheaper)
        nearer = [(r.error, r.warm.median) for r in fit if r.warm.median <= 4 * limit]
        assert exact is None if not nearer else (exact.error, exact.warm.median) == min(nearer)


def test_cheapest_looks_at_the_gap_where_it_is_asked():
    rows = [trial(1e-3, 1.0, gap=0.5), trial(1e-3, 2.0, gap=0.01), trial(0.0, 3.0)]

    assert trade(rows).cheapest(1e-2, max_gap=0.1) is rows[1]
    assert trade(rows).cheapest(0.0) is rows[2]
    assert trade(rows).cheapest() is rows[0]


def test_timing_has_median_quartiles_and_rounds():
    timing = Timing.of([5.0, 1.0, 4.0, 2.0, 3.0], 99.0)

    assert (timing.median, timing.low_quartile, timing.high_quartile) == (3.0, 2.0, 4.0)
    assert timing.rounds == 5
    assert timing.interval is None


def test_timing_of_no_rounds_is_that_of_the_first_call():
    timing = Timing.of([], 7.0)

    assert (timing.median, timing.rounds, timing.interval) == (7.0, 0, None)


# Ranks from below, from tables of the sign test.
@pytest.mark.parametrize(
    ("count", "rank"), [(5, None), (6, 1), (8, 1), (9, 2), (12, 3), (15, 4), (20, 6), (25, 8)]
)
def test_interval_holds_the_median_by_the_sign_test(count, rank):
    times = [float(k) for k in range(1, count + 1)]

    interval = Timing.of(times[::-1], 0.0).interval

    assert interval == (None if rank is None else (float(rank), float(count + 1 - rank)))
