"""How near two moving bodies come to each other, and when, frozen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

from obbcli.answers.contact import Vector  # noqa: TC001  # kinds of fields are read

if TYPE_CHECKING:
    from obbcli.answers.contact import Contact
    from obbcli.answers.counts import QueryStats

VerdictWord: TypeAlias = Literal["holds", "violated", "open"]


@dataclass(frozen=True, kw_only=True)
class LeastClearance:
    """The least distance of two bodies over an interval of time.

    Attributes:
        bounds: mesh units; (lo, hi): at no time are the bodies nearer than lo, and at `time` they
            are no further apart than hi. (0, 0) where they are proven to touch. hi is None where a
            limit ended the search before any distance was known.
        time: s; when they are so near. Of bodies that touch, the upper end of the first contact's
            bracket.
        when: s; stretches of time (lo, hi), in order: at all other times the bodies are proven to
            be further apart than the upper end of `bounds`. Of bodies that touch, from the first
            contact on.
        when_share: the part of the duration that `when` takes; 1 where the duration is 0.
        point_a: where on A the distance at `time` was measured, world coordinates.
        point_b: where on B.
        triangle_a: row of A's mesh file that `point_a` lies in.
        triangle_b: row of B's mesh file that `point_b` lies in.
        part_a: path of the part of A that `triangle_a` is of, where `FILE#PATTERN` selected parts.
        part_b: path of the part of B that `triangle_b` is of, likewise.
    """

    bounds: tuple[float, float | None]
    time: float | None = None
    when: tuple[tuple[float, float], ...] = ()
    when_share: float = 1.0
    point_a: Vector | None = None
    point_b: Vector | None = None
    triangle_a: int | None = None
    triangle_b: int | None = None
    part_a: str | None = None
    part_b: str | None = None


@dataclass(frozen=True, kw_only=True)
class GreatestClearance:
    """The greatest distance of two bodies over an interval of time.

    Attributes:
        bounds: mesh units; (lo, hi): at `time` the bodies are at least lo apart, and at no time
            more than hi.
        time: s; when they are so far apart.
        point_a: a point of A that is nearest to B then, world coordinates.
        point_b: the one of B nearest to it.
        triangle_a: row of A's mesh file that `point_a` lies in.
        triangle_b: row of B's mesh file that `point_b` lies in.
    """

    bounds: tuple[float, float]
    time: float
    point_a: Vector
    point_b: Vector
    triangle_a: int
    triangle_b: int


@dataclass(frozen=True, kw_only=True)
class CurvePiece:
    """The least distance of two bodies in one interval of a curve.

    Attributes:
        start: s; where the interval begins.
        end: s; where it ends; both times are part of it.
        bounds: mesh units; (lo, hi): in all of the interval the bodies are never nearer than lo,
            and at `time` no further apart than hi. hi is None where a limit came first.
        time: s; None where a limit came first.
    """

    start: float
    end: float
    bounds: tuple[float, float | None]
    time: float | None = None


@dataclass(frozen=True, kw_only=True)
class AtLeast:
    """Whether two bodies keep a distance.

    Attributes:
        distance: mesh units; what was asked.
        verdict: `"holds"`: they are proven never to be nearer; `"violated"`: they are nearer at
            `time`; `"open"`: neither is proven.
        time: s; a time at which they are nearer, not always the first: that is what
            `first_contact` with this clearance tells. None where none is known.
    """

    distance: float
    verdict: VerdictWord
    time: float | None = None


@dataclass(frozen=True, kw_only=True)
class Clearance:
    """How near two moving bodies come to each other in [0, duration].

    Attributes:
        minimum: the least distance, when and where.
        maximum: the greatest distance, when and where; None where it was not asked for, or a limit
            ended the search before.
        curve: the least distance in each of equal intervals, in order; None where not asked for.
        at_least: whether they keep the distance asked about; None where none was.
        first_contact: when and where they first touch; None where they are not known to.
        complete: whether the search ended before a limit. Where not, the bracket is wide.
        stats: what the question cost.
    """

    minimum: LeastClearance
    maximum: GreatestClearance | None = None
    curve: tuple[CurvePiece, ...] | None = None
    at_least: AtLeast | None = None
    first_contact: Contact | None = None
    complete: bool = True
    stats: QueryStats
