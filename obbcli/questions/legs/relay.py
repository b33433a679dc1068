"""Questions asked one after the other, about legs: times in which velocities are constant.

`through_poses` proves motion through poses with it, and `sampled` steps.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from obbcli.answers.contact import FirstContact
from obbcli.answers.status import Status
from obbcli.questions.border import SECONDS_A_SLICE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from obbcli.accuracy import Accuracy
    from obbcli.answers.counts import QueryStats
    from obbcli.motion.body import Body
    from obbcli.questions.border import Trees
    from obbcli.questions.first_contact import Query

    Asker = Callable[[Body, Body, float, Accuracy], Query]

Counts = tuple[int, int, int, int]
_ROUNDING = 2.0**-50


class Leg(NamedTuple):
    """A time in which both bodies have constant velocities.

    Attributes:
        start: s, of the whole question's clock.
        duration: s, rounded up.
        bodies: posed at the start.
        slack: mesh units; by no more than this does the bodies' distance on their true paths differ
            from that of `bodies`, up to the start of the next leg.
    """

    start: float
    duration: float
    bodies: tuple[Body, Body]
    slack: float


def length_of(start: float, end: float) -> float:
    """Return end - start, s, rounded up."""
    length = end - start
    reaches = math.fsum((start, length, -end)) >= 0
    return length if reaches else math.nextafter(length, math.inf)


class Relay(ABC):
    """The questions about legs as one that can be advanced.

    Args:
        bodies: that move.
        trees: theirs.
        duration: s, of the whole.
        accuracy: what is asked of the answer; its time tolerance in s.
        ask: makes the question about a leg.
    """

    def __init__(
        self,
        bodies: tuple[Body, Body],
        trees: Trees,
        duration: float,
        accuracy: Accuracy,
        ask: Asker,
    ) -> None:
        self._legs = self._legs_of(bodies, trees, duration, accuracy)
        self._duration = duration
        self._accuracy = accuracy
        self._ask = ask
        self._done: Counts = (0, 0, 0, 0)
        self._present: Counts = (0, 0, 0, 0)
        self._answer: FirstContact | None = None
        self._leg = next(self._legs)
        self._query = self._ask_about(self._leg)

    @staticmethod
    @abstractmethod
    def _legs_of(
        bodies: tuple[Body, Body], trees: Trees, duration: float, accuracy: Accuracy
    ) -> Iterator[Leg]:
        """Yield at least one leg, earliest first."""

    @property
    @abstractmethod
    def lower_bound(self) -> float:
        """No contact in [0, lower_bound): proven. s."""

    @property
    def time(self) -> float:
        """Up to when the question has come, s."""
        return self.lower_bound

    @abstractmethod
    def _conclude(self, found: FirstContact) -> FirstContact | None:
        """Return the answer after that of the present question, or go on to the next one."""

    @property
    def counts(self) -> Counts:
        """Box tests, triangle tests, exact ones and pops so far."""
        return sum_of(self._done, self._present)

    def answer(self, stats: QueryStats) -> FirstContact:
        """Return what is known now."""
        if self._answer is None:
            return self._unresolved(stats)
        return replace(self._answer, stats=stats)

    def step(self, pops: int, until: float) -> bool:
        """Take at most so many pairs from the queue, and none of later than `until`, s.

        Fewer where they take long. True when the answer is complete.
        """
        found = self._query.advance(pops, SECONDS_A_SLICE, until=self._until(until))
        stats = found.stats
        self._present = (
            stats.box_tests,
            stats.triangle_tests,
            stats.exact_triangle_tests,
            stats.pops,
        )
        if self._query.is_finished:
            self._answer = self._conclude(found)
        return self._answer is not None

    def _until(self, time: float) -> float:
        """Return how far the present question is to be asked for a time of the whole, s.

        Whenever it has come that far, `self.time` must be later than `time`.
        """
        # What the difference is off by, and the sum that makes a time of the whole again.
        return time - self._leg.start + _ROUNDING * time

    def _go_on(self, leg: Leg, ask: Callable[[Leg], Query]) -> None:
        self._done = sum_of(self._done, self._present)
        self._present = (0, 0, 0, 0)
        self._leg = leg
        self._query = ask(leg)

    def _ask_about(self, leg: Leg) -> Query:
        """Return the question about a leg that comes first."""
        return self._ask(*leg.bodies, leg.duration, self._accuracy)

    def _unresolved(self, stats: QueryStats) -> FirstContact:
        low = self.lower_bound
        return FirstContact(
            status=Status.UNRESOLVED, time=low, time_bounds=(low, None), stats=stats
        )

    def _clock(self, time: float, *, up: bool) -> float:
        return on_clock(self._leg.start, time, self._duration, up=up)


def on_clock(start: float, time: float, duration: float, *, up: bool) -> float:
    """Return a leg's time on the whole question's clock, rounded down or up, s."""
    total = start + time
    rest = math.fsum((start, time, -total))
    if up and rest > 0:
        total = math.nextafter(total, math.inf)
    elif not up and rest < 0:
        total = math.nextafter(total, 0.0)
    return min(total, duration)


def sum_of(a: Counts, b: Counts) -> Counts:
    """Return what two questions cost together."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]
