"""`SteadyQuery`: the first contact of bodies of constant velocities, from t = 0 on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from obbcli.answers.contact import Contact
from obbcli.answers.counts import Counts
from obbcli.answers.status import Status
from obbcli.questions.border import moving_query, static_query
from obbcli.questions.describe import boxes_at_start, contact_at_start, contact_of, unresolved

if TYPE_CHECKING:
    from obbcli import kernels
    from obbcli.questions.pair_question import PairQuestion

SEPARATED = Contact(status=Status.SEPARATED)


class SteadyQuery:
    """The first contact of two bodies of constant velocities, as a question that can be advanced.

    Contact at t = 0 is decided first, on the exact surfaces; only then is the motion looked at.

    Args:
        pair: the question; neither motion changes its velocities.
        any_contact: whether any proof of contact will do, not of the first.

    Attributes:
        at_start: the kernels' question about t = 0.
        is_finished: whether the answer is complete.

    Raises:
        MotionError: positions leave the range of double.
        TreeFileError: a tree file is damaged.
    """

    def __init__(self, pair: PairQuestion, *, any_contact: bool = False) -> None:
        self._pair = pair
        self._any_contact = any_contact
        self._moving: kernels.ContactQuery | None = None
        self.at_start = static_query(pair)
        self.is_finished = False

    @classmethod
    def begun(
        cls,
        pair: PairQuestion,
        at_start: kernels.StaticQuery,
        moving: kernels.ContactQuery | None,
        *,
        is_finished: bool,
        any_contact: bool = False,
    ) -> SteadyQuery:
        """Return the question as the kernels have begun it.

        Args:
            pair: the question.
            at_start: the kernels' question about t = 0.
            moving: that about the motion; None where there is none yet.
            is_finished: whether the answer is complete.
            any_contact: whether any proof of contact will do, not of the first.
        """
        query = cls.__new__(cls)
        query._pair, query._any_contact = pair, any_contact
        query.at_start, query._moving, query.is_finished = at_start, moving, is_finished
        return query

    @property
    def lower_bound(self) -> float:
        """No contact in [0, lower_bound): proven. s."""
        return 0.0 if self._moving is None else self._moving.lower_bound

    @property
    def time(self) -> float:
        """Up to when the question has come, s."""
        return self.lower_bound

    @property
    def counts(self) -> Counts:
        """What the search has cost so far."""
        counts = Counts(*self.at_start.counts())
        return counts if self._moving is None else counts + Counts(*self._moving.counts())

    @property
    def pops(self) -> int:
        """How many pairs were taken from queues so far."""
        at_start = self.at_start.counts()[3]
        return at_start if self._moving is None else at_start + self._moving.counts()[3]

    def step(self, pops: int, until: float = math.inf) -> bool:
        """Take at most so many pairs from the queue, and none of later than `until`, s.

        Fewer where they take long. True when the answer is complete.

        Raises:
            kernels.TreeError: a tree file is damaged.
        """
        self.is_finished = self._step(pops, until)
        return self.is_finished

    def _step(self, pops: int, until: float) -> bool:
        if self._moving is None:
            before = self.at_start.counts()[3]
            if not self.at_start.advance(pops):
                return False
            if self.at_start.is_contact or self._is_over_at_start():
                return True
            self._moving = moving_query(self._pair, any_contact=self._any_contact)
            pops -= self.at_start.counts()[3] - before
        return self._moving.advance(pops, until)

    def _is_over_at_start(self) -> bool:
        """Return whether what holds at t = 0 holds throughout."""
        return not self._pair.accuracy.clearance > 0 and self._pair.moves_nothing

    def contact(self) -> Contact:
        """Return what is known now; unresolved where the answer is not complete."""
        pair = self._pair
        if self.at_start.is_by_boxes:
            query = moving_query(pair, any_contact=self._any_contact)
            return boxes_at_start(query, self.at_start.error_bound, pair.accuracy.clearance)
        witness = self.at_start.witness()
        if witness is not None:
            return contact_at_start(pair.bodies, pair.trees, *witness)
        if not self.is_finished or (self._moving is not None and self._moving.has_given_up):
            return unresolved(self.lower_bound)
        found = None if self._moving is None else self._moving.contact()
        if self._moving is None or found is None:
            return SEPARATED
        return contact_of(self._moving, found, pair.accuracy.clearance)
