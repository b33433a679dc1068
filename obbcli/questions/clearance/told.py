"""Parts of the answer about a clearance, made of what searches have found."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from obbcli.answers.clearance import AtLeast, GreatestClearance

if TYPE_CHECKING:
    from obbcli.answers.clearance import CurvePiece, LeastClearance, VerdictWord
    from obbcli.questions.clearance.curve import CurveSearch
    from obbcli.questions.clearance.greatest import GreatestSearch


def verdict_of(limit: float | None, least: LeastClearance) -> AtLeast | None:
    """Return whether bodies keep a distance; None where that was not asked."""
    if limit is None:
        return None
    low, high = least.bounds
    verdict: VerdictWord = "open"
    if low >= limit:
        verdict = "holds"
    elif high is not None and high < limit:
        verdict = "violated"
    time = least.time if verdict == "violated" else None
    return AtLeast(distance=limit, verdict=verdict, time=time)


def greatest_of(search: GreatestSearch | None) -> GreatestClearance | None:
    """Return the greatest distance as far as it is known; None where it was not looked for."""
    if search is None or search.high == math.inf:
        return None
    assert search.place is not None
    return GreatestClearance(bounds=(search.low, search.high), **search.place._asdict())


def curve_of(search: CurveSearch | None) -> tuple[CurvePiece, ...] | None:
    """Return the curve as far as it is known; None where it was not begun."""
    return None if search is None else search.all_pieces()
