"""Yes or no, and which: `collide` and `triangle_pairs`. Eberly 2008 §7."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import Accuracy
from obbcli.contact import Query
from obbcli.errors import MotionError
from obbcli.motion import as_body
from obbcli.question import (
    NO_LIMIT,
    POPS_A_SLICE,
    damaged,
    duration_of,
    static_query,
    trees_of,
    whole_limit,
)
from obbcli.results import Collision, QueryStats, Status

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from obbcli.motion import Body, Shape
    from obbcli.question import Trees

_EXACT = Accuracy()


def collide(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    solid: bool = False,
) -> Collision:
    """Return whether two bodies touch at any time of the closed interval [0, duration].

    Surfaces are closed: touching counts. Triangles decide exactly on their posed vertices, rounded
    to double as `Pose` says; boxes only rule out what cannot touch, with every rounding counted.
    With depth limits or coarse leaves (`Accuracy`) boxes stand for what they hold: `separated` is
    a proof all the same, contact is `approximate`, and `error_bound` bounds the gap. A moving
    question ends at any proof of contact, which is cheaper than the first.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        b: likewise.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: limits and coarseness; None: the exact answer.
        solid: whether closed surfaces hold what is inside them.

    Raises:
        MotionError: `solid` or a sampled method is asked for (not answered by this version), the
            duration is negative or not finite, or positions leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """
    accuracy = _EXACT if accuracy is None else accuracy
    if solid:
        raise MotionError("solid=True", "is not answered by this version", "ask about surfaces")
    bodies = as_body(a), as_body(b)
    if duration_of(duration, bodies) > 0 or accuracy.clearance > 0 or accuracy.method == "sampled":
        return _collide_moving(bodies, duration, accuracy)
    start = time.perf_counter()
    trees = trees_of(bodies)
    loaded = time.perf_counter()
    query = static_query(trees, bodies, accuracy)
    is_complete = _run(query, trees, accuracy)
    ended = time.perf_counter()
    status = Status.SEPARATED
    witness = None
    if query.is_contact:
        status = Status.OVERLAP_AT_START
        if not query.is_by_boxes:
            first_a, first_b = query.pairs()[0].tolist()
            witness = first_a, first_b
    elif not is_complete:
        status = Status.UNRESOLVED
    tree_a, tree_b = trees
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


def _collide_moving(
    bodies: tuple[Body, Body], duration: float | None, accuracy: Accuracy
) -> Collision:
    query = Query(*bodies, duration, accuracy, any_contact=True)
    found = query.advance(accuracy.max_iterations, accuracy.timeout)
    a, b = found.triangle_a, found.triangle_b
    return Collision(
        status=found.status,
        witness=None if a is None or b is None else (a, b),
        approximate=found.approximate,
        error_bound=found.error_bound,
        stats=found.stats,
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
        MotionError: `limit` is no whole number of at least 1, or posed coordinates leave the range
            of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """
    most = NO_LIMIT if limit is None else whole_limit(limit)
    bodies = as_body(a), as_body(b)
    trees = trees_of(bodies)
    query = static_query(trees, bodies, _EXACT, all_pairs=True, limit=most)
    _run(query, trees, None)
    return query.pairs()


def _run(query: kernels.StaticQuery, trees: Trees, accuracy: Accuracy | None) -> bool:
    """Advance a query to its end or to a limit of `accuracy`; return whether it ended."""
    left = NO_LIMIT if accuracy is None else accuracy.max_iterations
    timeout = None if accuracy is None else accuracy.timeout
    stop = None if timeout is None else time.monotonic() + timeout
    try:
        while not query.advance(min(POPS_A_SLICE, left)):
            left -= POPS_A_SLICE
            if left <= 0 or (stop is not None and time.monotonic() >= stop):
                return False
        return True
    except kernels.TreeError as fault:
        raise damaged(trees, fault) from fault
