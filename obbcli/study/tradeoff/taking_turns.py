"""What calls that take turns on the clock share: their parts of the time, and no collector."""

from __future__ import annotations

import gc
import math
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


def fair_part(costs: Iterable[float], available: float) -> float:
    """Return the most that each may take, so that together they take what is available."""
    ordered = sorted(costs)
    for index, cost in enumerate(ordered):
        sharers = len(ordered) - index
        if cost * sharers > available:
            return max(available, 0.0) / sharers
        available -= cost
    return math.inf


@contextmanager
def no_collections() -> Iterator[None]:
    """Keep the garbage collector from taking its time inside one call or another."""
    was_on = gc.isenabled()
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
