"""`PairQueue`: what is left to do about the pairs of a scene, earliest first."""

from __future__ import annotations

import heapq
import math
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.scene.candidates import Candidates


class Item(NamedTuple):
    """What is known of a pair. No two of one queue are about the same.

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
        self._begun: list[Item] = []
        # How many candidates have left the list, and the one that comes next.
        self._next: tuple[int, Item | None] = (0, self._candidate(0))

    def _candidate(self, row: int) -> Item | None:
        if row >= len(self._candidates.times):
            return None
        a, b = self._candidates.pairs[row].tolist()
        return Item(float(self._candidates.times[row]), a, b, None)

    def first(self) -> Item | None:
        """Return the earliest; None where nothing is left."""
        new = self._next[1]
        if not self._begun:
            return new
        return self._begun[0] if new is None else min(self._begun[0], new)

    def second_time(self) -> float:
        """Return when the one after the earliest may come, s; infinite where there is none."""
        taken = self._next[0]
        times = [item.time for item in self._begun[:3]]
        times += self._candidates.times[taken : taken + 2].tolist()
        return min(sorted(times)[1:], default=math.inf)

    def new(self, count: int) -> list[Item]:
        """Return up to so many of the pairs that nothing was begun about, earliest first."""
        taken = self._next[0]
        times = self._candidates.times[taken : taken + count].tolist()
        pairs = self._candidates.pairs[taken : taken + count].tolist()
        return [Item(time, a, b, None) for time, (a, b) in zip(times, pairs, strict=True)]

    def begun(self, count: int) -> list[Item]:
        """Return up to so many of the pairs that something was begun about, earliest first."""
        return heapq.nsmallest(count, self._begun)

    def put(self, gone: Sequence[Item], items: Sequence[Item]) -> None:
        """Let items take the place of others.

        In such an order that an interrupt in between loses no pair.

        Args:
            gone: the earliest of those that nothing was begun about, or any others.
            items: of the same pairs, something was begun about all of them.
        """
        if len(gone) == 1 and self._begun and gone[0] is self._begun[0]:
            if items:
                heapq.heapreplace(self._begun, items[0])
            else:
                heapq.heappop(self._begun)
            return
        old = {(item.a, item.b) for item in gone if item.work is not None}
        begun = (
            [each for each in self._begun if (each.a, each.b) not in old] if old else self._begun
        )
        begun = [*begun, *items]
        heapq.heapify(begun)
        taken = self._next[0] + len(gone) - len(old)
        self._begun, self._next = begun, (taken, self._candidate(taken))

    def __len__(self) -> int:
        return len(self._begun) + len(self._candidates.times) - self._next[0]
