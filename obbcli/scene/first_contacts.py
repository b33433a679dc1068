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
from obbcli.errors import MotionError
from obbcli.questions.budget import Budget
from obbcli.questions.describe import unresolved
from obbcli.questions.first_contact import Query
from obbcli.scene.contact_stream import ContactStream
from obbcli.scene.pair_queue import Item, PairQueue
from obbcli.scene.results import SceneContact, SceneStats

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import FirstContact
    from obbcli.scene.pairs import ScenePairs

# Queue pops of a question before another may be turned to: the least for which turning costs
# little, and about what a question takes.
_LEAST_POPS = 64
_POPS = 4096
_CONTACT_FIELDS = tuple(field.name for field in fields(Contact))


class FirstContacts(ContactStream):
    """Contacts of a scene, earliest first, one a pair that touches.

    Made by `Scene.first_contacts`. A pair that a limit leaves open comes too, as `unresolved`, at
    the time up to which it is proven apart; so nothing is lost.

    Args:
        asked: bodies and pairs.
        first: whether to end after the earliest contact.
        is_eager: whether to finish a question before turning to another where that costs less.
    """

    def __init__(self, asked: ScenePairs, *, first: bool, is_eager: bool = True) -> None:
        super().__init__(asked)
        self._accuracy: Accuracy = asked.accuracy
        self._agenda = PairQueue(asked.candidates)
        self._is_first = first
        self._is_eager = is_eager and not first
        self._best = math.inf  # the time of the earliest contact known, s
        self._is_stopped = False
        self._is_over = False
        self._budget = Budget(seconds=asked.accuracy.timeout)
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
            self._agenda.put(None)
            self._is_over = self._is_first and item.work.status is not Status.UNRESOLVED
            return item.work
        if self.is_late():
            self._close(item, unresolved(item.time))
        else:
            with self.asked.timed("query"):
                self._go_on(item)
        return None

    def is_late(self) -> bool:
        """Return whether no more time may be spent."""
        self._is_stopped = self._is_stopped or self._budget.is_over
        return self._is_stopped

    def _go_on(self, item: Item) -> None:
        """Advance the question about a pair."""
        query: Query = item.work
        try:
            if query is None:
                query = Query(
                    *self.asked.bodies_of(item.a, item.b),
                    self.asked.duration,
                    self._accuracy,
                    # Bodies whose boxes are apart at t = 0 do not hold each other then.
                    solid=self.asked.solid and item.time == 0.0,
                )
            before = query.counts
            found = self._advance(query)
        except MotionError as fault:
            where = f"{' and '.join(self.asked.names(item.a, item.b))}: {fault.where}"
            raise MotionError(where, fault.fault, fault.remedy) from fault
        self._counts += query.counts - before
        if found is None:
            self._agenda.put(item._replace(time=max(item.time, query.time), work=query))
        else:
            self._close(item, found)

    def _advance(self, query: Query) -> FirstContact | None:
        """Advance a question; return its answer once it is known or a limit is reached."""
        if self._is_eager:
            return self._answer(query, _POPS, math.inf)
        # Where only the first contact is asked for, no question goes beyond one that is known.
        best = self._best if self._is_first else math.inf
        found = self._answer(query, _LEAST_POPS, best)
        until = min(best, self._agenda.second_time())
        if found is None and query.time <= until:
            found = self._answer(query, _POPS, until)
        return found

    def _answer(self, query: Query, pops: int, until: float) -> FirstContact | None:
        left = self._accuracy.max_iterations - query.iterations
        found = query.advance(min(pops, left), self.seconds_left(), until=until)
        is_known = query.is_finished or query.iterations >= self._accuracy.max_iterations
        return found if is_known else None

    def seconds_left(self) -> float | None:
        """Return how much time may be spent, s; None: no limit."""
        return self._budget.seconds_left

    def _close(self, item: Item, found: Contact) -> None:
        """Note the end of a question."""
        self._ends[found.status] += 1
        if found.status is Status.SEPARATED:
            self._agenda.put(None)
            return
        assert found.time is not None
        contact = Contact(**{name: getattr(found, name) for name in _CONTACT_FIELDS})
        if found.status is not Status.UNRESOLVED:
            self._best = min(self._best, found.time)
        # An unresolved pair is told no earlier than the time that the queue has come to.
        when = max(found.time, item.time) if found.status is Status.UNRESOLVED else found.time
        result = SceneContact(*self.asked.names(item.a, item.b), contact)
        self._agenda.put(item._replace(time=when, work=result))
