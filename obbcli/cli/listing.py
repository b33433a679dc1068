"""The contacts that `obbtree first-contact` lists: those of the first, or the first N."""

from __future__ import annotations

import math
import time
from itertools import islice
from typing import TYPE_CHECKING

from obbcli.answers.status import Status
from obbcli.cli.boundary import CancelledError
from obbcli.cli.progress import proving
from obbcli.errors import UnresolvedError
from obbcli.report.contacts import Listing

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.answers.contact import Contact, FirstContact
    from obbcli.answers.counts import QueryStats
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.questions.search import Search


def list_contacts(
    pair: PairQuestion,
    first: FirstContact,
    limit: int | None,
    *,
    is_patch: bool,
    progress: bool,
) -> tuple[Listing, QueryStats]:
    """Return the contacts of all pairs, and what it cost to know them and the first.

    Args:
        pair: the question, about bodies on trees.
        first: what came out; what it left of the limits is left to the list.
        limit: at most so many contacts.
        is_patch: whether to list those alone whose bracket overlaps that of the first.
        progress: whether a bar may be drawn.

    Raises:
        CancelledError: Ctrl-C.
    """
    from obbcli.questions.contacts import search_contacts
    from obbcli.questions.search import Search

    if first.status is Status.SEPARATED or first.time is None:
        return Listing([], is_complete=True), first.stats
    if first.status is Status.UNRESOLVED:
        return Listing([], is_complete=False, unresolved_after=first.time), first.stats
    accuracy, spent = pair.accuracy, first.stats
    start = time.perf_counter()
    with proving(pair.duration, "all contacts known before", wanted=progress) as show:
        search = Search(
            accuracy.max_iterations - spent.pops,
            None if accuracy.timeout is None else accuracy.timeout - spent.seconds["query"],
            end=_end_of(first, pair) if is_patch else math.inf,
            progress=show,
        )
        listing = _listed(search_contacts(pair, search), first.time, limit)
    return listing, _with(spent, search, pair, time.perf_counter() - start)


def _end_of(first: FirstContact, pair: PairQuestion) -> float:
    """Return the time up to which contacts belong to the first, s."""
    assert first.time_bounds is not None
    low, high = first.time_bounds
    # Of boxes nothing says when there is contact: a bracket as wide as one may be.
    return low + pair.time_tolerance if high is None else high


def _listed(found: Iterator[Contact], first_time: float, limit: int | None) -> Listing:
    """Return contacts as far as limits allow."""
    contacts: list[Contact] = []
    try:
        contacts.extend(islice(found, limit))
    except UnresolvedError as fault:
        return Listing(contacts, is_complete=False, unresolved_after=fault.time or 0.0)
    except KeyboardInterrupt as fault:
        known = f"first contact at t = {first_time!r} s: proven; found of the list: {len(contacts)}"
        raise CancelledError("", "interrupted", known) from fault
    return Listing(contacts, is_complete=len(contacts) != limit)


def _with(spent: QueryStats, search: Search, pair: PairQuestion, seconds: float) -> QueryStats:
    """Return what an answer and its list cost together."""
    from obbcli.questions.border import stats_of

    counts = spent.counts + search.counts
    return stats_of(pair.trees, counts, {**spent.seconds, "contacts": seconds})
