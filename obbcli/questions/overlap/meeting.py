"""Do surfaces meet at t = 0, and where they do not, which parts of a solid are in the other?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from obbcli import kernels
from obbcli.questions.border import static_query

if TYPE_CHECKING:
    from typing import TypeAlias

    import numpy as np
    from numpy.typing import NDArray

    from obbcli.answers.status import Inner
    from obbcli.motion.body import Body
    from obbcli.questions.overlap.pursuit import Pursuit
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.tree.tree import ObbTree

Share: TypeAlias = Literal["none", "some", "all"]


def surfaces_meet(pair: PairQuestion, pursuit: Pursuit) -> bool | None:
    """Return whether any triangles of A and B meet, touching included; None at a limit.

    Raises:
        MotionError: posed coordinates leave the range of double.
        kernels.TreeError: a tree file is damaged.
    """
    query = static_query(pair)
    is_known = pursuit.run(query, lambda: query.counts()[3])
    pursuit.count(query.counts())
    return query.is_contact if is_known else None


def share_inside(pair: PairQuestion, inner: Inner, pursuit: Pursuit) -> Share | None:
    """Return which connected parts of a solid lie inside the other; None at a limit.

    The surfaces do not meet, so that a part is inside as a whole or not at all: one point decides.

    Args:
        pair: both closed, their surfaces apart.
        inner: whose parts are looked at.
        pursuit: the budget.

    Raises:
        kernels.TreeError: a tree file is damaged.
    """
    place = 0 if inner == "a" else 1
    body, other = pair.bodies[place], pair.bodies[1 - place]
    mesh, outer = pair.trees[place].mesh, pair.trees[1 - place]
    points = body.pose.apply(mesh.vertices[mesh.triangles[mesh.part_rows, 0]])
    # The first question asks about all parts and mostly says that none is inside; only where one
    # is, each is asked about by itself.
    found = _any_inside(points, other, outer, pursuit)
    if not found:
        return None if found is None else "none"
    for k in range(len(points) if len(points) > 1 else 0):
        found = _any_inside(points[k : k + 1], other, outer, pursuit)
        if not found:
            return None if found is None else "some"
    return "all"


def _any_inside(
    points: NDArray[np.float64], body: Body, tree: ObbTree, pursuit: Pursuit
) -> bool | None:
    """Return whether any point is inside a solid; None at a limit."""
    query = kernels.ContainmentQuery(tree.kernel, body.pose.kernel, points)
    is_known = pursuit.run(query, lambda: query.counts()[3])
    pursuit.count(query.counts())
    return query.inside is not None if is_known else None


def inner_of(share_a: Share, share_b: Share) -> tuple[bool, Inner | None]:
    """Return whether solids whose surfaces do not meet overlap, and which lies in the other.

    A solid lies in the other where all parts of its surface do and no part of the other's surface
    lies in it: a hollow of the other, for one, would be filled.
    """
    if share_a == "all" and share_b == "none":
        return True, "a"
    if share_b == "all" and share_a == "none":
        return True, "b"
    return share_a != "none" or share_b != "none", None
