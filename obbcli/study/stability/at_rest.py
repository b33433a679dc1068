"""Questions about bodies at rest at the extremes: do the brackets of distance and depths agree?

Each number is a proven bracket, and the change of a question bounds how far any point was moved. So
the true numbers differ by no more than a multiple of that, and brackets that are further apart
contradict each other. Nothing else does.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from obbcli.answers.overlap import Overlap
from obbcli.questions.distance import distance
from obbcli.questions.overlap.asked import Asked, refuse_other_accuracy
from obbcli.questions.overlap.overlap import overlap_of
from obbcli.questions.pair_question import PairQuestion
from obbcli.study.stability import extremes, surfaces, units
from obbcli.study.stability.one_by_one import LEAST_POPS, PATIENCE, OneByOne
from obbcli.study.stability.rows import RestRow
from obbcli.study.stability.world import Trees, pair_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.accuracy import Accuracy
    from obbcli.answers.distance import Distance
    from obbcli.answers.overlap import Bounds
    from obbcli.motion.body import Body, Shape
    from obbcli.study.asks import RestAsk
    from obbcli.study.stability.extremes import Changed, Extreme
    from obbcli.study.stability.rows import Outcome
    from obbcli.study.stability.world import Pair

_SWAP = "swap A and B"
# How much a number changes where points move by 1: the sum of how far those of A and of B do. A
# ball in both shrinks by no more on either side; other numbers are distances of a point of one
# from the other's surface.
_FACTORS = {"distance": 1.0, "thickness": 2.0, "protrusion_a": 1.0, "protrusion_b": 1.0}
# Of the volume no bound is claimed where points move.
_STILL = "volume"
# Powers of two: beyond it volumes are no doubles.
_CUBED = 250
_MIRRORED = {"protrusion_a": "protrusion_b", "protrusion_b": "protrusion_a"}
# Of numbers that were divided by the change of unit.
_ROUNDING = 2.0**-50


class _Told(NamedTuple):
    """What an answer says, in the unit of the question itself.

    Attributes:
        relation: None of a distance.
        bounds: of each number, by its name; an end that is not known is infinite.
    """

    relation: str | None
    bounds: dict[str, Bounds]


class RestBattery(OneByOne[RestRow]):
    """All extremes of a question about bodies at rest, tried one by one; as `Battery`.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        accuracy: what is asked of every answer. None: the defaults.
        ask: which question.

    Raises:
        MotionError: a field of `accuracy` says nothing about the question, or a body moves through
            poses.
        ObbError: as the question says.
    """

    answer: Distance | Overlap
    _row_kind = RestRow

    def __init__(
        self, a: Body | Shape, b: Body | Shape, accuracy: Accuracy | None, ask: RestAsk
    ) -> None:
        if ask == "overlap" and accuracy is not None:
            refuse_other_accuracy(accuracy)
        question = PairQuestion.of(a, b, 0.0, accuracy)
        self._ask_word = ask
        self._pair = pair_of(question)
        self._trees = Trees()
        # Overlaps alone: the search for a distance follows the order of the bodies.
        self._promises_bits = ask == "overlap"
        self._touch: tuple[float, float] | None = None
        self._slack = 0.0
        self.answer = self._answer(self._pair, 1.0)
        band = getattr(self.answer, "band", None)
        if band is not None:
            # The spacing of coordinates changes with them: the band is that of the question itself.
            self._touch, self._slack = (band.gap, band.overlap), band.slack
            self.answer = self._answer(self._pair, 1.0)
        asked = self._pair.accuracy
        most = min(asked.max_iterations, max(PATIENCE * _steps(self.answer), LEAST_POPS))
        self._pair = self._pair._replace(accuracy=replace(asked, max_iterations=most))
        self._told = _told(self.answer, 1.0)
        self._begin(_plan(self._pair, ask))

    def _answer(self, pair: Pair, length: float) -> Distance | Overlap:
        """Return the answer to a question; the band is that of the question itself, scaled."""
        a, b = self._trees.bodies(pair)
        if self._ask_word == "distance":
            return distance(a, b, pair.accuracy)
        touch = self._touch and (self._touch[0] * length, self._touch[1] * length)
        return overlap_of(
            PairQuestion.of(a, b, 0.0, pair.accuracy), Asked(touch=touch, values="deep")
        )

    def _expected(self, extreme: Extreme, _changed: Changed) -> str:
        is_exact = extreme.family == _SWAP and self._promises_bits
        return "same bits" if is_exact else "within bound"

    def _answered(self, row: RestRow, changed: Changed) -> RestRow:
        told = _told(self._answer(changed.pair, changed.length), changed.length)
        return self._judged(row, changed, _swapped(told) if row.family == _SWAP else told)

    def _judged(self, row: RestRow, changed: Changed, told: _Told) -> RestRow:
        """Return the row of an answer."""
        pairs = [(self._told.bounds[name], told.bounds[name]) for name in self._shared(told)]
        row = replace(
            row,
            relation=told.relation,
            bounds={name: (low, _finite(high)) for name, (low, high) in told.bounds.items()},
            difference=max((abs(one[0] - other[0]) for one, other in pairs), default=None),
        )
        outcome, reason = self._outcome(changed, told)
        if row.expected == "same bits" and outcome not in ("same", "unresolved"):
            outcome, reason = "broken", reason or "other bits, although nothing is rounded"
        return replace(row, outcome=outcome, held=outcome != "broken", reason=reason)

    def _shared(self, told: _Told) -> list[str]:
        """Return the numbers that both answers tell."""
        return [name for name in self._told.bounds if name in told.bounds]

    def _outcome(self, changed: Changed, told: _Told) -> tuple[Outcome, str]:
        """Return how an answer goes together with that to the question itself."""
        is_moved = changed.bound > 0
        needs_bound = False
        for name in self._shared(told):
            if name == _STILL and is_moved:
                continue
            gap = _gap(self._told.bounds[name], told.bounds[name])
            if gap > _FACTORS.get(name, 0.0) * changed.bound:
                return "broken", f"{name}: brackets are {gap:.3g} apart"
            needs_bound |= gap > 0
        if told.relation == "unresolved" and self._told.relation != "unresolved":
            most = changed.pair.accuracy.max_iterations
            return "unresolved", f"no relation within {most:,} steps, or within {changed.bound:.2g}"
        if told == self._told:
            return "same", ""
        if told.relation != self._told.relation and self._told.relation != "unresolved":
            if not is_moved and not self._is_at_the_band(told):
                return "broken", f"{told.relation} contradicts {self._told.relation}"
            needs_bound = True
        why = f"{changed.why}: points are off by up to {changed.bound:.2g}" if is_moved else ""
        return ("within bound" if needs_bound else "agrees"), why

    def _is_at_the_band(self, told: _Told) -> bool:
        """Return whether a number may be at the end of the band, where brackets decide."""
        assert self._touch is not None
        slack = 4.0 * self._slack
        for name, (low, high) in (*told.bounds.items(), *self._told.bounds.items()):
            limit = self._touch[name != "distance"]
            if name != _STILL and low <= limit + slack and high >= limit:
                return True
        return False


def _plan(pair: Pair, ask: RestAsk) -> Iterator[Extreme]:
    """Yield the extremes of a question about bodies at rest.

    Solids stay solids: no triangle is repeated, and none turned over alone.
    """
    yield from units.scaled(pair)
    yield from extremes.shifted(pair)
    yield from extremes.turned(pair)
    yield from surfaces.swapped(pair)
    yield from surfaces.permuted(pair)
    yield from surfaces.split(pair)
    if ask == "distance":
        yield from surfaces.repeated(pair)
    yield from surfaces.reversed_windings(pair)
    yield from surfaces.tilted(pair)
    yield from surfaces.coarsened(pair)


def _steps(answer: Distance | Overlap) -> int:
    """Return how many steps an answer took."""
    return answer.stats.pops + getattr(answer.stats, "cells", 0)


def _told(answer: Distance | Overlap, length: float) -> _Told:
    """Return what an answer says, divided by the length of 1 in it."""
    if not isinstance(answer, Overlap):
        return _Told(None, {"distance": _divided(answer.bounds, length)})
    found = {"distance": answer.distance} | {
        name: getattr(answer, name) for name in (*_FACTORS, _STILL) if name != "distance"
    }
    # Cubes of lengths leave the doubles long before these do.
    cube = length**3 if abs(math.log2(length)) < _CUBED else 0.0
    units = dict.fromkeys(found, length) | {_STILL: cube}
    return _Told(
        answer.relation,
        {
            name: _divided(one.bounds, units[name])
            for name, one in found.items()
            if one is not None and units[name] > 0
        },
    )


def _divided(bounds: tuple[float, float | None], length: float) -> Bounds:
    low, high = bounds
    return low / length, math.inf if high is None else high / length


def _swapped(told: _Told) -> _Told:
    """Return an answer of swapped bodies under the names of the question itself."""
    return _Told(
        told.relation, {_MIRRORED.get(name, name): told.bounds[name] for name in told.bounds}
    )


def _gap(one: Bounds, other: Bounds) -> float:
    """Return how far two brackets are apart, beyond the rounding of a division; 0 where not."""
    gap = max(one[0] - other[1], other[0] - one[1])
    return gap if gap > _ROUNDING * max(one[0], other[0]) else 0.0


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
