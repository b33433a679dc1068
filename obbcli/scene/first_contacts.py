"""`FirstContacts`: the first contacts of a scene's pairs, in order of time.

One queue for the scene holds every pair that may touch, by a time before which it is proven not to.
The smallest is taken and its question advanced. A pair that nobody reaches costs nothing.
"""

from __future__ import annotations

import math
from dataclasses import fields
from typing import TYPE_CHECKING

from obbcli.answers.contact import Contact
from obbcli.answers.counts import Counts
from obbcli.answers.status import Status
from obbcli.questions.budget import Budget
from obbcli.questions.describe import unresolved
from obbcli.scene.contact_stream import ContactStream
from obbcli.scene.pair_queue import Item, PairQueue
from obbcli.scene.results import SceneContact, SceneStats
from obbcli.scene.rounds import Advanced, Round, Rounds

if TYPE_CHECKING:
    from obbcli.scene.pairs import ScenePairs

_CONTACT_FIELDS = tuple(field.name for field in fields(Contact))


class FirstContacts(ContactStream):
    """Contacts of a scene, earliest first, one a pair that touches.

    Made by `Scene.first_contacts`. A pair that a limit leaves open comes too, as `unresolved`, at
    the time up to which it is proven apart; so nothing is lost.

    Args:
        asked: bodies and pairs.
        first: whether to end after the earliest contact.
        threads: how many look at pairs at the same time. Answers do not depend on it, nor does what
            they cost.
        is_eager: whether to finish a question before turning to another where that costs less.
    """

    def __init__(
        self, asked: ScenePairs, *, first: bool, threads: int = 1, is_eager: bool = True
    ) -> None:
        super().__init__(asked)
        self._agenda = PairQueue(asked.candidates)
        self._is_first = first
        self._best = math.inf  # the time of the earliest contact known, s
        self._is_stopped = False
        self._is_over = False
        self._budget = Budget(seconds=asked.accuracy.timeout)
        self._rounds = Rounds(
            asked, self._agenda, self._budget, threads=threads, is_eager=is_eager and not first
        )
        self._counts = Counts()
        self._ends = dict.fromkeys(Status, 0)

    @property
    def time(self) -> float:
        """Up to when all is known and was yielded, s; the duration when nothing is left."""
        item = None if self._is_over else self._agenda.first()
        return self.asked.duration if item is None else min(item.time, self.asked.duration)

    @property
    def is_finished(self) -> bool:
        """Whether all that was asked for was yielded."""
        return self._is_over or self._agenda.first() is None

    @property
    def stats(self) -> SceneStats:
        """What became of the pairs so far, and what it took."""
        ends = self._ends
        found = ends[Status.CONTACT] + ends[Status.OVERLAP_AT_START]
        return self.asked.stats(
            self._counts,
            apart=ends[Status.SEPARATED],
            in_contact=found,
            open_=ends[Status.UNRESOLVED],
        )

    def stop(self) -> None:
        """Give up: all that is not known yet comes next, as unresolved."""
        self._is_stopped = True

    def advance(self) -> SceneContact | None:
        """Go on for some milliseconds; return the next contact where that finds it.

        Raises:
            ObbError: as `__next__`.
        """
        item = None if self._is_over else self._agenda.first()
        if item is None:
            return None
        if isinstance(item.work, SceneContact):
            self._agenda.put([item], [])
            self._is_over = self._is_first and item.work.status is not Status.UNRESOLVED
            return item.work
        if self.is_late():
            advanced = [Advanced(item, unresolved(item.time))]
            self._take_in(Round([item], 0, advanced, Counts()))
        else:
            with self.asked.timed("query"):
                # Where only the first contact is asked for, nothing goes beyond one that is known.
                until = self._best if self._is_first else math.inf
                self._take_in(self._rounds.next(item, until))
        return None

    def is_late(self) -> bool:
        """Return whether no more time may be spent."""
        self._is_stopped = self._is_stopped or self._budget.is_over
        return self._is_stopped

    def _take_in(self, done: Round) -> None:
        """Put what a round has found into the queue."""
        ends = [(item, found) for item, found in done.advanced if found is not None]
        items = [
            item._replace(time=max(item.time, getattr(item.work, "time", 0.0)))
            for item, found in done.advanced
            if found is None
        ]
        items += [
            self._result(item, found) for item, found in ends if found.status != Status.SEPARATED
        ]
        self._agenda.put(done.gone, items)
        self._counts += done.spent
        self._ends[Status.SEPARATED] += done.apart
        for _, found in ends:
            self._ends[found.status] += 1

    def _result(self, item: Item, found: Contact) -> Item:
        """Return the place in the queue of an answer that is to be told."""
        assert found.time is not None
        contact = Contact(**{name: getattr(found, name) for name in _CONTACT_FIELDS})
        if found.status is not Status.UNRESOLVED:
            self._best = min(self._best, found.time)
        # An unresolved pair is told no earlier than the time that the queue has come to.
        when = max(found.time, item.time) if found.status is Status.UNRESOLVED else found.time
        told = SceneContact(*self.asked.names(item.a, item.b), contact)
        return item._replace(time=when, work=told)

    def seconds_left(self) -> float | None:
        """Return how much time may be spent, s; None: no limit."""
        return self._budget.seconds_left
