"""The greatest distance over a motion: upper bounds by points that were nearest at single times.

At any time the bodies are no further apart than any two points of theirs. A pair that is nearest at
one time stays nearly nearest for a while, and how far its points are apart over an interval is
bounded to third order, as for the least distance (see kernels/clearance/relative_motion.hpp).
"""

from __future__ import annotations

import heapq
import itertools
import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.accuracy import Accuracy
from obbcli.answers.counts import Counts
from obbcli.motion.body import Body, missing_pivot
from obbcli.questions.clearance.found import Place
from obbcli.questions.distance import measure
from obbcli.questions.legs.leg import Leg, on_clock
from obbcli.questions.legs.slack import ROUNDING, norm, rounding_of
from obbcli.questions.legs.through_poses import legs_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.answers.contact import Vector
    from obbcli.questions.pair_question import PairQuestion

    Points = tuple[NDArray[np.float64], NDArray[np.float64]]

# An interval is bounded part by part.
_PARTS = 16
# The latest pairs of points of an interval that are looked at.
_MOST_PAIRS = 4
_EXACT = Accuracy()


class _Open(NamedTuple):
    """An interval of a leg in which no distance is proven to exceed `high`."""

    leg: int
    start: float
    end: float
    high: float
    pairs: tuple[Points, ...]  # material points of A and of B, in their meshes' coordinates


class GreatestSearch:
    """The greatest distance of two moving bodies, best interval first.

    Args:
        pair: the question.
        tolerance: the relative width asked of the bracket.

    Attributes:
        low: mesh units; at `place.time` the bodies are at least so far apart: proven.
        place: when and where `low` was measured.
        counts: what it has cost so far.

    Raises:
        MotionError: positions leave the range of double.
    """

    def __init__(self, pair: PairQuestion, tolerance: float) -> None:
        self._pair, self._tolerance = pair, tolerance
        self._legs: list[Leg] = []
        self._ways: list[_Way] = []
        still = iter([Leg(0.0, pair.duration, pair.bodies, 0.0)])
        self._later = still if pair.is_steady else legs_of(pair)
        self._next: Leg | None = next(self._later)
        self._floor = 0.0
        self._heap: list[tuple[float, int, _Open]] = []
        self._order = itertools.count()
        self.low = 0.0
        self.place: Place | None = None
        self.counts = Counts()
        self._begin_leg()

    def _begin_leg(self) -> None:
        """Look at both ends of the next leg: one a step, as a path may have a million."""
        leg = self._next
        assert leg is not None
        self._next = next(self._later, None)
        self._legs.append(leg)
        self._ways.append(_Way(self._pair, leg))
        self._floor = max(self._floor, 64 * self._ways[-1].error)
        k = len(self._legs) - 1
        self._push(k, 0.0, leg.duration, (self._look(k, 0.0), self._look(k, leg.duration)))

    @property
    def high(self) -> float:
        """The bodies are never further apart: proven; infinite while unknown. Mesh units."""
        if self._next is not None:
            return math.inf
        return max(self.low, -self._heap[0][0] if self._heap else 0.0)

    @property
    def is_over(self) -> bool:
        """Whether the bracket is as narrow as asked, or as rounding allows."""
        if self._next is not None:
            return False
        return self.high - self.low <= max(self._tolerance * self.high, self._floor)

    def step(self) -> bool:
        """Halve the interval in which the distance may be greatest; return whether it is over."""
        if self._next is not None:
            self._begin_leg()
            return self.is_over
        if self.is_over:
            return True
        interval = heapq.heappop(self._heap)[2]
        middle = 0.5 * interval.start + 0.5 * interval.end
        if not interval.start < middle < interval.end:
            self._floor = math.inf  # doubles end here: what is known is all that can be
            heapq.heappush(self._heap, (-interval.high, next(self._order), interval))
            return True
        pairs = (*interval.pairs, self._look(interval.leg, middle))[-_MOST_PAIRS:]
        self._push(interval.leg, interval.start, middle, pairs)
        self._push(interval.leg, middle, interval.end, pairs)
        return self.is_over

    def _push(self, leg: int, start: float, end: float, pairs: tuple[Points, ...]) -> None:
        high = self._ways[leg].bound(start, end, pairs)
        entry = _Open(leg, start, end, high, pairs)
        heapq.heappush(self._heap, (-high, next(self._order), entry))

    def _look(self, k: int, time: float) -> Points:
        """Measure the distance at a time of a leg; return the nearest points in their meshes."""
        leg, way = self._legs[k], self._ways[k]
        placed, error = way.placed(time)
        question = self._pair._replace(bodies=placed, duration=0.0, accuracy=_EXACT)
        found = measure(question)[0]
        self.counts += found.stats.counts
        low = found.bounds[0] - error - leg.slack
        if self.place is None or low > self.low:
            self.low = max(low, 0.0)
            clock = on_clock(leg.start, time, self._pair.duration, up=True)
            self.place = Place(
                clock, found.point_a, found.point_b, found.triangle_a, found.triangle_b
            )
        return _in_mesh(placed[0], found.point_a), _in_mesh(placed[1], found.point_b)


