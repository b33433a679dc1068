"""`Budget`: what a search may still take, in queue pops and in wall time."""

from __future__ import annotations

import math
from time import perf_counter

# Queue pops between two looks at clock and signals: a few milliseconds. The kernels end a slice
# earlier where pops take long.
POPS_A_SLICE = 16_384


class Budget:
    """Queue pops and seconds that a search may still take.

    Args:
        pops: None: no limit.
        seconds: of wall time, from `start` on or from the first look at the clock. None: no limit.
    """

    def __init__(self, pops: int | None = None, seconds: float | None = None) -> None:
        self._pops = None if pops is None else max(pops, 0)
        self._seconds = math.inf if seconds is None else seconds
        self._stop: float | None = None

    def start(self) -> Budget:
        """Start the clock, if it has not started yet, and return this budget."""
        if self._stop is None:
            self._stop = perf_counter() + self._seconds
        return self

    def slice(self) -> int:
        """Return how many pops the search may take until it looks again."""
        return POPS_A_SLICE if self._pops is None else min(self._pops, POPS_A_SLICE)

    def spend(self, pops: int) -> None:
        """Count pops that were taken."""
        if self._pops is not None:
            self._pops = max(self._pops - pops, 0)

    @property
    def pops_left(self) -> int | None:
        """How many pops are left; None: no limit."""
        return self._pops

    @property
    def seconds_left(self) -> float | None:
        """How many seconds are left, at least 0; None: no limit."""
        self.start()
        assert self._stop is not None
        return None if self._stop == math.inf else max(self._stop - perf_counter(), 0.0)

    @property
    def is_over(self) -> bool:
        """Whether no pops or no seconds are left."""
        self.start()
        assert self._stop is not None
        return self._pops == 0 or perf_counter() >= self._stop
