"""How many threads to use: `thread_count`, for all that works on several cores at once."""

from __future__ import annotations

import os

from obbcli.errors import ObbError

# More than any machine at hand has cores; each costs memory.
_MOST_THREADS = 256


def usable_cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def thread_count(threads: int | None) -> int:
    """Return a number of threads for the kernels; None: one a core that may be used.

    Raises:
        ObbError: `threads` is no positive integer.
    """
    if threads is None:
        return min(usable_cores(), _MOST_THREADS)
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise ObbError("threads", f"is {threads!r}", "expected a positive integer or None")
    return min(threads, _MOST_THREADS)