def _in_mesh(body: Body, point: Vector) -> NDArray[np.float64]:
    """Return a point of the world as a body's mesh has it."""
    found = np.linalg.solve(body.pose.rotation, np.asarray(point) - body.pose.translation)
    return np.asarray(found, dtype=np.float64)


class _Way:
    """How two bodies move on a leg, as the bounds on their points need it."""

    def __init__(self, pair: PairQuestion, leg: Leg) -> None:
        self._leg, self._trees = leg, pair.trees
        self._pivots = [
            np.asarray(missing_pivot(body, tree))
            if (body.motion.is_turning and body.motion.pivot is None)
            else np.zeros(3)
            if body.motion.pivot is None
            else np.asarray(body.motion.pivot)
            for body, tree in zip(leg.bodies, pair.trees, strict=True)
        ]
        a, b = (body.motion for body in leg.bodies)
        self._spins = np.asarray(a.angular_velocity), np.asarray(b.angular_velocity)
        self._drift = np.asarray(b.linear_velocity) - np.asarray(a.linear_velocity)
        lengths = [
            norm(np.asarray(body.pose.translation))
            + norm(pivot)
            + leg.duration * norm(np.asarray(body.motion.linear_velocity))
            for body, pivot in zip(leg.bodies, self._pivots, strict=True)
        ]
        sizes = sum(rounding_of(tree) for tree in pair.trees)
        self.error = leg.slack + 16 * (sizes + ROUNDING * sum(lengths))

    def placed(self, time: float) -> tuple[tuple[Body, Body], float]:
        """Return the bodies at a time of the leg, and by how much they are off their paths."""
        bodies = []
        for body, tree, pivot in zip(self._leg.bodies, self._trees, self._pivots, strict=True):
            moment = body.motion.moment(time, body.pose, pivot)
            bodies.append(Body(tree, moment.pose))
        return (bodies[0], bodies[1]), self.error

    def bound(self, start: float, end: float, pairs: tuple[Points, ...]) -> float:
        """Bound the distance in an interval of the leg: the least over pairs, the most over parts.

        With A's spin W, B's O + W, and z from A's point to B's as seen from A, the third derivative
        is at most |O| (|W| + |O + W|)^2 |r|, with r B's point from its pivot, plus
        3 |W|^2 |V| + |W|^3 (|D| + h |V|), with D and V the way between the pivots and its velocity.
        """
        edges = np.linspace(start, end, _PARTS + 1)
        edges[-1] = end
        half = 0.5 * float((edges[1:] - edges[:-1]).max()) * (1 + 1e-12)
        parts = itertools.pairwise(edges)
        high = max(self._part(0.5 * float(lo + hi), half, pairs) for lo, hi in parts)
        return high * (1 + 1e-14) + 2 * self.error

    def _part(self, middle: float, half: float, pairs: tuple[Points, ...]) -> float:
        """Bound the distance of the nearest pair for half a part before and after its middle."""
        bodies, _ = self.placed(middle)
        centers = [
            pivot + middle * np.asarray(body.motion.linear_velocity)
            for pivot, body in zip(self._pivots, self._leg.bodies, strict=True)
        ]
        return min(self._apart(bodies, centers, half, pair) for pair in pairs)

    def _apart(
        self,
        bodies: tuple[Body, Body],
        centers: list[NDArray[np.float64]],
        half: float,
        pair: Points,
    ) -> float:
        """Bound how far two points are apart for half a part before and after its middle."""
        w_a, w_b = self._spins
        ends = [
            body.pose.rotation @ point + body.pose.translation
            for body, point in zip(bodies, pair, strict=True)
        ]
        r, z_b = ends[1] - centers[1], ends[1] - centers[0]
        u = self._drift + np.cross(w_b, r)
        z0 = ends[1] - ends[0]
        z1 = u - np.cross(w_a, z_b)
        z2 = (
            np.cross(w_b, np.cross(w_b, r))
            - 2 * np.cross(w_a, u)
            + np.cross(w_a, np.cross(w_a, z_b))
        )
        bow = 0.5 * half * half * z2
        speed_a, speed_b, drift = norm(w_a), norm(w_b), norm(self._drift)
        turning = norm(w_b - w_a) * (speed_a + speed_b) ** 2 * norm(r)
        apart = norm(centers[1] - centers[0]) + half * drift
        jerk = turning + 3 * speed_a**2 * drift + speed_a**3 * apart
        corners = (norm(z0 - half * z1 + bow), norm(z0 - bow), norm(z0 + half * z1 + bow))
        return max(corners) + 1.000001 * jerk * half**3 / 6
