"""Are two solids the same: the same triangles, whatever their order and the order of corners?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.motion.body import Body
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.tree.tree import ObbTree


def are_equal(pair: PairQuestion) -> bool:
    """Return whether A and B have the same posed triangles, bit by bit."""
    (a, b), (tree_a, tree_b) = pair.bodies, pair.trees
    if tree_a.triangle_count != tree_b.triangle_count:
        return False
    # The boxes tell most pairs apart before anything is sorted.
    if not np.array_equal(posed_bounds(a, tree_a), posed_bounds(b, tree_b)):
        return False
    return bool(np.array_equal(_sorted_triangles(a, tree_a), _sorted_triangles(b, tree_b)))


def posed_bounds(body: Body, tree: ObbTree) -> NDArray[np.float64]:
    """Return the lower and upper corner of a placed surface's axis-aligned box, (2, 3)."""
    corners = _posed_triangles(body, tree).reshape(-1, 3)
    return np.array([corners.min(axis=0), corners.max(axis=0)])


def _posed_triangles(body: Body, tree: ObbTree) -> NDArray[np.float64]:
    """Return the corners of all triangles, (F, 3, 3), without negative zeros."""
    mesh = tree.mesh
    posed: NDArray[np.float64] = body.pose.apply(mesh.vertices)[mesh.triangles] + 0.0
    return posed


def _sorted_triangles(body: Body, tree: ObbTree) -> NDArray[np.float64]:
    """Return all triangles in an order that depends on their corners alone, (F, 9)."""
    corners = _posed_triangles(body, tree)
    order = np.lexsort(corners.transpose(2, 0, 1)[::-1], axis=-1)
    rows = np.take_along_axis(corners, order[:, :, None], axis=1).reshape(-1, 9)
    sorted_rows: NDArray[np.float64] = rows[np.lexsort(rows.T[::-1])]
    return sorted_rows
