"""Yes or no, and which: `collide` and `triangle_pairs`. Eberly 2008 §7."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import Accuracy
from obbcli.answers.collision import Collision
from obbcli.errors import UnresolvedError
from obbcli.motion.body import as_body
from obbcli.questions.border import NO_LIMIT, limits_of, placed_of, refused, whole_limit
from obbcli.questions.pair_question import PairQuestion, trees_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from obbcli.answers.contact import FirstContact
    from obbcli.motion.body import Body, Shape

# What a pair takes at the peak: two rows, and what lists that grow set aside.
_BYTES_A_PAIR = 32
_EXACT_LIMITS = limits_of(Accuracy())


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
    question ends at any proof of contact, which is cheaper than the first. Asked by the sampled
    method (`Accuracy`), all but contact at t = 0 is `approximate`, `separated` too.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        b: likewise.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: limits and coarseness; None: the exact answer.
        solid: whether a body inside the other at t = 0 is contact too, without touching: closed
            surfaces then hold what is inside them.

    Raises:
        MotionError: the duration is negative or not finite, positions leave the range of double, or
            sampled steps turn by more than their integrator can follow.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> answer = collide("sample_meshes/gear.stl", "sample_meshes/pinion.stl")
        >>> answer.collides, answer.status.value
        (False, 'separated')
    """
    if duration is None and accuracy is None and not solid:
        # What most ask, in the fewest steps: there are bodies that take less than a microsecond.
        here, there = getattr(a, "at_rest", None), getattr(b, "at_rest", None)
        if here is not None and there is not None:
            try:
                return Collision.at_rest(kernels.collide(here, there, _EXACT_LIMITS))
            except (ValueError, kernels.TreeError) as fault:
                raise refused(trees_of((as_body(a), as_body(b))), fault) from fault
    return collide_pair(PairQuestion.of(a, b, duration, accuracy), solid=solid)


def collide_pair(pair: PairQuestion, *, solid: bool) -> Collision:
    """Return what `collide` says of a question that is understood already.

    Raises:
        ObbError: as `collide`.
    """
    accuracy = pair.accuracy
    if solid or pair.duration > 0 or accuracy.clearance > 0:
        # Imported where it is needed: bodies at rest answer without it.
        from obbcli.questions.first_contact import Query

        query = Query.about(pair, solid=solid, any_contact=True)
        return collision_of(query.advance(accuracy.max_iterations, accuracy.timeout))
    here, there = map(placed_of, pair.bodies, pair.trees)
    try:
        found = kernels.collide(here, there, limits_of(accuracy))
    except (ValueError, kernels.TreeError) as fault:
        raise refused(pair.trees, fault) from fault
    return Collision.at_rest(found, pair.load_seconds)


def collision_of(found: FirstContact) -> Collision:
    """Return the yes or no of an answer to `Query` with `any_contact`."""
    a, b = found.triangle_a, found.triangle_b
    return Collision(
        status=found.status,
        witness=None if a is None or b is None else (a, b),
        approximate=found.approximate,
        error_bound=found.error_bound,
        contained=found.contained,
        stats=found.stats,
    )


def triangle_pairs(
    a: Body | Shape,
    b: Body | Shape,
    limit: int | None = None,
    *,
    threads: int | None = None,
    max_memory: int | None = None,
) -> NDArray[np.int64]:
    """Return every pair of triangles that intersect at t = 0, int64 (N, 2), sorted.

    Exact: the same pairs as testing all triangles against all others in rational arithmetic.
    Rows of the meshes' files. Motions play no part. There may be as many pairs as the product of
    the numbers of triangles: `triangle_pair_blocks` yields them some at a time.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        b: likewise.
        limit: stop after so many pairs, and return those, sorted. Which ones depends on the trees.
            One thread looks for them.
        threads: at most so many; None: as many as this process may use cores. They change nothing
            but the time it takes.
        max_memory: bytes that the pairs may need, about. None: no limit.

    Raises:
        UnresolvedError: the pairs need more than `max_memory`.
        MotionError: `limit` or `max_memory` is no whole number of at least 1, or posed coordinates
            leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        ObbError: `threads` is no positive integer.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Pose
        >>> moved = Body("sample_meshes/pinion.stl", Pose(translation=[-1, 0, 0]))
        >>> triangle_pairs("sample_meshes/gear.stl", moved, limit=2).tolist()
        [[92, 460], [93, 460]]
    """
    # Imported where it is needed: a yes or no answers without it.
    from obbcli.threads import thread_count

    workers = thread_count(threads)
    most = NO_LIMIT if limit is None else whole_limit(limit)
    bodies = as_body(a), as_body(b)
    trees = trees_of(bodies)
    here, there = map(placed_of, bodies, trees)
    room = NO_LIMIT
    if max_memory is not None:
        room = whole_limit(max_memory, "max_memory") // _BYTES_A_PAIR
    try:
        found, _counts = kernels.triangle_pairs(here, there, most, workers, room)
    except (ValueError, kernels.TreeError) as fault:
        raise refused(trees, fault) from fault
    if found is None:
        raise UnresolvedError(
            "max_memory",
            f"more than {room} pairs of triangles intersect, and {max_memory} bytes are allowed",
            "allow more, cut the list with limit, or take it in blocks",
        )
    return found
