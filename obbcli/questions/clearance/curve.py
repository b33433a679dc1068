"""The least distance in each of equal intervals of a motion: a curve, as brackets."""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.clearance import CurvePiece
from obbcli.answers.counts import Counts
from obbcli.questions.border import screw_of
from obbcli.questions.clearance.moving import late_by
from obbcli.questions.legs.leg import Leg, on_clock
from obbcli.questions.legs.through_poses import legs_of

if TYPE_CHECKING:
    from obbcli.questions.pair_question import PairQuestion


class CurveSearch:
    """One search an interval, earliest first, each with its own bracket.

    Args:
        pair: the question.
        tolerance: the relative width asked of each bracket.
        intervals: how many equal intervals cover the duration; one where that is 0.

    Attributes:
        pieces: those that are known.

    Raises:
        MotionError: positions leave the range of double.
    """

    def __init__(self, pair: PairQuestion, tolerance: float, intervals: int) -> None:
        self._pair, self._tolerance = pair, tolerance
        self._intervals = intervals if pair.duration > 0 else 1
        still = [Leg(0.0, pair.duration, pair.bodies, 0.0)]
        self._legs = still if pair.is_steady else list(legs_of(pair))
        self._starts = [leg.start for leg in self._legs]
        self.pieces: list[CurvePiece] = []
        self._counts = Counts()
        self._query: kernels.ClearanceQuery | None = None
        self._begin_interval()

    @property
    def counts(self) -> Counts:
        """What it has cost so far."""
        query = self._query
        return self._counts if query is None else self._counts + Counts(*query.counts())

    @property
    def is_over(self) -> bool:
        """Whether all pieces are known."""
        return len(self.pieces) == self._intervals

    def _edge(self, k: int) -> float:
        """Return where interval k begins, s; the last ends at the duration."""
        return self._pair.duration * (k / self._intervals)

    def _begin_interval(self) -> None:
        k = len(self.pieces)
        self._from, self._to = self._edge(k), self._edge(k + 1)
        self._low, self._high, self._time = math.inf, math.inf, self._from
        # The leg before may end later than the next begins, by rounding.
        self._leg = max(bisect_right(self._starts, self._from) - 1, 0)
        self._begin_leg()

    def _begin_leg(self) -> None:
        """Begin the search on the part of the interval that the present leg covers."""
        leg = self._legs[self._leg]
        (a, b), (tree_a, tree_b) = leg.bodies, self._pair.trees
        begin = min(max(_since(leg.start, self._from, -math.inf), 0.0), leg.duration)
        end = min(max(_since(leg.start, self._to, math.inf), begin), leg.duration)
        self._query = kernels.ClearanceQuery(
            tree_a.kernel,
            a.pose.kernel,
            screw_of(a, tree_a),
            tree_b.kernel,
            b.pose.kernel,
            screw_of(b, tree_b),
            start=begin,
            end=end,
            tolerance=self._tolerance,
            high=self._high,
            slack=leg.slack,
        )

    def all_pieces(self) -> tuple[CurvePiece, ...]:
        """Return all pieces; of those that are not known yet, bounds that say nothing."""
        missing = (
            CurvePiece(start=self._edge(k), end=self._edge(k + 1), bounds=(0.0, None))
            for k in range(len(self.pieces), self._intervals)
        )
        return (*self.pieces, *missing)

    def step(self, pops: int) -> bool:
        """Take at most so many pairs from the queue; return whether all pieces are known.

        Raises:
            kernels.TreeError: a tree file is damaged.
        """
        if self.is_over:
            return True
        query = self._query
        assert query is not None
        if not query.advance(pops):
            return False
        self._take(query)
        following = self._leg + 1
        is_covered = following == len(self._legs) or self._starts[following] > self._to
        if not is_covered and not query.is_contact:
            self._leg = following
            self._begin_leg()
            return False
        self.pieces.append(
            CurvePiece(
                start=self._from,
                end=self._to,
                bounds=(min(self._low, self._high), self._high),
                time=self._time,
            )
        )
        if not self.is_over:
            self._begin_interval()
        return self.is_over

    def _take(self, query: kernels.ClearanceQuery) -> None:
        """Take over what a search has found."""
        self._counts += Counts(*query.counts())
        self._query = None
        low, high = query.bounds
        self._low = min(self._low, low)
        witness = query.witness
        if witness is not None and high < self._high:
            leg = self._legs[self._leg]
            time = on_clock(leg.start, witness[0], self._pair.duration, up=True)
            time = min(max(time, self._from), self._to)
            high += late_by(leg, self._pair.trees, witness[0], time)
            if high < self._high:
                self._high, self._time = high, time


def _since(start: float, time: float, outward: float) -> float:
    """Return how long after a start a time is, rounded outward."""
    length = time - start
    return length if math.fsum((time, -start, -length)) == 0 else math.nextafter(length, outward)
