"""How kernels are pursued: slice by slice, as far as one budget for all of them allows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from obbcli.answers.counts import Counts
from obbcli.questions.budget import POPS_A_SLICE, Budget

if TYPE_CHECKING:
    from collections.abc import Callable

    from obbcli.accuracy import Accuracy


class Resumable(Protocol):
    """A question of the kernels."""

    def advance(self, steps: int, /) -> bool:
        """Go on for so many steps; return whether the answer is complete."""


class Pursuit:
    """One budget for all that is asked about two bodies, and what it has cost.

    Args:
        accuracy: whose `max_iterations` and `timeout` end it.

    Attributes:
        counts: what the searches have cost so far.
        is_complete: whether no search was ended by a limit.
        cells: pieces of space and of surfaces that were bounded.
        points: points whose depth was measured.
        rays: that told what is inside.
    """

    def __init__(self, accuracy: Accuracy) -> None:
        self.counts = Counts()
        self.is_complete = True
        self.cells = self.points = self.rays = 0
        self._budget = Budget(accuracy.max_iterations, accuracy.timeout).start()

    @property
    def steps_left(self) -> int:
        """How many steps may still be taken, as `Budget` has it."""
        return self._budget.pops_left or 0

    @property
    def seconds_left(self) -> float | None:
        """How many seconds may still be taken; None: no limit."""
        return self._budget.seconds_left

    def run(self, query: Resumable, taken: Callable[[], int], slice_steps: int = 0) -> bool:
        """Advance a question to its end or to the end of the budget; return whether it ended.

        Args:
            query: of the kernels.
            taken: how many steps it has taken so far.
            slice_steps: between two looks at the clock. 0: as many as for pops of a queue.
        """
        most = slice_steps or POPS_A_SLICE
        before = taken()
        while not query.advance(min(self._budget.slice(), most)):
            now = taken()
            self._budget.spend(max(now - before, 1))
            before = now
            if self._budget.is_over:
                self.is_complete = False
                return False
        self._budget.spend(taken() - before)
        return True

    def take_step(self) -> bool:
        """Take a step outside of the kernels; return whether the budget allows it."""
        if self._budget.is_over:
            self.is_complete = False
            return False
        self._budget.spend(1)
        return True

    def count(self, counts: tuple[int, int, int, int, int]) -> None:
        """Add what a search has cost."""
        self.counts += Counts(*counts)

    def count_cells(self, cells: int, points: int, rays: int) -> None:
        """Add what a search for a depth has cost."""
        self.cells += cells
        self.points += points
        self.rays += rays

    def spend(self, counts: Counts) -> None:
        """Add what a search has cost that took its steps by itself."""
        self.counts += counts
        self._budget.spend(counts.pops)
