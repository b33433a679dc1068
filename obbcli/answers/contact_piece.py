"""`ContactPiece`: a stretch of a motion in which bodies touch, or are free, by proof."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

PieceKind: TypeAlias = Literal["contact", "free", "touch", "undecided"]
Bracket: TypeAlias = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class ContactPiece:
    """A stretch of a motion, and what is proven of it.

    Attributes:
        kind: `"contact"`: the bodies touch at every instant from `start[1]` to `end[0]`; `"free"`:
            at none of these; `"touch"`: contact shorter than can be resolved, within `start`, which
            `end` equals; `"undecided"`: neither is proven, though contact or freedom may be.
        start: s; (lo, hi): the piece begins in this bracket.
        end: s; (lo, hi): it ends in this one, where the next piece starts; that of a touch holds
            the ends of both its neighbours.
    """

    kind: PieceKind
    start: Bracket
    end: Bracket
