"""What a fuzz target is."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable


class BrokenPromiseError(BaseException):
    """A promise of ours did not hold; no reader may take it for an error of its file."""


class Target(NamedTuple):
    """Something that reads bytes.

    Args:
        seeds: returns inputs to begin with.
        run: takes any bytes; whatever it raises is a finding.
        cost: as many times fewer inputs are run of it, as each takes a process of its own.
    """

    seeds: Callable[[], list[bytes]]
    run: Callable[[bytes], None]
    cost: int = 1


def require(holds: object, promise: str) -> None:
    """Raise where a promise is broken."""
    if not holds:
        raise BrokenPromiseError(promise)
