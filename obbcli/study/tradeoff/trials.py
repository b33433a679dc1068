"""What one setting cost, answered and got wrong: a row of the trade."""

from __future__ import annotations

import math
import statistics
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from obbcli.answers.status import Status

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import FirstContact

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Timing:
    """Seconds a call, warm, of calls that took turns with those of all other settings.

    Attributes:
        median: s.
        low_quartile: s.
        high_quartile: s.
        interval: s; holds the true median with 95 % confidence, whatever the distribution; None of
            fewer calls than six, which cannot say so.
        rounds: how many calls; 0 where the budget allowed the first one alone, which warmed up.
    """

    median: float
    low_quartile: float
    high_quartile: float
    interval: tuple[float, float] | None
    rounds: int

    @classmethod
    def of(cls, times: Sequence[float], first: float) -> Timing:
        """Return what some calls took, or what the first did where there are no others."""
        ordered = sorted(times) or [first]
        quarter = (len(ordered) - 1) // 4
        return cls(
            statistics.median(ordered),
            ordered[quarter],
            ordered[-1 - quarter],
            _interval(sorted(times)),
            len(times),
        )


def _interval(ordered: Sequence[float]) -> tuple[float, float] | None:
    """Return the order statistics around the median, by the binomial distribution of signs."""
    count = len(ordered)
    tail, rank = 0.5**count, 0  # the chance that no more than `rank` calls were below the median
    while 2 * tail <= 1 - CONFIDENCE:
        rank += 1
        tail += math.comb(count, rank) * 0.5**count
    return (ordered[rank - 1], ordered[count - rank]) if rank else None


@dataclass(frozen=True, kw_only=True)
class Trial:
    """One setting, measured.

    Attributes:
        build: options of `ObbTree.build`, for both meshes; a body that came as a tree kept its own.
        accuracy: as `first_contact` takes it.
        answer: what it answered.
        is_verdict_wrong: whether that is contact where there is none, or none where there is.
        time_error: s; by how much its time is too early (negative) or too late, against the
            reference's bracket; 0 within it, or as near to it as it is wide, and where both are
            separated. None where it cannot be said: with a wrong verdict, or unresolved.
        gap: mesh units; how far apart the surfaces truly are at the time it names, an upper bound.
            None where it names none.
        claims_checked: how many of its claims were put to the test.
        faults: those that turned out untrue. There should be none, ever.
        warm: s a call.
        build_seconds: s that both trees took, whole.
        tree_bytes: bytes of both trees, whole, their meshes among them.
        on_front: whether no other setting was as good in both error and time and better in one.
    """

    build: dict[str, Any]
    accuracy: Accuracy
    answer: FirstContact
    is_verdict_wrong: bool
    time_error: float | None
    gap: float | None
    claims_checked: int
    faults: tuple[str, ...]
    warm: Timing
    build_seconds: float
    tree_bytes: int
    on_front: bool = False

    @property
    def error(self) -> float | None:
        """|time_error|, s; infinite with a wrong verdict; None where it cannot be said."""
        if self.is_verdict_wrong:
            return math.inf
        return None if self.time_error is None else abs(self.time_error)

    @property
    def is_proof(self) -> bool:
        """Whether the answer is proven, all of it, and not only found to be right here."""
        return self.answer.status is not Status.UNRESOLVED and not self.answer.approximate


class Unreached(NamedTuple):
    """A setting that was not measured, and why."""

    build: dict[str, Any]
    accuracy: Accuracy
    why: str


@dataclass(frozen=True, kw_only=True)
class Tradeoff:
    """What speed costs in accuracy, measured on two bodies in motion.

    Attributes:
        reference: the certified answer that errors are measured against.
        reference_accuracy: what it was asked with.
        duration: s; the interval asked about is [0, duration].
        rows: the settings that were measured, those of the default trees first.
        unreached: those that were not.
        budget: s allowed.
        seconds: s taken.
    """

    reference: FirstContact
    reference_accuracy: Accuracy
    duration: float
    rows: tuple[Trial, ...]
    unreached: tuple[Unreached, ...]
    budget: float
    seconds: float

    @property
    def front(self) -> tuple[Trial, ...]:
        """The rows that no other one beats in error and time, fastest first."""
        return tuple(sorted((row for row in self.rows if row.on_front), key=_time))

    @property
    def faulty(self) -> tuple[Trial, ...]:
        """The rows of which a claim is not true. There should be none, ever."""
        return tuple(row for row in self.rows if row.faults)

    def cheapest(
        self, max_error: float = math.inf, *, max_gap: float = math.inf, proven: bool = False
    ) -> Trial | None:
        """Return the fastest row of right verdict that errs by no more than is said, or None.

        Args:
            max_error: s; the largest `error`.
            max_gap: mesh units; the largest `gap`. Rows that name no time have none.
            proven: whether the answer must be a proof, and not only right as measured.
        """
        rows = (
            row
            for row in _answered(self.rows, proven=proven)
            if row.error <= max_error and (row.gap or 0.0) <= max_gap
        )
        return min(rows, key=lambda row: (_time(row), row.error), default=None)

    def most_accurate(self, max_time: float = math.inf, *, proven: bool = False) -> Trial | None:
        """Return the row that errs least of those that take no longer, or None.

        Args:
            max_time: s; the largest median of warm calls.
            proven: whether the answer must be a proof, and not only right as measured.
        """
        rows = (row for row in _answered(self.rows, proven=proven) if _time(row) <= max_time)
        return min(rows, key=lambda row: (row.error, _time(row)), default=None)


def front_of(points: Sequence[tuple[float | None, float]]) -> list[bool]:
    """Return which points no other one beats: as small in both coordinates and smaller in one.

    Args:
        points: error and time; errors of None and infinity are never on the front.
    """
    order = sorted(
        (time, error, index)
        for index, (error, time) in enumerate(points)
        if error is not None and error < math.inf
    )
    chosen = [False] * len(points)
    least, best = math.inf, (math.inf, math.inf)
    for time, error, index in order:
        if error < least or (time, error) == best:
            least, best = error, (time, error)
            chosen[index] = True
    return chosen


def _time(row: Trial) -> float:
    return row.warm.median


def _answered(rows: Iterable[Trial], *, proven: bool) -> Iterable[Any]:
    """Yield the rows whose error is a number."""
    for row in rows:
        if row.error is not None and row.error < math.inf and (row.is_proof or not proven):
            yield row
