"""How much space two solids share, and whether one of them overlaps itself there."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeAlias

from obbcli import kernels
from obbcli.answers.overlap import Volume
from obbcli.motion.pose import Pose

if TYPE_CHECKING:
    from obbcli.answers.overlap import Bounds
    from obbcli.answers.status import Inner
    from obbcli.questions.overlap.pursuit import Pursuit
    from obbcli.questions.pair_question import PairQuestion

    _Corner: TypeAlias = tuple[float, float, float]
    _Box: TypeAlias = tuple[_Corner, _Corner]

# Pops between two looks at the clock: a pair of shadows takes longer than a pair of boxes.
_POPS_A_SLICE = 4096
# Up to so many the whole of a solid is looked at, once; of larger ones what is near each pair.
_MOST_TRIANGLES = 20_000
_REMEMBERED = "_is_plain"
_AS_LOADED = Pose().kernel
_PLAIN = 0.0, 0.0


class SharedSpace:
    """The space that two closed solids have in common.

    Args:
        pair: A and B.
        pursuit: the budget.
    """

    def __init__(self, pair: PairQuestion, pursuit: Pursuit) -> None:
        self._pair = pair
        self._pursuit = pursuit
        self._is_plain = False
        self._known: dict[float, tuple[Bounds, Bounds] | None] = {}
        (a, b), (tree_a, tree_b) = pair.bodies, pair.trees
        self._query = kernels.ColumnVolume(
            tree_a.kernel, a.pose.kernel, tree_b.kernel, b.pose.kernel
        )

    def doubled(self, reach: float) -> tuple[Inner, ...] | None:
        """Return which solids are proven to overlap themselves; None at a limit.

        That is where the integral of w^2 - w is above 0, w being how often the surface winds about
        a point: it is 0 where it winds once or not at all, and at least 2 elsewhere.

        Args:
            reach: mesh units; how far around the common box of both is looked.
        """
        found = self._excesses(reach)
        if found is None:
            return None
        sides: tuple[Inner, Inner] = ("a", "b")
        doubled = tuple(one for one, excess in zip(sides, found, strict=True) if excess[0] > 0)
        self._is_plain |= not doubled
        return doubled

    def _excesses(self, reach: float) -> tuple[Bounds, Bounds] | None:
        """Return the integrals of w^2 - w of A and B, as brackets; None at a limit."""
        if reach not in self._known:
            low, high = self._query.window
            x, y, z = (value - reach for value in low)
            u, v, w = (value + reach for value in high)
            box = (x, y, z), (u, v, w)
            of_a, of_b = (
                _PLAIN if self._is_plain_all_over(place) else self._excess(place, box)
                for place in (0, 1)
            )
            self._known[reach] = None if of_a is None or of_b is None else (of_a, of_b)
        return self._known[reach]

    def _is_plain_all_over(self, place: int) -> bool:
        """Return whether a solid of no many triangles overlaps itself nowhere; trees remember it.

        How it is placed makes no difference beyond the rounding of its vertices.
        """
        tree = self._pair.trees[place]
        if tree.triangle_count > _MOST_TRIANGLES:
            return False
        remembered = vars(tree)
        if _REMEMBERED not in remembered:
            excess = self._excess_of(kernels.SelfOverlap(tree.kernel, _AS_LOADED))
            if excess is None:
                return False
            remembered[_REMEMBERED] = excess[0] <= 0
        return bool(remembered[_REMEMBERED])

    def _excess(self, place: int, box: _Box) -> Bounds | None:
        body, tree = self._pair.bodies[place], self._pair.trees[place]
        return self._excess_of(kernels.SelfOverlap(tree.kernel, body.pose.kernel, box))

    def _excess_of(self, query: kernels.SelfOverlap) -> Bounds | None:
        is_known = self._pursuit.run(query, lambda: query.counts()[3], _POPS_A_SLICE)
        self._pursuit.count(query.counts())
        return query.excess if is_known else None

    def volume(self) -> Volume | None:
        """Return the volume; None where a limit was met before anything bounds it."""
        # What was found further around holds here too.
        excesses = None if self._is_plain else self._excesses(0.0)
        query = self._query
        self._pursuit.run(query, lambda: query.counts()[3], _POPS_A_SLICE)
        self._pursuit.count(query.counts())
        low, high = query.bounds
        if excesses is not None and any(bounds[0] > 0 for bounds in excesses):
            low, high = _of_solids_that_overlap_themselves((low, high), excesses)
            return Volume(bounds=(low, high)) if math.isfinite(high) else None
        if not math.isfinite(high):
            return None
        return Volume(bounds=(low, high), centroid=query.centroid)


def _of_solids_that_overlap_themselves(counted: Bounds, excesses: tuple[Bounds, Bounds]) -> Bounds:
    """Return bounds of a volume whose parts may be counted more than once.

    With w = 1 + a about A and 1 + b about B, what is counted less the volume is the integral of
    a + b + a b over the space inside both. Where w > 1, 0 < a <= (w^2 - w) / 2; where w < 0,
    -a <= w^2 - w; and a^2 <= 2 (w^2 - w) in both. So the integral of a is at most E_A / 2 and at
    least -E_A, and that of a b at most 2 sqrt(E_A E_B) either way (Cauchy and Schwarz).
    """
    of_a, of_b = (bounds[1] for bounds in excesses)
    both = 2.0 * math.sqrt(of_a * of_b)
    low, high = counted
    # Far beyond the rounding of these few operations.
    room = 1.0 + 2.0**-40
    return (
        max(low - room * ((of_a + of_b) / 2.0 + both), 0.0),
        high + room * (of_a + of_b + both),
    )
