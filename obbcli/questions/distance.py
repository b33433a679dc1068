"""How far apart, and where: `distance`. Best-first on the trees, every bound proven."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.distance import Distance
from obbcli.questions.border import damaged, limits_of, out_of_range, stats_of
from obbcli.questions.budget import Budget
from obbcli.questions.pair_question import PairQuestion

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.motion.body import Body, Shape


def distance(a: Body | Shape, b: Body | Shape, accuracy: Accuracy | None = None) -> Distance:
    """Return how far apart two bodies are at t = 0, and where they are nearest.

    `bounds` are a proof for the posed vertices rounded to double (see `Pose`), with every rounding
    counted: no two points of the surfaces are nearer than `bounds[0]`, and two of them are no
    further apart than `bounds[1]`. By default they are as close as doubles allow, a few units in
    the last place of the distance, or 2^-49 of the largest coordinate where nothing but rounding
    tells hundreds of nearest pairs apart. Surfaces that touch or cross have the distance 0 exactly,
    and no others do; to be inside is not to touch. Swapping the bodies swaps the points.

    Every limit of `accuracy` keeps the bounds proven and lets them part: `distance_tolerance` stops
    where they are this close, `max_depth_a`, `max_depth_b` and `leaves` bound what is in a box by
    the box, and `max_iterations` and `timeout` stop wherever the search is. Its other fields say
    nothing about bodies at rest and are not used; motions play no part.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        accuracy: limits and coarseness; None: as close as doubles allow.

    Raises:
        MotionError: posed coordinates or the distance leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> distance("sample_meshes/housing.stl", "sample_meshes/board.vtk").bounds
        (0.049999999999972254, 0.049999999999999996)
    """
    return measure(PairQuestion.of(a, b, 0.0, accuracy))[0]


def measure(pair: PairQuestion) -> tuple[Distance, bool]:
    """Return what `distance` does, and whether it ended before `max_iterations` and `timeout`.

    Raises:
        ObbError: as `distance`.
        OSError: a file cannot be read.
    """
    trees = pair.trees
    start = time.perf_counter()
    try:
        query = _query(pair)
        is_complete = _run(query, pair.accuracy)
        low, high, point_a, point_b, triangle_a, triangle_b, counts = query.answer()
    except ValueError as fault:
        raise out_of_range(trees, "pose", fault) from fault
    except kernels.TreeError as fault:
        raise damaged(trees, fault) from fault
    answer = Distance(
        distance=high,
        bounds=(low, high),
        point_a=point_a,
        point_b=point_b,
        triangle_a=triangle_a,
        triangle_b=triangle_b,
        stats=stats_of(
            trees, counts, {"load": pair.load_seconds, "query": time.perf_counter() - start}
        ),
    )
    return pair.with_parts(answer, (triangle_a, triangle_b)), is_complete


def _query(pair: PairQuestion) -> kernels.DistanceQuery:
    """Return the kernels' query, not yet advanced."""
    (tree_a, tree_b), (a, b), accuracy = pair.trees, pair.bodies, pair.accuracy
    return kernels.DistanceQuery(
        tree_a.kernel,
        a.pose.kernel,
        tree_b.kernel,
        b.pose.kernel,
        limits_of(accuracy),
    )


def _run(query: kernels.DistanceQuery, accuracy: Accuracy) -> bool:
    """Advance a query to its end or to a limit of `accuracy`; return whether it ended."""
    budget = Budget(accuracy.max_iterations, accuracy.timeout).start()
    before = 0
    while not query.advance(budget.slice()):
        budget.spend(query.pops - before)
        before = query.pops
        if budget.is_over:
            return False
    return True
