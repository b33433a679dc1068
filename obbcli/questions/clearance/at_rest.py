"""The least distance of bodies that do not move against each other: that at t = 0."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import Accuracy
from obbcli.answers.counts import Counts
from obbcli.questions.border import limits_of
from obbcli.questions.clearance.found import Place

if TYPE_CHECKING:
    from obbcli.questions.clearance.found import Span
    from obbcli.questions.pair_question import PairQuestion


class RestSearch:
    """The distance at t = 0 of bodies whose distance is the same at all times.

    Args:
        pair: the question.

    Raises:
        ValueError: posed coordinates leave the range of double.
        kernels.TreeError: a tree file is damaged.
    """

    def __init__(self, pair: PairQuestion) -> None:
        (a, b), (tree_a, tree_b) = pair.bodies, pair.trees
        self._duration = pair.duration
        self._query = kernels.DistanceQuery(
            tree_a.kernel, a.pose.kernel, tree_b.kernel, b.pose.kernel, limits_of(Accuracy())
        )

    @property
    def low(self) -> float:
        """The bodies are never nearer: proven. Mesh units."""
        return self._query.answer()[0]

    @property
    def high(self) -> float:
        """They are no further apart, mesh units."""
        return self._query.answer()[1]

    @property
    def place(self) -> Place:
        """Where `high` was measured."""
        _, _, point_a, point_b, triangle_a, triangle_b, _ = self._query.answer()
        return Place(0.0, point_a, point_b, triangle_a, triangle_b)

    @property
    def is_contact(self) -> bool:
        """Whether triangles are proven to intersect."""
        return self.high == 0

    @property
    def counts(self) -> Counts:
        """What it has cost so far."""
        return Counts(*self._query.answer()[6])

    def step(self, pops: int) -> bool:
        """Take at most so many pairs from the queue; return whether the search is over."""
        return self._query.advance(pops)

    def when(self) -> list[Span]:
        """Return the whole duration: no time is better than another."""
        return [(0.0, self._duration)] if math.isfinite(self._duration) else []
