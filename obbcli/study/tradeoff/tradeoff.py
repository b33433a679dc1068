"""`tradeoff`: the trade of speed against accuracy in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.errors import UnresolvedError
from obbcli.study.tradeoff.measuring import Study

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.motion.body import Body, Shape
    from obbcli.study.tradeoff.measuring import Progress
    from obbcli.study.tradeoff.trials import Tradeoff


def tradeoff(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    *,
    budget: float = 60.0,
    progress: Progress | None = None,
) -> Tradeoff:
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
        budget: s that it may take; building the default trees is not cut short.
        progress: called with about how many seconds are left, and how many settings are measured.

    Raises:
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
    study = Study(a, b, duration, accuracy, budget=budget)
    study.run(progress)
    result = study.result()
    if not study.has_reference:
        assert result.reference.time is not None
        raise UnresolvedError(
            "tradeoff",
            "a limit was reached before the certified answer was known",
            "raise budget, max_iterations or timeout",
            time=result.reference.time,
        )
    return result
