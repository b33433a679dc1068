"""`Look`: a leg's bodies at single times: do they touch, and for how long is that proven?"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli import kernels
from obbcli.motion.body import Body, missing_pivot, pivot_of
from obbcli.questions.border import NO_LIMIT, placed_of, refused
from obbcli.questions.intervals.piercing import piercings
from obbcli.questions.intervals.relative_motion import Frame, RelativeMotion
from obbcli.questions.intervals.witness import near_points
from obbcli.questions.legs.slack import rounding_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.questions.intervals.witness import Functions
    from obbcli.questions.legs.leg import Leg
    from obbcli.questions.pair_question import PairQuestion

# Pairs of triangles that are looked at for witnesses.
_MOST_PAIRS = 64
# Of the sizes in play: places, velocities times spans and turns come to a quarter of this.
_ROUNDING = 2.0**-44
# Radians that the bodies turn by, both together, in the longest span of a witness.
_LARGEST_TURN = 0.5
_EDGES = [[0, 1], [1, 2], [2, 0]]


class Span(NamedTuple):
    """The times at which contact is proven by one witness, s of the leg's clock."""

    start: float
    end: float


class Look:
    """The bodies of a leg, looked at where they are at single times.

    Args:
        pair: the question about the whole motion.
        leg: a time in which both bodies have constant velocities.
        within: mesh units; bodies this close are in contact.
    """

    def __init__(self, pair: PairQuestion, leg: Leg, within: float) -> None:
        self._pair, self._leg, self._within = pair, leg, within
        frames, sizes = [], 0.0
        for body, tree in zip(leg.bodies, pair.trees, strict=True):
            motion = body.motion
            pivot = np.array(pivot_of(body, tree)) if motion.is_turning else np.zeros(3)
            frames.append(Frame(motion.linear_velocity, motion.angular_velocity, pivot))
            sizes += _size_in_motion(body, tree.bounds, frames[-1], leg.duration)
        # Lengths of about 1 keep products of some of them within doubles.
        self._scale = scale = math.ldexp(1.0, min(max(-math.frexp(sizes)[1], -1000), 1000))
        x, y = (Frame(scale * f.velocity, f.spin, scale * f.pivot) for f in frames)
        self._frames = x, y
        self._error = scale * (_ROUNDING * sizes + leg.slack)
        turns = sum(float(np.linalg.norm(frame.spin)) for frame in frames)
        self._longest = leg.duration if turns == 0 else min(leg.duration, _LARGEST_TURN / turns)

    def posed(self, time: float) -> tuple[PairQuestion, float]:
        """Return the question about the bodies at a time, and how far they are off their paths."""
        error, bodies = self._leg.slack, []
        for body, tree in zip(self._leg.bodies, self._pair.trees, strict=True):
            moment = body.motion.moment(time, body.pose, missing_pivot(body, tree))
            error += rounding_of(tree, *moment.summands) if moment.summands else 0.0
            bodies.append(Body(tree, moment.pose, moment.motion))
        return self._pair._replace(bodies=(bodies[0], bodies[1])), error

    def touching(self, time: float) -> NDArray[np.int64]:
        """Return some pairs of triangles that intersect at a time, (N, 2)."""
        pair, _ = self.posed(time)
        here, there = map(placed_of, pair.bodies, pair.trees)
        try:
            found, _counts = kernels.triangle_pairs(here, there, _MOST_PAIRS, 1, NO_LIMIT)
        except (ValueError, kernels.TreeError) as fault:
            raise refused(pair.trees, fault) from fault
        assert found is not None
        return found

    def spans(self, time: float) -> list[Span]:
        """Return the times at which contact is proven by witnesses that hold at a time."""
        pairs = self.touching(time)
        found = [*self._pierced(time, pairs)] if len(pairs) else []
        if self._within > 0:
            found += self._near(time)
        return found

    def _spans_of(self, functions: Functions, time: float) -> list[Span]:
        held = functions.hold(np.zeros((len(functions.value), 1)), 1.0)[:, 0]
        if not held.any():
            return []
        good = functions.rows(held)
        later = good.spans(1.0, min(self._longest, self._leg.duration - time))
        earlier = good.spans(-1.0, min(self._longest, time))
        ends = np.minimum(time + later, self._leg.duration).tolist()
        starts = np.maximum(time - earlier, 0.0).tolist()
        return [self._span(*ends, time) for ends in zip(starts, ends, strict=True)]

    def _span(self, start: float, end: float, time: float) -> Span:
        """Return a span, which rounding of the sums of times makes no longer."""
        last = self._leg.duration
        return Span(
            math.nextafter(start, time) if start > 0 else 0.0,
            math.nextafter(end, time) if end < last else last,
        )

    def _pierced(self, time: float, pairs: NDArray[np.int64]) -> list[Span]:
        a, b = (
            self._scale * np.array([body.pose.apply(tree.triangle(int(row))) for row in column])
            for body, tree, column in zip(
                self._leg.bodies, self._pair.trees, pairs.T.tolist(), strict=True
            )
        )
        found = []
        x, y = self._frames
        for moving, fixed, frames in ((a, b, (x, y)), (b, a, (y, x))):
            edges = moving[:, _EDGES].reshape(-1, 2, 3)
            faces = np.repeat(fixed, 3, axis=0)
            motion = RelativeMotion(*frames, time)
            found += self._spans_of(piercings(motion, edges, faces, self._error), time)
        return found

    def _near(self, time: float) -> list[Span]:
        """Return for how long the nearest points of a time stay near."""
        from obbcli.questions.distance import measure

        pair, _ = self.posed(time)
        exact = replace(pair.accuracy, clearance=0.0, time_tolerance=None)
        found, _is_complete = measure(pair._replace(duration=0.0, accuracy=exact))
        if found.point_a is None or found.point_b is None or found.distance >= self._within:
            return []
        x, y = self._frames
        points = [
            _at_start(self._scale * np.array([point]), frame, time)
            for point, frame in ((found.point_a, x), (found.point_b, y))
        ]
        motion = RelativeMotion(x, y, time)
        within = self._scale * self._within
        functions = near_points(motion, (points[0], points[1]), within, self._error)
        return self._spans_of(functions, time)


def _at_start(points: NDArray[np.float64], frame: Frame, time: float) -> NDArray[np.float64]:
    """Return where points of a body at a time were at the start, (N, 3)."""
    back = Frame(frame.velocity, -frame.spin, frame.pivot)
    away = points - frame.pivot_at(time) + frame.pivot
    return back.turned(away, time) + frame.pivot


def _size_in_motion(
    body: Body, bounds: NDArray[np.float64], frame: Frame, duration: float
) -> float:
    """Bound the sizes that rounding is told by: coordinates, ways and arcs."""

    def norm(vector: NDArray[np.float64]) -> float:
        return float(np.linalg.norm(vector))

    reach = norm(np.abs(bounds).max(axis=0)) + norm(body.pose.translation)
    arm = reach + norm(frame.pivot)
    arcs = arm * (1 + norm(frame.spin) * duration)
    return reach + 2 * norm(frame.pivot) + 2 * norm(frame.velocity) * duration + 2 * arcs
