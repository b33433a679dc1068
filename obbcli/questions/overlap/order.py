"""Which of two bodies the kernels see first: the same one, whichever the caller named first."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.motion.body import Body
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.tree.tree import ObbTree


def is_b_first(pair: PairQuestion) -> bool:
    """Return whether B goes before A: by their counts, else by their posed corners.

    Bodies that are the same in all of this may be asked about in either order.
    """
    (a, b), (tree_a, tree_b) = pair.bodies, pair.trees
    if tree_a.triangle_count != tree_b.triangle_count:
        return tree_b.triangle_count < tree_a.triangle_count
    corners_a, corners_b = _corners(a, tree_a), _corners(b, tree_b)
    differ = corners_a != corners_b
    if not differ.any():
        return False
    place = int(np.argmax(differ))
    return bool(corners_b[place] < corners_a[place])


def _corners(body: Body, tree: ObbTree) -> NDArray[np.float64]:
    """Return the posed coordinates of all corners in the order of the triangles."""
    mesh = tree.mesh
    corners: NDArray[np.float64] = body.pose.apply(mesh.vertices)[mesh.triangles].ravel()
    return corners
