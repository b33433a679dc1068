"""What every question about two bodies shares: trees, limits, and the kernels' query at rest."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.errors import MotionError, TreeFileError
from obbcli.mesh import Mesh
from obbcli.motion import PathMotion
from obbcli.tree import ObbTree, load_tree

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from obbcli.accuracy import Accuracy
    from obbcli.errors import ObbError
    from obbcli.motion import Body, Shape

_NO_DEPTH_LIMIT = 2**32 - 1
NO_LIMIT = 2**64 - 1
# Queue pops between two looks at clock and signals: a few milliseconds.
POPS_A_SLICE = 16_384

Trees = tuple[ObbTree, ObbTree]


def trees_of(bodies: tuple[Body, Body]) -> Trees:
    """Return the trees of two bodies, one for both where they share a shape.

    Raises:
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """
    a, b = bodies
    tree_a = _tree(a.shape)
    return tree_a, tree_a if b.shape is a.shape else _tree(b.shape)


def _tree(shape: Shape) -> ObbTree:
    if isinstance(shape, ObbTree):
        return shape
    if isinstance(shape, Mesh):
        return ObbTree.build(shape)
    if isinstance(shape, (str, os.PathLike)):
        return load_tree(shape)
    raise MotionError(
        "shape", f"is of type {type(shape).__name__}", "pass a tree, a mesh or a path"
    )


def duration_of(duration: float | None, bodies: tuple[Body, Body]) -> float:
    """Return the end of the interval asked about, s.

    By default 0 where both bodies rest, the last time of a motion through poses, or else 1.

    Raises:
        MotionError: not a finite number of at least 0.
    """
    if duration is None:
        motions = [body.motion for body in bodies if not body.motion.is_at_rest]
        paths = [float(m.times[-1]) for m in motions if isinstance(m, PathMotion)]
        return max(paths, default=1.0 if motions else 0.0)
    try:
        seconds = float(duration)
    except (TypeError, ValueError) as fault:
        raise MotionError("duration", f"is {duration!r}", "use a number of seconds") from fault
    except OverflowError as fault:
        raise MotionError("duration", str(fault), "use a finite number of seconds") from fault
    if isinstance(duration, str) or not 0 <= seconds < math.inf:
        raise MotionError(
            "duration", f"is {duration!r}", "use a finite number of at least 0 seconds"
        )
    return seconds


def box_limits(accuracy: Accuracy) -> tuple[bool, int, int]:
    """Return how boxes stand for triangles: in leaves, and from which depth on in either tree."""
    depths = (accuracy.max_depth_a, accuracy.max_depth_b)
    depth_a, depth_b = (_NO_DEPTH_LIMIT if d is None else min(d, _NO_DEPTH_LIMIT) for d in depths)
    return accuracy.leaves == "boxes", depth_a, depth_b


def pivot_of(body: Body, tree: ObbTree) -> NDArray[np.float64]:
    """Return where a body's axis passes at t = 0, world coordinates, (3,)."""
    if body.motion.pivot is not None:
        return body.motion.pivot
    pivot: NDArray[np.float64] = body.pose.apply(tree.surface_centroid[None])[0]
    return pivot


def static_query(
    trees: Trees,
    bodies: tuple[Body, Body],
    accuracy: Accuracy,
    *,
    all_pairs: bool = False,
    limit: int = NO_LIMIT,
) -> kernels.StaticQuery:
    """Return the kernels' query about the bodies at t = 0, not yet advanced.

    Raises:
        MotionError: posed coordinates leave the range of double.
        TreeFileError: a tree file is damaged.
    """
    (tree_a, tree_b), (a, b) = trees, bodies
    try:
        return kernels.StaticQuery(
            tree_a.kernel,
            a.pose.kernel,
            tree_b.kernel,
            b.pose.kernel,
            all_pairs,
            *box_limits(accuracy),
            limit,
        )
    except ValueError as fault:
        raise out_of_range(trees, "pose", fault) from fault
    except kernels.TreeError as fault:
        raise damaged(trees, fault) from fault


def out_of_range(trees: Trees, where: str, fault: ValueError) -> ObbError:
    """Return the error for numbers beyond doubles: a damaged tree's own, or what motion makes."""
    for tree in trees:
        try:
            tree.check()
        except TreeFileError as damage:
            return damage
    return MotionError(where, str(fault), "move or scale the bodies")


def damaged(trees: Trees, fault: Exception) -> TreeFileError:
    """Return the error for a fault that a traversal met."""
    names = " or ".join(sorted({tree.source or "a tree" for tree in trees}))
    return TreeFileError(names, str(fault), "build it again from the mesh")
