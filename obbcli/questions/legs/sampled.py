"""The sampled method: a motion asked about step by step, on a model of it. Eberly 2008 §5.

`steps` makes the model and proves how far it is off; here the questions about it are asked.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from obbcli.answers.status import Status
from obbcli.questions.legs.relay import Relay
from obbcli.questions.legs.steps import steps_of
from obbcli.questions.steady import SEPARATED

if TYPE_CHECKING:
    from obbcli.answers.contact import Contact
    from obbcli.questions.legs.leg import Leg
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.questions.steady import SteadyQuery


class SampledQuery(Relay):
    """The question about bodies that move, step by step.

    Contact at t = 0 is decided exactly, since nothing has been sampled then. All else is said of
    the modelled paths alone: it is `approximate`, contact has `evidence="sampled"`, and the
    `error_bound` covers the steps up to it. No time but 0 is a proven bound.
    The duration is more than 0.

    Args:
        pair: the question.
        any_contact: whether any proof of contact will do, not of the first.
    """

    _error = 0.0

    def __init__(self, pair: PairQuestion, *, any_contact: bool = False) -> None:
        exact = replace(pair.accuracy, time_tolerance=pair.time_tolerance)
        timed = pair._replace(accuracy=exact)
        super().__init__(timed, steps_of(timed), any_contact=any_contact)

    @property
    def lower_bound(self) -> float:
        """0: samples prove nothing."""
        return 0.0

    @property
    def time(self) -> float:
        """When the present step starts, s."""
        return self._leg.start

    def _ask_about(self, leg: Leg) -> SteadyQuery:
        self._error = max(self._error, leg.slack)
        return self._question(leg, method="certified")

    def _until(self, time: float) -> float:  # noqa: ARG002  # a step says when it began alone
        return math.inf

    def _conclude(self, found: Contact) -> Contact | None:
        if found.status is Status.UNRESOLVED:
            return replace(found, time=0.0, time_bounds=(0.0, None))
        if found.time is not None:
            is_at_start = found.status is Status.OVERLAP_AT_START and self._leg.start == 0
            return found if is_at_start else self._sampled(found)
        leg = next(self._legs, None)
        if leg is None:
            return replace(SEPARATED, approximate=True, error_bound=self._error)
        self._go_on(leg, self._ask_about(leg))
        return None

    def _sampled(self, found: Contact) -> Contact:
        """Return a step's contact on the whole question's clock, and how far that is from truth."""
        assert found.time_bounds is not None
        low, high = found.time_bounds
        time = self._clock(low, up=False)
        end = None if high is None else max(time, self._clock(high, up=True))
        return replace(
            found,
            status=Status.CONTACT,
            time=time,
            time_bounds=(time, end),
            evidence="sampled",
            approximate=True,
            error_bound=found.error_bound + self._error,
        )
