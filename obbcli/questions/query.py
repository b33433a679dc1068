"""`Query`: the question when two moving bodies first touch, which goes on where it stopped."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.contact import FirstContact
from obbcli.answers.counts import Counts
from obbcli.questions.border import damaged, static_query, stats_of
from obbcli.questions.budget import Budget
from obbcli.questions.containment import Containment
from obbcli.questions.legs.through_poses import legs_of
from obbcli.questions.motion_search import search_of
from obbcli.questions.pair_question import PairQuestion
from obbcli.questions.steady import SteadyQuery

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.motion.body import Body, Shape
    from obbcli.questions.motion_search import MotionSearch


class Query:
    """A first-contact question that can be advanced, looked at and advanced again.

    At any moment `lower_bound` is proven: no contact before it. The sampled method proves nothing
    of the kind, so that there it stays 0.

    Motions through poses are asked about from one break time of either body to the next, with the
    bodies posed anew at each, rounded; what that is off their continuous paths (some 1e-14 of the
    coordinates, or as much as a given matrix is not orthonormal) counts against what is proven, and
    contact that only such nearness shows is `"within_tolerance"`.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
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
        pair = PairQuestion.of(a, b, duration, accuracy)
        self._set_up(pair, solid=solid, any_contact=any_contact)

    @classmethod
    def about(cls, pair: PairQuestion, *, solid: bool = False, any_contact: bool = False) -> Query:
        """Return the query that asks a question which is understood already.

        Raises:
            ObbError: as the class says.
        """
        query = cls.__new__(cls)
        query._set_up(pair, solid=solid, any_contact=any_contact)
        return query

    @classmethod
    def begun(cls, search: SteadyQuery, pair: PairQuestion) -> Query:
        """Return the query about a pair that goes on with a search of one slice so far."""
        query = cls.__new__(cls)
        query._start(pair, search)
        query._is_finished = search.is_finished
        query._spent = max(search.pops, 1)
        return query

    def _start(self, pair: PairQuestion, search: MotionSearch) -> None:
        self._pair = pair
        self._search = search
        self._solids: Containment | None = None
        # The question about t = 0 that solids ask where the search asks none.
        self._at_start: kernels.StaticQuery | None = None
        self._seconds = {"load": pair.load_seconds, "query": 0.0}
        self._is_finished = False
        self._spent = 0

    def _set_up(self, pair: PairQuestion, *, solid: bool, any_contact: bool) -> None:
        start = time.perf_counter()
        self._start(pair, search_of(pair, any_contact=any_contact))
        if solid:
            self._solids = self._containment()
        self._seconds["query"] = time.perf_counter() - start

    def _containment(self) -> Containment:
        """Return the question whether a part of one body is inside the other at t = 0."""
        pair = self._pair
        if isinstance(self._search, SteadyQuery):
            return Containment(pair.bodies, pair.trees, self._search.at_start)
        placed = next(legs_of(pair._replace(duration=0.0))).question(pair)
        self._at_start = static_query(placed)
        return Containment(placed.bodies, pair.trees, self._at_start)

    @property
    def is_finished(self) -> bool:
        """Whether the answer is complete."""
        return self._is_finished

    @property
    def lower_bound(self) -> float:
        """No contact in [0, lower_bound): proven. s."""
        return self._search.lower_bound

    @property
    def time(self) -> float:
        """Up to when the question has come, s: `lower_bound`, or the present sampled step."""
        return self._search.time

    @property
    def iterations(self) -> int:
        """What `advance` has taken of `max_iterations`: queue pops, and one for steps of none."""
        return self._spent

    @property
    def duration(self) -> float:
        """The end of the interval asked about, s."""
        return self._pair.duration

    @property
    def counts(self) -> Counts:
        """What the searches have cost so far."""
        counts = self._search.counts
        if self._solids is not None:
            counts += self._solids.counts
        return counts if self._at_start is None else counts + Counts(*self._at_start.counts())

    @property
    def _pops(self) -> int:
        """How many pairs were taken from queues so far, by all searches."""
        pops = self._search.pops
        if self._solids is not None:
            pops += self._solids.pops
        return pops if self._at_start is None else pops + self._at_start.counts()[3]

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
        budget = Budget(max_iterations, seconds).start()
        try:
            while not self._is_finished and self.time <= until:
                before = self._pops
                self._is_finished = self._step(budget.slice(), until)
                spent = max(self._pops - before, 1)
                self._spent += spent
                budget.spend(spent)
                if self._is_finished or budget.is_over:
                    break
        except kernels.TreeError as fault:
            raise damaged(self._pair.trees, fault) from fault
        finally:
            self._seconds["query"] += time.perf_counter() - start
        return self.answer()

    def _step(self, pops: int, until: float) -> bool:
        """Advance the question about solids, then the search; return whether all is answered."""
        if self._solids is not None:
            if not self._solids.advance(pops):
                return False
            if self._solids.contained is not None:
                return True
        return self._search.step(pops, until)

    def answer(self) -> FirstContact:
        """Return what is known now, as `advance`, without going on."""
        solids = self._solids
        is_contained = solids is not None and solids.contained is not None
        found = solids.answer() if solids and is_contained else self._search.contact()
        stats = stats_of(self._pair.trees, self.counts, dict(self._seconds))
        answer = FirstContact.of(found, stats)
        return self._pair.with_parts(answer, (answer.triangle_a, answer.triangle_b))
