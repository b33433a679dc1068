"""`tradeoff`: the trade of speed against accuracy in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.errors import MotionError, UnresolvedError
from obbcli.study.asks import ASKS
from obbcli.study.tradeoff.measuring import Study
from obbcli.study.tradeoff.trials import Tradeoff

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.motion.body import Body, Shape
    from obbcli.study.asks import Ask
    from obbcli.study.tradeoff.at_rest import RestStudy, RestTradeoff
    from obbcli.study.tradeoff.measuring import Progress


def tradeoff(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    *,
    ask: Ask = "first-contact",
    budget: float = 60.0,
    progress: Progress | None = None,
) -> Tradeoff | RestTradeoff:
    """Measure what speed costs in accuracy, for these bodies in this motion.

    The certified answer comes first, to 1e-12 of the duration. Methods are varied on the default
    trees (tolerances, depth limits, sampled steps from one to a million), trees under the default
    question, and the best of either are crossed. Settings are asked in turns, warm; small ones come
    first, and what the budget did not reach is listed. Errors hold for this question alone: another
    motion may fool a sampled setting that was right here.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
            A tree is used as it is; to see how others would do, give the mesh.
        b: the other shape, of the same kinds.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: what the user would ask with: it is measured as well, and all settings share its
            `clearance`, `max_iterations` and `timeout`. None: the defaults.
        ask: `"first-contact"`; or `"distance"` or `"overlap"`, which are asked of the bodies at
            t = 0: then it is measured what a tolerance costs, and every bracket is held against the
            narrowest.
        budget: s that it may take; building the default trees is not cut short.
        progress: called with about how many seconds are left, and how many settings are measured.

    Raises:
        MotionError: the question is none, or an argument says nothing about it.
        UnresolvedError: the budget or a limit ended the certified answer.
        MotionError: the duration or the budget is negative or not finite, or positions leave the
            range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, -10, 0]))
        >>> found = tradeoff(finger, "sample_meshes/workpiece.obj", budget=1.0)
        >>> found.reference.time, found.faulty
        (0.5, ())
    """
    study = study_of(a, b, duration, accuracy, ask=ask, budget=budget)
    study.run(progress)
    result = study.result()
    if isinstance(result, Tradeoff) and not study.has_reference:
        assert result.reference.time is not None
        raise UnresolvedError(
            "tradeoff",
            "a limit was reached before the certified answer was known",
            "raise budget, max_iterations or timeout",
            time=result.reference.time,
        )
    return result


def study_of(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    *,
    ask: Ask = "first-contact",
    budget: float = 60.0,
) -> Study | RestStudy:
    """Return the study of a question, not yet run; arguments as those of `tradeoff`.

    Raises:
        MotionError: the question is none, or an argument says nothing about it.
        ObbError: as `tradeoff`.
    """
    if ask == "first-contact":
        return Study(a, b, duration, accuracy, budget=budget)
    if ask not in ASKS:
        raise MotionError("ask", f"is {ask!r}", "use one of " + ", ".join(ASKS))
    if duration:
        fault = f"is {duration!r}, and {ask} is asked at t = 0"
        raise MotionError("duration", fault, "leave it out")
    from obbcli.study.tradeoff.at_rest import RestStudy

    return RestStudy(a, b, accuracy, ask=ask, budget=budget)
