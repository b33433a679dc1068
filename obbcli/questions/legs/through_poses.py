"""Motion through poses, asked about leg by leg: between break times, all velocities are constant.

The path of a body is continuous: each piece turns and goes as its velocities say from its own pose,
and what rounding leaves between its end and the next pose is closed on the shortest way. Legs are
proven with that much to spare, so that nothing slips through between two of them.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from obbcli.answers.contact import FirstContact
from obbcli.answers.status import Status
from obbcli.motion.body import Body, missing_pivot
from obbcli.questions.legs.relay import Leg, Relay, length_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.accuracy import Accuracy
    from obbcli.motion.pose import Pose
    from obbcli.questions.border import Trees
    from obbcli.questions.first_contact import Query
    from obbcli.tree.tree import ObbTree

# Of the coordinates: posing a vertex thrice (12 u each), a matrix product (16 u) and the pose in
# closed form (28 u) come to a third of this; the rest lets the kernels prove closeness within it.
ROUNDING = 2.0**-45


def legs_of(bodies: tuple[Body, Body], trees: Trees, duration: float) -> Iterator[Leg]:
    """Yield the legs of [0, duration], earliest first; the last may be an instant.

    Raises:
        MotionError: positions leave the range of double.
    """
    breaks = {0.0}
    for body in bodies:
        breaks.update(body.motion.breaks(0.0, duration))
    starts = sorted(breaks)
    pairs = tuple(zip(bodies, trees, strict=True))
    for start, end in zip(starts, [*starts[1:], duration], strict=True):
        (a, error_a), (b, error_b) = (_placed(body, tree, start) for body, tree in pairs)
        jumps = sum(jump_at(body, tree, end) for body, tree in pairs) if end > start else 0.0
        yield Leg(start, length_of(start, end), (a, b), error_a + error_b + jumps)


def _placed(body: Body, tree: ObbTree, time: float) -> tuple[Body, float]:
    """Return the body with pose and velocities at a time, and by how much that is off its path."""
    moment = body.motion.moment(time, body.pose, missing_pivot(body, tree))
    error = rounding_of(tree, *moment.summands) if moment.summands else 0.0
    return Body(tree, moment.pose, moment.motion), error


def rounding_of(tree: ObbTree, *vectors: NDArray[np.float64]) -> float:
    """Bound what rounding moves a vertex by where these are added up."""
    return ROUNDING * sum(map(norm, (*vectors, np.abs(tree.bounds).max(axis=0))))


def jump_at(body: Body, tree: ObbTree, time: float) -> float:
    """Bound how far any vertex is from the next pose where a piece ends at this time."""
    jump = body.motion.jump(time)
    if jump is None:
        return 0.0
    return _apart(tree, jump.end, jump.after) + rounding_of(tree, *jump.summands)


def _apart(tree: ObbTree, a: Pose, b: Pose) -> float:
    """Bound how far two poses put any vertex apart, but for rounding."""
    low, high = tree.bounds
    center = 0.5 * low + 0.5 * high
    turned = a.rotation - b.rotation
    middle = turned @ center + (a.translation - b.translation)
    return norm(middle) + math.hypot(*turned.ravel().tolist()) * norm(high - center)


def norm(vector: NDArray[np.float64]) -> float:
    """Return a vector's length."""
    return math.hypot(*vector.tolist())


class LegQueries(Relay):
    """The question about bodies with paths, leg by leg.

    A leg is first asked with its slack as clearance: apart is then a proof for the true paths, and
    the lower bound too. Where that is contact, the leg's own path is asked for its evidence, and
    then the instant at which the next leg starts; if neither shows any, closeness remains.

    """

    _near: FirstContact | None = None
    _is_at_end = False  # only the instant after the leg of the near contact is left

    @staticmethod
    def _legs_of(
        bodies: tuple[Body, Body],
        trees: Trees,
        duration: float,
        accuracy: Accuracy,  # noqa: ARG004
    ) -> Iterator[Leg]:
        return legs_of(bodies, trees, duration)

    @property
    def lower_bound(self) -> float:
        """No contact in [0, lower_bound): proven. s."""
        known = self._answer or self._near
        if known is None:
            return self._clock(self._query.lower_bound, up=False)
        return self._duration if known.time is None else known.time

    def _until(self, time: float) -> float:
        # What is near is known to be at a time before.
        return super()._until(time) if self._near is None else math.inf

    def _conclude(self, found: FirstContact) -> FirstContact | None:
        """Return the answer after that of the present question, or ask the next one."""
        if found.status is Status.UNRESOLVED:
            return self._unresolved(found.stats)
        if found.time is not None:
            found = self._on_clock(found)
            if self._near is not None or self._leg.slack == 0:
                return found
            self._near = found
            self._go_on(self._leg, self._ask_close)
            return None
        leg = next(self._legs, None)
        if self._near is None:
            if leg is None:
                return FirstContact(status=Status.SEPARATED, stats=found.stats)
            self._go_on(leg, self._ask_about)
            return None
        # Contact at the very end of a leg may show only in the pose after it.
        if leg is None or self._is_at_end or not self._is_soon(leg.start):
            return self._near
        self._is_at_end = True
        self._go_on(leg._replace(duration=0.0), self._ask_close)
        return None

    def _is_soon(self, time: float) -> bool:
        assert self._near is not None
        assert self._near.time is not None
        return time - self._near.time <= (self._accuracy.time_tolerance or 0.0)

    def _ask_close(self, leg: Leg) -> Query:
        return super()._ask_about(leg)

    def _ask_about(self, leg: Leg) -> Query:
        clearance = self._accuracy.clearance + leg.slack
        return self._ask(*leg.bodies, leg.duration, replace(self._accuracy, clearance=clearance))

    def _on_clock(self, found: FirstContact) -> FirstContact:
        """Return a leg's contact on the whole question's clock, from what is proven on."""
        assert found.time_bounds is not None
        low, high = found.time_bounds
        if self._near is None:
            low = self._clock(low, up=False)
        else:
            assert self._near.time is not None
            low = self._near.time
        end = None if high is None else max(low, self._clock(high, up=True))
        # What is but near at t = 0 was decided exactly to be apart then.
        is_near = found.evidence == "within_tolerance" and self._accuracy.clearance == 0
        is_at_start = low == 0 and not end and found.status is Status.OVERLAP_AT_START
        return replace(
            found,
            status=Status.OVERLAP_AT_START if is_at_start and not is_near else Status.CONTACT,
            time=low,
            time_bounds=(low, end),
        )
