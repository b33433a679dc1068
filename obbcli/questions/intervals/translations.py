"""Bodies that only translate: the union of the exact contact intervals of their triangles.

Seen from each other two triangles go straight, so that they touch in one interval, whose ends are
rational. No witness is needed: faces that slide on each other touch as others do.
"""

from __future__ import annotations

import math
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.answers.contact_piece import ContactPiece
from obbcli.primitives import PrimitiveContacts, Triangle
from obbcli.primitives import first_contact as triangles_in_contact
from obbcli.questions.contacts import search_contacts
from obbcli.questions.intervals.look import Look
from obbcli.questions.intervals.stretches import is_inside
from obbcli.questions.legs.through_poses import legs_of
from obbcli.questions.search import Search

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.answers.contact import Contact
    from obbcli.answers.contact_piece import Bracket
    from obbcli.questions.intervals.stretches import Asked

# Pairs whose last contacts are asked for at once.
_BLOCK = 1024
_AT_START = (0.0, 0.0)


class _Part(NamedTuple):
    """A time in which bodies touch, or do not, and the brackets of its ends."""

    touches: bool
    start: Bracket
    end: Bracket


def translations(asked: Asked) -> Iterator[ContactPiece]:
    """Yield the pieces of bodies of constant linear velocities, earliest first.

    Ends that no double can tell apart are one.

    Raises:
        UnresolvedError: a limit was reached; all that is known before its `time` was yielded.
        ObbError: as `contact_intervals`.
    """
    contact: _Part | None = None
    for part in _parts(asked):
        if part.touches:
            contact = part if contact is None else contact._replace(end=part.end)
            continue
        if contact is not None:
            yield _contact(contact)
            contact = None
        yield ContactPiece(kind="free", start=part.start, end=part.end)
    if contact is not None:
        yield _contact(contact)


def _contact(part: _Part) -> ContactPiece:
    if part.start[1] < part.end[0]:
        return ContactPiece(kind="contact", start=part.start, end=part.end)
    whole = (part.start[0], part.end[1])
    return ContactPiece(kind="touch", start=whole, end=whole)


def _parts(asked: Asked) -> Iterator[_Part]:
    """Yield when surfaces touch, and the times between, in which solids may hold each other."""
    before: Bracket | None = None
    last = asked.pair.duration, asked.pair.duration
    for start, end in _unions(asked):
        if start != _AT_START:
            begin = before or _AT_START
            yield _Part(_are_inside(asked, begin, start), begin, start)
        yield _Part(True, start, end)
        before = end
    if before is None or before[0] < last[0]:
        begin = before or _AT_START
        yield _Part(_are_inside(asked, begin, last), begin, last)


def _are_inside(asked: Asked, start: Bracket, end: Bracket) -> bool:
    """Return whether one solid is inside the other between two contacts of surfaces."""
    if not asked.solid:
        return False
    leg = next(legs_of(asked.pair))
    posed, _error = Look(asked.pair, leg, 0.0).posed(0.5 * start[1] + 0.5 * end[0])
    return is_inside(posed, asked.budget)


def _unions(asked: Asked) -> Iterator[tuple[Bracket, Bracket]]:
    """Yield the intervals in which any triangles touch, earliest first, by brackets of ends."""
    start: Bracket | None = None
    end = -math.inf
    for first, last in _pair_intervals(asked):
        if start is not None and first[0] <= end:
            end = max(end, last)
            continue
        if start is not None:
            yield start, _end(start, end, asked.pair.duration)
        start, end = first, last
    if start is not None:
        yield start, _end(start, end, asked.pair.duration)


def _end(start: Bracket, end: float, duration: float) -> Bracket:
    """Return the bracket of an end, given by the double that is nearest to it."""
    if end >= duration:
        return (duration, duration)
    if end == 0 == start[1]:
        return (0.0, 0.0)
    return (math.nextafter(end, 0.0), math.nextafter(end, duration))


def _pair_intervals(asked: Asked) -> Iterator[tuple[Bracket, float]]:
    """Yield when each pair of triangles touches first and last, in order of the first times."""
    budget = asked.budget
    pops = budget.pops_left
    search = Search(1 if pops is None else pops, budget.seconds_left)
    found = search_contacts(asked.pair, search)
    size = 1
    while block := list(islice(found, size)):
        yield from zip(map(_first, block), _lasts(asked, block), strict=True)
        size = min(2 * size, _BLOCK)
        asked.tally.counts = search.counts


def _first(contact: Contact) -> Bracket:
    assert contact.time_bounds is not None
    low, high = contact.time_bounds
    assert high is not None
    return low, high


def _lasts(asked: Asked, block: list[Contact]) -> list[float]:
    """Return when pairs that touch do so last, s: the nearest doubles."""
    rows = np.array([(one.triangle_a, one.triangle_b) for one in block])
    a, b = (
        Triangle(np.array([body.pose.apply(tree.triangle(row)) for row in column]))
        for body, tree, column in zip(
            asked.pair.bodies, asked.pair.trees, rows.T.tolist(), strict=True
        )
    )
    here, there = (body.motion.linear_velocity for body in asked.pair.bodies)
    found = triangles_in_contact(a, b, here, there, asked.pair.duration, threads=1)
    assert isinstance(found, PrimitiveContacts)
    lasts = [one.time if one.time is not None else 0.0 for one in block]
    for row, last in zip(found.rows.tolist(), found.last_time.tolist(), strict=True):
        lasts[row] = max(lasts[row], last)
    return lasts
