"""Yes or no: `collide`. Eberly 2008 §7."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.collision import Collision
from obbcli.motion.body import as_body
from obbcli.questions.border import limits_of, placed_of, quick_question, refused
from obbcli.questions.pair_question import PairQuestion, trees_of, with_parts

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import FirstContact
    from obbcli.motion.body import Body, Shape
    from obbcli.questions.first_contact import Queries


def _going_on(a: Body | Shape, b: Body | Shape, queries: Queries) -> Collision:
    from obbcli.questions.first_contact import going_on

    return collision_of(going_on(a, b, queries, any_contact=True))


def _named(a: Body | Shape, b: Body | Shape, found: Collision) -> Collision:
    return with_parts(trees_of((as_body(a), as_body(b))), found, found.witness)


@kernels.asked_by_kernels_first(quick_question(_going_on, named=_named, any_contact=True))
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
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
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
    return collide_pair(PairQuestion.of(a, b, duration, accuracy), solid=solid)


def collide_pair(pair: PairQuestion, *, solid: bool) -> Collision:
    """Return what `collide` says of a question that is understood already.

    Raises:
        ObbError: as `collide`.
    """
    accuracy = pair.accuracy
    if solid or pair.duration > 0 or accuracy.clearance > 0:
        # Bodies at rest answer without this import.
        from obbcli.questions.query import Query

        query = Query.about(pair, solid=solid, any_contact=True)
        return collision_of(query.advance(accuracy.max_iterations, accuracy.timeout))
    here, there = map(placed_of, pair.bodies, pair.trees)
    try:
        found: Collision = kernels.collide(here, there, limits_of(accuracy), pair.load_seconds)
    except (ValueError, kernels.TreeError) as fault:
        raise refused(pair.trees, fault) from fault
    return pair.with_parts(found, found.witness)


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
        part_a=found.part_a,
        part_b=found.part_b,
    )
