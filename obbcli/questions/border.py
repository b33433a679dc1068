"""What every question about two bodies shares: trees, limits, and the kernels' query at rest."""

from __future__ import annotations

import math
import operator
import os
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.counts import QueryStats
from obbcli.errors import MotionError, TreeFileError
from obbcli.mesh import Mesh
from obbcli.motion.body import pivot_of
from obbcli.tree.tree import ObbTree, load_tree

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from obbcli.accuracy import Accuracy
    from obbcli.errors import ObbError
    from obbcli.motion.body import Body, Shape

_NO_DEPTH_LIMIT = 2**32 - 1
# Of the duration: the width asked of a bracket where the caller asks for none.
_TIME_TOLERANCE = 1e-9
NO_LIMIT = 2**64 - 1
_ORIGIN = (0.0, 0.0, 0.0)
# Queue pops between two looks at clock and signals: a few milliseconds. The kernels end a slice
# earlier where pops take long, as relays of questions do.
POPS_A_SLICE = 16_384
SECONDS_A_SLICE = 0.01

Trees = tuple[ObbTree, ObbTree]


def trees_of(bodies: tuple[Body, Body]) -> Trees:
    """Return the trees of two bodies, one for both where they share a shape.

    Raises:
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """
    a, b = bodies[0].shape, bodies[1].shape
    if isinstance(a, ObbTree) and isinstance(b, ObbTree):
        return a, b
    tree = _tree(a)
    return tree, tree if b is a else _tree(b)


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


def duration_of(duration: float | None, bodies: Sequence[Body]) -> float:
    """Return the end of the interval asked about, s.

    By default 0 where all bodies rest, the last time of a motion through poses, or else 1.

    Raises:
        MotionError: not a finite number of at least 0.
    """
    if duration is None:
        motions = [body.motion for body in bodies if not body.motion.is_at_rest]
        if not motions:
            return 0.0
        ends = (motion.ends_at for motion in motions)
        return max((end for end in ends if end is not None), default=1.0)
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


def placed_of(body: Body, tree: ObbTree) -> kernels.Placed:
    """Return a body's tree where its pose puts it."""
    return body.placed or kernels.Placed(tree.kernel, body.pose.kernel)


def static_query(
    trees: Trees, bodies: tuple[Body, Body], accuracy: Accuracy
) -> kernels.StaticQuery:
    """Return the kernels' query about the bodies at t = 0, not yet advanced.

    Raises:
        MotionError: posed coordinates leave the range of double.
        TreeFileError: a tree file is damaged.
    """
    (tree_a, tree_b), (a, b) = trees, bodies
    try:
        return kernels.StaticQuery(placed_of(a, tree_a), placed_of(b, tree_b), limits_of(accuracy))
    except (ValueError, kernels.TreeError) as fault:
        raise refused(trees, fault) from fault


def stats_of(
    trees: Trees, counts: tuple[int, int, int, int], seconds: Mapping[str, float]
) -> QueryStats:
    """Return what a question cost.

    Args:
        trees: those asked about.
        counts: box tests, triangle tests, exact ones, pops.
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
    bodies: tuple[Body, Body],
    trees: Trees,
    duration: float,
    accuracy: Accuracy,
    *,
    any_contact: bool = False,
    each_pair: bool = False,
) -> kernels.ContactQuery:
    """Return the kernels' query about bodies of constant velocities, not yet advanced.

    Raises:
        MotionError: positions leave the range of double.
        TreeFileError: a tree file is damaged.
    """
    (a, b), (tree_a, tree_b) = bodies, trees
    screw_a, screw_b = _screw(a, tree_a), _screw(b, tree_b)
    try:
        return kernels.ContactQuery(
            tree_a.kernel,
            a.pose.kernel,
            screw_a,
            tree_b.kernel,
            b.pose.kernel,
            screw_b,
            limits_of(accuracy),
            duration=duration,
            time_tolerance=time_tolerance(accuracy, duration),
            any_contact=any_contact,
            each_pair=each_pair,
        )
    except ValueError as fault:
        raise out_of_range(trees, "motion", fault) from fault
    except kernels.TreeError as fault:
        raise damaged(trees, fault) from fault


def time_tolerance(accuracy: Accuracy, duration: float) -> float:
    """Return the width asked of a bracket, s."""
    asked = accuracy.time_tolerance
    return _TIME_TOLERANCE * duration if asked is None else asked


def moves_nothing(bodies: tuple[Body, Body], trees: Trees, duration: float) -> bool:
    """Return whether neither of two bodies of constant velocities moves against the other."""
    (a, b), (tree_a, tree_b) = bodies, trees
    ma, mb = a.motion, b.motion
    if duration == 0 or (ma.is_at_rest and mb.is_at_rest):
        return True
    if ma.is_at_rest or mb.is_at_rest:
        return False
    if (ma.linear_velocity != mb.linear_velocity).any() or (
        ma.angular_velocity != mb.angular_velocity
    ).any():
        return False
    return not ma.is_turning or bool((pivot_of(a, tree_a) == pivot_of(b, tree_b)).all())


def _screw(body: Body, tree: ObbTree) -> kernels.Screw:
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
    # A body that does not turn has no use for a pivot, nor for the pass over its mesh to find one.
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
