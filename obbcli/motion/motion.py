"""How a body moves: `Motion`, constant or through given poses.

World position of a vertex `p`: `x(0) = Q p + s`, then `x(t) = K + t V + R(t W) (x(0) - K)`; or
through given poses, in pieces of that kind.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from obbcli.arrays import as_floats, as_vector
from obbcli.errors import MotionError
from obbcli.motion.pose import Pose, vector_or_zero
from obbcli.motion.rotation import rotation_matrix, rotation_vector, turn_after

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

__all__ = ["Motion", "PathMotion", "Pose", "rotation_matrix"]

# Rad: nearer to half a turn, a matrix orthonormal to 1e-9 does not tell which way round is meant.
_HALF_TURN_MARGIN = 1e-8


@dataclass(frozen=True, init=False, eq=False)
class Motion:
    """How a body moves: constant linear and angular velocity in the world frame.

    Args:
        linear_velocity: V, (3,) mesh units a second. None: 0.
        angular_velocity: W, (3,) rad/s. None: 0.
        pivot: K, (3,) world coordinates: where the axis of rotation passes at t = 0; it travels
            with V. None: the centroid of the body's surface, posed.

    Attributes:
        linear_velocity: float64 (3,), read-only.
        angular_velocity: float64 (3,), read-only.
        pivot: float64 (3,), read-only, or None.
        is_at_rest: whether neither velocity moves anything.
        is_turning: whether there is an angular velocity.

    Raises:
        MotionError: not three finite numbers.

    Example:
        >>> Motion(linear_velocity=[0, 0, -2], angular_velocity=[0, 0, 3]).is_turning
        True
    """

    linear_velocity: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    pivot: NDArray[np.float64] | None
    is_at_rest: bool
    is_turning: bool

    def __init__(
        self,
        linear_velocity: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        pivot: ArrayLike | None = None,
    ) -> None:
        velocity = vector_or_zero(linear_velocity, "linear_velocity")
        spin = vector_or_zero(angular_velocity, "angular_velocity")
        point = None if pivot is None else as_vector(pivot, "pivot", MotionError)
        object.__setattr__(self, "linear_velocity", velocity)
        object.__setattr__(self, "angular_velocity", spin)
        object.__setattr__(self, "pivot", point)
        is_turning = bool(spin.any())
        object.__setattr__(self, "is_at_rest", not (is_turning or velocity.any()))
        object.__setattr__(self, "is_turning", is_turning)

    def __repr__(self) -> str:
        """Return what makes the same motion again."""
        values = {
            "linear_velocity": self.linear_velocity if self.linear_velocity.any() else None,
            "angular_velocity": self.angular_velocity if self.is_turning else None,
            "pivot": self.pivot,
        }
        told = [f"{name}={x.tolist()}" for name, x in values.items() if x is not None]
        return f"Motion({', '.join(told)})"

    @cached_property
    def velocities(self) -> tuple[list[float], list[float]]:
        """Linear and angular velocity as plain numbers."""
        return self.linear_velocity.tolist(), self.angular_velocity.tolist()

    @staticmethod
    def through(times: ArrayLike, poses: Sequence[Pose]) -> PathMotion:
        """Return the motion through given poses at given times.

        Between two poses the velocities are constant: the origin of the mesh's coordinates goes
        straight, and the body turns about it the shorter way round. Before the first time the body
        rests at the first pose, after the last at the last. The poses place the mesh themselves: a
        `Body` that moves so takes no other pose.

        Args:
            times: (N,) s, N at least 2, strictly increasing, the first at least 0.
            poses: N poses; from one to the next less than half a turn. What turned further in
                between needs more poses: matrices cannot tell.

        Raises:
            MotionError: times or poses are of another number or kind or order, or a piece, which is
                named, turns by half a turn (to 1e-8) or moves faster than a double can hold.

        Example:
            >>> path = Motion.through([0, 2], [Pose(), Pose(translation=[1, 0, 0])])
            >>> path.times.tolist()
            [0.0, 2.0]
        """
        return PathMotion(times, poses)

    def pose_at(self, t: float, pose: Pose | None = None, pivot: ArrayLike | None = None) -> Pose:
        """Return where the motion takes a body by the time `t`, in closed form.

        The map `x(0) -> x(t)`: rotation `R(t W)`, translation `K + t V - R(t W) K`; given a pose,
        the map of mesh coordinates that this makes with it. Off by a few roundings of
        `|K| + |s| + t |V|`, however many turns that is.

        Args:
            t: s, of either sign.
            pose: the body's pose at t = 0. None: as loaded.
            pivot: K where the motion has none of its own, (3,) world coordinates.

        Raises:
            MotionError: the time is not a finite number, the motion turns and neither it nor the
                caller says about which pivot, or positions leave the range of double.
        """
        time = _as_time(t, "t")
        start = _AS_LOADED if pose is None else pose
        if self.is_at_rest or time == 0:
            return start
        turns = self.is_turning
        center = self.pivot if self.pivot is not None or pivot is None else pivot
        if turns and center is None:
            raise MotionError(
                "pivot", "is not given, and the motion turns", "pass the point it turns about"
            )
        turn = turn_after(self.angular_velocity, time)
        middle = vector_or_zero(center, "pivot")
        with np.errstate(over="ignore", invalid="ignore"):  # Pose refuses what comes of it
            shift = time * self.linear_velocity
            if not turns:
                return Pose.carried(start.rotation, start.translation + shift)
            shift = shift + turn.shift_of(start.translation - middle)
            return Pose.carried(turn.matrix @ start.rotation, start.translation + shift)


class PathMotion(Motion):
    """How a body moves through given poses; made by `Motion.through`.

    It has no one velocity, and no pivot: `piece` has those of each piece.

    Attributes:
        times: float64 (N,), read-only, s.
        poses: N poses.
        is_at_rest: whether all poses are the same.
    """

    times: NDArray[np.float64]
    poses: tuple[Pose, ...]

    def __init__(self, times: ArrayLike, poses: Sequence[Pose]) -> None:
        clock = as_floats(times, (None,), "times", MotionError)
        places = tuple(poses)
        for k, pose in enumerate(places):
            if not isinstance(pose, Pose):
                refuse(f"poses[{k}]", pose, "pass Pose objects")
        if len(places) != len(clock) or len(clock) < 2:
            raise MotionError(
                "times", f"{len(clock)} for {len(places)} poses", "give as many, at least two"
            )
        if clock[0] < 0:
            raise MotionError("times[0]", f"is {clock[0]}", "start at 0 or later")
        for k in np.flatnonzero(~(np.diff(clock) > 0))[:1].tolist():
            raise MotionError(
                f"times[{k + 1}]", f"is {clock[k + 1]} after {clock[k]}", "let times increase"
            )
        object.__setattr__(self, "times", clock)
        object.__setattr__(self, "poses", places)
        pieces = tuple(self._piece(k) for k in range(len(clock) - 1))
        object.__setattr__(self, "_pieces", pieces)
        object.__setattr__(self, "is_at_rest", all(piece is _AT_REST for piece in pieces))

    _pieces: tuple[Motion, ...]

    def piece(self, index: int) -> Motion:
        """Return the motion from pose `index` to the next, on a clock that starts there.

        Index -1 and N - 1 are the rest before and after.
        """
        return self._pieces[index] if 0 <= index < len(self._pieces) else _AT_REST

    def index_at(self, t: float) -> int:
        """Return the index of the piece that `t` is in: of two, the later."""
        return bisect_right(self.times, t) - 1

    def pose_at(self, t: float, pose: Pose | None = None, pivot: ArrayLike | None = None) -> Pose:
        """Return where the motion has taken the mesh by the time `t`; exact at the given times.

        Args:
            t: s.
            pose: none, or the first of the motion's own.
            pivot: none.

        Raises:
            MotionError: the time is not a finite number, or a pose or pivot is given.
        """
        time = _as_time(t, "t")
        self.first_pose(_AS_LOADED if pose is None else pose)
        if pivot is not None:
            raise MotionError("pivot", "is given to a motion through poses", "leave it out")
        index = max(self.index_at(time), 0)
        at = self.poses[index]
        return self.piece(index).pose_at(max(time - float(self.times[index]), 0.0), at)

    def first_pose(self, pose: Pose) -> Pose:
        """Return the pose at t = 0 of a body that has this motion and is said to be at `pose`.

        Raises:
            MotionError: it is neither the identity nor the motion's first pose.
        """
        if pose.is_identity or is_same_pose(pose, self.poses[0]):
            return self.poses[0]
        raise MotionError(
            "pose", "is given beside a motion through poses", "make it part of those poses"
        )

    def _piece(self, index: int) -> Motion:
        here, there = self.poses[index : index + 2]
        if is_same_pose(here, there):
            return _AT_REST
        turn = np.zeros(3)
        if not np.array_equal(here.rotation, there.rotation):
            turn = rotation_vector(there.rotation @ here.rotation.T)
        name = f"piece {index} of the motion, from pose {index} to {index + 1}"
        if float(np.linalg.norm(turn)) > np.pi - _HALF_TURN_MARGIN:
            raise MotionError(name, "turns by half a turn", "give a pose in between")
        time = self.times[index + 1] - self.times[index]
        with np.errstate(over="ignore", invalid="ignore"):
            velocity, spin = (there.translation - here.translation) / time, turn / time
        if not (np.isfinite(velocity).all() and np.isfinite(spin).all()):
            raise MotionError(name, f"is too fast: it takes {time} s", "let it take longer")
        return Motion(velocity, spin, here.translation)


def is_same_pose(a: Pose, b: Pose) -> bool:
    """Return whether two poses are the same, number by number."""
    return np.array_equal(a.rotation, b.rotation) and np.array_equal(a.translation, b.translation)


def _as_time(value: float, name: str) -> float:
    """Return a finite number of seconds."""
    return float(as_floats(value, (), name, MotionError))


def refuse(name: str, value: object, remedy: str) -> None:
    """Raise for an argument of another kind."""
    raise MotionError(name, f"is of type {type(value).__name__}", remedy)


_AS_LOADED = Pose()
_AT_REST = Motion()
