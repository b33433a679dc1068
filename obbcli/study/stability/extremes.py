"""The extremes that change a question's numbers and not its answer: place, velocity, rotation.

Each gives the changed question, how lengths and times in it compare, and a bound on how far the
rounding of the changed input may have moved any point: what the answers may differ by.
"""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.motion.pose import Pose
from obbcli.motion.rotation import rotation_matrix
from obbcli.study.stability.world import SLACK, UNIT, Pair, Side, longest, two_sum

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from obbcli.study.stability.world import Floats

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
        clock: a time of the original on the changed question's clock; exact.
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
        magnitude: by how much, as a number for the axis of a plot.
        change: makes the changed question.
    """

    family: str
    name: str
    magnitude: float
    change: Callable[[], Changed]


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
