"""Questions asked one after the other, about legs: times in which velocities are constant.

`through_poses` proves motion through poses with it, and `sampled` steps.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from obbcli.answers.counts import Counts
from obbcli.questions.describe import unresolved
from obbcli.questions.legs.leg import Leg, on_clock
from obbcli.questions.steady import SteadyQuery

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.answers.contact import Contact
    from obbcli.questions.pair_question import PairQuestion

_ROUNDING = 2.0**-50


class Relay(ABC):
    """The questions about the legs of a motion as one that can be advanced.

    Args:
        pair: the question about the whole motion.
        legs: at least one, earliest first.
        any_contact: whether any proof of contact will do, not of the first.
    """

    def __init__(
        self, pair: PairQuestion, legs: Iterator[Leg], *, any_contact: bool = False
    ) -> None:
        self._pair = pair
        self._legs = legs
        self._any_contact = any_contact
        self._done = Counts()
        self._answer: Contact | None = None
        self._leg = next(legs)
        self._query = self._ask_about(self._leg)

    @property
    @abstractmethod
    def lower_bound(self) -> float:
        """No contact in [0, lower_bound): proven. s."""

    @property
    def time(self) -> float:
        """Up to when the question has come, s."""
        return self.lower_bound

    @abstractmethod
    def _ask_about(self, leg: Leg) -> SteadyQuery:
        """Return the question about a leg that comes first."""

    @abstractmethod
    def _conclude(self, found: Contact) -> Contact | None:
        """Return the answer after that of the present question, or go on to the next one."""

    @property
    def counts(self) -> Counts:
        """What the search has cost so far."""
        return self._done + self._query.counts

    @property
    def pops(self) -> int:
        """How many pairs were taken from queues so far."""
        return self._done.pops + self._query.pops

    def contact(self) -> Contact:
        """Return what is known now; unresolved where the answer is not complete."""
        return unresolved(self.lower_bound) if self._answer is None else self._answer

    def step(self, pops: int, until: float) -> bool:
        """Take at most so many pairs from the queue, and none of later than `until`, s.

        Fewer where they take long. True when the answer is complete.

        Raises:
            kernels.TreeError: a tree file is damaged.
        """
        if self._query.step(pops, self._until(until)):
            self._answer = self._conclude(self._query.contact())
        return self._answer is not None

    def _until(self, time: float) -> float:
        """Return how far the present question is to be asked for a time of the whole, s.

        Whenever it has come that far, `self.time` must be later than `time`.
        """
        # The second summand covers the rounding of the difference and of `_clock`'s sum.
        return time - self._leg.start + _ROUNDING * time

    def _go_on(self, leg: Leg, query: SteadyQuery) -> None:
        """Turn to the next question, which is about a leg."""
        self._done += self._query.counts
        self._leg = leg
        self._query = query

    def _question(self, leg: Leg, **changes: object) -> SteadyQuery:
        """Return the question about a leg, with some fields of its accuracy changed."""
        pair = leg.question(self._pair, **changes)
        return SteadyQuery(pair, any_contact=self._any_contact)

    def _clock(self, time: float, *, up: bool) -> float:
        return on_clock(self._leg.start, time, self._pair.duration, up=up)
