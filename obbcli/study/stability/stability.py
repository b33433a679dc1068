"""`stability`: a question at the extremes in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.errors import MotionError
from obbcli.study.asks import ASKS
from obbcli.study.stability.at_rest import RestBattery
from obbcli.study.stability.battery import Battery

if TYPE_CHECKING:
    from collections.abc import Callable

    from obbcli.accuracy import Accuracy
    from obbcli.motion.body import Body, Shape
    from obbcli.study.asks import Ask
    from obbcli.study.stability.rows import Stability


def stability(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    *,
    ask: Ask = "first-contact",
    progress: Callable[[int, int, str], None] | None = None,
) -> Stability:
    """Ask the same question at its extremes, and say which answers hold.

    The world is scaled, shifted, turned and hurried, bodies are swapped, triangles are reordered,
    split, repeated and reversed, time is scaled and cut, bodies are spun and tilted, and digits are
    taken away. What may change is bounded by what that did to the input.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: what is asked of every answer; an extreme may take 200 times the queue pops of the
            question itself, and at least 50,000, as far as `max_iterations` allows. None: the
            defaults.
        ask: `"first-contact"`; or `"distance"` or `"overlap"`, which are asked of the bodies at
            t = 0, whatever their motion, and whose brackets must overlap up to the bound.
        progress: called before each extreme with how many are done, of how many, and which is next.

    Raises:
        MotionError: the method is sampled, or a body moves through poses.
        ObbError: as `first_contact` says.

    Example:
        >>> from obbcli import Body, Mesh, Motion
        >>> floor = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> roof = Mesh([[0, 0, 1], [1, 0, 1], [0, 1, 1]], [[0, 1, 2]])
        >>> stability(floor, Body(roof, motion=Motion([0, 0, -2]))).broken
        ()
    """
    battery = battery_of(a, b, duration, accuracy, ask=ask)
    while not battery.is_finished:
        if progress is not None:
            progress(len(battery.rows), battery.count, battery.next_extreme)
        battery.advance()
    return battery.result()


def battery_of(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    *,
    ask: Ask = "first-contact",
) -> Battery | RestBattery:
    """Return the extremes of a question, none tried yet; arguments as those of `stability`.

    Raises:
        MotionError: the question is none, or an argument says nothing about it.
        ObbError: as `first_contact` says.
    """
    if ask == "first-contact":
        return Battery(a, b, duration, accuracy)
    if ask not in ASKS:
        raise MotionError("ask", f"is {ask!r}", "use one of " + ", ".join(ASKS))
    if duration:
        fault = f"is {duration!r}, and {ask} is asked at t = 0"
        raise MotionError("duration", fault, "leave it out")
    return RestBattery(a, b, accuracy, ask)
