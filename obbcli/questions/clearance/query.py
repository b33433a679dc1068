"""How near do two moving bodies come? `ClearanceQuery`, which goes on where it stopped."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import CLEARANCE_TOLERANCE
from obbcli.answers.clearance import Clearance, LeastClearance
from obbcli.answers.contact import Contact
from obbcli.answers.counts import Counts
from obbcli.answers.status import Status
from obbcli.questions.border import damaged, out_of_range, stats_of
from obbcli.questions.budget import Budget
from obbcli.questions.clearance.asked import Asked, refuse_other_accuracy
from obbcli.questions.clearance.at_rest import RestSearch
from obbcli.questions.clearance.curve import CurveSearch
from obbcli.questions.clearance.found import joined, share_of
from obbcli.questions.clearance.greatest import GreatestSearch
from obbcli.questions.clearance.moving import MovingSearch
from obbcli.questions.clearance.told import curve_of, greatest_of, verdict_of
from obbcli.questions.pair_question import PairQuestion
from obbcli.questions.query import Query

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import FirstContact
    from obbcli.motion.body import Body, Shape
    from obbcli.questions.clearance.found import LeastSearch

_CONTACT = (Status.CONTACT, Status.OVERLAP_AT_START)


class ClearanceQuery:
    """The least distance of two moving bodies, as a question that can be advanced.

    At any moment `bounds` are proven. Bodies that touch are asked for their first contact.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        duration: s; the closed interval [0, duration] is asked about. None: 1 where a body moves,
            else 0.
        accuracy: its `max_iterations` and `timeout` are left to the caller of `advance`; its other
            fields say nothing here.
        tolerance: relative width asked of the bracket.
        at_least: mesh units; ask only whether the bodies keep this distance.
        solid: whether closed surfaces hold what is inside them: a body inside the other touches.
        greatest: whether the greatest distance is asked for, too.

    Raises:
        MotionError: an argument is refused, a field of `accuracy` has no meaning here, or positions
            leave the range of double.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, 10, 0]))
        >>> query = ClearanceQuery(finger, "sample_meshes/workpiece.obj")
        >>> query.advance().minimum.time, query.is_finished
        (0.0, True)
    """

    def __init__(
        self,
        a: Body | Shape,
        b: Body | Shape,
        duration: float | None = None,
        accuracy: Accuracy | None = None,
        *,
        tolerance: float = CLEARANCE_TOLERANCE,
        at_least: float | None = None,
        solid: bool = False,
        greatest: bool = False,
    ) -> None:
        asked = Asked.of(tolerance, at_least, solid, greatest)
        if accuracy is not None:
            refuse_other_accuracy(accuracy)
        self._set_up(PairQuestion.of(a, b, duration, accuracy), asked)

    @classmethod
    def about(cls, pair: PairQuestion, asked: Asked) -> ClearanceQuery:
        """Return the query that asks a question which is understood already.

        Raises:
            ObbError: as the class says.
        """
        query = cls.__new__(cls)
        query._set_up(pair, asked)
        return query

    def _set_up(self, pair: PairQuestion, asked: Asked) -> None:
        start = time.perf_counter()
        self._pair, self._asked = pair, asked
        self._search: LeastSearch | None = None
        self._at_start: Query | None = None
        self._contact: Query | None = None
        self._touching: FirstContact | None = None
        self._greatest: GreatestSearch | None = None
        self._curve: CurveSearch | None = None
        self._spent = 0
        self._is_least_found = False
        self._is_finished = False
        if asked.solid:
            instant = pair._replace(duration=0.0)
            self._at_start = Query.about(instant, solid=True)
        else:
            self._begin()
        self._seconds = {"load": pair.load_seconds, "query": time.perf_counter() - start}

    def _begin(self) -> None:
        """Begin the search for the least distance."""
        pair = self._pair
        try:
            is_at_rest = pair.is_at_rest or (pair.is_steady and pair.moves_nothing)
            self._search = RestSearch(pair) if is_at_rest else MovingSearch(pair, self._asked)
        except kernels.TreeError as fault:
            raise damaged(pair.trees, fault) from fault
        except ValueError as fault:
            if type(fault) is not ValueError:
                raise
            raise out_of_range(pair.trees, "motion", fault) from fault

    @property
    def is_finished(self) -> bool:
        """Whether the answer is complete."""
        return self._is_finished

    @property
    def iterations(self) -> int:
        """What `advance` has taken of `max_iterations`: queue pops, and one for steps of none."""
        return self._spent

    @property
    def bounds(self) -> tuple[float, float]:
        """Proven now: the least distance is at least the one and at most the other, mesh units.

        The upper one is infinite while no distance is known.
        """
        if self._touches:
            return 0.0, 0.0
        if self._search is None:
            return 0.0, math.inf
        low = 0.0 if self._search.is_contact else self._search.low
        return low, self._search.high

    @property
    def _touches(self) -> bool:
        """Whether the bodies are proven to touch."""
        if self._search is not None and self._search.is_contact:
            return True
        found = self._touching
        return (
            found is not None and found.status in _CONTACT and found.evidence != "within_tolerance"
        )

    @property
    def counts(self) -> Counts:
        """What the searches have cost so far."""
        counts = Counts() if self._search is None else self._search.counts
        for query in (self._at_start, self._contact):
            if query is not None:
                counts += query.counts
        for search in (self._greatest, self._curve):
            if search is not None:
                counts += search.counts
        return counts

    def advance(self, max_iterations: int | None = None, seconds: float | None = None) -> Clearance:
        """Go on for so many queue pops or seconds, and return what is known then.

        Signals are looked at every few milliseconds.

        Args:
            max_iterations: queue pops. None: no limit.
            seconds: wall time. None: no limit.

        Raises:
            MotionError: positions leave the range of double.
            TreeFileError: a tree file is damaged.
        """
        start = time.perf_counter()
        budget = Budget(max_iterations, seconds).start()
        try:
            while not self._is_finished:
                before = self.counts.pops
                self._is_finished = self._step(budget.slice())
                spent = max(self.counts.pops - before, 1)
                self._spent += spent
                budget.spend(spent)
                if self._is_finished or budget.is_over:
                    break
        except kernels.TreeError as fault:
            raise damaged(self._pair.trees, fault) from fault
        finally:
            self._seconds["query"] += time.perf_counter() - start
        return self.answer()

    def _step(self, pops: int) -> bool:
        """Take at most so many pops of what is to be asked next; return whether all is answered."""
        if not self._is_least_found:
            self._is_least_found = self._find_least(pops)
            return self._is_least_found and not (self._asked.greatest or self._asked.intervals)
        asked = self._asked
        if asked.greatest:
            if self._greatest is None:
                self._greatest = GreatestSearch(self._pair, asked.tolerance)
            if not self._greatest.step():
                return False
        if not asked.intervals:
            return True
        if self._curve is None:
            self._curve = CurveSearch(self._pair, asked.tolerance, asked.intervals)
        return self._curve.step(pops)

    def _find_least(self, pops: int) -> bool:
        """Go on with the least distance; return whether it is found."""
        if self._contact is not None:
            self._touching = self._contact.advance(pops)
            return self._contact.is_finished
        if self._search is None:
            assert self._at_start is not None
            found = self._at_start.advance(pops)
            if not self._at_start.is_finished:
                return False
            if found.status is Status.OVERLAP_AT_START:
                self._touching = found
                return True
            self._begin()
            return False
        if not self._search.step(pops):
            return False
        if not self._is_contact_open():
            return True
        self._contact = Query.about(self._pair)
        return False

    def _is_contact_open(self) -> bool:
        """Return whether the first contact is to be asked for: of bodies that touch, or may."""
        assert self._search is not None
        if self._search.is_contact:
            return True
        return self._asked.at_least is None and self._search.low == 0

    def answer(self) -> Clearance:
        """Return what is known now, as `advance`, without going on."""
        least = self._least()
        contact = self._first_contact()
        return Clearance(
            minimum=self._pair.with_parts(least, (least.triangle_a, least.triangle_b)),
            maximum=greatest_of(self._greatest),
            curve=curve_of(self._curve),
            at_least=verdict_of(self._asked.at_least, least),
            first_contact=contact,
            complete=self._is_finished,
            stats=stats_of(self._pair.trees, self.counts, dict(self._seconds)),
        )

    def _first_contact(self) -> Contact | None:
        """Return the first contact where the bodies touch and it is known."""
        found = self._touching
        if found is None or found.status not in _CONTACT or not self._touches:
            return None
        fields = {name: vars(found)[name] for name in Contact.__dataclass_fields__}
        return Contact(**fields)

    def _least(self) -> LeastClearance:
        """Return the least distance as far as it is known."""
        low, high = self.bounds
        duration = self._pair.duration
        contact = self._first_contact()
        if contact is not None:
            assert contact.time_bounds is not None
            begin, end = contact.time_bounds
            spans = [(begin, duration)]
            return LeastClearance(
                bounds=(0.0, 0.0),
                time=begin if end is None else end,
                when=((begin, duration),),
                when_share=share_of(spans, duration),
                point_a=contact.point_a,
                point_b=contact.point_b,
                triangle_a=contact.triangle_a,
                triangle_b=contact.triangle_b,
            )
        search = self._search
        place = None if search is None else search.place
        if search is None or place is None:
            return LeastClearance(bounds=(low, None), when=((0.0, duration),))
        spans = [(0.0, duration)] if search.is_contact else joined(search.when())
        return LeastClearance(
            bounds=(low, high),
            when=tuple(spans),
            when_share=share_of(spans, duration),
            **place._asdict(),
        )
