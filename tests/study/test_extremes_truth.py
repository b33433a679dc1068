"""Extremes of worst cases against rational arithmetic: the answers, and the bounds themselves."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
import pytest
from oracles.moving import first_contact_triangles

from obbcli import Body, Mesh, Motion, Status, first_contact
from obbcli.questions.pair_question import PairQuestion
from obbcli.study.stability.battery import plan
from obbcli.study.stability.world import Trees, pair_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.study.stability.world import Pair

    Floats = NDArray[np.float64]

    Row = list[Fraction]

# Where no rotation is exact: lengths alone can be compared.
TURNED = "rotate the world"
# Those that keep every vertex in its row.
IN_ORDER = {"scale by 2^k", "scale by 10^k", "shift the world", "common velocity"}
IN_ORDER |= {"time by 2^k", "time by 10^k", "tilt B", "round coordinates", TURNED}


def up(height: float) -> Floats:
    return np.array([0.0, 0.0, height])


def worst_case(seed: int) -> Pair:
    """Return two triangles that close in: near-parallel, thin, or corner to corner, by seed."""
    rng = np.random.default_rng(seed)
    first = rng.uniform(-1, 1, (3, 3))
    if seed % 4 == 0:  # faces all but parallel
        second = first + up(0.25) + rng.uniform(-1, 1, (3, 3)) * 1e-13
    elif seed % 4 == 1:  # needles
        first[2] = first[0] + (first[1] - first[0]) * 0.5 + rng.uniform(-1, 1, 3) * 1e-12
        second = rng.uniform(-1, 1, (3, 3)) + up(1.0)
    elif seed % 4 == 2:  # corner on corner, on a grid
        first = np.round(first * 16) / 16
        second = np.round(rng.uniform(0, 1, (3, 3)) * 16) / 16
        second += first[0] - second[0] + up(1.0)
    else:
        second = rng.uniform(-1, 1, (3, 3)) + up(1.5)
    bodies = (
        Body(Mesh(first, [[0, 1, 2]]), motion=Motion([0, 0, 0.5])),
        Body(Mesh(second, [[0, 1, 2]]), motion=Motion([0.1, 0, -1])),
    )
    return pair_of(PairQuestion.of(*bodies, 2.0))


def truth(pair: Pair) -> Fraction | None:
    """Return the exact first time of contact of all triangles against all."""
    times = [
        first_contact_triangles(
            pair.a.vertices[i], pair.b.vertices[j], pair.a.velocity, pair.b.velocity, pair.duration
        )
        for i in np.unique(pair.a.triangles, axis=0)
        for j in np.unique(pair.b.triangles, axis=0)
    ]
    return min((time for time in times if time is not None), default=None)


@pytest.mark.parametrize("seed", range(8))
def test_answers_at_the_extremes_are_the_exact_ones(seed: int) -> None:
    pair = worst_case(seed)
    exact = truth(pair)
    low, high = (None, None) if exact is None else (float(exact), float(exact))
    seen = 0
    for extreme in plan(pair, low, high):
        changed = extreme.change().pair
        is_whole = all(
            np.isfinite(rows).all()
            for side in changed.sides
            for rows in (side.vertices, side.velocity)
        )
        if not is_whole or changed.largest > 1e306 or len(changed.a.triangles) > 4:
            continue
        answer = first_contact(*Trees().bodies(changed), changed.duration)
        expected = truth(changed)
        seen += 1
        if expected is None:
            assert answer.status is Status.SEPARATED, extreme
            continue
        assert answer.time_bounds is not None, extreme
        first, last = answer.time_bounds
        assert last is not None
        assert Fraction(first) <= expected <= Fraction(last), extreme
        assert Fraction(last) - Fraction(first) <= Fraction(np.spacing(last)), extreme
    assert seen > 100


def rows(values: object) -> list[Row]:
    return [[Fraction(x) for x in row] for row in np.asarray(values).tolist()]


def gaps(pair: Pair, time: Fraction) -> list[Row]:
    """Return every vertex of B relative to every vertex of A at a time, exactly."""
    a, b = (
        [
            [x + time * Fraction(v) for x, v in zip(row, side.velocity.tolist(), strict=True)]
            for row in rows(side.vertices)
        ]
        for side in pair.sides
    )
    return [[x - y for x, y in zip(q, p, strict=True)] for p in a for q in b]


def square(row: Row) -> Fraction:
    return sum((x * x for x in row), Fraction(0))


@pytest.mark.parametrize("seed", range(8))
def test_no_point_is_further_off_than_the_bound(seed: int) -> None:
    pair = worst_case(seed)
    seen, tight = set(), 0
    for extreme in plan(pair, 0.5, 0.5):
        if extreme.family not in IN_ORDER:
            continue
        changed = extreme.change()
        if not np.isfinite([changed.pair.largest, changed.bound]).all():
            continue
        bound, unit = Fraction(changed.bound), Fraction(changed.length)
        if "x, y, z" in extreme.name or (not bound and extreme.family == TURNED):
            continue
        seen.add(extreme.family)
        for time in (Fraction(0), Fraction(pair.duration)):
            old = gaps(pair, time)
            new = [[x / unit for x in row] for row in gaps(changed.pair, time * changed.clock)]
            for before, after in zip(old, new, strict=True):
                if extreme.family == TURNED:
                    # sqrt(p) <= sqrt(q) + e, squared twice.
                    large, small = sorted([square(before), square(after)], reverse=True)
                    over = large - small - bound * bound
                    assert over <= 0 or over * over <= 4 * bound * bound * small, extreme
                    continue
                off = square([x - y for x, y in zip(after, before, strict=True)])
                assert off <= bound * bound, extreme
                tight += off * 100 > bound * bound > 0
    assert seen == IN_ORDER
    assert tight > 20
