"""When do two moving bodies touch, and when are they free? `contact_intervals`."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING

from obbcli.errors import MotionError
from obbcli.questions.border import whole_limit
from obbcli.questions.budget import Budget
from obbcli.questions.containment import body_name, require_watertight
from obbcli.questions.intervals.pieces import pieces_of
from obbcli.questions.intervals.stretches import Asked, Tally, resolution, stretches_of
from obbcli.questions.intervals.translations import translations
from obbcli.questions.pair_question import PairQuestion

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact_piece import ContactPiece
    from obbcli.motion.body import Body, Shape


def contact_intervals(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    *,
    within: float = 0.0,
    solid: bool = False,
    limit: int | None = None,
) -> Iterator[ContactPiece]:
    """Yield the pieces of [0, duration] in which two bodies touch, or are free, in order of time.

    Free and contact pieces are proven at every instant between their brackets, with every rounding
    counted. What is shorter than the time tolerance may hide in a bracket, and only there. What
    neither proof covers is an `undecided` piece: faces that slide on each other while a body turns,
    for instance, which `within` decides. Bodies of constant velocities that do not turn are decided
    exactly, unless `within` is given.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: its time tolerance is the width of the brackets, never below 2^-40 of the
            duration; its limits hold for the iterator as a whole.
        within: mesh units; surfaces this close or closer are in contact.
        solid: whether a body inside the other is contact too.
        limit: at most so many pieces.

    Raises:
        MotionError: `within` is negative or not finite, `limit` is no whole number of at least 1,
            `accuracy` has a clearance, samples, or uses boxes for triangles, the duration is
            negative or not finite, or positions leave the range of double.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        UnresolvedError: while iterating: a limit of `accuracy` was reached. What was yielded holds.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, -10, 0]))
        >>> [piece.kind for piece in contact_intervals(finger, "sample_meshes/workpiece.obj")]
        ['free', 'contact']
    """
    most = None if limit is None else whole_limit(limit)
    pair = PairQuestion.of(a, b, duration, accuracy)
    return islice(intervals_of(pair, within=within, solid=solid), most)


def intervals_of(
    pair: PairQuestion, *, within: float = 0.0, solid: bool = False, tally: Tally | None = None
) -> Iterator[ContactPiece]:
    """Return what `contact_intervals` yields, of a question that is understood already.

    Args:
        pair: the question.
        within: as `contact_intervals` has it.
        solid: likewise.
        tally: where costs are counted. None: nowhere.

    Raises:
        ObbError: as `contact_intervals`.
    """
    refuse_inexact(pair.accuracy)
    near = length(within, "within")
    if solid:
        for name, tree in zip("AB", pair.trees, strict=True):
            require_watertight(tree.mesh, body_name(name, tree))
    limits = Budget(pair.accuracy.max_iterations, pair.accuracy.timeout).start()
    asked = Asked(pair, near, solid, limits, tally or Tally())
    straight = all(body.motion.goes_straight for body in pair.bodies)
    if near == 0 and pair.is_steady and straight:
        return translations(asked)
    return pieces_of(stretches_of(asked), pair.duration, resolution(pair))


def refuse_inexact(accuracy: Accuracy) -> None:
    """Refuse what a proof over the whole motion cannot use.

    Raises:
        MotionError: a clearance, samples, or boxes in place of triangles.
    """
    if accuracy.clearance != 0:
        fault = f"is {accuracy.clearance!r}, which could mean two things here"
        raise MotionError("clearance", fault, "leave it at 0; intervals take within")
    if accuracy.method != "certified":
        raise MotionError("method", "samples prove no contact interval", "use 'certified'")
    for name, default in (("leaves", "triangles"), ("max_depth_a", None), ("max_depth_b", None)):
        if getattr(accuracy, name) != default:
            fault = "lets boxes stand for triangles, whose contact is no proof"
            raise MotionError(name, fault, f"leave it at {default!r}")


def length(value: float, name: str) -> float:
    """Return a finite length of at least 0, mesh units.

    Raises:
        MotionError: it is none.
    """
    from obbcli.accuracy import ASPECTS

    number = ASPECTS["clearance"].checked(name, value)
    assert isinstance(number, float)
    return number
