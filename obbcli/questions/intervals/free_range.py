"""For how long are two bodies free around t = 0, and what stops them? `free_range`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.answers.free_range import FreeRange
from obbcli.answers.status import Status
from obbcli.motion.body import Body, with_pivot
from obbcli.motion.motion import Motion
from obbcli.questions.border import stats_of
from obbcli.questions.intervals.contact_intervals import refuse_inexact
from obbcli.questions.pair_question import PairQuestion
from obbcli.questions.query import Query

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import Contact, FirstContact
    from obbcli.motion.body import Shape
    from obbcli.tree.tree import ObbTree


def free_range(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    *,
    solid: bool = False,
) -> FreeRange:
    """Return the free interval around t = 0 in [-duration, duration], and what stops the bodies.

    Two first contacts: one as time runs on, one as it runs backwards, with all velocities turned
    round. A body that moves through poses rests at the first of them before t = 0.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        duration: s, of each direction; None: 1 where a body moves, else 0.
        accuracy: what is asked of each first contact; limits hold for each of the two.
        solid: whether a body inside the other at t = 0 is contact too.

    Raises:
        MotionError: `accuracy` has a clearance, samples, or uses boxes for triangles, the duration
            is negative or not finite, or positions leave the range of double.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, -10, 0]))
        >>> free_range(finger, "sample_meshes/workpiece.obj").free
        (-1.0, 0.5)
    """
    return free_range_of(PairQuestion.of(a, b, duration, accuracy), solid=solid)


def free_range_of(pair: PairQuestion, *, solid: bool = False) -> FreeRange:
    """Return the answer to a question that is understood already.

    Raises:
        ObbError: as `free_range`.
    """
    refuse_inexact(pair.accuracy)
    after, query = _asked(pair, solid=solid)
    before, counts, seconds = after, query.counts, after.stats.seconds["query"]
    if after.status is not Status.OVERLAP_AT_START:
        before, query = _asked(backwards(pair), solid=solid)
        counts += query.counts
        seconds += before.stats.seconds["query"]
    is_free = Status.OVERLAP_AT_START not in (before.status, after.status)
    return FreeRange(
        free=(0.0 - _end(before, pair), _end(after, pair)) if is_free else None,
        complete=Status.UNRESOLVED not in (before.status, after.status),
        before=before,
        after=after,
        stats=stats_of(pair.trees, counts, {"load": pair.load_seconds, "query": seconds}),
    )


def _asked(pair: PairQuestion, *, solid: bool) -> tuple[FirstContact, Query]:
    query = Query.about(pair, solid=solid)
    return query.advance(pair.accuracy.max_iterations, pair.accuracy.timeout), query


def _end(stop: Contact, pair: PairQuestion) -> float:
    """Return up to when the bodies are proven free, s."""
    return pair.duration if stop.time is None else stop.time


def backwards(pair: PairQuestion) -> PairQuestion:
    """Return the question in which time runs backwards from t = 0."""
    a, b = map(_turned_round, pair.bodies, pair.trees)
    return pair._replace(bodies=(a, b))


def _turned_round(body: Body, tree: ObbTree) -> Body:
    if body.motion.places_mesh:
        return Body(tree, body.pose)
    motion = with_pivot(body, tree)
    back = Motion(0.0 - motion.linear_velocity, 0.0 - motion.angular_velocity, motion.pivot)
    return Body(tree, body.pose, back)
