"""`Rounds`: how the questions about a scene's pairs are advanced, some milliseconds at a time.

Where all contacts are wanted, many pairs are asked about at the same time, and a question that was
begun is gone on with until it is answered. Where the first alone is wanted, or the contacts of each
pair come in between, one question is advanced at a time, and no further than the next pair's time.
"""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor, wait
from typing import TYPE_CHECKING, NamedTuple

from obbcli.answers.counts import Counts
from obbcli.errors import MotionError
from obbcli.questions.query import Query
from obbcli.scene.first_slices import FirstSlices
from obbcli.scene.results import SceneContact

if TYPE_CHECKING:
    from obbcli.answers.contact import Contact
    from obbcli.questions.budget import Budget
    from obbcli.scene.pair_queue import Item, PairQueue
    from obbcli.scene.pairs import ScenePairs

# Queue pops of a question before another may be turned to: the least for which turning costs
# little, and about what a question takes.
_LEAST_POPS = 64
_POPS = 4096
# How many pairs are asked about at the same time, at most: enough for many threads, and done within
# some milliseconds.
_MOST_AT_ONCE = 256


class Advanced(NamedTuple):
    """A pair of which a question was advanced.

    Attributes:
        item: with its query.
        found: the answer; None while there is more to do.
    """

    item: Item
    found: Contact | None


class Round(NamedTuple):
    """What one round has done.

    Attributes:
        gone: the items that it was about.
        apart: how many of them are proven apart.
        advanced: all others.
        spent: what it has cost.
    """

    gone: list[Item]
    apart: int
    advanced: list[Advanced]
    spent: Counts


class Rounds:
    """What advances the questions about the pairs in a queue.

    Args:
        asked: bodies and pairs.
        queue: the pairs.
        budget: how much time may be spent.
        threads: how many look at pairs at the same time. Answers do not depend on it, nor does what
            they cost.
        is_eager: whether all answers are wanted, in whatever order they are found.
    """

    def __init__(
        self,
        asked: ScenePairs,
        queue: PairQueue,
        budget: Budget,
        *,
        threads: int,
        is_eager: bool,
    ) -> None:
        self._asked = asked
        self._queue = queue
        self._budget = budget
        self._threads = threads if is_eager else 1
        self._is_eager = is_eager
        self._most = asked.accuracy.max_iterations
        self._at_once = 1  # how many pairs are asked about next, at the same time
        self._slices: FirstSlices | None = None
        if is_eager and asked.accuracy.method == "certified":
            self._slices = FirstSlices(asked, _POPS, threads)
        self._pool: ThreadPoolExecutor | None = None

    def next(self, item: Item, until: float) -> Round:
        """Advance the question about the earliest pair, or those about several.

        Args:
            item: the earliest.
            until: s; no question need go beyond.

        Raises:
            ObbError: a shape is refused, or positions leave the range of double.
        """
        if self._slices is None or item.work is not None:
            return self._advance_all(self._several(item), until)
        items = self._queue.new(self._at_once)
        # The first answers come soon, and where many are wanted many are asked at once.
        self._at_once = min(2 * self._at_once, _MOST_AT_ONCE)
        others, spent = self._slices.ask(items, self._budget.seconds_left)
        advanced = [
            Advanced(each, self._known(each.work) if isinstance(each.work, Query) else None)
            for each in others
        ]
        return Round(items, len(items) - len(others), advanced, spent)

    def _several(self, item: Item) -> list[Item]:
        """Return the earliest item, and as many more as there are threads for."""
        if self._threads == 1:
            return [item]
        # Each thread has another one to go on with when it is done with a short one.
        count = 2 * self._threads
        if item.work is None:
            return self._queue.new(count)
        earliest = self._queue.begun(count)
        return [each for each in earliest if not isinstance(each.work, SceneContact)]

    def _advance_all(self, items: list[Item], until: float) -> Round:
        """Advance the questions about pairs, which share the threads."""
        begun = (each.work for each in items if isinstance(each.work, Query))
        before = sum((query.counts for query in begun), Counts())
        asked = [each._replace(work=self._query(each)) for each in items]
        if len(asked) == 1:
            advanced = [self._advanced(asked[0], until)]
        else:
            self._pool = self._pool or ThreadPoolExecutor(self._threads)
            tasks = [self._pool.submit(self._advanced, each, until) for each in asked]
            try:
                wait(tasks)
            finally:
                wait(tasks)  # also after an interrupt: a query is advanced by one thread at a time
            advanced = [task.result() for task in tasks]
        spent = sum((each.work.counts for each in asked), Counts()) - before
        return Round(items, 0, advanced, spent)

    def _query(self, item: Item) -> Query:
        """Return the question about a pair.

        Raises:
            MotionError: positions leave the range of double.
        """
        if isinstance(item.work, Query):
            return item.work
        asked = self._asked
        try:
            return Query(
                *asked.bodies_of(item.a, item.b),
                asked.duration,
                asked.accuracy,
                # Bodies whose boxes are apart at t = 0 do not hold each other then.
                solid=asked.solid and item.time == 0.0,
            )
        except MotionError as fault:
            raise self._named(item, fault) from fault

    def _named(self, item: Item, fault: MotionError) -> MotionError:
        names = " and ".join(self._asked.names(item.a, item.b))
        return MotionError(f"{names}: {fault.where}", fault.fault, fault.remedy)

    def _advanced(self, item: Item, until: float) -> Advanced:
        """Advance the question about a pair.

        Raises:
            MotionError: positions leave the range of double.
        """
        try:
            found = self._advance(item.work, until)
        except MotionError as fault:
            raise self._named(item, fault) from fault
        return Advanced(item, found)

    def _advance(self, query: Query, until: float) -> Contact | None:
        """Advance a question; return its answer once it is known or a limit is reached."""
        if self._is_eager:
            return self._slice(query, _POPS, math.inf)
        found = self._slice(query, _LEAST_POPS, until)
        until = min(until, self._queue.second_time())
        if found is None and query.time <= until:
            found = self._slice(query, _POPS, until)
        return found

    def _slice(self, query: Query, pops: int, until: float) -> Contact | None:
        left = self._most - query.iterations
        query.advance(min(pops, left), self._budget.seconds_left, until=until)
        return self._known(query)

    def _known(self, query: Query) -> Contact | None:
        """Return the answer once it is known or a limit is reached."""
        is_known = query.is_finished or query.iterations >= self._most
        return query.answer() if is_known else None
