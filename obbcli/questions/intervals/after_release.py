"""First contact after release: contact does not count until the bodies have been apart.

Parts that rest on each other at t = 0 are meant to touch there. What is asked is when they are
released, and when they touch again.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from obbcli.answers.contact import Contact, FirstContact
from obbcli.answers.status import Status
from obbcli.errors import MotionError, UnresolvedError
from obbcli.questions.describe import unresolved
from obbcli.questions.intervals.contact_intervals import intervals_of, length
from obbcli.questions.intervals.stretches import Tally, resolution
from obbcli.questions.legs.through_poses import PathQuery
from obbcli.questions.query import Query

if TYPE_CHECKING:
    from obbcli.answers.contact_piece import Bracket
    from obbcli.questions.pair_question import PairQuestion


class _Release(NamedTuple):
    """When bodies are apart first.

    Attributes:
        bracket: s; they touch up to its lower end, and are apart from its upper end on. None where
            they are never seen apart.
        since: s; a time at which they are proven to be apart; where they are not, that up to which
            they are proven to touch, if not all along.
        is_open: whether a limit or an undecided piece hides when it is, or whether it is.
    """

    bracket: Bracket | None
    since: float
    is_open: bool = False


def asked_after_release(
    pair: PairQuestion,
    after_release: bool,  # as `first_contact` is told it
    released_by: float,
    *,
    solid: bool,
) -> FirstContact:
    """Return the first contact after release, where that is asked for.

    Raises:
        MotionError: it is not, though it is said what releases the bodies.
        ObbError: as `contact_after_release`.
    """
    if not after_release:
        fault = "says when bodies are released, and no release is asked for"
        raise MotionError("released_by", fault, "add after_release=True")
    return contact_after_release(pair, released_by=released_by, solid=solid)


def contact_after_release(
    pair: PairQuestion, *, released_by: float = 0.0, solid: bool = False
) -> FirstContact:
    """Return the first contact after the bodies have been apart by more than a distance.

    Args:
        pair: the question.
        released_by: mesh units.
        solid: whether a body inside the other is in contact.

    Raises:
        ObbError: as `first_contact`; an accuracy that has a clearance, samples, or uses boxes for
            triangles is refused.
    """
    tally = Tally()
    released = _release(pair, length(released_by, "released_by"), tally, solid=solid)
    if released.bracket is None:
        found = unresolved(released.since) if released.is_open else _at_start(pair, solid=solid)
    elif released.bracket == (0.0, 0.0) and released.since == 0.0:
        answer = Query.about(pair).advance(pair.accuracy.max_iterations, pair.accuracy.timeout)
        tally.counts += answer.stats.counts
        found = answer
    else:
        found = _from(pair, released.since, tally)
    answer = FirstContact.of(found, tally.stats(pair))
    answer = pair.with_parts(answer, (answer.triangle_a, answer.triangle_b))
    return replace(answer, released=released.bracket)


def _release(pair: PairQuestion, distance: float, tally: Tally, *, solid: bool) -> _Release:
    """Return when the bodies are further apart than a distance first."""
    known = 0.0
    try:
        for piece in intervals_of(pair, within=distance, solid=solid, tally=tally):
            if piece.kind == "free":
                inner = piece.start[1] + min(
                    resolution(pair), 0.5 * max(piece.end[0] - piece.start[1], 0.0)
                )
                is_from_start = known == 0 and piece.start == (0.0, 0.0) and piece.end[0] > 0
                touched = is_from_start and _touch_at_start(pair, solid=solid)
                return _Release(piece.start, 0.0 if is_from_start and not touched else inner)
            if piece.kind == "undecided" and piece.end[1] - piece.start[0] > resolution(pair):
                return _Release(None, piece.start[0], is_open=True)
            known = piece.end[0]
    except UnresolvedError:
        return _Release(None, known, is_open=True)
    return _Release(None, known)


def _touch_at_start(pair: PairQuestion, *, solid: bool) -> bool:
    return _at_zero(pair, solid=solid).status is not Status.SEPARATED


def _at_zero(pair: PairQuestion, *, solid: bool) -> FirstContact:
    query = Query.about(pair._replace(duration=0.0), solid=solid)
    return query.advance(pair.accuracy.max_iterations, pair.accuracy.timeout)


def _at_start(pair: PairQuestion, *, solid: bool) -> Contact:
    """Return the contact of bodies that are never released: that at t = 0."""
    found = _at_zero(pair, solid=solid)
    if found.status is Status.SEPARATED:
        # Near, not touching: no nearer than the distance that would release them.
        return Contact(status=Status.OVERLAP_AT_START, time=0.0, time_bounds=(0.0, 0.0))
    return found


def _from(pair: PairQuestion, start: float, tally: Tally) -> Contact:
    """Return the first contact from a time on at which the bodies are proven to be apart."""
    from obbcli.questions.budget import Budget

    search = PathQuery(pair, start=start)
    budget = Budget(pair.accuracy.max_iterations, pair.accuracy.timeout).start()
    while not budget.is_over:
        before = search.pops
        if search.step(budget.slice(), math.inf):
            break
        budget.spend(max(search.pops - before, 1))
    tally.counts += search.counts
    return search.contact()
