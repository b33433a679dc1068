"""Does one solid fill the other, or lie in it, up to the band? What depths alone do not tell."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli import kernels
from obbcli.questions.overlap.same import posed_bounds

if TYPE_CHECKING:
    from obbcli.answers.status import Inner
    from obbcli.questions.overlap.depths import Depths
    from obbcli.questions.overlap.pursuit import Pursuit
    from obbcli.questions.pair_question import PairQuestion


def are_alike(pair: PairQuestion, depths: Depths, limit: float) -> bool | None:
    """Return whether no point of either surface is further from the other than a limit.

    That is the Hausdorff distance. None where a limit of work was met.

    Args:
        pair: A and B, closed.
        depths: those of the pair.
        limit: mesh units.
    """
    (a, b), (tree_a, tree_b) = pair.bodies, pair.trees
    # The boxes of alike surfaces differ by no more, which tells most others apart.
    apart = np.abs(posed_bounds(a, tree_a) - posed_bounds(b, tree_b)).max()
    if apart > limit + depths.floor:
        return False
    for inner in ("a", "b"):
        is_further = depths.reaches_from(inner, limit)
        if is_further is not False:
            return None if is_further is None else False
    return True


def lies_in(pair: PairQuestion, inner: Inner, limit: float, pursuit: Pursuit) -> bool | None:
    """Return whether all vertices of a solid lie in the other, or no further outside than a limit.

    Asked where the other's surface reaches into the solid no deeper than the limit: what lies
    outside has vertices then, but for bridges that are no thicker than twice the limit. None where
    a limit of work was met.

    Args:
        pair: A and B, closed.
        inner: which solid.
        limit: mesh units.
        pursuit: the budget.
    """
    place = 0 if inner == "a" else 1
    body, tree = pair.bodies[place], pair.trees[place]
    outer, other = pair.bodies[1 - place], pair.trees[1 - place]
    probe = kernels.SolidProbe(other.kernel, outer.pose.kernel)
    origin, exponent = probe.frame
    near = float(np.ldexp(limit, -exponent))
    used = np.unique(tree.mesh.triangles)
    points = body.pose.apply(tree.mesh.vertices[used])
    for point in points.tolist():
        if not pursuit.take_step():
            return None
        if probe.winding(point) == 0:
            here = (np.ldexp(point, -exponent) - origin).tolist()
            if probe.nearest(here, 0.0, near)[0] > near:
                return False
    return True
