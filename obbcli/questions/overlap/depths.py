"""`Depths`: thickness and protrusions of two solids, each narrowed no further than it is needed.

A decision ("deeper than this?") is cheaper than a value, and both leave a proven bracket. What is
known of a depth is what all questions about it have left.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, TypeAlias

from obbcli import kernels
from obbcli.answers.overlap import Depth
from obbcli.questions.overlap.order import is_b_first

if TYPE_CHECKING:
    from obbcli.answers.contact import Vector
    from obbcli.answers.overlap import Bounds, DepthWord
    from obbcli.answers.status import Inner
    from obbcli.questions.overlap.pursuit import Pursuit
    from obbcli.questions.pair_question import PairQuestion

    _Query: TypeAlias = kernels.ThicknessQuery | kernels.ProtrusionQuery
    _Place: TypeAlias = tuple[Vector | None, int | None, int | None]

# Cells of a kernel between two looks at the clock: some milliseconds.
_CELLS_A_SLICE = 64
# Of one kernel: what 200,000 of them hold is some 40 MB.
_MOST_CELLS = 200_000

NOTHING = Depth(bounds=(0.0, 0.0))


class Depths:
    """What is known of the depths of two closed surfaces.

    Args:
        pair: A and B.
        tolerance: relative width asked of values.
        floor: mesh units; brackets are narrowed no further.
        pursuit: the budget.

    Attributes:
        floor: as given.
    """

    def __init__(
        self, pair: PairQuestion, tolerance: float, floor: float, pursuit: Pursuit
    ) -> None:
        self._pair = pair
        self._tolerance = tolerance
        self.floor = floor
        self._pursuit = pursuit
        self._is_b_first = is_b_first(pair)
        self._bounds: dict[DepthWord, Bounds] = {}
        self._places: dict[DepthWord, _Place] = {}

    def bounds(self, which: DepthWord) -> Bounds:
        """Return what is known of a depth; hi is infinite where it was never asked."""
        return self._bounds.get(which, (0.0, math.inf))

    def told(self, which: DepthWord) -> Depth | None:
        """Return a depth as answers tell it; None where nothing is known that bounds it."""
        bounds = self.bounds(which)
        if bounds[1] == math.inf:
            return None
        point, triangle_a, triangle_b = self._places.get(which, (None, None, None))
        return Depth(bounds=bounds, point=point, triangle_a=triangle_a, triangle_b=triangle_b)

    def is_none(self, which: DepthWord) -> None:
        """Hold a depth to be 0, which is proven otherwise."""
        self._bounds[which] = (0.0, 0.0)

    def exceeds(self, which: DepthWord, limit: float) -> bool | None:
        """Return whether a depth exceeds a limit, mesh units; None where a limit of work was met.

        A depth does not where its bracket ends at most the floor beyond.
        """
        if self._verdict(which, limit) is None:
            self._ask(which, limit)
        return self._verdict(which, limit)

    def reaches_from(self, inner: Inner, limit: float) -> bool | None:
        """Return whether a point of a surface is further than a limit from the other surface.

        Inside or outside, unlike a protrusion; mesh units. None where a limit of work was met.
        """
        (a, b), (tree_a, tree_b) = self._pair.bodies, self._pair.trees
        bodies = (tree_a.kernel, a.pose.kernel), (tree_b.kernel, b.pose.kernel)
        first, second = bodies if inner == "a" else reversed(bodies)
        query = kernels.ProtrusionQuery(*first, *second, **self._options(limit), inside_only=False)
        self._run(query)
        low, high = query.bounds
        if low > limit:
            return True
        return False if high <= limit + self.floor else None

    def settle(self, which: DepthWord) -> None:
        """Narrow the bracket of a depth down to the tolerance."""
        low, high = self.bounds(which)
        if high == math.inf or high - low > max(self.floor, self._tolerance * high):
            self._ask(which, None)

    def _verdict(self, which: DepthWord, limit: float) -> bool | None:
        low, high = self.bounds(which)
        if low > limit:
            return True
        return False if high <= limit + self.floor else None

    def _ask(self, which: DepthWord, limit: float | None) -> None:
        """Ask the kernels, and add what they find to what is known."""
        query = self._query(which, limit)
        self._run(query)
        old_low, old_high = self.bounds(which)
        low, high = query.bounds
        self._bounds[which] = max(low, old_low), min(high, old_high)
        if low > old_low:
            triangles = query.triangle_a, query.triangle_b
            triangle_a, triangle_b = triangles[::-1] if self._is_swapped(which) else triangles
            self._places[which] = query.point, triangle_a, triangle_b

    def _query(self, which: DepthWord, limit: float | None) -> _Query:
        (a, b), (tree_a, tree_b) = self._pair.bodies, self._pair.trees
        here, there = (tree_a.kernel, a.pose.kernel), (tree_b.kernel, b.pose.kernel)
        if self._is_swapped(which):
            here, there = there, here
        kind = kernels.ThicknessQuery if which == "thickness" else kernels.ProtrusionQuery
        query: _Query = kind(*here, *there, **self._options(limit))
        return query

    def _options(self, limit: float | None) -> dict[str, Any]:
        """Return how a question is asked."""
        return {
            "tolerance": self._tolerance,
            "deeper_than": limit,
            "floor": self.floor,
            "max_cells": min(max(self._pursuit.steps_left, 1), _MOST_CELLS),
        }

    def _run(self, query: _Query) -> None:
        """Pursue a question; one that ended for want of cells is not answered."""
        options = self._options(None)
        self._pursuit.run(query, lambda: query.cells, _CELLS_A_SLICE)
        self._pursuit.is_complete &= query.cells < options["max_cells"]
        self._pursuit.count_cells(query.cells, query.points, query.rays)

    def _is_swapped(self, which: DepthWord) -> bool:
        """Return whether the kernels see B first."""
        return self._is_b_first if which == "thickness" else which == "protrusion_b"
