"""Pieces of a motion, made of proven stretches: what lies between two of them is named too."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.answers.contact_piece import ContactPiece

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.answers.contact_piece import Bracket, PieceKind
    from obbcli.questions.intervals.stretches import Stretch


def pieces_of(
    stretches: Iterator[Stretch], duration: float, tolerance: float
) -> Iterator[ContactPiece]:
    """Yield the pieces of [0, duration], earliest first.

    A gap between contact and free that is no wider than the tolerance is where one ends and the
    other starts; between two free stretches it is a touch. Every other gap is undecided.

    Args:
        stretches: earliest first; none begins before the end of the one before it.
        duration: s.
        tolerance: s.
    """
    gaps = _Gaps(tolerance)
    start: Bracket = (0.0, 0.0)
    kind: PieceKind | None = None
    low = end = 0.0
    for found in stretches:
        if kind == found.kind and found.start <= end:
            end = max(end, found.end)
            continue
        filling, bounds = gaps.between(kind, found.kind, end, found.start)
        if kind is not None:
            yield _piece(kind, start, low, bounds[0])
        if filling is not None:
            yield filling
        kind, start, low, end = found.kind, bounds[1], found.start, found.end
    if kind is not None:
        last = gaps.until(duration, end)
        yield _piece(kind, start, low, last)
        end = last[1]
    if kind is None or end < duration:
        yield ContactPiece(kind="undecided", start=(end, end), end=(duration, duration))


class _Gaps:
    """What stands between two stretches."""

    def __init__(self, tolerance: float) -> None:
        self._tolerance = tolerance

    def between(
        self, kind: PieceKind | None, later: PieceKind, end: float, start: float
    ) -> tuple[ContactPiece | None, tuple[Bracket, Bracket]]:
        """Return the piece in a gap, if any, and the brackets of its neighbours' ends there."""
        is_short = start - end <= self._tolerance
        together = (end, start)
        if is_short and kind != later:
            return None, (together, together)
        if is_short and kind == "free":
            touch = ContactPiece(kind="touch", start=together, end=together)
            return touch, (together, together)
        before, after = (end, end), (start, start)
        if kind is None:
            before = (0.0, 0.0)
        return ContactPiece(kind="undecided", start=before, end=after), (before, after)

    def until(self, duration: float, end: float) -> Bracket:
        """Return where the last stretch ends."""
        if 0 < duration - end <= self._tolerance:
            return (end, duration)
        return (end, end)


def _piece(kind: PieceKind, start: Bracket, low: float, end: Bracket) -> ContactPiece:
    if kind == "contact" and end[0] <= low:
        # Contact that is proven at one instant alone.
        whole = (start[0], end[1])
        return ContactPiece(kind="touch", start=whole, end=whole)
    return ContactPiece(kind=kind, start=start, end=end)
