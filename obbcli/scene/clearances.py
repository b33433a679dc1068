"""`Clearances`: how near the bodies of a scene come to each other, the nearest pair first."""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from obbcli.accuracy import Accuracy
from obbcli.answers.counts import Counts
from obbcli.questions.budget import Budget
from obbcli.questions.clearance.query import ClearanceQuery
from obbcli.questions.pair_question import PairQuestion
from obbcli.scene.reach import WideningPairs

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.answers.clearance import Clearance
    from obbcli.questions.clearance.asked import Asked
    from obbcli.scene.bodies import SceneParts
    from obbcli.scene.pairs import ScenePairs
    from obbcli.scene.results import SceneStats
    from obbcli.scene.shapes import Shapes


@dataclass(frozen=True)
class SceneClearance:
    """How near two bodies of a scene come to each other.

    Attributes:
        body_a: the name of A, of the two bodies the one that comes first in the scene.
        body_b: the name of B.
        clearance: what `clearance` says of the two.
    """

    body_a: str
    body_b: str
    clearance: Clearance


class _Item(NamedTuple):
    """A pair that waits: never nearer than `low`, mesh units; no two are about the same bodies."""

    low: float
    a: int
    b: int
    query: ClearanceQuery | None


class Clearances(Iterator[SceneClearance]):
    """Pairs of a scene in order of their least distance. Made by `Scene.clearances`.

    The pair that may be nearest is advanced until another may be nearer. It is yielded once its
    question has ended and no other pair may be nearer than the lower end of its bracket. Where a
    limit on time or `stop` ends the search, pairs that were begun come as they are then.

    Args:
        scene: its parts; of the accuracy, `max_iterations` holds for a pair, `timeout` for all.
        shapes: its meshes and trees.
        pairs: the bodies asked about, by name; None: all pairs.
        asked: what is asked of each pair. Where that is whether a distance is kept, pairs whose
            bounds prove it are counted, and not yielded.
        within: mesh units; pairs that are proven further apart are counted, and not yielded. None:
            all are yielded.

    Attributes:
        wanted: what is asked of each pair.
        within: as given.
        accuracy: likewise.
        is_stopped: whether the search was given up, by `stop` or for want of time.

    Raises:
        ObbError: as `Scene.clearances`.
    """

    def __init__(
        self,
        scene: SceneParts,
        shapes: Shapes,
        pairs: Iterable[tuple[str, str]] | None,
        asked: Asked,
        within: float | None,
    ) -> None:
        self.wanted, self.within, self.accuracy = asked, within, scene.accuracy
        limits = [one for one in (within, asked.at_least) if one is not None]
        most = min(limits, default=None)
        self._pairs = WideningPairs(scene, shapes, pairs, solid=asked.solid, most=most)
        self._limits = Accuracy(max_iterations=scene.accuracy.max_iterations)
        found = self._pairs.asked.candidates.pairs.tolist()
        self._waiting = [_Item(0.0, a, b, None) for a, b in sorted(found)]
        self._budget = Budget(seconds=scene.accuracy.timeout)
        self._counts = Counts()
        self._ends = {"apart": 0, "in_contact": 0, "open_": 0}
        self._floor = math.inf
        self.is_stopped = False

    @property
    def asked(self) -> ScenePairs:
        """The bodies and pairs of the question."""
        return self._pairs.asked

    @property
    def low(self) -> float:
        """Proven: no pair that was neither yielded nor left out is ever nearer, mesh units.

        Infinite where there are none left.
        """
        first = self._waiting[0].low if self._waiting else math.inf
        return min(first, self._pairs.reach, self._floor)

    @property
    def stats(self) -> SceneStats:
        """What became of the pairs so far, and what it took.

        With `at_least`, pairs that are nearer count as in contact.
        """
        begun = [item.query.counts for item in self._waiting if item.query is not None]
        stats = self.asked.stats(sum(begun, self._counts), **self._ends)
        if self._pairs.is_exhausted:
            return stats
        return stats._replace(later=stats.later + stats.apart_by_bounds, apart_by_bounds=0)

    def stop(self) -> None:
        """Give up: pairs that were begun come next, as they are."""
        self.is_stopped = True

    @property
    def is_finished(self) -> bool:
        """Whether all that was asked for was yielded."""
        if self._is_ended():
            return not any(item.query is not None for item in self._waiting)
        return not self._waiting and self._pairs.is_exhausted

    def __next__(self) -> SceneClearance:
        """Return the pair that is nearest of those left.

        Raises:
            ObbError: as `clearance`.
        """
        while not self.is_finished:
            found = self.advance()
            if found is not None:
                return found
        raise StopIteration

    def _is_ended(self) -> bool:
        """Return whether the search is given up, as of when time has run out."""
        self.is_stopped = self.is_stopped or self._budget.is_over
        return self.is_stopped

    def _next_begun(self) -> SceneClearance | None:
        """Return the first of the pairs that were begun, as it is."""
        begun = [item for item in self._waiting if item.query is not None]
        if not begun:
            return None
        item = min(begun, key=lambda one: one[:3])
        self._waiting.remove(item)
        heapq.heapify(self._waiting)
        return self._told(item)

    def advance(self) -> SceneClearance | None:
        """Take one step, of some milliseconds; return the next pair where that tells it.

        Raises:
            ObbError: as `__next__`.
        """
        if self._is_ended():
            return self._next_begun()
        if not self._waiting or self._waiting[0].low >= self._pairs.reach:
            if not self._pairs.is_exhausted:
                self._widen()
            return None
        return self._step(self._waiting[0])

    def _step(self, item: _Item) -> SceneClearance | None:
        """Advance the pair that waits first, and return it where its question has ended."""
        if item.query is not None and self._is_over(item.query):
            heapq.heappop(self._waiting)
            return self._told(item)
        # An interrupt in between loses no pair: it stays in the queue until its place is known.
        with self.asked.timed("query"):
            query = self._begun(item) if item.query is None else item.query
            heapq.heapreplace(self._waiting, item._replace(query=query))
            query.advance(self._pops(query), self._budget.seconds_left)
        low = max(item.low, query.bounds[0])
        if self.within is not None and low > self.within:
            heapq.heappop(self._waiting)
            self._counts += query.counts
            self._ends["apart"] += 1
        else:
            heapq.heapreplace(self._waiting, item._replace(low=low, query=query))
        return None

    def _widen(self) -> None:
        """Let pairs wait whose boxes come within the next reach."""
        # An interrupt leaves this as it is, and `low` is true of pairs that it has lost.
        self._floor = low = self._pairs.reach
        for a, b in self._pairs.widen():
            heapq.heappush(self._waiting, _Item(low, a, b, None))
        self._floor = math.inf

    def _pops(self, query: ClearanceQuery) -> int:
        return min(Budget().slice(), self._limits.max_iterations - query.iterations)

    def _is_over(self, query: ClearanceQuery) -> bool:
        return query.is_finished or query.iterations >= self._limits.max_iterations

    def _begun(self, item: _Item) -> ClearanceQuery:
        """Return the question about a pair; solids whose boxes are apart at t = 0 hold nothing."""
        pair = PairQuestion.of(
            *self.asked.bodies_of(item.a, item.b), self.asked.duration, self._limits
        )
        is_solid = self.wanted.solid and (item.a, item.b) in self._pairs.held
        return ClearanceQuery.about(pair, self.wanted._replace(solid=is_solid))

    def _told(self, item: _Item) -> SceneClearance:
        """Return what is known of a pair, which is begun and no longer waits, and count it."""
        assert item.query is not None
        found = item.query.answer()
        low, high = found.minimum.bounds
        if item.low > low:  # bounds of bodies prove more than a search that a limit has cut
            found = replace(found, minimum=replace(found.minimum, bounds=(item.low, high)))
        self._counts += item.query.counts
        self._ends[_end_of(found)] += 1
        return SceneClearance(*self.asked.names(item.a, item.b), found)


def _end_of(found: Clearance) -> str:
    """Return what became of a pair."""
    if found.at_least is not None:
        ends = {"holds": "apart", "violated": "in_contact", "open": "open_"}
        return ends[found.at_least.verdict]
    low, high = found.minimum.bounds
    if high == 0:
        return "in_contact"
    return "apart" if found.complete and low > 0 else "open_"
