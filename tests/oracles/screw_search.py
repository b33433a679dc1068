"""The search behind `screw`: time in [0, 1], cut where features are not proven apart."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import mpmath
import numpy as np
from oracles.screw_bounds import places

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from oracles.screw_bounds import Couple, Rotor
    from oracles.screw_features import Features

NARROW = 2.0**-33  # of the whole time: where wide numbers take over from doubles
TIME_UNIT = 2.0**-50  # several roundings of a time in [0, 1]
RADIANS = 2.0  # of turn a first piece of time spans
MOST_PIECES = 40_000
STALL = Fraction(1, 10**16)
MOST_STEPS = 400

Owners = tuple[tuple[int, ...], tuple[int, ...]]


class Pieces(NamedTuple):
    """Pairs of features of one kind, each over its own [start, end]."""

    number: Any
    start: Any
    end: Any


class Search:
    """Finds the first contact of two bodies that are apart at 0."""

    def __init__(
        self,
        coarse: Couple,
        fine: Couple,
        features: list[Features],
        touching: Callable[[Owners, Fraction], bool],
    ) -> None:
        self.coarse, self.fine, self.features = coarse, fine, features
        self.touching = touching
        self.best: Fraction | None = None

    def run(self) -> tuple[Fraction | None, Fraction | None]:
        """Return (lo, hi), (lo, None) where contact is neither proven nor excluded, or Nones."""
        for windows in self._windows():
            left = [self._isolate(kind, windows) for kind in self.features]
            lo = self._close_in(left)
            if lo is not None or self.best is not None:
                return lo, self.best
        return None, None

    def _windows(self) -> Iterator[list[tuple[float, float]]]:
        """Yield pieces of time in order, so many at once as the number of features allows."""
        turn = float(self.coarse.a.speed + self.coarse.b.speed)
        count = max(1, int(np.ceil(turn / RADIANS)))
        ends = np.linspace(0, 1, count + 1)
        most = max(1, MOST_PIECES // max(1, sum(len(kind.a) for kind in self.features)))
        for i in range(0, count, most):
            yield list(zip(ends[i:-1][:most], ends[i + 1 :][:most], strict=True))

    def _isolate(self, kind: Features, windows: list[tuple[float, float]]) -> Pieces:
        """Return what is left of the windows where the pairs are proven apart."""
        every = np.arange(len(kind.a))
        number = np.tile(every, len(windows))
        start, end = (np.repeat([window[i] for window in windows], len(every)) for i in (0, 1))
        pieces, done = Pieces(number, start, end), []
        while len(pieces.number):
            if self.best is not None:
                pieces = _chosen(pieces, pieces.start < float(self.best) + TIME_UNIT)
            pieces = _chosen(pieces, ~self._boxes_apart(kind, pieces))
            pieces = self._cut(kind, pieces)
            narrow = pieces.end - pieces.start < NARROW
            done.append(_chosen(pieces, narrow))
            pieces = _chosen(pieces, ~narrow)
            if len(pieces.number) > 50 * MOST_PIECES:
                raise RuntimeError("too many pieces of time are left: the features stay too near")
            self._try_contact(kind, pieces)
        return Pieces(*(np.concatenate(parts) for parts in zip(*done, strict=True)))

    def _cut(self, kind: Features, pieces: Pieces) -> Pieces:
        """Return the pieces without the middles that are proven, at most half as long each."""
        number, start, end = pieces
        middle = (start + end) / 2
        with np.errstate(over="ignore"):
            apart = self.coarse.apart(kind.a[number], kind.b[number], middle)
        before, after = (np.maximum(s * (1 - 1e-9) - TIME_UNIT, 0) for s in apart)
        parts = Pieces(
            np.concatenate((number, number)),
            np.concatenate((start, middle + after)),
            np.concatenate((middle - before, end)),
        )
        # A point in time is a piece too: the ends of the whole belong to it.
        return _chosen(parts, parts.start <= parts.end)

    def _boxes_apart(self, kind: Features, pieces: Pieces) -> Any:
        number, start, end = pieces
        low_a, high_a = self._boxes(self.coarse.a, kind.a[number], start, end)
        low_b, high_b = self._boxes(self.coarse.b, kind.b[number], start, end)
        margin = 4 * self.coarse.margin
        return ((low_b - high_a > margin) | (low_a - high_b > margin)).any(axis=1)

    def _boxes(self, body: Rotor, index: Any, start: Any, end: Any) -> tuple[Any, Any]:
        """Return boxes of paths: about the position in the middle, within those of the circles."""
        half = (end - start)[:, None, None] / 2
        time = (end + start) / 2
        position, velocity = places(body, index, time, self.coarse.kind)
        radius = body.radius[index][..., None]
        stray = abs(velocity) * half + radius * (body.speed * half) ** 2 / 2
        center = (body.offset + time[:, None] * body.drift)[:, None] + body.along[index]
        ring = abs(body.drift) * half + radius * np.sqrt(np.maximum(1 - body.axis**2, 0) + 1e-14)
        low = np.maximum(position - stray, center - ring)
        high = np.minimum(position + stray, center + ring)
        return low.min(axis=1), high.max(axis=1)

    def _try_contact(self, kind: Features, pieces: Pieces) -> None:
        """Look whether the piece that ends first ends in contact."""
        if len(pieces.number):
            first = int(np.argmin(pieces.end))
            end = Fraction(float(pieces.end[first]))
            self._test(kind.owners[int(pieces.number[first])], end)

    def _test(self, owners: Owners, time: Fraction) -> bool:
        if self.best is not None and time >= self.best:
            return False
        if not self.touching(owners, time):
            return False
        self.best = time
        return True

    def _close_in(self, left: list[Pieces]) -> Fraction | None:
        """Return the earliest time that cannot be proven free, bringing `best` close to it."""
        spans = sorted(
            (start, end, kind, number)
            for kind, pieces in enumerate(left)
            for number, start, end in _merged(pieces)
        )
        lowest: Fraction | None = None
        for start, end, kind, number in spans:
            if self.best is not None and start >= self.best:
                break
            features = self.features[kind]
            # Freedom beyond the lowest time so far would change nothing.
            end = end if lowest is None else min(end, lowest)
            time = self._advance(features.a[number], features.b[number], start, end)
            if time is None or (self.best is not None and time >= self.best):
                continue
            lowest = time if lowest is None else min(lowest, time)
            self._prove_after(features.owners[number], time)
        known = [time for time in (lowest, self.best) if time is not None]
        return min(known, default=None)

    def _prove_after(self, owners: Owners, time: Fraction) -> None:
        step = Fraction(1, 10**15)
        while step < Fraction(1, 10**4) and not self._test(owners, min(time + step, Fraction(1))):
            step *= 4

    def _advance(self, index_a: Any, index_b: Any, start: float, end: Any) -> Fraction | None:
        """Return the time at which no more can be proven, or None where `end` is passed."""
        time = mpmath.mpf(start)
        last = mpmath.fdiv(*end.as_integer_ratio())
        for _ in range(MOST_STEPS):
            moment = np.array([time], dtype=object)
            _, after = self.fine.apart(index_a[None], index_b[None], moment)
            step = after[0] * (1 - mpmath.mpf(10) ** -20)
            if step < STALL:
                break
            if time + step > last:
                return None
            time += step
        return Fraction(*time.as_integer_ratio()) if time else Fraction(0)


def _chosen(pieces: Pieces, mask: Any) -> Pieces:
    return Pieces(*(part[mask] for part in pieces))


def _merged(pieces: Pieces) -> Iterator[tuple[int, float, float]]:
    """Yield each pair's pieces that adjoin as one."""
    order = np.lexsort((pieces.start, pieces.number))
    current: tuple[int, float, float] | None = None
    for i in order:
        number, start, end = (part[i].item() for part in pieces)
        if current and current[0] == number and start <= current[2] + NARROW:
            current = number, current[1], max(end, current[2])
            continue
        if current:
            yield current
        current = number, start, end
    if current:
        yield current
