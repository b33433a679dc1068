"""The least distance over a motion, leg by leg: each leg keeps what earlier ones have found."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from obbcli import kernels
from obbcli.answers.counts import Counts
from obbcli.questions.border import screw_of
from obbcli.questions.clearance.found import Place, joined
from obbcli.questions.legs.leg import Leg, on_clock
from obbcli.questions.legs.slack import norm
from obbcli.questions.legs.through_poses import legs_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.questions.clearance.asked import Asked
    from obbcli.questions.clearance.found import Span
    from obbcli.questions.pair_question import PairQuestion, Trees


class _Done(NamedTuple):
    """What is kept of a leg: no distance is below `low`, and those near it are in `when`."""

    low: float
    when: list[Span]


class MovingSearch:
    """The least distance of bodies that move, by the kernels' search on each leg.

    Args:
        pair: the question.
        asked: what is asked about the distance.

    Raises:
        ValueError: positions leave the range of double.
        MotionError: likewise, on a path.
        kernels.TreeError: a tree file is damaged.
    """

    def __init__(self, pair: PairQuestion, asked: Asked) -> None:
        self._pair, self._asked = pair, asked
        self._legs = self._legs_of_motion()
        self._done: list[_Done] = []
        self._low = math.inf  # of the legs that are done
        self._counts = Counts()
        self._next: Leg | None = None
        self.high = math.inf
        self.place: Place | None = None
        self.is_contact = False
        self._begin(next(self._legs))

    def _legs_of_motion(self) -> Iterator[Leg]:
        pair = self._pair
        return (
            iter([Leg(0.0, pair.duration, pair.bodies, 0.0)]) if pair.is_steady else legs_of(pair)
        )

    def _begin(self, leg: Leg) -> None:
        (a, b), (tree_a, tree_b) = leg.bodies, self._pair.trees
        self._leg = leg
        self._query = kernels.ClearanceQuery(
            tree_a.kernel,
            a.pose.kernel,
            screw_of(a, tree_a),
            tree_b.kernel,
            b.pose.kernel,
            screw_of(b, tree_b),
            start=0.0,
            end=leg.duration,
            tolerance=self._asked.tolerance,
            at_least=self._asked.at_least,
            high=self.high,
            slack=leg.slack,
        )
        self._next = next(self._legs, None)
        self._look()

    @property
    def low(self) -> float:
        """The bodies are never nearer: proven. Mesh units."""
        if self._next is not None:
            return 0.0  # nothing is known of later legs
        return min(self._low, self._query.bounds[0], self.high)

    @property
    def counts(self) -> Counts:
        """What it has cost so far."""
        return self._counts + Counts(*self._query.counts())

    @property
    def pops(self) -> int:
        """How many pairs were taken from queues so far."""
        return self.counts.pops

    def step(self, pops: int) -> bool:
        """Take at most so many pairs from the queue; return whether the search is over."""
        is_over = self._query.advance(pops)
        self._look()
        if not is_over:
            return False
        if self._next is None or self.is_contact or self._is_violated():
            return True
        self._counts += Counts(*self._query.counts())
        self._low = min(self._low, self._query.bounds[0])
        self._keep()
        self._begin(self._next)
        return False

    def _is_violated(self) -> bool:
        limit = self._asked.at_least
        return limit is not None and self.high < limit

    def _look(self) -> None:
        """Take over what the present leg's search has found, where that is nearer."""
        self.is_contact = self._query.is_contact
        witness = self._query.witness
        if witness is None or not self._query.bounds[1] < self.high:
            return
        seconds, point_a, point_b, triangle_a, triangle_b = witness
        time = on_clock(self._leg.start, seconds, self._pair.duration, up=True)
        high = self._query.bounds[1] + late_by(self._leg, self._pair.trees, seconds, time)
        if high < self.high:
            self.high = high
            self.place = Place(time, point_a, point_b, triangle_a, triangle_b)

    def _keep(self) -> None:
        """Remember when the present leg's bodies are near; `when` leaves out those that are not."""
        if self._query.bounds[0] <= self.high:
            self._done.append(_Done(self._query.bounds[0], self._when_on_leg()))

    def _when_on_leg(self) -> list[Span]:
        start, end = self._leg.start, self._pair.duration
        return [
            (on_clock(start, low, end, up=False), on_clock(start, high, end, up=True))
            for low, high in self._query.when(self.high)
        ]

    def when(self) -> list[Span]:
        """Return stretches of time, s: at all others the distance is proven to exceed `high`."""
        spans = [span for done in self._done if done.low <= self.high for span in done.when]
        spans += self._when_on_leg()
        if self._next is not None:
            spans.append((self._next.start, self._pair.duration))
        return joined(spans)


def late_by(leg: Leg, trees: Trees, seconds: float, time: float) -> float:
    """Bound by how much bodies move between a leg's time and one of the whole clock, mesh units."""
    late = abs(math.fsum((leg.start, seconds, -time)))
    if late == 0:
        return 0.0
    speed = 0.0
    for body, tree in zip(leg.bodies, trees, strict=True):
        low, high = tree.bounds
        linear, angular = body.motion.linear_velocity, body.motion.angular_velocity
        pivot = 0.0 if body.motion.pivot is None else norm(body.motion.pivot)
        reach = norm(abs(low)) + norm(abs(high)) + norm(body.pose.translation) + pivot
        speed += norm(linear) + norm(angular) * reach
    return 2 * late * speed
