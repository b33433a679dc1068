"""`PairQueue`: what is left to do about the pairs of a scene, earliest first."""

from __future__ import annotations

import heapq
import math
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from obbcli.scene.candidates import Candidates


class Item(NamedTuple):
    """What is known of a pair. No two of one agenda are about the same.

    Attributes:
        time: s; nothing of it comes before.
        a: place of the first body in the scene.
        b: place of the second.
        work: what was begun; None where nothing was yet.
    """

    time: float
    a: int
    b: int
    work: Any


class PairQueue:
    """Pairs by time, then by their places in the scene.

    Args:
        candidates: pairs that nothing was begun about.
    """

    def __init__(self, candidates: Candidates) -> None:
        self._candidates = candidates
        self._taken = 0  # how many candidates have left the list
        self._new: Item | None = None  # the candidate that left the list last
        self._begun: list[Item] = []
        self._take()

    def _take(self) -> None:
        candidates, k = self._candidates, self._taken
        self._new = None
        if k < len(candidates.times):
            a, b = candidates.pairs[k].tolist()
            self._new = Item(float(candidates.times[k]), a, b, None)
            self._taken += 1

    def first(self) -> Item | None:
        """Return the earliest; None where nothing is left."""
        if not self._begun:
            return self._new
        return self._begun[0] if self._new is None else min(self._begun[0], self._new)

    def second_time(self) -> float:
        """Return when the one after the earliest may come, s; infinite where there is none."""
        if self.first() is self._new:
            times = [item.time for item in self._begun[:1]]
            times += self._candidates.times[self._taken : self._taken + 1].tolist()
        else:
            times = [item.time for item in self._begun[1:3]]
            times += [] if self._new is None else [self._new.time]
        return min(times, default=math.inf)

    def put(self, item: Item | None) -> None:
        """Let something else take the place of the earliest, or nothing.

        In such an order that an interrupt in between loses no pair.
        """
        is_new = self.first() is self._new
        if not is_new and item is not None:
            heapq.heapreplace(self._begun, item)
        elif not is_new:
            heapq.heappop(self._begun)
        elif item is not None:
            heapq.heappush(self._begun, item)
        if is_new:
            self._take()

    def __len__(self) -> int:
        rest = len(self._candidates.times) - self._taken + (self._new is not None)
        return len(self._begun) + rest
