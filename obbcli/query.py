"""Questions about two bodies: `collide` and `triangle_pairs`. Eberly 2008 §7."""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import Accuracy
from obbcli.errors import MotionError, TreeFileError
from obbcli.mesh import Mesh
from obbcli.motion import Body, as_body
from obbcli.results import Collision, QueryStats, Status
from obbcli.tree import ObbTree, load_tree

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from obbcli.motion import Shape

_EXACT = Accuracy()
_NO_DEPTH_LIMIT = 2**32 - 1
_NO_LIMIT = 2**64 - 1
# Between two looks at clock and signals: a few milliseconds.
_POPS_A_SLICE = 16_384


def collide(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    solid: bool = False,
) -> Collision:
    """Return whether two bodies touch.

    Surfaces are closed: touching counts. Triangles decide exactly on their posed vertices, rounded
    to double as `Pose` says; boxes only rule out what cannot touch, with every rounding counted.
    With depth limits or coarse leaves (`Accuracy`) boxes stand for what they hold: `separated` is
    a proof all the same, contact is `approximate`, and `error_bound` bounds the gap.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        b: likewise.
        duration: s; for bodies at rest any duration is the same question.
        accuracy: limits and coarseness; None: the exact answer.
        solid: whether closed surfaces hold what is inside them.

    Raises:
        MotionError: a body moves, `solid`, `clearance` or a sampled method is asked for (this
            version answers surfaces at rest), or posed coordinates leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """
    accuracy = _EXACT if accuracy is None else accuracy
    body_a, body_b = as_body(a), as_body(b)
    _require_rest(body_a, body_b, duration, accuracy, solid)
    start = time.perf_counter()
    tree_a, tree_b = _trees(body_a, body_b)
    loaded = time.perf_counter()
    query = _static_query(tree_a, body_a, tree_b, body_b, accuracy=accuracy, all_pairs=False)
    is_complete = _run(query, (tree_a, tree_b), accuracy)
    ended = time.perf_counter()
    status = Status.SEPARATED
    witness = None
    if query.is_contact:
        status = Status.OVERLAP_AT_START
        if not query.is_by_boxes:
            witness = tuple(query.pairs()[0].tolist())
    elif not is_complete:
        status = Status.UNRESOLVED
    return Collision(
        status=status,
        witness=witness,
        approximate=query.is_by_boxes,
        error_bound=query.error_bound,
        stats=QueryStats(
            *query.counts(),
            tree_a.node_count,
            tree_b.node_count,
            tree_a.possible_node_count,
            tree_b.possible_node_count,
            {"load": loaded - start, "query": ended - loaded},
        ),
    )


def triangle_pairs(a: Body | Shape, b: Body | Shape, limit: int | None = None) -> NDArray[np.int64]:
    """Return every pair of triangles that intersect at t = 0, int64 (N, 2), sorted.

    Exact: the same pairs as testing all triangles against all others in rational arithmetic.
    Rows of the meshes' files. Motions play no part.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        b: likewise.
        limit: stop after so many pairs, and return those, sorted. Which ones depends on the trees.

    Raises:
        MotionError: `limit` is below 1, or posed coordinates leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """
    if limit is not None and limit < 1:
        raise MotionError("limit", f"is {limit}", "use a whole number of at least 1")
    body_a, body_b = as_body(a), as_body(b)
    tree_a, tree_b = _trees(body_a, body_b)
    query = _static_query(
        tree_a,
        body_a,
        tree_b,
        body_b,
        accuracy=_EXACT,
        all_pairs=True,
        limit=_NO_LIMIT if limit is None else limit,
    )
    _run(query, (tree_a, tree_b), None)
    return query.pairs()


def _require_rest(
    a: Body, b: Body, duration: float | None, accuracy: Accuracy, solid: bool
) -> None:
    """Refuse what is not answered yet, rather than answer another question."""
    if duration is not None and not 0 <= duration < float("inf"):
        raise MotionError("duration", f"is {duration}", "use a finite number of at least 0 seconds")
    asked = {
        "a moving body": duration != 0 and not (a.motion.is_at_rest and b.motion.is_at_rest),
        "solid=True": solid,
        "clearance > 0": accuracy.clearance > 0,
        "method='sampled'": accuracy.method == "sampled",
    }
    for what, is_asked in asked.items():
        if is_asked:
            raise MotionError(what, "is not answered by this version", "ask about surfaces at rest")


def _trees(a: Body, b: Body) -> tuple[ObbTree, ObbTree]:
    """Return the trees of two bodies, one for both where they share a shape."""
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


def _static_query(
    tree_a: ObbTree,
    a: Body,
    tree_b: ObbTree,
    b: Body,
    *,
    accuracy: Accuracy,
    all_pairs: bool,
    limit: int = _NO_LIMIT,
) -> kernels.StaticQuery:
    """Return the kernels' query, not yet advanced."""
    try:
        return kernels.StaticQuery(
            tree_a.kernel,
            a.pose.kernel,
            tree_b.kernel,
            b.pose.kernel,
            all_pairs,
            accuracy.leaves == "boxes",
            _depth(accuracy.max_depth_a),
            _depth(accuracy.max_depth_b),
            limit,
        )
    except ValueError as fault:
        raise MotionError("pose", str(fault), "move or scale the bodies") from fault


def _depth(limit: int | None) -> int:
    return _NO_DEPTH_LIMIT if limit is None else min(limit, _NO_DEPTH_LIMIT)


def _run(
    query: kernels.StaticQuery, trees: tuple[ObbTree, ObbTree], accuracy: Accuracy | None
) -> bool:
    """Advance a query to its end or to a limit of `accuracy`; return whether it ended."""
    left = _NO_LIMIT if accuracy is None else accuracy.max_iterations
    timeout = None if accuracy is None else accuracy.timeout
    stop = None if timeout is None else time.monotonic() + timeout
    try:
        while not query.advance(min(_POPS_A_SLICE, left)):
            left -= _POPS_A_SLICE
            if left <= 0 or (stop is not None and time.monotonic() >= stop):
                return False
        return True
    except kernels.TreeError as fault:
        names = " or ".join(sorted({tree.source or "a tree" for tree in trees}))
        raise TreeFileError(names, str(fault), "build it again from the mesh") from fault
