"""For how long witnesses of contact hold: an edge that pierces a triangle, or two near points.

A witness is a few functions of time that stay positive as long as it holds. Each is known by value,
first and second derivative, and a bound on the third, so that `v + a u + b u^2 / 2 - J u^3 / 6`
bounds it from below. A span ends where the least of that is no more than rounding allows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.questions.intervals.polynomials import norm, plus, poly, reach_of, times, value_at

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.questions.intervals.relative_motion import RelativeMotion

    Floats = NDArray[np.float64]

_ROUNDS = 3
_STEPS = 48
# From one span that is tried first to the next.
_FACTOR = 0.45
# Errors of places and arms, times sizes, come to a third of this.
ERROR_FACTOR = 16.0


class Functions(NamedTuple):
    """Functions of time that a witness needs to stay positive, (N, F) each.

    What bounds the third derivatives and the errors over a span of s seconds are polynomials of s:
    (N, F, degree + 1) coefficients, lowest first.
    """

    value: Floats
    first: Floats
    second: Floats
    third: Floats
    error: Floats

    def rows(self, chosen: NDArray[np.bool_] | NDArray[np.int64]) -> Functions:
        """Return the functions of some witnesses."""
        return Functions(*(part[chosen] for part in self))

    def hold(self, spans: Floats, sign: float) -> NDArray[np.bool_]:
        """Return whether all functions of a witness stay positive over spans, (N, K) -> (N, K)."""
        s = spans[:, None, :]
        v, a, b = self.value[..., None], sign * self.first[..., None], self.second[..., None]
        least = np.minimum(v, v + a * s + 0.5 * b * s * s)
        with np.errstate(divide="ignore", invalid="ignore"):
            turning = np.where(b > 0, -a / b, -1.0)
        inside = (turning > 0) & (turning < s)
        least = np.where(inside, np.minimum(least, v + 0.5 * a * turning), least)
        lowest = least - value_at(self.third, s) * s**3 / 6
        held: NDArray[np.bool_] = np.all(lowest > value_at(self.error, s), axis=1)
        return held

    def spans(self, sign: float, longest: float) -> Floats:
        """Return how long each witness holds, later (sign 1) or earlier (sign -1), s, (N,)."""
        count = len(self.value)
        low, high = np.zeros(count), np.full(count, longest)
        tried = np.broadcast_to(longest * _FACTOR ** np.arange(_STEPS), (count, _STEPS))
        for _ in range(_ROUNDS):
            held = self.hold(tried, sign)
            # Spans fall from left to right; the first that holds is the longest.
            place = np.where(held.any(axis=1), held.argmax(axis=1), tried.shape[1])
            rows = np.arange(count)
            before = np.where(place > 0, tried[rows, np.maximum(place - 1, 0)], high)
            there = tried[rows, np.minimum(place, tried.shape[1] - 1)]
            low = np.where(place < tried.shape[1], np.maximum(low, there), low)
            high = np.where(place > 0, np.minimum(high, before), low)
            share = np.linspace(1.0, 0.0, 18)[1:-1]
            tried = low[:, None] + share * (high - low)[:, None]
        return low


def near_points(
    motion: RelativeMotion, points: tuple[Floats, Floats], within: float, error: float
) -> Functions:
    """Return the functions of points of X and Y that are no further apart than `within`.

    Args:
        motion: of X seen from Y.
        points: of X and of Y, (N, 3) each, at the start of the leg.
        within: mesh units.
        error: mesh units; by how much any place is off at most.
    """
    p = motion.path(points[0])
    gap = p.place - motion.fixed(points[1])
    reach = reach_of(p, motion.third_growth)
    far = plus(poly(norm(gap)), reach.way)
    third = 2 * plus(times(far, reach.third), 3 * times(reach.first, reach.second))

    def dot(x: Floats, y: Floats) -> Floats:
        products: Floats = np.einsum("ni,ni->n", x, y)[:, None]
        return products

    errors = ERROR_FACTOR * error * plus(far, poly(np.full(len(gap), within)))
    return Functions(
        within * within - dot(gap, gap),
        -2 * dot(gap, p.first),
        -2 * (dot(p.first, p.first) + dot(gap, p.second)),
        third[:, None],
        errors[:, None],
    )
