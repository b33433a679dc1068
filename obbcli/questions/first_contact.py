"""When do two moving bodies first touch? `Query` and `first_contact`. Eberly 2008 §5 and §7.

A `Query` goes on where it stopped; `first_contact` runs one to its end.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import Accuracy
from obbcli.answers.contact import Contact, FirstContact
from obbcli.answers.status import Status
from obbcli.motion.body import as_body
from obbcli.questions.border import (
    POPS_A_SLICE,
    damaged,
    duration_of,
    moves_nothing,
    moving_query,
    static_query,
    stats_of,
    time_tolerance,
    trees_of,
)
from obbcli.questions.containment import Containment
from obbcli.questions.describe import (
    answer_at_rest,
    boxes_at_start,
    contact_at_start,
    contact_of,
    unresolved,
)
from obbcli.questions.legs.relay import sum_of
from obbcli.questions.legs.sampled import SampledQueries
from obbcli.questions.legs.through_poses import LegQueries, legs_of

if TYPE_CHECKING:
    from obbcli.answers.counts import QueryStats
    from obbcli.motion.body import Body, Shape
    from obbcli.questions.legs.relay import Asker, Counts, Relay

_EXACT = Accuracy()
_SEPARATED = Contact(status=Status.SEPARATED)


class Query:
    """A first-contact question that can be advanced, looked at and advanced again.

    At any moment `lower_bound` is proven: no contact before it. The sampled method proves nothing
    of the kind, so that there it stays 0.

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
        solid: whether a body inside the other at t = 0 is contact too, as `Containment` says.
        any_contact: whether any proof of contact will do, not of the first.

    Raises:
        MotionError: the duration is negative or not finite, positions leave the range of double,
            or sampled steps turn by more than their integrator can follow.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, -10, 0]))
        >>> query = Query(finger, "sample_meshes/workpiece.obj")
        >>> query.advance(max_iterations=1).status.value, query.advance().time
        ('unresolved', 0.5)
    """

    def __init__(
        self,
        a: Body | Shape,
        b: Body | Shape,
        duration: float | None = None,
        accuracy: Accuracy | None = None,
        *,
        solid: bool = False,
        any_contact: bool = False,
    ) -> None:
        self._accuracy = _EXACT if accuracy is None else accuracy
        self._bodies = as_body(a), as_body(b)
        self._follows_path = any(body.motion.steady is None for body in self._bodies)
        self._duration = duration_of(duration, self._bodies)
        start = time.perf_counter()
        self._trees = trees_of(self._bodies)
        loaded = time.perf_counter()
        placed = self._bodies
        if self._follows_path:
            placed = next(legs_of(self._bodies, self._trees, 0.0)).bodies
        self._at_start = static_query(self._trees, placed, self._accuracy)
        self._solids = Containment(placed, self._trees, self._at_start) if solid else None
        self._seconds = {"load": loaded - start, "query": time.perf_counter() - loaded}
        self._moving: kernels.ContactQuery | None = None
        self._legs = self._relay(partial(Query, any_contact=any_contact))
        self._any_contact = any_contact
        self._is_finished = False
        self._spent = 0

    def _relay(self, ask: Asker) -> Relay | None:
        """Return what asks one question after another, where one is not enough."""
        bodies, end = self._bodies, self._duration
        tolerance = time_tolerance(self._accuracy, end)
        is_sampled = self._accuracy.method == "sampled" and end > 0
        if is_sampled and not all(body.motion.is_at_rest for body in bodies):
            accuracy = replace(self._accuracy, time_tolerance=tolerance)
            return SampledQueries(bodies, self._trees, end, accuracy, ask)
        if not self._follows_path:
            return None
        # A bracket may consist of two: of the time the bodies are near, and of contact.
        exact = replace(self._accuracy, time_tolerance=0.5 * tolerance)
        return LegQueries(bodies, self._trees, end, exact, ask)

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
    def time(self) -> float:
        """Up to when the question has come, s: `lower_bound`, or the present sampled step."""
        return self.lower_bound if self._legs is None else self._legs.time

    @property
    def iterations(self) -> int:
        """What `advance` has taken of `max_iterations`: queue pops, and one for steps of none."""
        return self._spent

    @property
    def duration(self) -> float:
        """The end of the interval asked about, s."""
        return self._duration

    def advance(
        self,
        max_iterations: int | None = None,
        seconds: float | None = None,
        *,
        until: float = math.inf,
    ) -> FirstContact:
        """Go on for so many queue pops or seconds, and return what is known then.

        `Status.UNRESOLVED` where the answer is not complete, or bodies turn too fast to be followed
        in doubles; its `time_bounds[0]` is proven.
        Signals are looked at every few milliseconds.

        Args:
            max_iterations: queue pops. None: no limit.
            seconds: wall time. None: no limit.
            until: s; no further than that contact is ruled out up to a later time (of sampled
                motion: than the steps that begin by then).

        Raises:
            MotionError: positions leave the range of double, or sampled steps turn by more than
                their integrator can follow.
            TreeFileError: a tree file is damaged.
        """
        start = time.perf_counter()
        stop = None if seconds is None else start + seconds
        left = max_iterations
        try:
            while not self._is_finished and self.time <= until:
                pops = POPS_A_SLICE if left is None else min(left, POPS_A_SLICE)
                before = self.counts[3]
                self._is_finished = self._step(pops, until)
                spent = max(self.counts[3] - before, 1)
                self._spent += spent
                if left is not None:
                    left = max(left - spent, 0)
                if left == 0 or (stop is not None and time.perf_counter() >= stop):
                    break
        except kernels.TreeError as fault:
            raise damaged(self._trees, fault) from fault
        finally:
            self._seconds["query"] += time.perf_counter() - start
        return self._answer()

    def _step(self, pops: int, until: float) -> bool:
        """Advance the question at t = 0, then the moving one; return whether all is answered."""
        if self._solids is not None:
            if not self._solids.advance(pops):
                return False
            if self._solids.contained is not None:
                return True
        if self._legs is not None:
            return self._legs.step(pops, until)
        if self._moving is None:
            before = self._at_start.counts()[3]
            if not self._at_start.advance(pops):
                return False
            if self._at_start.is_contact or self._is_over_at_start():
                return True
            self._moving = self._moving_query()
            pops -= self._at_start.counts()[3] - before
        return self._moving.advance(pops, until)

    def _is_over_at_start(self) -> bool:
        """Return whether what holds at t = 0 holds throughout."""
        is_still = moves_nothing(self._bodies, self._trees, self._duration)
        return is_still and not self._accuracy.clearance > 0

    def _moving_query(self) -> kernels.ContactQuery:
        ask = partial(moving_query, any_contact=self._any_contact)
        return ask(self._bodies, self._trees, self._duration, self._accuracy)

    def _answer(self) -> FirstContact:
        if self._solids is not None and self._solids.contained is not None:
            return FirstContact.of(self._solids.answer(), self._stats())
        if self._legs is not None:
            return self._legs.answer(self._stats())
        return FirstContact.of(self._contact(), self._stats())

    def _contact(self) -> Contact:
        if self._at_start.is_by_boxes:
            query, bound = self._moving_query(), self._at_start.error_bound
            return boxes_at_start(query, bound, self._accuracy.clearance)
        witness = self._at_start.witness()
        if witness is not None:
            return contact_at_start(self._bodies, self._trees, *witness)
        if not self._is_finished or (self._moving is not None and self._moving.has_given_up):
            return unresolved(self.lower_bound)
        found = None if self._moving is None else self._moving.contact()
        if self._moving is None or found is None:
            return _SEPARATED
        return contact_of(self._moving, found, self._accuracy.clearance)

    @property
    def counts(self) -> Counts:
        """Box tests, triangle tests, exact ones and pops so far."""
        counts = self._at_start.counts()
        if self._solids is not None:
            counts = sum_of(counts, self._solids.counts)
        if self._legs is not None:
            return sum_of(counts, self._legs.counts)
        return counts if self._moving is None else sum_of(counts, self._moving.counts())

    def _stats(self) -> QueryStats:
        return stats_of(self._trees, self.counts, dict(self._seconds))


def first_contact(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    solid: bool = False,
) -> FirstContact:
    """Return when and where two bodies first touch in the closed interval [0, duration].

    SEPARATED is proof; no contact exists before `time_bounds[0]`, in floating point with every
    rounding counted, whatever the number of turns. Without rotation the time is exact: the bracket
    is the doubles around a rational number. All that is said by the sampled method (`Accuracy`)
    holds for paths that are off the true ones by up to `error_bound`, but for contact at t = 0.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        b: likewise.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: what is asked of the answer, and the limits after which it is `unresolved`.
        solid: whether a body inside the other at t = 0 is contact too, without touching: closed
            surfaces then hold what is inside them.

    Raises:
        MotionError: the duration is negative or not finite, positions leave the range of double,
            or sampled steps turn by more than their integrator can follow.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, -10, 0]))
        >>> answer = first_contact(finger, "sample_meshes/workpiece.obj")
        >>> answer.status.value, answer.time_bounds, answer.evidence
        ('contact', (0.5, 0.5), 'intersecting')
    """
    if duration is None and accuracy is None and not solid:
        here, there = getattr(a, "at_rest", None), getattr(b, "at_rest", None)
        if here is not None and there is not None:
            return answer_at_rest((as_body(a), as_body(b)), here, there)
    accuracy = _EXACT if accuracy is None else accuracy
    query = Query(a, b, duration, accuracy, solid=solid)
    return query.advance(accuracy.max_iterations, accuracy.timeout)
