"""When and where two bodies touch: one contact, and the first of a question, both frozen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from obbcli.answers.status import Inner, Status, is_contact
from obbcli.answers.words import EvidenceWord, FeatureWord  # noqa: TC001  # kinds of fields are read

if TYPE_CHECKING:
    from obbcli.answers.counts import QueryStats

Vector: TypeAlias = tuple[float, float, float]


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
            both proven closer than `distance` at hi, and where that is more than the clearance,
            contact in the bracket or none until they have parted again; `"boxes"`: boxes that stand
            for triangles met; `"sampled"`: time, bounds and place are those of the sampled paths,
            and nothing is proven but `error_bound`.
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
        part_a: path of the part of A that `triangle_a` is of, where `FILE#PATTERN` selected parts.
        part_b: path of the part of B that `triangle_b` is of, likewise.
    """

    status: Status
    time: float | None = None
    time_bounds: tuple[float, float | None] | None = None
    evidence: EvidenceWord | None = None
    point: Vector | None = None
    point_a: Vector | None = None
    point_b: Vector | None = None
    normal: Vector | None = None
    normal_a: Vector | None = None
    normal_b: Vector | None = None
    triangle_a: int | None = None
    triangle_b: int | None = None
    feature: FeatureWord | None = None
    distance: float | None = None
    contained: Inner | None = None
    approximate: bool = False
    error_bound: float = 0.0
    part_a: str | None = None
    part_b: str | None = None

    @property
    def collides(self) -> bool:
        """Return whether the bodies touch.

        Raises:
            UnresolvedError: a limit was reached before the answer was known.
        """
        return is_contact(self.status)


@dataclass(frozen=True, kw_only=True)
class FirstContact(Contact):
    """The first contact of two bodies, and what it cost to know.

    Attributes:
        stats: what the question cost.
        released: s; where contact was not to count until the bodies have been apart: (lo, hi), when
            they were first. None where they never were, or nothing of the kind was asked.
    """

    stats: QueryStats
    released: tuple[float, float] | None = None

    @classmethod
    def of(cls, contact: Contact, stats: QueryStats) -> FirstContact:
        """Return a contact with the counters of its question."""
        # The fields are set past the frozen dataclass, whose own way takes longer than a question.
        made = object.__new__(cls)
        vars(made).update(vars(contact), stats=stats)
        return made
