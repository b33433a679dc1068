"""The kernels' pairs of travelling boxes against brute force in fractions."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from obbcli import kernels

if TYPE_CHECKING:
    from collections.abc import Sequence

Vector = tuple[float, float, float]
EPSILON = Fraction(1, 2**30)


class Swept(NamedTuple):
    """A box in [low, high] at `start`, and its velocity."""

    body: int
    start: float
    end: float
    low: Vector
    high: Vector
    velocity: Vector


def near_since(a: Swept, b: Swept, reach: Fraction) -> Fraction | None:
    """Return when two boxes first come within reach of each other; None where they never do."""
    first = max(Fraction(a.start), Fraction(b.start))
    last = min(Fraction(a.end), Fraction(b.end))
    for k in range(3):
        for p, q in ((a, b), (b, a)):
            # The room above p and below q at time t is `room + rate t`.
            rate = Fraction(q.velocity[k]) - Fraction(p.velocity[k])
            room = Fraction(q.low[k]) - Fraction(q.velocity[k]) * Fraction(q.start)
            room -= Fraction(p.high[k]) - Fraction(p.velocity[k]) * Fraction(p.start)
            room -= reach
            if rate == 0:
                if room > 0:
                    return None
            elif rate < 0:
                first = max(first, -room / rate)
            else:
                last = min(last, -room / rate)
    return first if first <= last else None


def pairs_in_fractions(boxes: Sequence[Swept], reach: Fraction) -> dict[tuple[int, int], Fraction]:
    """Return when the boxes of two bodies first come within reach, for those that do."""
    found: dict[tuple[int, int], Fraction] = {}
    for a, b in combinations(boxes, 2):
        pair = min(a.body, b.body), max(a.body, b.body)
        time = None if a.body == b.body else near_since(a, b, reach)
        if time is not None:
            found[pair] = min(time, found.get(pair, time))
    return found


def pairs_of(
    boxes: Sequence[Swept],
    reach: float = 0.0,
    groups: Sequence[int] | None = None,
    static: Sequence[bool] | None = None,
    ignored: Sequence[Sequence[bool]] = ((False,),),
) -> list[tuple[int, int, float]]:
    """Return what the kernels find."""
    count = max((box.body for box in boxes), default=-1) + 1
    pairs, times = kernels.swept_pairs(
        np.array([box.body for box in boxes], np.uint32),
        np.array([(box.start, box.end) for box in boxes], float).reshape(-1, 2),
        np.array([(*box.low, *box.high, *box.velocity) for box in boxes], float).reshape(-1, 9),
        np.array([0] * count if groups is None else groups, np.uint32),
        np.array([0] * count if static is None else static, np.uint8),
        np.array(ignored, np.uint8).ravel(),
        len(ignored),
        reach,
    )
    return [(a, b, time) for (a, b), time in zip(pairs.tolist(), times.tolist(), strict=True)]


def is_sandwiched(boxes: Sequence[Swept], reach: float) -> None:
    """Check the kernels' answer between those for a little less and a little more reach."""
    found = pairs_of(boxes, reach)
    times = {(a, b): Fraction(time) for a, b, time in found}
    surely = pairs_in_fractions(boxes, Fraction(reach) - EPSILON)
    perhaps = pairs_in_fractions(boxes, Fraction(reach) + EPSILON)

    assert len(times) == len(found)
    assert surely.keys() <= times.keys() <= perhaps.keys()
    assert all(times[pair] <= surely[pair] for pair in surely)
    assert all(perhaps[pair] - EPSILON <= times[pair] for pair in times)
    assert found == sorted(found, key=lambda row: (row[2], row[0], row[1]))


small = st.integers(-6, 6)
vectors = st.tuples(small, small, small)


@st.composite
def swept(draw: st.DrawFn, bodies: int) -> Swept:
    low, size = draw(vectors), draw(st.tuples(*[st.integers(0, 4)] * 3))
    start = draw(st.integers(0, 3))
    velocity = draw(st.one_of(st.just((0, 0, 0)), vectors, vectors.map(lambda v: _times(v, 40))))
    high = (low[0] + size[0], low[1] + size[1], low[2] + size[2])
    return Swept(
        draw(st.integers(0, bodies - 1)),
        start,
        start + draw(st.integers(0, 4)),
        low,
        high,
        velocity,
    )


def _times(vector: tuple[int, int, int], factor: int) -> tuple[int, int, int]:
    return factor * vector[0], factor * vector[1], factor * vector[2]


@given(boxes=st.lists(swept(bodies=8), max_size=24), reach=st.sampled_from([0.0, 0.5, 2.0]))
@settings(max_examples=300)
def test_pairs_are_those_of_brute_force(boxes: list[Swept], reach: float) -> None:
    is_sandwiched(boxes, reach)


@pytest.mark.parametrize("speed", [0, 1, 100])
@pytest.mark.parametrize("seed", range(3))
def test_many_bodies_are_those_of_brute_force(seed: int, speed: int) -> None:
    rng = np.random.default_rng(seed)
    boxes = []
    for body in range(150):
        low = rng.integers(-30, 30, 3)
        high = low + rng.integers(0, 6, 3)
        velocity = speed * rng.integers(-3, 4, 3)
        boxes.append(Swept(body, 0, 1, *(tuple(v.tolist()) for v in (low, high, velocity))))

    is_sandwiched(boxes, 0.0)
    assert 0 < len(pairs_of(boxes)) < 150 * 149 / 2


