"""When do two moving bodies first touch? `first_contact`. Eberly 2008 §5 and §7."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers import collision  # noqa: F401  # the kernels make answers of its class
from obbcli.questions.border import quick_question
from obbcli.questions.describe import answer_told
from obbcli.questions.pair_question import PairQuestion
from obbcli.questions.query import Query
from obbcli.questions.steady import SteadyQuery

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import FirstContact
    from obbcli.motion.body import Body, Shape

    Queries = tuple[kernels.StaticQuery, kernels.ContactQuery | None, bool]


def going_on(
    a: Body | Shape, b: Body | Shape, queries: Queries, *, any_contact: bool = False
) -> FirstContact:
    """Return the answer to a question about two bodies, as they are, that the kernels have begun.

    Args:
        a: a body of constant velocities with its tree, or a tree.
        b: as `a`.
        queries: about t = 0, about the motion or None, and whether all is answered.
        any_contact: whether any proof of contact will do, not of the first.

    Raises:
        ObbError: as `Query`.
    """
    pair = PairQuestion.of(a, b)
    at_start, moving, is_finished = queries
    search = SteadyQuery.begun(
        pair, at_start, moving, is_finished=is_finished, any_contact=any_contact
    )
    query = Query.begun(search, pair)
    return query.advance(pair.accuracy.max_iterations - search.pops, pair.accuracy.timeout)


@kernels.asked_by_kernels_first(quick_question(going_on, answer_told))
def first_contact(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    solid: bool = False,
    after_release: bool = False,
    released_by: float = 0.0,
) -> FirstContact:
    """Return when and where two bodies first touch in the closed interval [0, duration].

    SEPARATED is proof; no contact exists before `time_bounds[0]`, in floating point with every
    rounding counted, whatever the number of turns. Without rotation the time is exact: the bracket
    is the doubles around a rational number. All that is said by the sampled method (`Accuracy`)
    holds for paths that are off the true ones by up to `error_bound`, but for contact at t = 0.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: what is asked of the answer, and the limits after which it is `unresolved`.
        solid: whether a body inside the other at t = 0 is contact too, without touching: closed
            surfaces then hold what is inside them.
        after_release: whether contact does not count until the bodies have been apart, first at
            `released`; of bodies that never are, the status is OVERLAP_AT_START.
        released_by: mesh units; apart by more than this, where `after_release`.

    Raises:
        MotionError: the duration is negative or not finite, positions leave the range of double,
            sampled steps turn too far for their integrator, or `after_release` does not fit.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, -10, 0]))
        >>> answer = first_contact(finger, "sample_meshes/workpiece.obj")
        >>> answer.status.value, answer.time_bounds, answer.evidence
        ('contact', (0.5, 0.5), 'intersecting')
    """
    pair = PairQuestion.of(a, b, duration, accuracy)
    if after_release or released_by:
        from obbcli.questions.intervals.after_release import asked_after_release

        return asked_after_release(pair, after_release, released_by, solid=solid)
    query = Query.about(pair, solid=solid)
    return query.advance(pair.accuracy.max_iterations, pair.accuracy.timeout)
