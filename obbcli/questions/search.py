"""How the contacts of all pairs are looked for: as far as limits allow, and what that has cost.

`contacts` says what to look for, and asks here for each next contact.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.status import Status
from obbcli.errors import UnresolvedError
from obbcli.questions.border import POPS_A_SLICE, damaged
from obbcli.questions.legs.relay import on_clock, sum_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from obbcli.answers.contact import FirstContact
    from obbcli.questions.border import Trees
    from obbcli.questions.first_contact import Query
    from obbcli.questions.legs.relay import Counts


class Search:
    """The limits of a search for contacts, and its counters.

    Args:
        pops: how many pairs may be taken from queues.
        seconds: of wall time from the first question on. None: no limit.
        end: s; later contacts are of no interest.
        progress: called now and then with the time before which all contacts are known, s.
    """

    def __init__(
        self,
        pops: int,
        seconds: float | None = None,
        *,
        end: float = math.inf,
        progress: Callable[[float], object] | None = None,
    ) -> None:
        self.end = end
        self.counts: Counts = (0, 0, 0, 0)
        """Box tests, triangle tests, exact ones and pops so far."""
        self._left = pops
        self._seconds = math.inf if seconds is None else seconds
        self._stop: float | None = None
        self._progress = progress

    def found(
        self, query: kernels.ContactQuery, trees: Trees, start: float = 0.0
    ) -> Iterator[kernels.Contact]:
        """Yield what the kernels find, earliest first, until all that follows is of no interest.

        Args:
            query: about each pair.
            trees: those it is about.
            start: s; where its clock begins.

        Raises:
            TreeFileError: a tree file is damaged.
            UnresolvedError: a limit was reached, or bodies turn too fast.
        """
        is_finished = False
        while True:
            found = query.take()
            if found is not None:
                yield found
                continue
            proven = on_clock(start, query.lower_bound, math.inf, up=False)
            if proven > self.end:
                return
            if is_finished:
                break
            self._look(proven)
            before = query.counts()
            try:
                is_finished = query.advance(min(self._left, POPS_A_SLICE))
            except kernels.TreeError as fault:
                raise damaged(trees, fault) from fault
            self._count(query.counts(), before)
        if query.has_given_up:
            raise _unresolved(
                "bodies turn too fast to be followed", proven, "ask about a shorter duration"
            )

    def answer(self, query: Query, proven: float) -> FirstContact:
        """Return the answer about a single pair.

        Args:
            query: about nothing else.
            proven: s; all other contacts before it are known.

        Raises:
            UnresolvedError: a limit was reached.
        """
        found = query.advance(self._left, self._look(proven))
        stats = found.stats
        self._count((stats.box_tests, stats.triangle_tests, stats.exact_triangle_tests, stats.pops))
        if found.status is Status.UNRESOLVED:
            raise _at_limit(proven)
        return found

    def _look(self, proven: float) -> float:
        """Say how far the search has come, and return the seconds left to it.

        Raises:
            UnresolvedError: no pops or no seconds are left.
        """
        if self._progress is not None:
            self._progress(proven)
        now = time.perf_counter()
        if self._stop is None:
            self._stop = now + self._seconds
        if self._left <= 0 or now >= self._stop:
            raise _at_limit(proven)
        return self._stop - now

    def _count(self, counts: Counts, before: Counts = (0, 0, 0, 0)) -> None:
        boxes, triangles, exact, pops = (
            now - then for now, then in zip(counts, before, strict=True)
        )
        self.counts = sum_of(self.counts, (boxes, triangles, exact, pops))
        self._left -= pops


def _at_limit(proven: float) -> UnresolvedError:
    return _unresolved("stopped at a limit", proven, "raise max_iterations or timeout")


def _unresolved(fault: str, proven: float, remedy: str) -> UnresolvedError:
    known = f"all contacts before t = {proven!r} s are known, later ones are not"
    return UnresolvedError("contacts", f"{fault}: {known}", remedy, time=proven)
