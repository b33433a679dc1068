"""Whether two bodies touch: the yes or no, frozen. When and where they do is in `contact`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.counts import QueryStats
from obbcli.answers.status import Status, is_contact

if TYPE_CHECKING:
    from obbcli.answers.status import Inner


@kernels.made_by_kernels
@dataclass(frozen=True, init=False)
class Collision(kernels.AtRestAnswer):
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
        self._hold(status, witness, approximate, error_bound, stats)
        # What is None is so by default.
        rest = {"contained": contained, "part_a": part_a, "part_b": part_b}
        vars(self).update((name, value) for name, value in rest.items() if value is not None)


# How the kernels' questions end: apart, touching, stopped.
_OF_BODIES_AT_REST = Status.SEPARATED, Status.OVERLAP_AT_START, Status.UNRESOLVED
kernels.set_answer_classes(
    Collision,
    QueryStats,
    (Status.SEPARATED, Status.OVERLAP_AT_START, Status.UNRESOLVED),
    is_contact,
)
