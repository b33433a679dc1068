"""The extremes that write the same surfaces in another way, or in fewer digits, or tilt them."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from obbcli.study.stability.extremes import Changed, Extreme
from obbcli.study.stability.world import SLACK, longest, two_sum

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from obbcli.accuracy import Accuracy
    from obbcli.study.stability.world import Floats, Pair, Side

SEEDS = (1, 2, 3)
COPIES = (2, 4, 16)
# Larger meshes are not split or copied any further: the answer costs what their triangles do.
MOST_TRIANGLES = 400_000
TILTS = (1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-15, 1e-16)
# Bits of a mantissa: 24 are those of float32.
BITS = (48, 40, 32, 24, 16, 11)
_AXIS = np.array([0.8, -0.36, 0.48])


def swapped(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with A and B in each other's place."""
    swap = pair._replace(a=pair.b, b=pair.a, accuracy=_swapped_depths(pair))
    yield Extreme("swap A and B", "swapped", 1.0, lambda: Changed(swap, is_same=pair.is_exact))


def _swapped_depths(pair: Pair) -> Accuracy:
    asked = pair.accuracy
    return replace(asked, max_depth_a=asked.max_depth_b, max_depth_b=asked.max_depth_a)


def permuted(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with triangles, then vertices, in random orders."""
    for family, change in (("permute triangles", _dealt), ("permute vertices", _renumbered)):
        for seed in SEEDS:
            yield Extreme(
                family,
                f"order {seed}",
                float(seed),
                partial(_each, pair, change, seed),
            )


def _lossless(pair: Pair, a: Side, b: Side) -> Changed:
    return Changed(pair._replace(a=a, b=b), is_same=pair.is_exact)


def _each(pair: Pair, change: Callable[[Side, int], Side], number: int) -> Changed:
    return _lossless(pair, *(change(side, number) for side in pair.sides))


def _dealt(side: Side, seed: int) -> Side:
    order = np.random.default_rng(seed).permutation(len(side.triangles))
    return side._replace(triangles=side.triangles[order])


def _renumbered(side: Side, seed: int) -> Side:
    order = np.random.default_rng(seed).permutation(len(side.vertices))
    place = np.empty(len(order), dtype=np.int32)
    place[order] = np.arange(len(order), dtype=np.int32)
    return side._replace(vertices=side.vertices[order], triangles=place[side.triangles])


def reversed_windings(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with triangles turned inside out: of A, of B, of both."""
    a, b = (side._replace(triangles=side.triangles[:, ::-1]) for side in pair.sides)
    for number, (name, sides) in enumerate(
        {"of A": (a, pair.b), "of B": (pair.a, b), "of both": (a, b)}.items(), 1
    ):
        yield Extreme(
            "reverse windings",
            name,
            float(number),
            partial(_lossless, pair, *sides),
        )


def repeated(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with every triangle there several times."""
    count = max(len(side.triangles) for side in pair.sides)
    for copies in COPIES:
        if count * copies > MOST_TRIANGLES:
            return
        yield Extreme(
            "repeat triangles",
            f"{copies} times",
            float(copies),
            partial(_each, pair, _copied, copies),
        )


def _copied(side: Side, copies: int) -> Side:
    return side._replace(triangles=np.tile(side.triangles, (copies, 1)))


def split(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with each triangle cut into 4, 16 and 64 at the middles of its sides."""
    count = max(len(side.triangles) for side in pair.sides)
    for times in (1, 2, 3):
        if count * 4**times > MOST_TRIANGLES:
            return
        yield Extreme(
            "split triangles",
            f"into {4**times}",
            4.0**times,
            partial(_split_pair, pair, times),
        )


def _split_pair(pair: Pair, times: int) -> Changed:
    bound, sides = 0.0, []
    for side in pair.sides:
        now = side
        for _ in range(times):
            now, off = _split(now)
            bound += off
        sides.append(now)
    asked = pair._replace(a=sides[0], b=sides[1])
    if bound == 0:
        return Changed(asked, is_same=pair.is_exact)
    return Changed(asked, bound * SLACK, "middles that no double holds were rounded, as measured")


def _split(side: Side) -> tuple[Side, float]:
    """Return a side with triangles cut into four, and how far middles were rounded."""
    corners = side.vertices[side.triangles]
    total, error = two_sum(corners, np.roll(corners, -1, axis=1))
    middles = total / 2
    off = longest(error.reshape(-1, 3)) / 2
    if not np.array_equal(2 * middles, total):
        off += 2.0**-1074  # the half of an odd subnormal
    p, q, r = (corners[:, i] for i in range(3))
    pq, qr, rp = (middles[:, i] for i in range(3))
    pieces = [p, pq, rp, pq, q, qr, rp, qr, r, pq, qr, rp]
    vertices = np.stack(pieces, axis=1).reshape(-1, 3)
    triangles = np.arange(len(vertices), dtype=np.int32).reshape(-1, 3)
    return side._replace(vertices=vertices, triangles=triangles), off


def coarsened(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with coordinates rounded to fewer bits: at 24 to float32, as STL does."""
    for bits in BITS:
        name = "float32" if bits == 24 else f"{bits} bits"
        yield Extreme(
            "round coordinates",
            name,
            2.0**-bits,
            partial(_coarsened, pair, bits),
        )


def _coarsened(pair: Pair, bits: int) -> Changed:
    bound, sides = 0.0, []
    for side in pair.sides:
        rounded = _rounded(side.vertices, bits)
        bound += longest(rounded - side.vertices) * SLACK
        sides.append(side._replace(vertices=rounded))
    asked = pair._replace(a=sides[0], b=sides[1])
    if bound == 0:
        return Changed(asked, is_same=True, why="the coordinates have no more digits than that")
    return Changed(asked, bound, "coordinates were rounded, as measured")


def _rounded(values: Floats, bits: int) -> Floats:
    """Return values rounded to a number of bits; the exponents stay those of doubles."""
    mantissa, exponent = np.frexp(values)
    return np.asarray(np.ldexp(np.round(np.ldexp(mantissa, bits)), exponent - bits))


def tilted(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with B tilted about the middle of its box: faces that were parallel are not.

    The pivot stays where it is.
    """
    for angle in TILTS:
        yield Extreme(
            "tilt B",
            f"{angle:.0e} rad",
            angle,
            partial(_tilted, pair, angle),
        )


def _tilted(pair: Pair, angle: float) -> Changed:
    side = pair.b
    low, high = side.vertices.min(axis=0), side.vertices.max(axis=0)
    middle = low / 2 + high / 2
    arms = side.vertices - middle
    # R x - x alone is added: a turn this small would be lost in R x itself.
    vertices = side.vertices + _turn_less_one(angle, arms)
    points = longest(vertices - side.vertices) * SLACK
    asked = pair._replace(b=side._replace(vertices=vertices))
    if points == 0:
        return Changed(asked, is_same=True, why="no coordinate changed: less than half an ulp")
    return Changed(asked, points, "vertices were turned away, as measured")


def _turn_less_one(angle: float, arms: Floats) -> Floats:
    """Return R x - x for a turn about the axis, to full relative accuracy."""
    across = np.cross(_AXIS, arms)
    half = math.sin(angle / 2)
    return np.asarray(math.sin(angle) * across + 2 * half * half * np.cross(_AXIS, across))


def cut(pair: Pair, low: float | None, high: float | None) -> Iterator[Extreme]:
    """Yield the pair with the duration ending just before, at and just after its contact.

    Args:
        pair: the question.
        low: s; no contact before it. None: none at all.
        high: s; contact then. None: none is proven.
    """
    ends = _ends(pair.duration, low, high)
    for name, magnitude, end in ends:
        if 0 <= end <= pair.duration:
            yield Extreme(
                "cut the duration",
                name,
                magnitude,
                partial(Changed, pair._replace(duration=end), 0.0, "before lo none, at hi contact"),
            )


def _ends(
    duration: float, low: float | None, high: float | None
) -> Iterator[tuple[str, float, float]]:
    if duration == 0:
        return
    if low is None:
        for share in (0.9, 0.5, 0.1, 1e-3, 1e-6):
            yield f"to {share:g} of it", share, duration * share
        return
    steps = (1e-3, 1e-6, 1e-9, 1e-12)
    if low > 0:
        for step in steps:
            yield f"{step:.0e} before", step, low * (1 - step)
        yield "1 ulp before", 2.0**-52, float(np.nextafter(low, 0))
    if high is not None:
        yield "at contact", 0.0, high
        yield "1 ulp after", 2.0**-52, float(np.nextafter(high, np.inf))
        for step in steps[::-1]:
            yield f"{step:.0e} after", step, high * (1 + step)


def spun(pair: Pair) -> Iterator[Extreme]:
    """Yield the pair with angular velocities up to a million times as large.

    The answers are others; each is checked by itself.
    """
    if not pair.is_turning:
        return
    for power in range(7):
        yield Extreme(
            "angular speed",
            f"1e{power} times",
            10.0**power,
            partial(_spun, pair, 10.0**power),
        )


def _spun(pair: Pair, factor: float) -> Changed:
    a, b = (side._replace(spin=side.spin * factor) for side in pair.sides)
    why = "posed at rest they are apart before the bracket, and meet at its end"
    return Changed(pair._replace(a=a, b=b), why=why, is_related=False)
