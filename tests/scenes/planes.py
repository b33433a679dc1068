"""When a moving mesh first reaches a plane, in closed form up to one root of a monotone piece.

A vertex' height along a fixed direction is `c + v t + r cos(w t - phase)`: between neighbouring
extremes it is monotone, and the maxima of successive turns lie on a line, so that the turn of the
first contact is a quotient and needs no search.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mpmath
from oracles.exact import plain

if TYPE_CHECKING:
    from oracles.screw import Mover

DIGITS = 60


def plane_time(body: Mover, normal: Any, level: Any, duration: float) -> mpmath.mpf | None:
    """Return the first time in [0, duration] at which a vertex has `normal . x >= level`, or None.

    Exact input (the rounded pose), right to about 40 digits.
    """
    with mpmath.workdps(DIGITS):
        n, w, k, v = (
            [mpmath.mpf(x) for x in plain(row)]
            for row in (normal, body.spin, body.pivot, body.velocity)
        )
        speed = mpmath.norm(w)
        axis = [x / speed for x in w] if speed else w
        times = []
        for point in body.start.tolist():
            arm = [mpmath.mpf(x) - y for x, y in zip(point, k, strict=True)]
            lift = mpmath.fdot(axis, arm)
            along = [lift * x for x in axis] if speed else arm
            across = [x - y for x, y in zip(arm, along, strict=True)]
            p, q = mpmath.fdot(n, across), mpmath.fdot(n, _cross(axis, across))
            base = mpmath.fdot(n, k) + mpmath.fdot(n, along) - mpmath.mpf(level)
            path = _Path(base, mpmath.fdot(n, v), mpmath.hypot(p, q), speed, mpmath.atan2(q, p))
            times.append(path.first(mpmath.mpf(duration)))
        return min((time for time in times if time is not None), default=None)


def _cross(p: Any, q: Any) -> list[Any]:
    return [p[i - 2] * q[i - 1] - p[i - 1] * q[i - 2] for i in range(3)]


class _Path:
    """`base + rate t + size cos(speed t - phase)`."""

    def __init__(self, base: Any, rate: Any, size: Any, speed: Any, phase: Any) -> None:
        self.base, self.rate, self.size, self.speed, self.phase = base, rate, size, speed, phase

    def height(self, t: Any) -> Any:
        return self.base + self.rate * t + self.size * mpmath.cos(self.speed * t - self.phase)

    def first(self, duration: Any) -> Any:
        """Return the first time in [0, duration] at which the height is at least 0, or None."""
        if self.height(mpmath.mpf(0)) >= 0:
            return mpmath.mpf(0)
        if abs(self.rate) >= self.size * self.speed:
            return self._root(mpmath.mpf(0), duration)
        # Extremes: sin(speed t - phase) = rate / (size speed), the maxima on the rising side of 0.
        tilt = mpmath.asin(self.rate / (self.size * self.speed))
        turn = 2 * mpmath.pi / self.speed
        top = ((self.phase + tilt) / self.speed) % turn
        peak = self.height(top)
        later = mpmath.ceil(-peak / (self.rate * turn)) if peak < 0 < self.rate else 0
        if peak < 0 >= self.rate:
            # The maxima do not rise; what rises at the end of the interval ends below them.
            return None
        top += later * turn
        # The minimum before that maximum: from there the height only rises.
        low = top - turn / 2 - 2 * tilt / self.speed
        while low > top:
            low -= turn
        low = max(low, mpmath.mpf(0))
        if low > duration:
            return None
        return self._root(low, min(top, duration))

    def _root(self, low: Any, high: Any) -> Any:
        if self.height(high) < 0:
            return None
        for _ in range(170):
            middle = (low + high) / 2
            if self.height(middle) >= 0:
                high = middle
            else:
                low = middle
        return high
