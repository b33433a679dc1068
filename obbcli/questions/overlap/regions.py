"""The parts of the space that two solids share."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli import kernels
from obbcli.answers.overlap import Region
from obbcli.questions.overlap.order import is_b_first
from obbcli.questions.overlap.same import posed_bounds

if TYPE_CHECKING:
    from obbcli.questions.overlap.asked import Asked
    from obbcli.questions.overlap.pursuit import Pursuit
    from obbcli.questions.pair_question import PairQuestion

# Of the diagonal of the box that both bodies have in common, where no resolution is asked for.
_SHARE = 0.02
# Of the kernel between two looks at the clock: some milliseconds.
_CELLS_A_SLICE = 256


def regions_of(pair: PairQuestion, asked: Asked, floor: float, pursuit: Pursuit) -> dict[str, Any]:
    """Return the regions of two closed solids, by the names of `Overlap`; none at a limit.

    Args:
        pair: A and B.
        asked: whose `resolution` is not None.
        floor: mesh units; brackets are narrowed no further.
        pursuit: the budget.

    Raises:
        ValueError: posed coordinates leave the range of double.
        kernels.TreeError: a tree file is damaged.
    """
    resolution = asked.resolution or _default_resolution(pair)
    if resolution is None:
        return {"regions": (), "unproven": 0}
    (a, b), (tree_a, tree_b) = pair.bodies, pair.trees
    bodies = [(tree_a.kernel, a.pose.kernel), (tree_b.kernel, b.pose.kernel)]
    is_swapped = is_b_first(pair)
    first, second = reversed(bodies) if is_swapped else bodies
    query = kernels.OverlapRegions(
        *first, *second, resolution=resolution, tolerance=asked.tolerance, floor=floor
    )
    is_known = pursuit.run(query, lambda: query.cells, _CELLS_A_SLICE)
    pursuit.count_cells(query.cells, 0, 0)
    if not is_known:
        return {"resolution": resolution}
    pursuit.is_complete &= query.is_complete
    found = tuple(_region(told, is_swapped=is_swapped) for told in query.regions)
    return {"regions": found, "resolution": resolution, "unproven": query.unproven}


def _region(told: Any, *, is_swapped: bool) -> Region:
    low, high, point, thickness, *triangles = told
    triangle_a, triangle_b = reversed(triangles) if is_swapped else triangles
    return Region(
        bounds=(low, high),
        point=point,
        thickness=thickness,
        triangle_a=triangle_a,
        triangle_b=triangle_b,
    )


def _default_resolution(pair: PairQuestion) -> float | None:
    """Return a fiftieth of the diagonal of the common box; None where there is none."""
    boxes = [posed_bounds(*placed) for placed in zip(pair.bodies, pair.trees, strict=True)]
    low, high = np.max([box[0] for box in boxes], axis=0), np.min([box[1] for box in boxes], axis=0)
    if not np.all(low < high):
        return None
    # Neither squares of huge lengths nor a share of tiny ones leave the doubles.
    diagonal = math.hypot(*(high * _SHARE - low * _SHARE).tolist())
    return min(max(diagonal, math.ulp(0.0)), sys.float_info.max)
