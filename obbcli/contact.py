"""When do two moving bodies first touch? `Query` and `first_contact`. Eberly 2008 §5 and §7.

A `Query` goes on where it stopped; `first_contact` runs one to its end.
"""

from __future__ import annotations

import time
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from obbcli import kernels, primitives
from obbcli.accuracy import Accuracy
from obbcli.errors import MotionError
from obbcli.legs import LegQueries
from obbcli.motion import PathMotion, as_body
from obbcli.question import (
    POPS_A_SLICE,
    box_limits,
    damaged,
    duration_of,
    out_of_range,
    pivot_of,
    static_query,
    trees_of,
)
from obbcli.relay import sum_of
from obbcli.results import FirstContact, QueryStats, Status

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.motion import Body, Shape
    from obbcli.relay import Counts
    from obbcli.results import Vector
    from obbcli.tree import ObbTree

_EXACT = Accuracy()
# Of the duration: the width asked of a bracket where the caller asks for none.
_TIME_TOLERANCE = 1e-9

_EVIDENCE = {
    kernels.Evidence.INTERSECTING: "intersecting",
    kernels.Evidence.WITHIN_TOLERANCE: "within_tolerance",
    kernels.Evidence.BOXES: "boxes",
}
_FEATURES = ("vertex", "edge", "face")


