"""What `stability` returns: rows, one an extreme, frozen."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Mapping

    from obbcli.answers.contact import FirstContact
    from obbcli.answers.distance import Distance
    from obbcli.answers.overlap import Overlap
    from obbcli.answers.status import Status

Outcome: TypeAlias = Literal["same", "agrees", "within bound", "unresolved", "refused", "broken"]


@dataclass(frozen=True, kw_only=True)
class Row:
    """One extreme: what was expected of it, and what came out.

    Attributes:
        family: what was changed.
        extreme: by how much.
        magnitude: the same as a number.
        expected: `"same bits"` of status and times; `"within bound"`: no contradiction, once either
            question gets the bound as clearance; `"proven"`: the answer agrees with bodies at rest.
        bound: mesh units; no point is further than this from where the question itself has it.
        why: how the bound was derived.
        status: what was answered; None where it was refused.
        time_bounds: s; on the clock of the question itself.
        difference: s; how far the lower ends of the two brackets are apart. None where either has
            none.
        outcome: `"same"` in every bit; `"agrees"`: both can be true; `"within bound"`: the answers
            differ, and the bound explains it; `"unresolved"`: no answer, and no contradiction;
            `"refused"` as no double holds it; `"broken"`.
        held: whether what was expected is so.
        reason: what the outcome comes from; empty where there is nothing to say.
    """

    family: str
    extreme: str
    magnitude: float
    expected: str
    bound: float
    why: str
    status: Status | None
    time_bounds: tuple[float, float | None] | None
    difference: float | None
    outcome: Outcome
    held: bool
    reason: str


@dataclass(frozen=True, kw_only=True)
class RestRow(Row):
    """One extreme of a question about bodies at rest, which has neither status nor times.

    Attributes:
        relation: what was answered, of an overlap; None where it was refused, and of a distance.
        bounds: the brackets of the answer by their names, in mesh units of the question itself; hi
            is None where it is not known.
        difference: mesh units; the furthest that lower ends are from those of the question itself.
    """

    relation: str | None = None
    bounds: Mapping[str, tuple[float, float | None]] = field(default_factory=dict)


@dataclass(frozen=True)
class Stability:
    """What became of a question at its extremes.

    Attributes:
        answer: to the question itself: a `FirstContact`, a `Distance` or an `Overlap`.
        rows: one an extreme.
    """

    answer: FirstContact | Distance | Overlap
    rows: tuple[Row, ...]

    @property
    def broken(self) -> tuple[Row, ...]:
        """What ought to hold and does not: a defect of obbtree's."""
        return tuple(row for row in self.rows if not row.held)
