"""The border to the kernels: a question as they take it, and what they refuse as our errors."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import DEFAULT_DURATION, TIME_TOLERANCE, Accuracy
from obbcli.answers.counts import QueryStats
from obbcli.errors import MotionError, TreeFileError
from obbcli.motion.body import pivot_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from obbcli.errors import ObbError
    from obbcli.motion.body import Body
    from obbcli.questions.pair_question import PairQuestion, Trees
    from obbcli.tree.tree import ObbTree

_NO_DEPTH_LIMIT = 2**32 - 1
NO_LIMIT = 2**64 - 1
_ORIGIN = (0.0, 0.0, 0.0)


def limits_of(accuracy: Accuracy) -> kernels.Limits:
    """Return how far a certified question is pursued, as the kernels see it.

    What is None is left as the kernels have it: no limit, and no tolerance.
    """
    limits = kernels.Limits()
    limits.boxes_for_leaves = accuracy.leaves == "boxes"
    limits.clearance = accuracy.clearance
    limits.max_pops = min(accuracy.max_iterations, NO_LIMIT)
    if accuracy.max_depth_a is not None:
        limits.max_depth_a = min(accuracy.max_depth_a, _NO_DEPTH_LIMIT)
    if accuracy.max_depth_b is not None:
        limits.max_depth_b = min(accuracy.max_depth_b, _NO_DEPTH_LIMIT)
    if accuracy.distance_tolerance is not None:
        limits.distance_tolerance = accuracy.distance_tolerance
    if accuracy.timeout is not None:
        limits.seconds = accuracy.timeout
    return limits


def quick_question(
    going_on: Callable[..., object],
    told: Callable[..., object] | None = None,
    named: Callable[..., object] | None = None,
    *,
    any_contact: bool = False,
) -> kernels.QuickQuestion:
    """Return what is asked of two bodies, as they are, without further arguments.

    Args:
        going_on: as `kernels.QuickQuestion` has it.
        told: likewise.
        named: likewise.
        any_contact: likewise.
    """
    exact = Accuracy()
    tolerance = TIME_TOLERANCE * DEFAULT_DURATION
    limits = limits_of(exact)
    return kernels.QuickQuestion(
        limits, DEFAULT_DURATION, tolerance, any_contact, screw_of, going_on, told, named
    )


def placed_of(body: Body, tree: ObbTree) -> kernels.Placed:
    """Return a body's tree where its pose puts it."""
    return body.placed or kernels.Placed(tree.kernel, body.pose.kernel)


def static_query(pair: PairQuestion) -> kernels.StaticQuery:
    """Return the kernels' query about the bodies at t = 0, not yet advanced.

    Raises:
        MotionError: posed coordinates leave the range of double.
        TreeFileError: a tree file is damaged.
    """
    (tree_a, tree_b), (a, b) = pair.trees, pair.bodies
    limits = limits_of(pair.accuracy)
    try:
        return kernels.StaticQuery(placed_of(a, tree_a), placed_of(b, tree_b), limits)
    except (ValueError, kernels.TreeError) as fault:
        raise refused(pair.trees, fault) from fault


def stats_of(
    trees: Trees, counts: tuple[int, int, int, int, int], seconds: Mapping[str, float]
) -> QueryStats:
    """Return what a question cost.

    Args:
        trees: those asked about.
        counts: those of a search, in the order of `Counts`.
        seconds: s of wall time by stage.
    """
    (built_a, possible_a), (built_b, possible_b) = trees[0].node_counts(), trees[1].node_counts()
    return QueryStats(*counts, built_a, built_b, possible_a, possible_b, seconds)


def refused(trees: Trees, fault: ValueError | kernels.TreeError) -> ObbError:
    """Return the error for what the kernels refuse at rest: damage, or poses beyond doubles."""
    if isinstance(fault, kernels.TreeError):
        return damaged(trees, fault)
    return out_of_range(trees, "pose", fault)


def out_of_range(trees: Trees, where: str, fault: ValueError) -> ObbError:
    """Return the error for numbers beyond doubles: a damaged tree's own, or what motion makes."""
    for tree in trees:
        try:
            tree.check()
        except TreeFileError as damage:
            return damage
    return MotionError(where, str(fault), "move or scale the bodies")


def moving_query(
    pair: PairQuestion,
    *,
    any_contact: bool = False,
    each_pair: bool = False,
    box_tests_before_screw: int | None = None,
) -> kernels.ContactQuery:
    """Return the kernels' query about bodies of constant velocities, not yet advanced.

    Args:
        pair: the question.
        any_contact: whether any proof of contact will do, not of the first.
        each_pair: whether the contacts of all pairs of triangles are asked for.
        box_tests_before_screw: after how many it is asked whether the bodies move on a common
            screw. None: after as many as they have triangles.

    Raises:
        MotionError: positions leave the range of double.
        TreeFileError: a tree file is damaged.
    """
    (a, b), (tree_a, tree_b) = pair.bodies, pair.trees
    screw_a, screw_b = screw_of(a, tree_a), screw_of(b, tree_b)
    try:
        return kernels.ContactQuery(
            tree_a.kernel,
            a.pose.kernel,
            screw_a,
            tree_b.kernel,
            b.pose.kernel,
            screw_b,
            limits_of(pair.accuracy),
            duration=pair.duration,
            time_tolerance=pair.time_tolerance,
            any_contact=any_contact,
            each_pair=each_pair,
            box_tests_before_screw=box_tests_before_screw,
        )
    except ValueError as fault:
        raise out_of_range(pair.trees, "motion", fault) from fault
    except kernels.TreeError as fault:
        raise damaged(pair.trees, fault) from fault


def screw_of(body: Body, tree: ObbTree) -> kernels.Screw:
    """Return how a body moves, as the kernels see it; a body that has its tree remembers."""
    if body.shape is not tree:
        return _screw_over(body, tree)
    remembered = vars(body)
    screw: kernels.Screw | None = remembered.get("_screw")
    if screw is None:
        screw = remembered["_screw"] = _screw_over(body, tree)
    return screw


def _screw_over(body: Body, tree: ObbTree) -> kernels.Screw:
    motion = body.motion
    # A body that does not turn needs no pivot; to find one costs a pass over its mesh.
    pivot = pivot_of(body, tree).tolist() if motion.is_turning else _ORIGIN
    return kernels.Screw(*motion.velocities, pivot)


def whole_limit(limit: int, name: str = "limit") -> int:
    """Return a limit as an int that the kernels can hold.

    Raises:
        MotionError: no whole number of at least 1.
    """
    try:
        number = operator.index(limit)
    except TypeError as fault:
        raise MotionError(name, f"is {limit!r}", "use a whole number of at least 1") from fault
    if isinstance(limit, bool) or number < 1:
        raise MotionError(name, f"is {limit!r}", "use a whole number of at least 1")
    return min(number, NO_LIMIT)


def damaged(trees: Trees, fault: Exception) -> TreeFileError:
    """Return the error for a fault that a traversal met, under the name of the tree that has it."""
    met = [tree for tree in trees if tree.fault == str(fault)] or trees
    names = " or ".join(sorted({tree.place for tree in met}))
    return TreeFileError(names, str(fault), "build it again from the mesh")
