"""Whether two bodies touch: the yes or no, frozen. When and where they do is in `contact`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from obbcli.answers.counts import QueryStats
from obbcli.answers.status import Status, is_contact

if TYPE_CHECKING:
    from obbcli.answers.status import Inner

    _Counts = tuple[int, int, int, int, int, int, int, int]
    # What `Collision.at_rest` takes.
    Found = tuple[bool, bool, float, tuple[int, int] | None, float, _Counts]

# Looking them up in the enumeration takes as long as a test of two boxes.
_SEPARATED, _OVERLAP_AT_START = Status.SEPARATED, Status.OVERLAP_AT_START
_UNRESOLVED = Status.UNRESOLVED
_new = object.__new__


@dataclass(frozen=True, init=False)
class Collision:
    """Whether two bodies touch at any time asked about.

    Attributes:
        status: how the question ended. `Status.SEPARATED` is a proof unless `approximate`.
        witness: the ids of a triangle of A and one of B that meet; None where nothing meets or
            where boxes stand for their triangles.
        approximate: whether boxes stood for triangles, so that contact is not proven, or the motion
            was sampled, so that nothing is.
        error_bound: mesh units; how far apart the surfaces can be although contact is said; of a
            sampled answer also by how much any point's path relative to the other body was off the
            true one. 0 where exact.
        stats: what the question cost.
        contained: of solids that do not touch, `"a"` where A or a connected part of it lies inside
            B, else `"b"` where B or a part of it lies inside A. None elsewhere.
        part_a: path of the part of A that the witness is of, where `FILE#PATTERN` selected parts.
        part_b: path of the part of B that it is of, likewise.
    """

    status: Status
    witness: tuple[int, int] | None
    approximate: bool
    error_bound: float
    stats: QueryStats
    contained: Inner | None = None
    part_a: str | None = None
    part_b: str | None = None

    def __init__(
        self,
        status: Status,
        witness: tuple[int, int] | None,
        approximate: bool,
        error_bound: float,
        stats: QueryStats,
        contained: Inner | None = None,
        part_a: str | None = None,
        part_b: str | None = None,
    ) -> None:
        # The fields are set past the frozen dataclass, whose own way takes longer than a question.
        fields = vars(self)
        fields["status"] = status
        fields["witness"] = witness
        fields["approximate"] = approximate
        fields["error_bound"] = error_bound
        fields["stats"] = stats
        fields["contained"] = contained
        fields["part_a"] = part_a
        fields["part_b"] = part_b

    @classmethod
    def at_rest(cls, found: Found, load: float = 0.0) -> Collision:
        """Return what the kernels found of bodies at rest.

        Args:
            found: whether the question was answered, whether boxes met, how far apart these hold
                what they stand for, the witness, s of wall time, and the numbers of `QueryStats`.
            load: s of wall time that the trees took before.
        """
        is_complete, by_boxes, error_bound, witness, seconds, counts = found
        status = _SEPARATED
        if by_boxes or witness is not None:
            status = _OVERLAP_AT_START
        elif not is_complete:
            status = _UNRESOLVED
        made: Collision = _new(cls)
        fields = made.__dict__
        fields["status"] = status
        fields["witness"] = witness
        fields["approximate"] = by_boxes
        fields["error_bound"] = error_bound
        fields["contained"] = None
        fields["_cost"] = counts, load, seconds
        return made

    def _stats(self) -> QueryStats:
        cost: tuple[_Counts, float, float] = vars(self)["_cost"]
        counts, load, seconds = cost
        return QueryStats(*counts, {"load": load, "query": seconds})

    @property
    def collides(self) -> bool:
        """Return whether the bodies touch.

        Raises:
            UnresolvedError: a limit was reached before the answer was known.
        """
        # The common statuses are compared in place: a call takes as long as a test of two boxes.
        status = self.status
        if status is _UNRESOLVED:
            return is_contact(status)
        return status is not _SEPARATED


# Only made where they are looked at: that takes as long as many a question. Set from here, so that
# the field has no default.
_late = cached_property(Collision._stats)
_late.__set_name__(Collision, "stats")
Collision.stats = _late  # type: ignore[assignment]