def test_touching_at_one_instant_counts() -> None:
    passing = [
        Swept(0, 0, 4, (0, 0, 0), (1, 1, 1), (1, 0, 0)),
        Swept(1, 0, 4, (5, 3, 0), (6, 4, 1), (-1, -1, 0)),
    ]

    # In x from t = 2 to 3, in y from t = 2 on.
    assert pairs_of(passing) == [(0, 1, 2.0)]
    assert pairs_of([passing[0], passing[1]._replace(start=1, end=5)]) == [(0, 1, 3.0)]
    # Two units later y is only reached when x has been left.
    late = passing[1]._replace(low=(5, 5, 0), high=(6, 6, 1))
    assert pairs_of([passing[0], late]) == []


def test_pieces_of_a_body_are_asked_in_their_own_time() -> None:
    there, back = Swept(0, 0, 1, (0, 0, 0), (1, 1, 1), (8, 0, 0)), (-8, 0, 0)
    path = [there, Swept(0, 1, 2, (8, 0, 0), (9, 1, 1), back)]
    wall = Swept(1, 0, 2, (-3, 0, 0), (-2, 1, 1), (0, 0, 0))

    assert pairs_of([*path, wall], 1.5) == []
    assert pairs_of([*path, wall._replace(low=(4, 0, 0), high=(5, 1, 1))]) == [(0, 1, 0.375)]
    assert pairs_of([path[1], wall._replace(low=(4, 0, 0), high=(5, 1, 1))]) == [(0, 1, 1.375)]


def test_static_bodies_and_ignored_groups_are_left_out() -> None:
    boxes = [Swept(k, 0, 1, (0, 0, 0), (1, 1, 1), (0, 0, 0)) for k in range(6)]
    ignored = [[False, False, True], [False, True, False], [True, False, False]]
    groups, static = [0, 0, 1, 1, 2, 2], [True, False, True, False, True, False]

    found = pairs_of(boxes, groups=groups, static=static, ignored=ignored)

    expected = [
        (a, b)
        for a, b in combinations(range(6), 2)
        if not (static[a] and static[b]) and not ignored[groups[a]][groups[b]]
    ]
    assert [(a, b) for a, b, _ in found] == expected


def test_many_static_bodies_meet_what_moves_and_each_other_not() -> None:
    static = [Swept(k, 0, 1, (3 * k, 0, 0), (3 * k + 4, 1, 1), (0, 0, 0)) for k in range(40)]
    mover = Swept(40, 0, 1, (0, 2, 0), (9, 3, 1), (0, -2, 0))
    walls = [True] * 40

    found = pairs_of([*static, mover], static=[*walls, False])

    assert found == [(k, 40, 0.5) for k in range(4)]
    ignored = [[False, True], [True, False]]
    groups = [1] * 2 + [0] * 38 + [1]
    found = pairs_of([*static, mover], static=[*walls, False], groups=groups, ignored=ignored)
    assert found == [(0, 40, 0.5), (1, 40, 0.5)]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e308])
@pytest.mark.parametrize("column", range(9))
def test_what_is_not_finite_may_be_anywhere(column: int, bad: float) -> None:
    far = [Swept(k, 0, 1, (9 * k, 0, 0), (9 * k + 1, 1, 1), (0, 0, 0)) for k in range(12)]
    assert pairs_of(far) == []
    row = [*far[5].low, *far[5].high, *far[5].velocity]
    row[column] = bad
    lost = far[5]._replace(low=tuple(row[:3]), high=tuple(row[3:6]), velocity=tuple(row[6:]))

    found = pairs_of([*far[:5], lost, *far[6:]])

    assert [(a, b) for a, b, _ in found] == [(min(k, 5), max(k, 5)) for k in range(12) if k != 5]
    assert {time for _, _, time in found} == {0.0}


def test_nothing_gives_nothing() -> None:
    assert pairs_of([]) == []
    assert pairs_of([Swept(0, 0, 1, (0, 0, 0), (1, 1, 1), (0, 0, 0))]) == []


@pytest.mark.parametrize(
    ("bodies", "groups", "ignored"), [(1, [0], 1), (0, [1], 1), (0, [0], 2), (0, [0, 0], 1)]
)
def test_numbers_out_of_range_are_refused(bodies: int, groups: list[int], ignored: int) -> None:
    zeros = np.zeros((1, 9))
    with pytest.raises(ValueError, match="out of range"):
        kernels.swept_pairs(
            np.array([bodies], np.uint32),
            np.zeros((1, 2)),
            zeros,
            np.array(groups, np.uint32),
            np.zeros(1, np.uint8),
            np.zeros(ignored, np.uint8),
            1,
            0.0,
        )


def test_scattered_bodies_take_less_than_all_pairs() -> None:
    # A thousand times as many bodies at the same density: quadratic work would take hours.
    rng = np.random.default_rng(0)
    count = 200_000
    places = rng.integers(0, 100, (count, 3)).astype(float)
    pairs, _ = kernels.swept_pairs(
        np.arange(count, dtype=np.uint32),
        np.tile([0.0, 1.0], (count, 1)),
        np.concatenate([places, places + 0.5, rng.uniform(-1, 1, (count, 3))], axis=1),
        np.zeros(count, np.uint32),
        np.zeros(count, np.uint8),
        np.zeros(1, np.uint8),
        1,
        0.0,
    )

    assert count // 10 < len(pairs) < 10 * count
