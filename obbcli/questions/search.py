"""How the contacts of all pairs are looked for: as far as limits allow, and what that has cost.

`contacts` says what to look for, and asks here for each next contact.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.counts import Counts
from obbcli.answers.status import Status
from obbcli.errors import UnresolvedError
from obbcli.questions.border import damaged
from obbcli.questions.budget import Budget
from obbcli.questions.legs.leg import on_clock

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from obbcli.answers.contact import FirstContact
    from obbcli.questions.pair_question import Trees
    from obbcli.questions.query import Query


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
        self.counts = Counts()
        """What the search has cost so far."""
        self._budget = Budget(pops, seconds)
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
            before = Counts(*query.counts())
            try:
                is_finished = query.advance(self._budget.slice())
            except kernels.TreeError as fault:
                raise damaged(trees, fault) from fault
            self._count(Counts(*query.counts()) - before)
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
        self._look(proven)
        found = query.advance(self._budget.pops_left, self._budget.seconds_left)
        self._count(found.stats.counts)
        if found.status is Status.UNRESOLVED:
            raise _at_limit(proven)
        return found

    def _look(self, proven: float) -> None:
        """Say how far the search has come.

        Raises:
            UnresolvedError: no pops or no seconds are left.
        """
        if self._progress is not None:
            self._progress(proven)
        if self._budget.is_over:
            raise _at_limit(proven)

    def _count(self, spent: Counts) -> None:
        self.counts += spent
        self._budget.spend(spent.pops)


def _at_limit(proven: float) -> UnresolvedError:
    return _unresolved("stopped at a limit", proven, "raise max_iterations or timeout")


def _unresolved(fault: str, proven: float, remedy: str) -> UnresolvedError:
    known = f"all contacts before t = {proven!r} s are known, later ones are not"
    return UnresolvedError("contacts", f"{fault}: {known}", remedy, time=proven)
