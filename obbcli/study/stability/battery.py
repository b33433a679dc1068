"""The same question of a first contact at the extremes, and which answers hold: `Battery`.

An answer is two proofs: no contact before the bracket, contact at its end. Two questions of which
one's points are within e of the other's contradict each other where contact in the one, at a time
that the other proves free of contact even with clearance e, is proven as well. Nothing else does:
what is compared is what was promised.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from obbcli.answers.status import Status
from obbcli.questions.first_contact import first_contact
from obbcli.questions.pair_question import PairQuestion
from obbcli.study.stability import extremes, surfaces, units
from obbcli.study.stability.one_by_one import LEAST_POPS, PATIENCE, OneByOne
from obbcli.study.stability.proofs import Proofs, on_clock
from obbcli.study.stability.rows import Row
from obbcli.study.stability.samples import fault_of_samples
from obbcli.study.stability.world import SLACK, Trees, pair_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import FirstContact
    from obbcli.motion.body import Body, Shape
    from obbcli.study.stability.extremes import Changed, Extreme
    from obbcli.study.stability.rows import Outcome
    from obbcli.study.stability.world import Pair


class Battery(OneByOne[Row]):
    """All extremes of a question, tried one by one.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: what is asked of every answer. None: the defaults.

    Raises:
        MotionError: the method is sampled, or a body moves through poses.
        ObbError: as `first_contact` says.
    """

    answer: FirstContact
    _row_kind = Row

    def __init__(
        self,
        a: Body | Shape,
        b: Body | Shape,
        duration: float | None = None,
        accuracy: Accuracy | None = None,
    ) -> None:
        question = PairQuestion.of(a, b, duration, accuracy)
        self._pair = pair_of(question)
        self._trees = Trees()
        asked = self._pair
        whole = first_contact(*self._trees.bodies(asked), asked.duration, asked.accuracy)
        self.answer = question.with_parts(whole, (whole.triangle_a, whole.triangle_b))
        most = min(asked.accuracy.max_iterations, max(PATIENCE * whole.stats.pops, LEAST_POPS))
        self._pair = asked._replace(accuracy=replace(asked.accuracy, max_iterations=most))
        self._told = Proofs.of(self.answer, self._pair, Fraction(1))
        told = self._told
        low = None if told.is_free else float(told.free)
        high = None if told.met is None else float(told.met)
        self._begin(plan(self._pair, low, high))

    def _expected(self, _extreme: Extreme, changed: Changed) -> str:
        if not changed.is_related:
            return "proven"
        return "same bits" if changed.is_same else "within bound"

    def _answered(self, row: Row, changed: Changed) -> Row:
        return self._judged(row, changed, self._ask(changed.pair))

    def _ask(self, pair: Pair) -> FirstContact:
        return first_contact(*self._trees.bodies(pair), pair.duration, pair.accuracy)

    def _judged(self, row: Row, changed: Changed, answer: FirstContact) -> Row:
        """Return the row of an answer."""
        told = Proofs.of(answer, changed.pair, changed.clock)
        row = replace(
            row,
            status=answer.status,
            time_bounds=on_clock(answer, changed.clock),
            difference=self._told.difference(told) if changed.is_related else None,
        )
        outcome, reason = self._outcome(changed, answer, told)
        held = outcome != "broken"
        if changed.is_same and outcome not in ("same", "unresolved"):
            held, reason = False, reason or "other bits, although nothing is rounded"
            outcome = "broken"
        return replace(row, outcome=outcome, held=held, reason=reason)

    def _outcome(self, changed: Changed, answer: FirstContact, told: Proofs) -> tuple[Outcome, str]:
        if not changed.is_related:
            fault = fault_of_samples(changed.pair, self._trees, answer)
            if fault:
                return "broken", fault
            if answer.status is Status.UNRESOLVED:
                return "unresolved", _limit(changed)
            return "agrees", ""
        if self._told.denies(told) or told.denies(self._told):
            if self._is_contradiction(changed, told):
                return "broken", f"{answer.status} contradicts {self.answer.status}"
            return "within bound", _why_other_bits(changed, is_cut=False)
        if answer.status is Status.UNRESOLVED:
            return "unresolved", _limit(changed)
        if answer.status is self.answer.status and self._told.is_same_as(told):
            return "same", ""
        is_cut = changed.pair.duration != self._pair.duration and changed.clock == 1
        return "agrees", _why_other_bits(changed, is_cut=is_cut)

    def _is_contradiction(self, changed: Changed, told: Proofs) -> bool:
        """Return whether two answers still contradict each other with the bound as clearance."""
        if changed.bound == 0 and told.gap == 0 and self._told.gap == 0:
            return True
        if self._told.denies(told):
            gap = told.gap / changed.length
            wider = Proofs.of(
                self._ask(_cleared(self._pair, changed.bound + gap)), self._pair, Fraction(1)
            )
            if wider.denies(told):
                return True
        if told.denies(self._told):
            room = (changed.bound + self._told.gap) * changed.length
            asked = _cleared(changed.pair, room)
            return Proofs.of(self._ask(asked), asked, changed.clock).denies(self._told)
        return False


def plan(pair: Pair, low: float | None, high: float | None) -> Iterator[Extreme]:
    """Yield all extremes of a question, family by family.

    Args:
        pair: the question.
        low: s; no contact before it. None: none at all.
        high: s; contact then. None: none is proven.
    """
    yield from units.scaled(pair)
    yield from extremes.shifted(pair)
    yield from extremes.hurried(pair)
    yield from extremes.turned(pair)
    yield from surfaces.swapped(pair)
    yield from surfaces.permuted(pair)
    yield from surfaces.split(pair)
    yield from surfaces.repeated(pair)
    yield from surfaces.reversed_windings(pair)
    yield from units.timed(pair)
    yield from surfaces.cut(pair, low, high)
    yield from surfaces.spun(pair)
    yield from surfaces.tilted(pair)
    yield from surfaces.coarsened(pair)


def _cleared(pair: Pair, room: float) -> Pair:
    """Return a pair with so much more clearance, rounded up."""
    asked = pair.accuracy
    room = max((asked.clearance + room) * SLACK, 5e-324)
    return pair._replace(accuracy=replace(asked, clearance=room))


def _limit(changed: Changed) -> str:
    most = changed.pair.accuracy.max_iterations
    return f"no answer within {most:,} steps, or within the digits of doubles"


def _why_other_bits(changed: Changed, *, is_cut: bool) -> str:
    if changed.bound == 0:
        return "" if is_cut else "the same surfaces in other boxes: other brackets, and both hold"
    return f"{changed.why}: points are off by up to {changed.bound:.2g}"
