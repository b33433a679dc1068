"""The extremes of a question, tried one by one: what all kinds of questions have in common."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections import deque
from dataclasses import replace
from typing import TYPE_CHECKING, Generic, TypeVar

import numpy as np

from obbcli.errors import ObbError
from obbcli.study.stability.rows import Row, Stability

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.answers.contact import FirstContact
    from obbcli.answers.distance import Distance
    from obbcli.answers.overlap import Overlap
    from obbcli.study.stability.extremes import Changed, Extreme
    from obbcli.study.stability.rows import Outcome
    from obbcli.study.stability.world import Pair

# An extreme may take this many times what the question itself took, and at least so many pops.
PATIENCE = 200
LEAST_POPS = 50_000
# Beyond this a refusal is right: posed coordinates may reach about 1e307.
LARGEST = 1e306

_Row = TypeVar("_Row", bound=Row)


class OneByOne(ABC, Generic[_Row]):
    """All extremes of a question, tried one by one.

    Attributes:
        answer: to the question itself.
        count: of the extremes.
        rows: of those that were tried.
    """

    answer: FirstContact | Distance | Overlap
    _row_kind: type[_Row]

    def _begin(self, extremes: Iterable[Extreme]) -> None:
        """Take over what is to be tried."""
        self._left = deque(extremes)
        self.count = len(self._left)
        self.rows: list[_Row] = []

    @property
    def next_extreme(self) -> str:
        """What `advance` tries next; empty where nothing is left."""
        return f"{self._left[0].family}, {self._left[0].name}" if self._left else ""

    @property
    def is_finished(self) -> bool:
        """Whether all extremes were tried."""
        return not self._left

    def advance(self) -> _Row:
        """Try the next extreme; an interrupt leaves it to be tried."""
        row = self._try(self._left[0])
        self._left.popleft()
        self.rows.append(row)
        return row

    def result(self) -> Stability:
        """Return what is known so far."""
        return Stability(self.answer, tuple(self.rows))

    @abstractmethod
    def _expected(self, extreme: Extreme, changed: Changed) -> str:
        """Return what is expected of the answer, as rows tell it."""

    @abstractmethod
    def _answered(self, row: _Row, changed: Changed) -> _Row:
        """Ask the changed question, and return its row.

        Raises:
            ObbError: it is refused.
        """

    def _try(self, extreme: Extreme) -> _Row:
        changed = extreme.change()
        row = self._row_kind(
            family=extreme.family,
            extreme=extreme.name,
            magnitude=extreme.magnitude,
            expected=self._expected(extreme, changed),
            bound=changed.bound,
            why=changed.why,
            status=None,
            time_bounds=None,
            difference=None,
            outcome="broken",
            held=False,
            reason="",
        )
        if not is_in_range(changed.pair):
            reason = "numbers beyond the range of doubles"
            return replace(row, outcome="refused", held=True, reason=reason)
        try:
            return self._answered(row, changed)
        except ObbError as fault:
            is_right = changed.pair.largest > LARGEST
            outcome: Outcome = "refused" if is_right else "broken"
            return replace(row, outcome=outcome, held=is_right, reason=str(fault))


def is_in_range(pair: Pair) -> bool:
    """Return whether all numbers of a question are finite."""
    numbers = [pair.duration]
    for side in pair.sides:
        for rows in (side.vertices, side.velocity, side.spin, side.pivot):
            numbers += [float(np.abs(rows).max())]
    return all(math.isfinite(number) for number in numbers)
