"""The extremes that change a question's numbers and not its answer: scale, place, clock, order.

Each gives the changed question, how lengths and times in it compare, and a bound on how far the
rounding of the changed input may have moved any point: what the answers may differ by.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.pose import Pose
from obbcli.rotation import rotation_matrix
from obbcli.study.world import SLACK, UNIT, Pair, Side, longest, two_sum

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from obbcli.study.world import Floats

POWERS_OF_TWO = (1, 10, 100, 300, 500, 800, 1000, 1020)
POWERS_OF_TEN = (1, 3, 6, 12, 30, 100, 200, 300)
SHIFTS = (3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 15)
VELOCITIES = (0, 1, 2, 3, 4, 6, 8, 10, 12, 15)
TURNS = (1e-9, 1e-3, 0.5, 1.0, 2.0, 3.0)
# No coordinate axis, no diagonal: nothing cancels by luck.
_DIRECTION = np.array([0.6, -0.64, 0.48])
_AXIS = np.array([0.36, 0.48, -0.8])

NOTHING_ROUNDED = "nothing is rounded"


class Changed(NamedTuple):
    """A changed question.

    Attributes:
        pair: the question.
        bound: mesh units of the original: no point is further than this from where the original
            has it, at any time.
        why: how the bound was derived.
        is_same: whether the answer must have the same bits.
        length: a length of the original in the changed question's unit.
        clock: likewise of a time; exact.
        is_related: whether the original's answer holds of it; if not, it is checked by itself.
    """

    pair: Pair
    bound: float = 0.0
    why: str = NOTHING_ROUNDED
    is_same: bool = False
    length: float = 1.0
    clock: Fraction = Fraction(1)
    is_related: bool = True


class Extreme(NamedTuple):
    """One extreme that is to be tried.

    Attributes:
        family: what is changed.
        name: by how much, in words.
        magnitude: likewise as a number, for the axis of a plot.
        change: makes the changed question.
    """

    family: str
    name: str
    magnitude: float
    change: Callable[[], Changed]


def scaled(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair in other units: powers of two, which round nothing, and of ten."""
    for power in POWERS_OF_TWO:
        for sign in (1, -1):
            yield Extreme(
                "scale by 2^k",
                f"2^{sign * power}",
                2.0 ** (sign * power),
                partial(_scaled, pair, 2.0 ** (sign * power), is_binary=True),
            )
    for power in POWERS_OF_TEN:
        for sign in (1, -1):
            yield Extreme(
                "scale by 10^k",
                f"1e{sign * power}",
                float(f"1e{sign * power}"),
                partial(_scaled, pair, float(f"1e{sign * power}"), is_binary=False),
            )


def _scaled(pair: Pair, factor: float, *, is_binary: bool) -> Changed:
    with np.errstate(over="ignore", under="ignore"):
        a, b = (
            side._replace(
                vertices=side.vertices * factor,
                velocity=side.velocity * factor,
                pivot=side.pivot * factor,
            )
            for side in pair.sides
        )
    asked = pair.accuracy
    near = asked.distance_tolerance
    accuracy = replace(
        asked,
        clearance=_within(asked.clearance * factor),
        distance_tolerance=None if near is None else _within(near * factor),
    )
    changed = Pair(a, b, pair.duration, accuracy)
    if is_binary and all(
        _is_back(old, new, factor) for old, new in zip(pair.sides, changed.sides, strict=True)
    ):
        return Changed(changed, is_same=True, length=factor)
    bound = sum(_scaled_by(side, pair.duration, factor) for side in pair.sides)
    bound += 4 * UNIT * asked.clearance
    why = "a product is off by 2^-53 of itself, or by 2^-1075 where it is subnormal"
    return Changed(changed, bound, why, length=factor)


def _within(value: float) -> float:
    """Return a tolerance as a double."""
    return min(value, float(np.finfo(float).max))


def _is_back(old: Side, new: Side, factor: float) -> bool:
    """Return whether scaling by a power of two lost no bit."""
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        return all(
            np.array_equal(before, after / factor)
            for before, after in (
                (old.vertices, new.vertices),
                (old.velocity, new.velocity),
                (old.pivot, new.pivot),
            )
        )


def _scaled_by(side: Side, duration: float, factor: float) -> float:
    """Return how far products by `factor` move points, in the units before it."""
    tiny = 2.0**-1074 / factor

    def off(rows: Floats) -> float:
        return 2.0 * (UNIT * longest(rows) + tiny)

    return side.off_by(
        duration,
        points=off(side.vertices),
        pivot=off(side.pivot[None]),
        velocity=off(side.velocity[None]),
    )


