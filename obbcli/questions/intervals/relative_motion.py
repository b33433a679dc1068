"""`RelativeMotion`: how one body moves as seen from the other, about one time, to third order.

Position, velocity and acceleration are those of the motions; the third derivative is bounded. With
`S(u) = R(-u W_y) R(u W_x)`, `O = W_x - W_y` and `D` the way from one pivot to the other, a point at
`r` from X's pivot is at `z(u) = R(-u W_y) (D + u V) + S(u) r`, and `S' = [R(-u W_y) O] S`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.motion.rotation import turn_after

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


class Frame(NamedTuple):
    """A body of constant velocities on a leg's clock.

    Attributes:
        velocity: V, (3,) mesh units a second.
        spin: W, (3,) rad/s.
        pivot: K at the start of the leg, (3,).
    """

    velocity: Floats
    spin: Floats
    pivot: Floats

    def turned(self, points: Floats, time: float) -> Floats:
        """Return where points of the start are at a time, from the pivot, (..., 3)."""
        away = points - self.pivot
        if not self.spin.any():
            return away
        turned: Floats = away @ turn_after(self.spin, time).matrix.T
        return turned

    def pivot_at(self, time: float) -> Floats:
        """Return where the pivot is at a time, (3,)."""
        return self.pivot + time * self.velocity


class Path(NamedTuple):
    """Points about one time: derivatives there, and what bounds the third one.

    Attributes:
        place: (..., 3).
        first: the first derivative, (..., 3).
        second: the second derivative, (..., 3).
        third: bound on the third one, (...), but for what grows with the time that passes.
    """

    place: Floats
    first: Floats
    second: Floats
    third: Floats


class RelativeMotion:
    """The motion of X seen from Y about a time: axes are the world's then, the origin Y's pivot.

    Args:
        moving: X.
        seen_from: Y.
        time: s, of the leg's clock.

    Attributes:
        turn_bounds: bounds on the first three derivatives of `S(u)`, in 1/s, 1/s^2, 1/s^3.
        third_growth: by how much the third derivative's bound grows a second.
    """

    def __init__(self, moving: Frame, seen_from: Frame, time: float) -> None:
        self._moving, self._seen_from, self._time = moving, seen_from, time
        wx, wy = moving.spin, seen_from.spin
        self._turn = wx - wy
        self._change = -np.cross(wy, wx)
        o, y, c = (float(np.linalg.norm(v)) for v in (self._turn, wy, self._change))
        self.turn_bounds = o, c + o * o, y * c + 3 * c * o + o**3
        self._way = moving.pivot_at(time) - seen_from.pivot_at(time)
        self._velocity = moving.velocity - seen_from.velocity
        across = float(np.linalg.norm(np.cross(wy, self._velocity)))
        self._third = 3 * y * across + y * y * float(np.linalg.norm(np.cross(wy, self._way)))
        self.third_growth = y * y * across

    def path(self, points: Floats) -> Path:
        """Return the paths of points of X, given at the start of the leg, (N, 3)."""
        wy, v, way = self._seen_from.spin, self._velocity, self._way
        arms = self._moving.turned(points, self._time)
        first = v - np.cross(wy, way)
        second = np.cross(wy, np.cross(wy, way)) - 2 * np.cross(wy, v)
        turned = self.turn_of(arms)
        third = self._third + self.turn_bounds[2] * np.linalg.norm(arms, axis=-1)
        return Path(way + arms, first + turned.first, second + turned.second, third)

    def turn_of(self, arms: Floats) -> Path:
        """Return how vectors of X turn, given at the time, (N, 3)."""
        first = np.cross(self._turn, arms)
        second = np.cross(self._change, arms) + np.cross(self._turn, first)
        return Path(arms, first, second, self.turn_bounds[2] * np.linalg.norm(arms, axis=-1))

    def fixed(self, points: Floats) -> Floats:
        """Return where points of Y are, given at the start of the leg, (..., 3)."""
        return self._seen_from.turned(points, self._time)
