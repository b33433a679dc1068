"""How many threads to use, `thread_count`; and two pieces of work at the same time, `both`."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, TypeVar

from obbcli.errors import ObbError

if TYPE_CHECKING:
    from collections.abc import Callable

_First = TypeVar("_First")
_Second = TypeVar("_Second")

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


def both(
    first: Callable[[], _First], second: Callable[[], _Second], *, at_once: bool
) -> tuple[_First, _Second]:
    """Return what two functions return.

    Where both fail it is the first one's error that is raised, as if they were called in turn. An
    interrupt waits for the second.

    Args:
        first: called by this thread.
        second: called by another one meanwhile if `at_once`, else after the first.
        at_once: whether that pays: both take longer than to start a thread, most of it without the
            interpreter's lock.

    Raises:
        Exception: what they raise.
    """
    if not at_once or usable_cores() < 2:
        return first(), second()
    from threading import Thread

    results: list[_Second] = []
    faults: list[Exception] = []

    def work() -> None:
        try:
            results.append(second())
        except Exception as fault:  # noqa: BLE001  # raised again by the caller
            faults.append(fault)

    thread = Thread(target=work, name="second")
    try:
        thread.start()
    except RuntimeError:  # the system gives no more threads
        return first(), second()
    try:
        found = first()
    finally:
        thread.join()
    for fault in faults:
        raise fault
    return found, results[0]
