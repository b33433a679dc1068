"""How two bodies lie to each other at rest, and how deep one reaches into the other, frozen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from obbcli.answers.contact import Vector  # noqa: TC001  # kinds of fields are read
from obbcli.answers.counts import Counts
from obbcli.answers.status import Inner  # noqa: TC001

if TYPE_CHECKING:
    from collections.abc import Mapping

RelationWord: TypeAlias = Literal[
    "clear",
    "near",
    "touching",
    "overlapping",
    "contained",
    "duplicate",
    "crossing",
    "unresolved",
]
DepthWord: TypeAlias = Literal["thickness", "protrusion_a", "protrusion_b"]
Bounds: TypeAlias = tuple[float, float]

MEETING: tuple[RelationWord, ...] = ("overlapping", "contained", "duplicate", "crossing")
"""The relations of bodies that share more than a touch."""


@dataclass(frozen=True, kw_only=True)
class Band:
    """What counts as touching: a gap and an overlap that are forgiven.

    Attributes:
        gap: mesh units; surfaces no further apart than this touch.
        overlap: mesh units; bodies touch whose thickness and protrusions are no more than this.
        slack: mesh units; a length is at most `gap` or `overlap` where its bracket ends by this
            much beyond it: no bracket can tell equal lengths apart. 1e-9 of the pair's size.
        reason: where the numbers come from, a sentence.
    """

    gap: float
    overlap: float
    slack: float
    reason: str


@dataclass(frozen=True, kw_only=True)
class Gap:
    """How far apart two surfaces are; (0, 0) and nothing else where they touch.

    Attributes:
        bounds: mesh units; (lo, hi), both proven.
        point_a: where on A hi was measured, world coordinates.
        point_b: where on B.
        triangle_a: row of A's mesh file that `point_a` lies in.
        triangle_b: row of B's mesh file that `point_b` lies in.
        part_a: path of the part of A that `triangle_a` is of, where `FILE#PATTERN` selected parts.
        part_b: path of the part of B that `triangle_b` is of, likewise.
    """

    bounds: Bounds
    point_a: Vector | None = None
    point_b: Vector | None = None
    triangle_a: int | None = None
    triangle_b: int | None = None
    part_a: str | None = None
    part_b: str | None = None


@dataclass(frozen=True, kw_only=True)
class Depth:
    """How deep, as a proven bracket.

    Attributes:
        bounds: mesh units; (lo, hi), both proven. (0, 0) where nothing overlaps, by proof. hi is
            None where a solid overlaps itself: surfaces within it hide how deep it is.
        point: where lo is attained, world coordinates: the centre of a ball inside both (of a
            thickness), or a point of the one surface inside the other solid. None where lo is 0.
        triangle_a: row of A's mesh file that is nearest to the point, or that holds it. None
            without a point.
        triangle_b: the same of B.
        part_a: path of the part of A that `triangle_a` is of, where `FILE#PATTERN` selected parts.
        part_b: path of the part of B that `triangle_b` is of, likewise.
    """

    bounds: tuple[float, float | None]
    point: Vector | None = None
    triangle_a: int | None = None
    triangle_b: int | None = None
    part_a: str | None = None
    part_b: str | None = None


@dataclass(frozen=True, kw_only=True)
class Volume:
    """How much space two solids share.

    Attributes:
        bounds: cubed mesh units; (lo, hi), both proven. Of solids that are not proven to overlap
            themselves it is taken that they do not.
        centroid: the mean place of that space, world coordinates; None where it has no volume.
    """

    bounds: Bounds
    centroid: Vector | None = None


@dataclass(frozen=True, kw_only=True)
class Region:
    """A part of the space that two solids share, apart from all others by proof.

    Parts that are about as near to each other as the resolution may be told as one.

    Attributes:
        bounds: lowest and highest corner of a box along the axes that holds it, world coordinates;
            up to about the resolution larger than it.
        point: the centre of a ball in it, world coordinates.
        thickness: mesh units; (lo, hi), proven: the diameter of its largest ball.
        triangle_a: row of A's mesh file that is nearest to the point.
        triangle_b: the same of B.
        part_a: path of the part of A that `triangle_a` is of, where `FILE#PATTERN` selected parts.
        part_b: path of the part of B that `triangle_b` is of, likewise.
    """

    bounds: tuple[Vector, Vector]
    point: Vector
    thickness: Bounds
    triangle_a: int
    triangle_b: int
    part_a: str | None = None
    part_b: str | None = None


class OverlapStats(NamedTuple):
    """What a question about an overlap cost.

    Attributes:
        box_tests: pairs of boxes tested.
        triangle_tests: pairs of triangles tested.
        exact_triangle_tests: those of them that exact arithmetic had to decide.
        pops: pairs taken from the queue or stack.
        image_tests: pairs of images tested.
        nodes_built_a: nodes of A's tree that exist after the question; a lazy tree builds only what
            is asked for.
        nodes_built_b: the same for B.
        nodes_possible_a: nodes that A's tree can have.
        nodes_possible_b: the same for B.
        cells: pieces of space, and of surfaces, whose depth was bounded.
        points: points whose depth was measured.
        rays: that told what is inside.
        seconds: s of wall time by stage.
    """

    box_tests: int
    triangle_tests: int
    exact_triangle_tests: int
    pops: int
    image_tests: int
    nodes_built_a: int
    nodes_built_b: int
    nodes_possible_a: int
    nodes_possible_b: int
    cells: int
    points: int
    rays: int
    seconds: Mapping[str, float]

    @property
    def counts(self) -> Counts:
        """Return what searches on the trees counted."""
        return Counts(*self[:5])


@dataclass(frozen=True, kw_only=True)
class SeparationAlong:
    """How far A has to go in a direction to be free of B for good.

    Attributes:
        direction: unit, world coordinates.
        bounds: mesh units; (lo, hi): at hi and beyond A touches B nowhere, at lo or a rounding
            before it still does. (0, 0) where A never touches B on its way. hi is None where a
            limit ended the search.
        error_bound: mesh units; by how much any vertex is off its path, as positions are rounded
            to double.
    """

    direction: Vector
    bounds: tuple[float, float | None]
    error_bound: float


@dataclass(frozen=True, kw_only=True)
class Overlap:
    """How two bodies lie to each other at t = 0, as solids where both are closed.

    Fields that do not apply, or were not asked for, are None.

    Attributes:
        relation: `"clear"`: further apart than the wanted distance; `"near"`: closer than that, and
            apart; `"touching"`: within the band; `"overlapping"`; `"contained"`: one solid lies in
            the other, up to the band; `"duplicate"`: both are the same solid, up to the band;
            `"crossing"`: triangles meet of a surface that does not close; `"unresolved"`: a limit
            was reached before it was known.
        contained: of solids that are `"contained"`: `"a"` where A lies in B, `"b"` where B in A.
        band: what counted as touching, and why.
        distance: how far apart the surfaces are.
        thickness: the diameter of the largest ball inside both solids.
        protrusion_a: how deep A's surface reaches into B: the distance from B's surface of A's
            deepest point inside B.
        protrusion_b: how deep B's surface reaches into A.
        volume: how much space both solids share.
        regions: the parts of the space that both solids share, the thickest first.
        resolution: mesh units; the boxes by which regions were told apart are no longer.
        unproven: how many groups of such boxes were left out, as no point is proven to lie in both
            solids there: faces that coincide, mostly.
        deeper: whether the thickness or a protrusion exceeds `deeper_than`; None where that was
            not asked, or is not known.
        by: which of them was found to exceed it first.
        separation_along: how far A has to go in the direction asked about.
        reason: why there are no depths, or no upper ends of them: which surface does not close,
            and where, or which solid overlaps itself.
        complete: whether the search ended before a limit. Where not, brackets are wide.
        stats: what the question cost.
    """

    relation: RelationWord
    contained: Inner | None = None
    band: Band
    distance: Gap | None = None
    thickness: Depth | None = None
    protrusion_a: Depth | None = None
    protrusion_b: Depth | None = None
    volume: Volume | None = None
    regions: tuple[Region, ...] | None = None
    resolution: float | None = None
    unproven: int | None = None
    deeper: bool | None = None
    by: DepthWord | None = None
    separation_along: SeparationAlong | None = None
    reason: str | None = None
    complete: bool = True
    stats: OverlapStats

    @property
    def overlaps(self) -> bool:
        """Whether the bodies share more than a touch.

        Raises:
            UnresolvedError: a limit was reached before that was known.
        """
        if self.relation == "unresolved":
            from obbcli.errors import UnresolvedError

            raise UnresolvedError(
                "overlaps",
                "the question stopped at a limit before its answer was known",
                "raise max_iterations or timeout",
            )
        return self.relation in MEETING
