"""Asking the kernels about bodies on a common screw: by images at once, or by steps alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli import kernels
from obbcli.answers.counts import Counts
from obbcli.questions.border import moving_query, static_query

if TYPE_CHECKING:
    from obbcli.questions.pair_question import PairQuestion

AT_ONCE, NEVER = 0, 2**63
MOST_POPS = 100_000


class Found(NamedTuple):
    """What one way says of a question."""

    status: str
    low: float
    contact: kernels.Contact | None
    counts: Counts

    def is_proven(self, clearance: float) -> bool:
        """Whether contact within the clearance is proven by the end of the bracket."""
        found = self.contact
        return found is not None and (
            found.evidence is kernels.Evidence.INTERSECTING or found.distance <= clearance
        )


def ask(pair: PairQuestion, before: int) -> Found:
    """Ask the kernels, with images from so many box tests on."""
    query = moving_query(pair, box_tests_before_screw=before)
    is_done = False
    while not is_done and query.counts()[3] < MOST_POPS:
        is_done = query.advance(MOST_POPS - query.counts()[3])
    contact = query.contact()
    status = "contact" if contact else "separated"
    if not is_done or query.has_given_up:
        status = "unresolved"
    return Found(status, query.lower_bound, contact, Counts(*query.counts()))


def is_apart_at_start(pair: PairQuestion) -> bool:
    query = static_query(pair)
    while not query.advance(MOST_POPS):
        pass
    return not query.is_contact