class Query:
    """A first-contact question that can be advanced, looked at and advanced again.

    At any moment `lower_bound` is proven: no contact before it.

    Motions through poses are asked about from one break time of either body to the next, with the
    bodies posed anew at each, rounded; what that is off their continuous paths (some 1e-14 of the
    coordinates, or as much as a given matrix is not orthonormal) counts against what is proven, and
    contact that only such nearness shows is `"within_tolerance"`.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        b: likewise.
        duration: s; the closed interval [0, duration] is asked about. None: 1 where a body moves,
            else 0.
        accuracy: what is asked of the answer; its `max_iterations` and `timeout` are left to the
            caller of `advance`. None: the defaults.

    Raises:
        MotionError: the duration is negative or not finite, a sampled method is asked for (not
            answered by this version), or positions leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """

    def __init__(
        self,
        a: Body | Shape,
        b: Body | Shape,
        duration: float | None = None,
        accuracy: Accuracy | None = None,
        *,
        any_contact: bool = False,
    ) -> None:
        self._accuracy = _EXACT if accuracy is None else accuracy
        self._bodies = as_body(a), as_body(b)
        self._duration = duration_of(duration, self._bodies)
        if self._accuracy.method == "sampled":
            raise MotionError(
                "method='sampled'", "is not answered by this version", "use the certified method"
            )
        self._seconds = {"load": 0.0, "query": 0.0}
        start = time.perf_counter()
        self._trees = trees_of(self._bodies)
        self._seconds["load"] = time.perf_counter() - start
        self._at_start = static_query(self._trees, self._bodies, self._accuracy)
        self._moving: kernels.ContactQuery | None = None
        self._legs: LegQueries | None = None
        if any(isinstance(body.motion, PathMotion) for body in self._bodies):
            # A bracket may consist of two: of the time the bodies are near, and of contact.
            exact = replace(self._accuracy, time_tolerance=0.5 * self._time_tolerance())
            ask = partial(Query, any_contact=any_contact)
            self._legs = LegQueries(self._bodies, self._trees, self._duration, exact, ask)
        self._any_contact = any_contact
        self._is_finished = False

    @property
    def is_finished(self) -> bool:
        """Whether the answer is complete."""
        return self._is_finished

    @property
    def lower_bound(self) -> float:
        """No contact in [0, lower_bound): proven. s."""
        if self._legs is not None:
            return self._legs.lower_bound
        return 0.0 if self._moving is None else self._moving.lower_bound

    @property
    def duration(self) -> float:
        """The end of the interval asked about, s."""
        return self._duration

    def advance(
        self, max_iterations: int | None = None, seconds: float | None = None
    ) -> FirstContact:
        """Go on for so many queue pops or seconds, and return what is known then.

        `Status.UNRESOLVED` where the answer is not complete, or bodies turn too fast to be followed
        in doubles; its `time_bounds[0]` is proven.
        Signals are looked at every few milliseconds.

        Args:
            max_iterations: queue pops. None: no limit.
            seconds: wall time. None: no limit.

        Raises:
            MotionError: positions leave the range of double.
            TreeFileError: a tree file is damaged.
        """
        start = time.perf_counter()
        stop = None if seconds is None else start + seconds
        left = max_iterations
        try:
            while not self._is_finished:
                pops = POPS_A_SLICE if left is None else min(left, POPS_A_SLICE)
                before = self._counts()[3]
                self._is_finished = self._step(pops)
                if left is not None:
                    left = max(left - max(self._counts()[3] - before, 1), 0)
                if left == 0 or (stop is not None and time.perf_counter() >= stop):
                    break
        except kernels.TreeError as fault:
            raise damaged(self._trees, fault) from fault
        finally:
            self._seconds["query"] += time.perf_counter() - start
        return self._answer()

    def _step(self, pops: int) -> bool:
        """Advance the question at t = 0, then the moving one; return whether all is answered."""
        if self._legs is not None:
            return self._legs.step(pops)
        if self._moving is None:
            if not self._at_start.advance(pops):
                return False
            if self._at_start.is_contact or (self._moves_nothing() and not self._needs_distance()):
                return True
            self._moving = self._moving_query()
        return self._moving.advance(pops)

    def _needs_distance(self) -> bool:
        return self._accuracy.clearance > 0

    def _moves_nothing(self) -> bool:
        """Return whether neither body moves against the other."""
        (a, b), (tree_a, tree_b) = self._bodies, self._trees
        ma, mb = a.motion, b.motion
        if self._duration == 0 or (ma.is_at_rest and mb.is_at_rest):
            return True
        if (ma.linear_velocity != mb.linear_velocity).any() or (
            ma.angular_velocity != mb.angular_velocity
        ).any():
            return False
        is_turning = bool(ma.angular_velocity.any())
        return not is_turning or bool((pivot_of(a, tree_a) == pivot_of(b, tree_b)).all())

    def _moving_query(self) -> kernels.ContactQuery:
        (a, b), (tree_a, tree_b) = self._bodies, self._trees
        accuracy = self._accuracy
        coarse, depth_a, depth_b = box_limits(accuracy)
        # Before the query: what a damaged tree makes of its pivot is no fault of the motion.
        screw_a, screw_b = _screw(a, tree_a), _screw(b, tree_b)
        try:
            return kernels.ContactQuery(
                tree_a.kernel,
                a.pose.kernel,
                screw_a,
                tree_b.kernel,
                b.pose.kernel,
                screw_b,
                duration=self._duration,
                time_tolerance=self._time_tolerance(),
                distance_tolerance=(
                    -1.0 if accuracy.distance_tolerance is None else accuracy.distance_tolerance
                ),
                clearance=accuracy.clearance,
                boxes_for_leaves=coarse,
                max_depth_a=depth_a,
                max_depth_b=depth_b,
                any_contact=self._any_contact,
            )
        except ValueError as fault:
            raise out_of_range(self._trees, "motion", fault) from fault

    def _time_tolerance(self) -> float:
        tolerance = self._accuracy.time_tolerance
        return _TIME_TOLERANCE * self._duration if tolerance is None else tolerance

    def _answer(self) -> FirstContact:
        if self._legs is not None:
            return self._legs.answer(self._stats())
        if self._at_start.is_contact:
            return self._contact_at_start()
        if not self._is_finished or (self._moving is not None and self._moving.has_given_up):
            lo = self.lower_bound
            return FirstContact(
                status=Status.UNRESOLVED, time=lo, time_bounds=(lo, None), stats=self._stats()
            )
        found = None if self._moving is None else self._moving.contact()
        if self._moving is None or found is None:
            return FirstContact(status=Status.SEPARATED, stats=self._stats())
        low, high, evidence, triangle_a, triangle_b, distance, error_bound = found
        place = self._moving.place()
        point_a, point_b, normal, normal_a, normal_b = map(_vector, place[:5])
        by_boxes = evidence is kernels.Evidence.BOXES
        # Whether surfaces themselves touch at t = 0 was decided exactly before.
        is_at_start = high == 0 and (by_boxes or self._accuracy.clearance > 0)
        return FirstContact(
            status=Status.OVERLAP_AT_START if is_at_start else Status.CONTACT,
            time=low,
            time_bounds=(low, None if by_boxes else high),
            evidence=_EVIDENCE[evidence],
            point=_vector([0.5 * p + 0.5 * q for p, q in zip(*place[:2], strict=True)]),
            point_a=point_a,
            point_b=point_b,
            normal=normal,
            normal_a=normal_a,
            normal_b=normal_b,
            triangle_a=None if by_boxes else triangle_a,
            triangle_b=None if by_boxes else triangle_b,
            feature="box" if by_boxes else f"{_FEATURES[place[5]]}-{_FEATURES[place[6]]}",
            distance=None if by_boxes else distance,
            approximate=by_boxes,
            error_bound=error_bound,
            stats=self._stats(),
        )

    def _contact_at_start(self) -> FirstContact:
        """Return the answer where the bodies touch at t = 0."""
        if self._at_start.is_by_boxes:
            return FirstContact(
                status=Status.OVERLAP_AT_START,
                time=0.0,
                time_bounds=(0.0, None),
                evidence="boxes",
                feature="box",
                approximate=True,
                error_bound=self._at_start.error_bound,
                stats=self._stats(),
            )
        id_a, id_b = self._at_start.pairs()[0].tolist()
        (a, b), (tree_a, tree_b) = self._bodies, self._trees
        # The exact question about the two triangles knows where they meet, and which features.
        touch = primitives.first_contact(
            primitives.Triangle(a.pose.apply(tree_a.vertices[tree_a.mesh.triangles[id_a]])),
            primitives.Triangle(b.pose.apply(tree_b.vertices[tree_b.mesh.triangles[id_b]])),
        )
        assert isinstance(touch, primitives.PrimitiveContact)
        point = _vector(touch.point)
        return FirstContact(
            status=Status.OVERLAP_AT_START,
            time=0.0,
            time_bounds=(0.0, 0.0),
            evidence="intersecting",
            point=point,
            point_a=point,
            point_b=point,
            normal=None if touch.normal is None else _vector(touch.normal),
            normal_a=None if touch.normal_a is None else _vector(touch.normal_a),
            normal_b=None if touch.normal_b is None else _vector(touch.normal_b),
            triangle_a=id_a,
            triangle_b=id_b,
            feature=touch.feature,
            distance=0.0,
            stats=self._stats(),
        )

    def _counts(self) -> Counts:
        """Box tests, triangle tests, exact ones and pops so far."""
        moving = (0, 0, 0, 0) if self._moving is None else self._moving.counts()
        if self._legs is not None:
            moving = self._legs.counts
        return sum_of(self._at_start.counts(), moving)

    def _stats(self) -> QueryStats:
        tree_a, tree_b = self._trees
        return QueryStats(
            *self._counts(),
            tree_a.node_count,
            tree_b.node_count,
            tree_a.possible_node_count,
            tree_b.possible_node_count,
            dict(self._seconds),
        )


