"""`FreeRange`: for how long two bodies are free around t = 0, and what stops them either way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from obbcli.answers.contact import Contact
    from obbcli.answers.counts import QueryStats


@dataclass(frozen=True, kw_only=True)
class FreeRange:
    """The free interval around t = 0.

    Attributes:
        free: s; (lo, hi), lo at most 0: the bodies are proven free at every instant between. None
            where they touch at t = 0.
        complete: whether both ends are known; False where a limit was reached before.
        before: what stops them as time runs backwards, its times counted from 0 that way; its
            status is separated where nothing does.
        after: what stops them as time runs on, likewise.
        stats: what the question cost.
    """

    free: tuple[float, float] | None
    complete: bool
    before: Contact
    after: Contact
    stats: QueryStats
