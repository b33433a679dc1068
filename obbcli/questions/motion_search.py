"""`MotionSearch`: how a first contact is looked for, and which way suits a question."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from obbcli.questions.legs.sampled import SampledQuery
from obbcli.questions.legs.through_poses import PathQuery
from obbcli.questions.steady import SteadyQuery

if TYPE_CHECKING:
    from obbcli.answers.contact import Contact
    from obbcli.answers.counts import Counts
    from obbcli.questions.pair_question import PairQuestion


class MotionSearch(Protocol):
    """How the first contact of one kind of motion is looked for."""

    @property
    def lower_bound(self) -> float:
        """No contact in [0, lower_bound): proven. s."""

    @property
    def time(self) -> float:
        """Up to when the search has come, s."""

    @property
    def counts(self) -> Counts:
        """What the search has cost so far."""

    @property
    def pops(self) -> int:
        """How many pairs were taken from queues so far."""

    def step(self, pops: int, until: float) -> bool:
        """Go on for so many pops, no further than `until`, s; return whether all is answered."""

    def contact(self) -> Contact:
        """Return what is known now."""


def search_of(pair: PairQuestion, *, any_contact: bool) -> MotionSearch:
    """Return the search that suits the motions and the method of a question."""
    if pair.accuracy.method == "sampled" and not pair.is_at_rest:
        return SampledQuery(pair, any_contact=any_contact)
    if pair.is_steady:
        return SteadyQuery(pair, any_contact=any_contact)
    return PathQuery(pair, any_contact=any_contact)
