"""The extremes that change units: of length, and of time."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Protocol

import numpy as np

from obbcli.study.stability.extremes import Changed, Extreme
from obbcli.study.stability.world import UNIT, Pair, Side, longest

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.study.stability.world import Floats

POWERS_OF_TWO = (1, 10, 100, 300, 500, 800, 1000, 1020)
POWERS_OF_TEN = (1, 3, 6, 12, 30, 100, 200, 300)


class _Change(Protocol):
    def __call__(self, pair: Pair, factor: float, *, is_binary: bool) -> Changed: ...


def scaled(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with all lengths times k."""
    yield from _by_powers(pair, "scale", _scaled)


def timed(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with velocities times k, and the duration divided by it."""
    if pair.duration > 0:
        yield from _by_powers(pair, "time", _timed)


def _by_powers(pair: Pair, what: str, change: _Change) -> Iterator[Extreme]:
    """Yield changes by powers of two, which lose no bit, and of ten."""
    for base, powers in ((2, POWERS_OF_TWO), (10, POWERS_OF_TEN)):
        for power in powers:
            for signed in (power, -power):
                name = f"2^{signed}" if base == 2 else f"1e{signed}"
                factor = 2.0**signed if base == 2 else float(name)
                made = partial(change, pair, factor, is_binary=base == 2)
                yield Extreme(f"{what} by {base}^k", name, factor, made)


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
