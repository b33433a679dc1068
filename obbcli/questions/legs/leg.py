"""`Leg`: a time in which both bodies of a question have constant velocities, and its clock."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from obbcli.motion.body import Body
    from obbcli.questions.pair_question import PairQuestion


class Leg(NamedTuple):
    """A time in which both bodies have constant velocities.

    Attributes:
        start: s, of the whole question's clock.
        duration: s, rounded up.
        bodies: posed at the start.
        slack: mesh units; by no more than this does the bodies' distance on their true paths differ
            from that of `bodies`, up to the start of the next leg.
    """

    start: float
    duration: float
    bodies: tuple[Body, Body]
    slack: float

    def question(self, pair: PairQuestion, **changes: object) -> PairQuestion:
        """Return the question about this leg of a pair's motion.

        Args:
            pair: the question about the whole motion.
            changes: fields of its accuracy that differ for the leg.
        """
        from dataclasses import replace

        accuracy = replace(pair.accuracy, **changes) if changes else pair.accuracy  # type: ignore[arg-type]
        return pair._replace(bodies=self.bodies, duration=self.duration, accuracy=accuracy)


def length_of(start: float, end: float) -> float:
    """Return end - start, s, rounded up."""
    length = end - start
    reaches = math.fsum((start, length, -end)) >= 0
    return length if reaches else math.nextafter(length, math.inf)


def on_clock(start: float, time: float, duration: float, *, up: bool) -> float:
    """Return a leg's time on the whole question's clock, rounded down or up, s."""
    total = start + time
    rest = math.fsum((start, time, -total))
    if up and rest > 0:
        total = math.nextafter(total, math.inf)
    elif not up and rest < 0:
        total = math.nextafter(total, 0.0)
    return min(total, duration)
