"""How a body moves: `Motion`, of constant velocities.

World position of a vertex `p`: `x(0) = Q p + s`, then `x(t) = K + t V + R(t W) (x(0) - K)`. Other
kinds of motion are made of pieces of that kind; what they have in common is what `Motion` says of
its pieces.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from obbcli.arrays import as_floats, as_vector
from obbcli.errors import MotionError
from obbcli.motion.pose import Pose, vector_or_zero
from obbcli.motion.rotation import turn_after

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import ArrayLike, NDArray

    from obbcli.motion.path import PathMotion
    from obbcli.motion.pieces import Jump, Moment, Piece

_ORIGIN = np.zeros(3)


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
        from obbcli.motion.path import PathMotion

        return PathMotion(times, poses)

    # ---- What every kind of motion says of its pieces

    @property
    def steady(self) -> Motion | None:
        """The one motion of constant velocities that this is; None where velocities change."""
        return self

    @property
    def goes_straight(self) -> bool:
        """Whether every point of a body goes straight at a constant speed, or rests."""
        return not self.is_turning

    @property
    def places_mesh(self) -> bool:
        """Whether the motion says where the mesh is, so that a body takes no other pose."""
        return False

    @property
    def needs_pivot(self) -> bool:
        """Whether the body's centroid has to say which point the motion turns about."""
        return self.is_turning and self.pivot is None

    @property
    def ends_at(self) -> float | None:
        """When the motion has come to rest for good, s; None where it goes on."""
        return None

    @property
    def top_velocity(self) -> NDArray[np.float64]:
        """The fastest linear velocity, (3,) mesh units a second."""
        return self.linear_velocity

    def first_pose(self, pose: Pose) -> Pose:
        """Return the pose at t = 0 of a body that has this motion and is said to be at `pose`.

        Raises:
            MotionError: the motion places the mesh itself, elsewhere.
        """
        return pose

    def breaks(self, start: float, end: float) -> list[float]:  # noqa: ARG002
        """Return the times after `start` and up to `end` at which velocities change, s, sorted."""
        return []

    def pieces(self, duration: float, pose: Pose) -> Iterator[Piece]:
        """Yield the pieces of [0, duration], of which the last may be an instant.

        Args:
            duration: s.
            pose: of the body at t = 0.
        """
        # Bodies at rest answer without this import.
        from obbcli.motion.pieces import Piece

        yield Piece(0.0, duration, pose, self)

    def moment(self, time: float, pose: Pose, pivot: NDArray[np.float64] | None) -> Moment:
        """Return where a body is at the start of a leg, and how it moves from there on.

        Args:
            time: s.
            pose: of the body at t = 0.
            pivot: K where the motion needs one, (3,) world coordinates; None elsewhere.

        Raises:
            MotionError: positions leave the range of double.
        """
        from obbcli.motion.pieces import Moment

        if self.is_at_rest or time == 0:
            return Moment(pose, self)
        velocity, spin = self.linear_velocity, self.angular_velocity
        center: NDArray[np.float64] | None = _ORIGIN
        if self.is_turning:
            center = self.pivot if pivot is None else pivot
        assert center is not None
        there = self.pose_at(time, pose, center)
        shift = time * velocity
        summands = (pose.translation, there.translation, center, center, shift)
        return Moment(there, Motion(velocity, spin, center + shift), summands)

    def jump(self, time: float) -> Jump | None:  # noqa: ARG002
        """Return how the piece that ends at a time misses the pose after it.

        None where no piece ends then, or its end and the pose after it are the same by definition.
        """
        return None

    def told(self, pose: Pose, centroid: NDArray[np.float64] | None) -> dict[str, object]:
        """Return the motion as documents show it: names and plain numbers.

        Args:
            pose: of the body at t = 0.
            centroid: of the body's surface, posed, (3,); None where the motion has a pivot of its
                own or places the mesh.
        """
        pivot = centroid if self.pivot is None else self.pivot
        assert pivot is not None
        return {
            "pose": pose.told(),
            "linear_velocity": self.linear_velocity.tolist(),
            "angular_velocity": self.angular_velocity.tolist(),
            "pivot": pivot.tolist(),
        }

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
        time = as_time(t, "t")
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


def as_time(value: float, name: str) -> float:
    """Return a finite number of seconds.

    Raises:
        MotionError: it is none.
    """
    return float(as_floats(value, (), name, MotionError))


def refuse(name: str, value: object, remedy: str) -> None:
    """Raise for an argument of another kind.

    Raises:
        MotionError: always.
    """
    raise MotionError(name, f"is of type {type(value).__name__}", remedy)


_AS_LOADED = Pose()
