"""What a question answers: status words, results and the counters behind them, all frozen.

Kernels and queries fill them, reports read them; nothing here computes.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from obbcli.errors import UnresolvedError

if TYPE_CHECKING:
    from collections.abc import Mapping

Vector: TypeAlias = tuple[float, float, float]
# The body that lies inside the other, or a part of it does.
Inner: TypeAlias = Literal["a", "b"]


class Status(str, Enum):
    """How a question ended; the values are the words of the JSON documents."""

    SEPARATED = "separated"
    """No contact in the whole closed interval: a proof, unless the answer was sampled."""
    CONTACT = "contact"
    """First contact at a time later than 0."""
    OVERLAP_AT_START = "overlap_at_start"
    """Contact at t = 0, touching included; also of bodies at rest."""
    UNRESOLVED = "unresolved"
    """A limit was reached before the answer was known."""

    def __str__(self) -> str:
        """Return the bare word."""
        return self.value


class QueryStats(NamedTuple):
    """What a question cost.

    Attributes:
        box_tests: pairs of boxes tested.
        triangle_tests: pairs of triangles tested.
        exact_triangle_tests: those of them that exact arithmetic had to decide.
        pops: pairs taken from the queue or stack.
        nodes_built_a: nodes of A's tree that exist after the question; a lazy tree builds only what
            is asked for.
        nodes_built_b: the same for B.
        nodes_possible_a: nodes that A's tree can have.
        nodes_possible_b: the same for B.
        seconds: s of wall time by stage.
    """

    box_tests: int
    triangle_tests: int
    exact_triangle_tests: int
    pops: int
    nodes_built_a: int
    nodes_built_b: int
    nodes_possible_a: int
    nodes_possible_b: int
    seconds: Mapping[str, float]


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
    """

    status: Status
    witness: tuple[int, int] | None
    approximate: bool
    error_bound: float
    stats: QueryStats
    contained: Inner | None = None

    def __init__(
        self,
        status: Status,
        witness: tuple[int, int] | None,
        approximate: bool,
        error_bound: float,
        stats: QueryStats,
        contained: Inner | None = None,
    ) -> None:
        # At once: what the dataclass would do field by field takes longer than many a question.
        vars(self).update(
            status=status,
            witness=witness,
            approximate=approximate,
            error_bound=error_bound,
            stats=stats,
            contained=contained,
        )

    @property
    def collides(self) -> bool:
        """Return whether the bodies touch.

        Raises:
            UnresolvedError: a limit was reached before the answer was known.
        """
        return _collides(self.status)


@dataclass(frozen=True, kw_only=True)
class Contact:
    """When and where two moving bodies, or two triangles of theirs, first touch.

    Fields that do not apply are None.

    Attributes:
        status: how the question ended. `Status.SEPARATED` is a proof for the whole closed interval,
            unless `approximate`.
        time: s; no contact before it, proven: the lower end of `time_bounds`. None where separated.
        time_bounds: s; (lo, hi): no contact before lo, contact at hi as `evidence` says. hi is None
            where boxes met or nothing is known beyond lo.
        evidence: `"intersecting"`: triangles proven to meet at hi; `"within_tolerance"`: points of
            both proven closer than `distance` at hi; `"boxes"`: boxes that stand for triangles met;
            `"sampled"`: time, bounds and place are those of the sampled paths, and nothing is
            proven but `error_bound`.
        point: world coordinates at `time`, midway between `point_a` and `point_b`; of a body inside
            the other, one of its vertices.
        point_a: the nearest point of A.
        point_b: the nearest point of B.
        normal: unit, from A to B: the axis that separated the two last.
        normal_a: unit normal of A's face (of a box: of the ellipsoid in it, Eberly 2008 §7.2).
        normal_b: the same of B, towards A.
        triangle_a: row of A's mesh file.
        triangle_b: row of B's mesh file.
        feature: what meets what, A's first: `"vertex-face"`, `"edge-edge"`, ...; `"box"`.
        distance: mesh units; proven bound on the gap at hi. 0 where triangles intersect.
        contained: of solids that do not touch at t = 0, `"a"` where A or a connected part of it
            lies inside B, else `"b"` where B or a part of it lies inside A. None elsewhere. It is
            its own proof: as no surfaces meet, evidence, triangles and distance are None.
        approximate: whether boxes stood for triangles, so that contact is not proven, or the motion
            was sampled, so that nothing is.
        error_bound: mesh units; how far apart the surfaces can be although contact is said; of a
            sampled answer also by how much any point's path relative to the other body was off the
            true one, up to the contact. 0 where exact.
    """

    status: Status
    time: float | None = None
    time_bounds: tuple[float, float | None] | None = None
    evidence: str | None = None
    point: Vector | None = None
    point_a: Vector | None = None
    point_b: Vector | None = None
    normal: Vector | None = None
    normal_a: Vector | None = None
    normal_b: Vector | None = None
    triangle_a: int | None = None
    triangle_b: int | None = None
    feature: str | None = None
    distance: float | None = None
    contained: Inner | None = None
    approximate: bool = False
    error_bound: float = 0.0

    @property
    def collides(self) -> bool:
        """Return whether the bodies touch.

        Raises:
            UnresolvedError: a limit was reached before the answer was known.
        """
        return _collides(self.status)


@dataclass(frozen=True, kw_only=True)
class FirstContact(Contact):
    """The first contact of two bodies, and what it cost to know.

    Attributes:
        stats: what the question cost.
    """

    stats: QueryStats

    @classmethod
    def of(cls, contact: Contact, stats: QueryStats) -> FirstContact:
        """Return a contact with the counters of its question."""
        return cls(**{**vars(contact), "stats": stats})


@dataclass(frozen=True, kw_only=True)
class Distance:
    """How far apart two bodies are at rest.

    Attributes:
        distance: mesh units; the upper one of `bounds`. 0 where the surfaces touch, and only there.
        bounds: mesh units; (lo, hi), both proven. A limit that ended the search leaves them wide.
        point_a: where on A hi was measured, world coordinates, rounded to double. Of bodies that
            touch a common point.
        point_b: where on B.
        triangle_a: row of A's mesh file that `point_a` lies in.
        triangle_b: row of B's mesh file that `point_b` lies in.
        stats: what the question cost.
    """

    distance: float
    bounds: tuple[float, float]
    point_a: Vector
    point_b: Vector
    triangle_a: int
    triangle_b: int
    stats: QueryStats


def _collides(status: Status) -> bool:
    if status is Status.UNRESOLVED:
        raise UnresolvedError(
            "collides",
            "the question stopped at a limit before its answer was known",
            "raise max_iterations or timeout",
        )
    return status is not Status.SEPARATED
