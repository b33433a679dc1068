"""How deep: `overlap`. Relation first, by what is cheapest; then as many numbers as are asked."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import DEPTH_TOLERANCE, Accuracy
from obbcli.answers.overlap import Depth, Gap, Overlap, OverlapStats
from obbcli.questions.border import refused, stats_of
from obbcli.questions.containment import body_name, why_open
from obbcli.questions.distance import measure
from obbcli.questions.overlap.along import separation_along
from obbcli.questions.overlap.asked import Asked, refuse_other_accuracy
from obbcli.questions.overlap.band import band_of
from obbcli.questions.overlap.depths import NOTHING
from obbcli.questions.overlap.meeting import inner_of, share_inside, surfaces_meet
from obbcli.questions.overlap.order import is_b_first
from obbcli.questions.overlap.pursuit import Pursuit
from obbcli.questions.overlap.regions import regions_of
from obbcli.questions.overlap.solids import DEPTHS, Solids
from obbcli.questions.pair_question import PairQuestion

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from numpy.typing import ArrayLike

    from obbcli.answers.overlap import RelationWord
    from obbcli.motion.body import Body, Shape
    from obbcli.questions.pair_question import Trees

_TOUCH = Gap(bounds=(0.0, 0.0))


def overlap(
    a: Body | Shape,
    b: Body | Shape,
    accuracy: Accuracy | None = None,
    *,
    tolerance: float = DEPTH_TOLERANCE,
    deeper_than: float | None = None,
    touch: Sequence[float] | None = None,
    along: ArrayLike | None = None,
    regions: float | bool | None = None,
) -> Overlap:
    """Return how two bodies lie to each other at t = 0, and how deep one is in the other.

    Closed surfaces are solids: inside is where the surface winds about a point a number of times
    other than zero. Bodies touch where their distance is at most the band's gap, and their
    thickness and both protrusions are at most its overlap. Every number is a proven bracket for
    the posed vertices rounded to double (see `Pose`); a limit of `accuracy` leaves brackets wide,
    and the relation `"unresolved"` where that matters. Swapping the bodies swaps the answer, bit
    by bit. Motions play no part.

    Of a surface that does not close there are no depths, and `reason` says why; triangles of it
    that meet the other body are `"crossing"`.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        accuracy: its `max_iterations` and `timeout` are limits, its `clearance` is the distance
            below which bodies are `"near"`; its other fields say nothing here.
        tolerance: relative width asked of brackets; they are never narrower than 1e-9 of the
            pair's size.
        deeper_than: mesh units; ask whether a depth exceeds it, which is cheaper than its value.
        touch: gap and overlap that count as touching, mesh units; (0, 0): the bare numbers. None:
            the larger of 1e-9 sizes and 4 spacings of the coarser file's coordinates, plus both
            sags.
        along: a direction, (3,), world coordinates: ask how far A has to go that way to be free.
        regions: ask for the parts of what both share, told apart at this resolution, mesh units.
            True: at a fiftieth of the diagonal of the box that both bodies have in common.

    Raises:
        MotionError: an argument is refused, a field of `accuracy` has no meaning here, or posed
            coordinates leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> answer = overlap("sample_meshes/housing.stl", "sample_meshes/board.vtk")
        >>> answer.relation, answer.thickness.bounds
        ('clear', (0.0, 0.0))
    """
    asked = Asked.of(tolerance, deeper_than, touch, along, regions)
    used = Accuracy() if accuracy is None else accuracy
    refuse_other_accuracy(used)
    return overlap_of(PairQuestion.of(a, b, 0.0, used), asked)


def overlap_of(pair: PairQuestion, asked: Asked) -> Overlap:
    """Return what `overlap` does of a question that is understood already.

    Of its accuracy no more is looked at than `overlap` says; scenes have fields for other
    questions.

    Raises:
        ObbError: as `overlap`.
    """
    start = time.perf_counter()
    question = _Question(pair, asked)
    try:
        found = question.related()
        if asked.direction is not None:
            found["separation_along"] = separation_along(pair, asked.direction, question.pursuit)
        if asked.resolution is not None:
            found |= question.regions()
    except (ValueError, kernels.TreeError) as fault:
        if isinstance(fault, kernels.TreeError) or type(fault) is ValueError:
            raise refused(pair.trees, fault) from fault
        raise
    seconds = {"load": pair.load_seconds, "query": time.perf_counter() - start}
    return Overlap(
        **_with_parts(found, pair.trees),
        band=question.band,
        complete=question.pursuit.is_complete,
        stats=_stats(pair, question.pursuit, seconds),
    )


def _with_parts(found: dict[str, Any], trees: Trees) -> dict[str, Any]:
    """Return what was found with the selected parts that its triangles are of."""
    a, b = trees
    if not (a.parts or b.parts):
        return found

    def named(one: Any) -> Any:
        return replace(one, part_a=a.part_of(one.triangle_a), part_b=b.part_of(one.triangle_b))

    told = {name: named(one) for name, one in found.items() if isinstance(one, (Gap, Depth))}
    if found.get("regions"):
        told["regions"] = tuple(map(named, found["regions"]))
    return found | told


def _stats(pair: PairQuestion, pursuit: Pursuit, seconds: dict[str, float]) -> OverlapStats:
    """Return what a question cost."""
    counted = stats_of(pair.trees, pursuit.counts, seconds)._asdict()
    return OverlapStats(**counted, cells=pursuit.cells, points=pursuit.points, rays=pursuit.rays)


class _Question:
    """What is asked about two bodies, on its way to the relation.

    Args:
        pair: A and B.
        asked: what is asked about them.
    """

    def __init__(self, pair: PairQuestion, asked: Asked) -> None:
        limits = pair.accuracy
        self.pursuit = Pursuit(limits)
        self.band = band_of(pair, asked.touch)
        self._wanted = max(limits.clearance, self.band.gap)
        self._pair = pair._replace(accuracy=Accuracy())
        self._asked = asked

    def related(self) -> dict[str, Any]:
        """Return the relation and what else was found, by the names of `Overlap`."""
        reason = self._why_open()
        meets = surfaces_meet(self._pair, self.pursuit)
        if meets is None:
            return {"relation": "unresolved", "reason": reason}
        if reason is not None:
            return self._of_surfaces(reason, meets=meets)
        if meets:
            return self._of_meeting_solids()
        return self._of_solids_apart()

    def regions(self) -> dict[str, Any]:
        """Return the parts of what both share; nothing of surfaces that do not close."""
        if self._why_open() is not None:
            return {}
        return regions_of(self._pair, self._asked, self.band.slack, self.pursuit)

    def _why_open(self) -> str | None:
        """Return why there are no depths: a surface that does not close; None of solids."""
        for name, tree in zip("AB", self._pair.trees, strict=True):
            fault = why_open(tree.mesh)
            if fault is not None:
                return f"{body_name(name, tree)} {fault}"
        return None

    def _of_surfaces(self, reason: str, *, meets: bool) -> dict[str, Any]:
        """Return what is said of surfaces of which one does not close."""
        if meets:
            return {"relation": "crossing", "distance": _TOUCH, "reason": reason}
        relation, distance = self._by_distance()
        return {"relation": relation, "distance": distance, "reason": reason}

    def _of_solids_apart(self) -> dict[str, Any]:
        """Return what is said of solids whose surfaces do not meet."""
        share_a = share_inside(self._pair, "a", self.pursuit)
        share_b = None if share_a is None else share_inside(self._pair, "b", self.pursuit)
        if share_a is None or share_b is None:
            return {"relation": "unresolved"}
        is_deep, inner = inner_of(share_a, share_b)
        relation, distance = self._by_distance()
        found: dict[str, Any] = {"relation": relation, "distance": distance}
        if is_deep:
            solids = Solids(self._pair, self._asked, self.band, self.pursuit, inner)
            return found | solids.related()
        if self._asked.deeper_than is not None:
            found["deeper"] = False
        return found | dict.fromkeys(DEPTHS, NOTHING)

    def _of_meeting_solids(self) -> dict[str, Any]:
        """Return what is said of solids whose surfaces meet."""
        solids = Solids(self._pair, self._asked, self.band, self.pursuit)
        return {"distance": _TOUCH, **solids.related()}

    def _by_distance(self) -> tuple[RelationWord, Gap]:
        """Return the relation of surfaces that do not meet, and how far apart they are."""
        left = Accuracy(
            max_iterations=max(self.pursuit.steps_left, 1), timeout=self.pursuit.seconds_left
        )
        is_swapped = is_b_first(self._pair)
        (a, b), (tree_a, tree_b) = self._pair.bodies, self._pair.trees
        pair = self._pair._replace(accuracy=left)
        if is_swapped:
            pair = pair._replace(bodies=(b, a), trees=(tree_b, tree_a))
        found, is_complete = measure(pair)
        self.pursuit.spend(found.stats.counts)
        self.pursuit.is_complete &= is_complete
        low, high = found.bounds
        places = (found.point_a, found.triangle_a), (found.point_b, found.triangle_b)
        (point_a, row_a), (point_b, row_b) = places[::-1] if is_swapped else places
        gap = Gap(
            bounds=found.bounds,
            point_a=point_a,
            point_b=point_b,
            triangle_a=row_a,
            triangle_b=row_b,
        )
        band = self.band
        if low > self._wanted:
            return "clear", gap
        if low > band.gap:
            is_near = high <= self._wanted + band.slack
            return "near" if is_near else "unresolved", gap
        return "touching" if high <= band.gap + band.slack else "unresolved", gap
