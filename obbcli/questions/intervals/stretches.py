"""Stretches of a motion in which bodies are proven to touch, or to be free: `stretches_of`.

Free stretches are first contacts, asked from times at which the bodies are apart. Contact is a
chain of witnesses, each of which reaches back to the end of the one before it.
"""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING, Literal, NamedTuple

from obbcli.answers.counts import Counts
from obbcli.answers.status import Status
from obbcli.errors import UnresolvedError
from obbcli.questions.border import static_query, stats_of
from obbcli.questions.containment import Containment
from obbcli.questions.intervals.look import Look, Span
from obbcli.questions.legs.leg import length_of, on_clock
from obbcli.questions.legs.through_poses import legs_of
from obbcli.questions.query import Query

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.answers.counts import QueryStats
    from obbcli.questions.budget import Budget
    from obbcli.questions.legs.leg import Leg
    from obbcli.questions.pair_question import PairQuestion

# Of the time tolerance: the first look after the end of a stretch, and the least that a witness
# takes the chain on by.
_FIRST_LOOK = 0.5
_LEAST_STEP = 0.25
_FINEST = 2.0**-40
# Looks at one leg that prove nothing, in a row.
_MOST_LOOKS = 200


class Stretch(NamedTuple):
    """A time in which one thing is proven at every instant.

    Attributes:
        kind: what is.
        start: s.
        end: s.
    """

    kind: Literal["contact", "free"]
    start: float
    end: float


class Tally:
    """What a question has cost so far.

    Attributes:
        counts: of all searches.
    """

    def __init__(self) -> None:
        self.counts = Counts()
        self._begun = perf_counter()

    def stats(self, pair: PairQuestion) -> QueryStats:
        """Return what a question has cost, up to now."""
        seconds = {"load": pair.load_seconds, "query": perf_counter() - self._begun}
        return stats_of(pair.trees, self.counts, seconds)


class Asked(NamedTuple):
    """What is asked of every leg.

    Attributes:
        pair: the question about the whole motion.
        within: mesh units; bodies this close are in contact.
        solid: whether a body inside the other is in contact.
        budget: what is left of the limits.
        tally: where costs are counted.
    """

    pair: PairQuestion
    within: float
    solid: bool
    budget: Budget
    tally: Tally


def resolution(pair: PairQuestion) -> float:
    """Return the width of brackets, s: as asked for, but never below 2^-40 of the duration."""
    return max(pair.time_tolerance, _FINEST * pair.duration)


def stretches_of(asked: Asked) -> Iterator[Stretch]:
    """Yield what is proven of [0, duration], earliest first, with gaps where nothing is.

    Raises:
        UnresolvedError: a limit was reached; all that is known before its `time` was yielded.
        ObbError: as `contact_intervals`.
    """
    for leg in legs_of(asked.pair):
        yield from _LegStretches(asked, leg).run()