def first_contact(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
) -> FirstContact:
    """Return when and where two bodies first touch in the closed interval [0, duration].

    SEPARATED is proof; no contact exists before `time_bounds[0]`, in floating point with every
    rounding counted, whatever the number of turns. Without rotation the time is exact: the bracket
    is the doubles around a rational number.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        b: likewise.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: what is asked of the answer, and the limits after which it is `unresolved`.

    Raises:
        MotionError: the duration is negative or not finite, a sampled method is asked for (not
            answered by this version), or positions leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """
    accuracy = _EXACT if accuracy is None else accuracy
    query = Query(a, b, duration, accuracy)
    return query.advance(accuracy.max_iterations, accuracy.timeout)


def _screw(body: Body, tree: ObbTree) -> kernels.Screw:
    motion = body.motion
    # A body that does not turn has no use for a pivot, nor for the pass over its mesh to find one.
    pivot = pivot_of(body, tree).tolist() if motion.angular_velocity.any() else (0.0, 0.0, 0.0)
    return kernels.Screw(
        motion.linear_velocity.tolist(), motion.angular_velocity.tolist(), tuple(pivot)
    )


def _vector(values: Iterable[float]) -> Vector:
    """Return three floats, without negative zeros."""
    x, y, z = (float(value) + 0.0 for value in values)
    return x, y, z
