"""The least distance over a motion: `clearance`, which runs a `ClearanceQuery` to its end."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.accuracy import CLEARANCE_TOLERANCE, Accuracy
from obbcli.questions.clearance.asked import Asked, refuse_other_accuracy
from obbcli.questions.clearance.curve import CurveSearch
from obbcli.questions.clearance.query import ClearanceQuery
from obbcli.questions.pair_question import PairQuestion

if TYPE_CHECKING:
    from obbcli.answers.clearance import Clearance, CurvePiece
    from obbcli.motion.body import Body, Shape


def clearance(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    *,
    tolerance: float = CLEARANCE_TOLERANCE,
    at_least: float | None = None,
    solid: bool = False,
    greatest: bool = False,
) -> Clearance:
    """Return how near two bodies come to each other in the closed interval [0, duration].

    The least distance is a proven bracket: at no time are the bodies nearer than its lower end,
    with every rounding counted, and at the time that the answer names they are no further apart
    than its upper end. Bodies that touch have the least distance 0, told with their first contact.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: its `max_iterations` and `timeout` are the limits after which the bracket stays
            as wide as it is; its other fields, `clearance` among them, are refused.
        tolerance: relative width asked of the bracket. It is never narrower than some 1e-12 of the
            coordinates.
        at_least: mesh units; ask only whether the bodies keep this distance, which is cheaper: the
            search ends as soon as that is known.
        solid: whether closed surfaces hold what is inside them: a body inside the other touches it.
        greatest: ask for the greatest distance in the interval, too, to the same tolerance; not
            with `solid`.

    Raises:
        MotionError: an argument is refused, a field of `accuracy` has no meaning here, or positions
            leave the range of double.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, 10, 0]))
        >>> clearance(finger, "sample_meshes/workpiece.obj", at_least=1.0).at_least.verdict
        'holds'
    """
    limits = Accuracy() if accuracy is None else accuracy
    asked = {"tolerance": tolerance, "at_least": at_least, "solid": solid, "greatest": greatest}
    query = ClearanceQuery(a, b, duration, limits, **asked)  # type: ignore[arg-type]
    return query.advance(limits.max_iterations, limits.timeout)


def clearance_curve(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    *,
    intervals: int,
    tolerance: float = CLEARANCE_TOLERANCE,
) -> tuple[CurvePiece, ...]:
    """Return the least distance in each of equal intervals that cover [0, duration].

    Each is a bracket as that of `clearance`: in all of the interval the surfaces are never nearer
    than its lower end. Where a limit ends the search the pieces that are left have bounds that say
    nothing, (0, None).

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: as `clearance` takes it.
        intervals: how many, from 1 to a million; one where the duration is 0.
        tolerance: relative width asked of each bracket.

    Raises:
        ObbError: as `clearance`.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, 10, 0]))
        >>> pieces = clearance_curve(finger, "sample_meshes/workpiece.obj", intervals=2)
        >>> [round(piece.bounds[1], 3) for piece in pieces]
        [2.0, 2.0]
    """
    asked = Asked.of(tolerance, intervals=intervals)
    limits = Accuracy() if accuracy is None else accuracy
    refuse_other_accuracy(limits)
    pair = PairQuestion.of(a, b, duration, limits)
    found = ClearanceQuery.about(pair, asked).advance(limits.max_iterations, limits.timeout)
    if found.curve is not None:
        return found.curve
    return CurveSearch(pair, tolerance, asked.intervals).all_pieces()