class _LegStretches:
    """The stretches of one leg, on whose clock all times here are."""

    def __init__(self, asked: Asked, leg: Leg) -> None:
        self._asked, self._leg = asked, leg
        self._look = Look(asked.pair, leg, asked.within)
        self._tolerance = resolution(asked.pair)
        self._end = leg.duration
        self._is_over = False

    def run(self) -> Iterator[Stretch]:
        time, known, step, misses = 0.0, 0.0, _FIRST_LOOK * self._tolerance, 0
        while True:
            found = self._stretch_at(time, known)
            if found is not None:
                yield self._on_clock(found)
                known, step, misses = found.end, _FIRST_LOOK * self._tolerance, 0
                if self._is_over:
                    raise self._at_limit(known)
            else:
                step, misses = 2 * step, misses + 1
            if time >= self._end or known >= self._end or misses > _MOST_LOOKS:
                return
            time = min(max(known, 0.0) + step, self._end)

    def _on_clock(self, found: Stretch) -> Stretch:
        is_free = found.kind == "free"
        total = self._asked.pair.duration
        start = on_clock(self._leg.start, found.start, total, up=True)
        end = on_clock(self._leg.start, found.end, total, up=False)
        if found.end >= self._end and is_free:
            end = min(self._leg.start + self._end, total)
        return Stretch(found.kind, start, max(start, end))

    def _spend(self, time: float) -> None:
        """Count a look.

        Raises:
            UnresolvedError: a limit was reached.
        """
        self._asked.budget.spend(1)
        if self._asked.budget.is_over:
            raise self._at_limit(time)

    def _at_limit(self, time: float) -> UnresolvedError:
        return _at_limit(on_clock(self._leg.start, time, self._asked.pair.duration, up=False))

    def _stretch_at(self, time: float, known: float) -> Stretch | None:
        """Return what is proven about a time and after it, but for before `known`."""
        self._spend(known)
        spans = self._look.spans(time)
        if spans:
            best = min(spans, key=lambda span: (max(span.start, known), -span.end))
            start = max(best.start, known)
            end = max(span.end for span in spans if span.start <= max(start, time))
            return Stretch("contact", start, self._chain(end))
        if len(self._look.touching(time)):
            is_exact = time == 0 and self._leg.slack == 0
            return Stretch("contact", time, time) if is_exact else None
        return self._earliest_free(time, known)

    def _earliest_free(self, time: float, known: float) -> Stretch | None:
        """Return the free stretch about a time; the bodies are too near at an earlier one."""
        found = self._free_from(time, known)
        near = known
        while found is not None and not self._is_over and time - near > self._tolerance:
            middle = 0.5 * near + 0.5 * time
            if not near < middle < time:
                break
            earlier = None if self._look.spans(middle) else self._free_from(middle, known)
            if earlier is None or earlier.end < time:
                near = middle
            else:
                found, time = earlier._replace(end=max(found.end, earlier.end)), middle
        return found

    def _chain(self, time: float) -> float:
        """Return until when witnesses prove contact that is proven up to a time."""
        jump = max(self._tolerance, 1e-3 * self._end)
        while time < self._end:
            self._spend(time)
            there = min(time + jump, self._end)
            reached = _furthest(self._look.spans(there), time)
            if reached is not None and reached > time:
                jump = 2 * max(jump, reached - time)
                time = reached
                continue
            self._spend(time)
            reached = _furthest(self._look.spans(time), time)
            if reached is not None and reached - time >= _LEAST_STEP * self._tolerance:
                jump = max(0.5 * jump, reached - time)
                time = reached
            elif jump <= _FIRST_LOOK * self._tolerance:
                return time if reached is None else max(time, reached)
            else:
                jump = max(0.125 * jump, _FIRST_LOOK * self._tolerance)
        return time

    def _free_from(self, time: float, known: float) -> Stretch | None:
        """Return for how long the bodies are free from a time on; None where they are too near."""
        posed, error = self._look.posed(time)
        accuracy = replace(
            posed.accuracy,
            clearance=self._asked.within + error,
            time_tolerance=_LEAST_STEP * self._tolerance,
        )
        rest = posed._replace(duration=length_of(time, self._end), accuracy=accuracy)
        query = Query.about(rest)
        budget = self._asked.budget
        answer = query.advance(budget.pops_left, budget.seconds_left)
        budget.spend(query.iterations)
        self._asked.tally.counts += query.counts
        if answer.status is Status.SEPARATED:
            end = self._end
        else:
            end = on_clock(time, query.lower_bound, self._end, up=False)
        if end <= time and time < self._end:
            if answer.status is Status.UNRESOLVED:
                self._spend(known)
            return None
        if time == self._end and answer.status is not Status.SEPARATED:
            return None
        kind: Literal["contact", "free"] = "free"
        if self._asked.solid and is_inside(posed, self._asked.budget):
            kind = "contact"
        self._is_over = answer.status is Status.UNRESOLVED
        return Stretch(kind, time, end)


def is_inside(placed: PairQuestion, budget: Budget) -> bool:
    """Return whether a part of one body, their surfaces apart, is inside the other at t = 0."""
    pair = placed._replace(duration=0.0, accuracy=replace(placed.accuracy, clearance=0.0))
    query = Containment(pair.bodies, pair.trees, static_query(pair))
    while not query.advance(budget.slice() or 1):
        budget.spend(1)
    return query.contained is not None


def _furthest(spans: list[Span], time: float) -> float | None:
    """Return the latest end of spans that reach back to a time; None where none does."""
    return max((span.end for span in spans if span.start <= time), default=None)


def _at_limit(time: float) -> UnresolvedError:
    return UnresolvedError(
        "contact_intervals",
        f"stopped at a limit: all pieces before t = {time!r} s are known, later ones are not",
        "raise max_iterations or timeout",
        time=time,
    )