def shifted(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair far from the origin."""
    for power in SHIFTS:
        yield Extreme(
            "shift the world",
            f"1e{power} sizes",
            10.0**power,
            partial(_shifted, pair, pair.size * 10.0**power * _DIRECTION),
        )


def _shifted(pair: Pair, shift: Floats) -> Changed:
    changed, bound = [], 0.0
    for side in pair.sides:
        vertices, points = _sum(side.vertices, shift)
        pivot, off = _sum(side.pivot, shift)
        changed.append(side._replace(vertices=vertices, pivot=pivot))
        bound += side.off_by(pair.duration, points=points, pivot=off)
    spacing = float(np.spacing(np.abs(shift).max()))
    why = f"coordinates round to the grid of doubles there, {spacing:.2g} apart, as measured"
    return _changed(pair, changed, bound, why)


def _sum(rows: Floats, shift: Floats) -> tuple[Floats, float]:
    """Return rounded sums, and the longest error of a row: exact, by Knuth's two-sum."""
    total, error = two_sum(rows, shift)
    return total, longest(np.atleast_2d(error)) * SLACK


def hurried(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with a velocity that both bodies have in common."""
    if pair.duration == 0:
        return
    unit = pair.size / pair.duration
    for power in VELOCITIES:
        yield Extreme(
            "common velocity",
            f"1e{power} sizes",
            10.0**power,
            partial(_hurried, pair, unit * 10.0**power * _DIRECTION),
        )


def _hurried(pair: Pair, velocity: Floats) -> Changed:
    changed, bound = [], 0.0
    for side in pair.sides:
        total, off = _sum(side.velocity, velocity)
        changed.append(side._replace(velocity=total))
        bound += side.off_by(pair.duration, velocity=off)
    why = "sums of velocities are rounded, as measured, and this lasts the duration"
    return _changed(pair, changed, bound, why)


def _changed(pair: Pair, sides: list[Side], bound: float, why: str) -> Changed:
    """Return a change of the sides; one that rounds nothing says so."""
    asked = pair._replace(a=sides[0], b=sides[1])
    if bound == 0:
        return Changed(asked, is_same=pair.is_exact)
    return Changed(asked, bound, why)


def turned(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair in a turned world: a third of a turn about a diagonal, and others."""
    yield Extreme(
        "rotate the world",
        "x, y, z to y, z, x",
        2.0 * np.pi / 3.0,
        partial(_cycled, pair),
    )
    for angle in TURNS:
        yield Extreme(
            "rotate the world",
            f"{angle:g} rad",
            angle,
            partial(_turned, pair, rotation_matrix(_AXIS * angle)),
        )


def _cycled(pair: Pair) -> Changed:
    sides = [
        side._replace(
            vertices=np.roll(side.vertices, 1, axis=1),
            velocity=np.roll(side.velocity, 1),
            spin=np.roll(side.spin, 1),
            pivot=np.roll(side.pivot, 1),
        )
        for side in pair.sides
    ]
    return _changed(pair, sides, 0.0, NOTHING_ROUNDED)


def _turned(pair: Pair, turn: Floats) -> Changed:
    """Return the pair turned by a matrix that is off a rotation by what its rounding did."""
    products = (turn[:, None, :] * turn[None, :, :]).sum(axis=-1)
    defect = float(np.abs(products - np.eye(3)).sum()) + 32 * UNIT
    pose = Pose(turn)
    off = defect + 8 * UNIT
    changed, bound = [], 0.0
    for side in pair.sides:
        vectors = pose.apply(np.array([side.velocity, side.spin, side.pivot]))
        changed.append(
            side._replace(
                vertices=pose.apply(side.vertices),
                velocity=vectors[0],
                spin=vectors[1],
                pivot=vectors[2],
            )
        )
        bound += side.off_by(
            pair.duration,
            points=off * longest(side.vertices),
            pivot=off * longest(side.pivot[None]),
            velocity=off * longest(side.velocity[None]),
            spin=off * longest(side.spin[None]),
        )
    why = f"the matrix is off a rotation by {defect:.2g}, products round by 2^-50 of lengths"
    return _changed(pair, changed, bound, why)


def timed(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with velocities times k, and the duration divided by it."""
    if pair.duration == 0:
        return
    for power in POWERS_OF_TWO:
        for sign in (1, -1):
            yield Extreme(
                "time by 2^k",
                f"2^{sign * power}",
                2.0 ** (sign * power),
                partial(_timed, pair, 2.0 ** (sign * power), is_binary=True),
            )
    for power in POWERS_OF_TEN:
        for sign in (1, -1):
            yield Extreme(
                "time by 10^k",
                f"1e{sign * power}",
                float(f"1e{sign * power}"),
                partial(_timed, pair, float(f"1e{sign * power}"), is_binary=False),
            )


def _timed(pair: Pair, factor: float, *, is_binary: bool) -> Changed:
    tolerance = pair.accuracy.time_tolerance
    with np.errstate(over="ignore", under="ignore"):
        a, b = (
            side._replace(velocity=side.velocity * factor, spin=side.spin * factor)
            for side in pair.sides
        )
        duration = float(np.float64(pair.duration) / factor)
        asked = None if tolerance is None else float(np.float64(tolerance) / factor)
    finite = (duration, asked or 0.0)
    is_finite = bool(np.isfinite(finite).all())
    accuracy = replace(pair.accuracy, time_tolerance=asked) if is_finite else pair.accuracy
    changed = Pair(a, b, duration, accuracy)
    clock = Fraction(1) / Fraction(factor)
    is_back = is_binary and all(
        _is_clock_back(old, new, factor) for old, new in zip(pair.sides, changed.sides, strict=True)
    )
    if is_back and is_finite and Fraction(duration) == Fraction(pair.duration) * clock:
        return Changed(changed, is_same=duration >= 2.0**-960, clock=clock)
    tiny = 2.0**-1074 / factor
    bound = sum(
        side.off_by(
            pair.duration,
            velocity=2.0 * (UNIT * longest(side.velocity[None]) + tiny),
            spin=2.0 * (UNIT * longest(side.spin[None]) + tiny),
        )
        for side in pair.sides
    )
    why = "velocities are off by 2^-53 of themselves, and this lasts the duration"
    return Changed(changed, bound, why, clock=clock)


def _is_clock_back(old: Side, new: Side, factor: float) -> bool:
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        return np.array_equal(old.velocity, new.velocity / factor) and np.array_equal(
            old.spin, new.spin / factor
        )
