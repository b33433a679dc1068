"""Motion through poses, asked about leg by leg: between break times, all velocities are constant.

The path of a body is continuous: each piece turns and goes as its velocities say from its own pose,
and what rounding leaves between its end and the next pose is closed on the shortest way. Legs are
proven with that much to spare, so that nothing slips through between two of them.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING

from obbcli.answers.status import Status
from obbcli.motion.body import Body, missing_pivot
from obbcli.questions.legs.leg import Leg, length_of
from obbcli.questions.legs.nearness import near_until
from obbcli.questions.legs.relay import Relay
from obbcli.questions.legs.slack import jump_at, rounding_of
from obbcli.questions.steady import SEPARATED

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.answers.contact import Contact
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.questions.steady import SteadyQuery
    from obbcli.tree.tree import ObbTree


def legs_of(pair: PairQuestion, start: float = 0.0) -> Iterator[Leg]:
    """Yield the legs of [start, duration], earliest first; the last may be an instant.

    Args:
        pair: the question.
        start: s, at most the duration.

    Raises:
        MotionError: positions leave the range of double.
    """
    breaks = {start}
    for body in pair.bodies:
        breaks.update(body.motion.breaks(start, pair.duration))
    starts = sorted(breaks)
    sides = tuple(zip(pair.bodies, pair.trees, strict=True))
    for begin, end in zip(starts, [*starts[1:], pair.duration], strict=True):
        (a, error_a), (b, error_b) = (_placed(body, tree, begin) for body, tree in sides)
        jumps = sum(jump_at(body, tree, end) for body, tree in sides) if end > begin else 0.0
        yield Leg(begin, length_of(begin, end), (a, b), error_a + error_b + jumps)


def _placed(body: Body, tree: ObbTree, time: float) -> tuple[Body, float]:
    """Return the body with pose and velocities at a time, and by how much that is off its path."""
    moment = body.motion.moment(time, body.pose, missing_pivot(body, tree))
    error = rounding_of(tree, *moment.summands) if moment.summands else 0.0
    return Body(tree, moment.pose, moment.motion), error


class PathQuery(Relay):
    """The question about bodies of which one changes its velocities, leg by leg.

    A leg is first asked with its slack as clearance: apart is then a proof for the true paths, and
    the lower bound too. Where that is contact, the leg's own path is asked for its evidence (with
    its slack off the clearance, if there is one), and then the instant at which the next leg
    starts. If neither shows any, closeness remains, and the bracket holds all of the time for which
    the bodies are as close.

    Args:
        pair: the question.
        any_contact: whether any proof of contact will do, not of the first.
        start: s; from when on contact counts. No other time is looked at.
    """

    _near: Contact | None = None
    _near_leg: Leg  # on which the bodies come near
    _later_leg: Leg | None = None  # the one after it
    _is_at_end = False  # whether the present question is the instant after the near leg

    def __init__(
        self, pair: PairQuestion, *, any_contact: bool = False, start: float = 0.0
    ) -> None:
        # The bracket of an answer joins two: when the bodies come near, and when they touch. Each
        # may take half of the width asked for.
        half = replace(pair.accuracy, time_tolerance=0.5 * pair.time_tolerance)
        halved = pair._replace(accuracy=half)
        super().__init__(halved, legs_of(halved, start), any_contact=any_contact)

    @property
    def lower_bound(self) -> float:
        """No contact in [0, lower_bound): proven. s."""
        known = self._answer or self._near
        if known is None:
            return self._clock(self._query.lower_bound, up=False)
        return self._pair.duration if known.time is None else known.time

    def _until(self, time: float) -> float:
        # A near contact lies before `time` already, so the question about it runs to its end.
        return super()._until(time) if self._near is None else math.inf

    def _conclude(self, found: Contact) -> Contact | None:
        """Return the answer after that of the present question, or ask the next one."""
        if found.status is Status.UNRESOLVED:
            low = self.lower_bound
            return replace(found, time=low, time_bounds=(low, None))
        if found.time is not None:
            found = self._on_clock(found)
            if self._leg.slack == 0 or (self._near is not None and self._holds(found)):
                return found
            if self._near is None:
                return self._come_near(found)
        if self._near is not None:
            return self._look_closer()
        leg = next(self._legs, None)
        if leg is None:
            return SEPARATED
        self._go_on(leg, self._ask_about(leg))
        return None

    def _come_near(self, near: Contact) -> Contact | None:
        """Ask for evidence of contact on a leg whose bodies come near."""
        self._near, self._near_leg = near, self._leg
        # At t = 0 nothing was rounded yet.
        is_at_start = near.time == 0 and self._leg.start == 0 and self._pair.accuracy.clearance > 0
        leg = self._leg._replace(duration=0.0, slack=0.0) if is_at_start else self._leg
        self._go_on(leg, self._ask_closely(leg))
        return None

    def _look_closer(self) -> Contact | None:
        """Ask the next question about bodies that are near, or return that nothing is decided."""
        assert self._near is not None
        if self._leg.slack == 0 and self._near_leg.slack > 0 and not self._is_at_end:
            self._go_on(self._near_leg, self._ask_closely(self._near_leg))
            return None
        # The pose after a leg may touch although the leg's own end, rounded, does not.
        if not self._is_at_end and (leg := next(self._legs, None)) is not None:
            self._later_leg = leg
            if self._is_soon(leg.start):
                self._is_at_end = True
                instant = leg._replace(duration=0.0)
                self._go_on(instant, self._ask_closely(instant))
                return None
        return self._near if self._any_contact else self._undecided(self._near)

    def _undecided(self, near: Contact) -> Contact:
        """Return near bodies with a bracket that holds all of the time for which they are near."""
        assert near.time_bounds is not None
        assert near.distance is not None or near.evidence == "boxes"
        low, high = near.time_bounds
        if high is None or near.distance is None:
            return near
        later = [] if self._later_leg is None else [self._later_leg]
        legs = chain((self._near_leg, *later), self._legs)
        end, distance = near_until(self._pair, legs, max(low - self._near_leg.start, 0.0))
        return replace(
            near,
            status=Status.CONTACT,
            time_bounds=(low, max(end, high)),
            distance=max(distance, near.distance + self._near_leg.slack),
        )

    def _holds(self, found: Contact) -> bool:
        """Return whether contact on a leg is contact on the true paths, as far as can be said."""
        if found.evidence != "within_tolerance" or self._leg.slack == 0:
            return True
        assert found.distance is not None
        accuracy = self._pair.accuracy
        enough = max(accuracy.clearance - self._leg.slack, accuracy.distance_tolerance or 0.0)
        return found.distance <= enough

    def _is_soon(self, time: float) -> bool:
        assert self._near is not None
        assert self._near.time is not None
        return time - self._near.time <= self._pair.time_tolerance

    def _ask_closely(self, leg: Leg) -> SteadyQuery:
        """Return the question whose contact is one on the true paths too, where that can be had."""
        if self._pair.accuracy.clearance == 0:
            return self._question(leg)
        clearance = max(self._pair.accuracy.clearance - leg.slack, 0.0)
        return self._question(leg, clearance=clearance)

    def _ask_about(self, leg: Leg) -> SteadyQuery:
        return self._question(leg, clearance=self._pair.accuracy.clearance + leg.slack)

    def _on_clock(self, found: Contact) -> Contact:
        """Return a leg's contact on the whole question's clock, from what is proven on."""
        assert found.time_bounds is not None
        low, high = found.time_bounds
        if self._near is None:
            low = self._clock(low, up=False)
        else:
            assert self._near.time is not None
            low = self._near.time
        end = None if high is None else max(low, self._clock(high, up=True))
        # The exact test at t = 0 has found the surfaces apart, so nearness alone is no overlap.
        is_near = found.evidence == "within_tolerance" and self._pair.accuracy.clearance == 0
        is_at_start = low == 0 and not end and found.status is Status.OVERLAP_AT_START
        return replace(
            found,
            status=Status.OVERLAP_AT_START if is_at_start and not is_near else Status.CONTACT,
            time=low,
            time_bounds=(low, end),
        )
