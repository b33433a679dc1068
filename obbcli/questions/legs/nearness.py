"""How long the bodies of legs stay near each other, where contact cannot be proven."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

from obbcli.accuracy import Accuracy
from obbcli.motion.body import Body, missing_pivot
from obbcli.questions.legs.leg import on_clock
from obbcli.questions.legs.slack import rounding_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.questions.legs.leg import Leg
    from obbcli.questions.pair_question import PairQuestion

# The first look at near bodies comes after such a share of the leg; each next one after twice that.
_SHORTEST = 2.0**-50
_HALVINGS = 12
# Legs that are looked at before the rest of the motion is said to be undecided as a whole.
_MOST_LEGS = 64
_EXACT = Accuracy()


class Nearness(NamedTuple):
    """Until when bodies are near on their true paths, and how far apart they are at most then.

    Attributes:
        end: s, of the whole question's clock: the bodies are proven no longer to be near, unless
            that is the duration.
        distance: mesh units.
    """

    end: float
    distance: float


def near_until(pair: PairQuestion, legs: Iterator[Leg], start: float) -> Nearness:
    """Return until when bodies that cannot be told from contact stay so.

    Nothing is said of the time in between but that contact, if there is any, may be in it.

    Args:
        pair: the question about the whole motion.
        legs: from the one in which the bodies come near on.
        start: s, of that leg's clock: when they do.
    """
    leg = None
    for leg in islice(legs, _MOST_LEGS):
        look = _Look(pair, leg)
        parted = None
        if start > 0 or leg.start == 0 or look.has_parted(leg.duration):
            parted = look.parted_after(start)
        if parted is not None:
            end = on_clock(leg.start, parted, pair.duration, up=True)
            return Nearness(end, look.distance(parted))
        start = 0.0
    assert leg is not None
    return Nearness(pair.duration, _Look(pair, leg).distance(leg.duration))


class _Look:
    """The bodies of a leg at single times."""

    def __init__(self, pair: PairQuestion, leg: Leg) -> None:
        self._pair, self._leg = pair, leg

    def parted_after(self, start: float) -> float | None:
        """Return a time from which on they are not near, s; None if they are until the end."""
        last, reach = start, max(_SHORTEST * self._leg.duration, 0.125 * self._pair.time_tolerance)
        while last < self._leg.duration:
            time = min(start + reach, self._leg.duration)
            if self.has_parted(time):
                return self._earliest(last, time)
            last, reach = time, 2 * reach
        return None

    def _earliest(self, near: float, parted: float) -> float:
        for _ in range(_HALVINGS):
            middle = 0.5 * near + 0.5 * parted
            if self.has_parted(middle):
                parted = middle
            else:
                near = middle
        return parted

    def has_parted(self, time: float) -> bool:
        """Return whether the true paths are proven to be beyond the clearance."""
        (low, _), error = self._gap(time)
        return low > self._pair.accuracy.clearance + error

    def distance(self, time: float) -> float:
        """Bound how far apart the true paths are, mesh units."""
        (_, high), error = self._gap(time)
        return high + error

    def _gap(self, time: float) -> tuple[tuple[float, float], float]:
        # Loaded where it is needed: few questions come to it.
        from obbcli.questions.distance import measure

        error, bodies = self._leg.slack, []
        for body, tree in zip(self._leg.bodies, self._pair.trees, strict=True):
            moment = body.motion.moment(time, body.pose, missing_pivot(body, tree))
            error += rounding_of(tree, *moment.summands) if moment.summands else 0.0
            bodies.append(Body(tree, moment.pose))
        pair = self._pair._replace(bodies=(bodies[0], bodies[1]), duration=0.0, accuracy=_EXACT)
        return measure(pair)[0].bounds, error
