"""Motion through given poses: `PathMotion`, in pieces of constant velocities."""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING

import numpy as np

from obbcli.arrays import as_floats
from obbcli.errors import MotionError
from obbcli.motion.motion import Motion, as_time, refuse
from obbcli.motion.pieces import Jump, Moment, Piece
from obbcli.motion.pose import Pose
from obbcli.motion.rotation import rotation_vector

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import ArrayLike, NDArray

# Rad: nearer to half a turn, a matrix orthonormal to 1e-9 does not tell which way round is meant.
_HALF_TURN_MARGIN = 1e-8
_AS_LOADED = Pose()
_AT_REST = Motion()


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
        object.__setattr__(self, "pivot", None)
        object.__setattr__(self, "is_at_rest", all(piece is _AT_REST for piece in pieces))
        object.__setattr__(self, "is_turning", any(piece.is_turning for piece in pieces))

    _pieces: tuple[Motion, ...]

    @property
    def steady(self) -> Motion | None:
        """Rest, where all poses are the same; else None."""
        return _AT_REST if self.is_at_rest else None

    @property
    def goes_straight(self) -> bool:
        """Whether the motion is rest: pieces lead into different directions."""
        return self.is_at_rest

    @property
    def places_mesh(self) -> bool:
        """True: the poses are the mesh's own."""
        return True

    @property
    def needs_pivot(self) -> bool:
        """False: each piece turns about the mesh's origin."""
        return False

    @property
    def ends_at(self) -> float | None:
        """The time of the last pose, s."""
        return float(self.times[-1])

    @property
    def top_velocity(self) -> NDArray[np.float64]:
        """The fastest linear velocity of all pieces, (3,) mesh units a second."""
        velocities = (piece.linear_velocity for piece in self._pieces)
        return max(velocities, key=lambda velocity: float(np.linalg.norm(velocity)))

    def breaks(self, start: float, end: float) -> list[float]:
        """Return the times of poses after `start` and up to `end`, s."""
        first, last = np.searchsorted(self.times, (start, end), "right")
        times: list[float] = self.times[first:last].tolist()
        return times

    def pieces(self, duration: float, pose: Pose) -> Iterator[Piece]:  # noqa: ARG002
        """Yield the pieces of [0, duration], with the rests before and after the poses."""
        times = self.times.tolist()
        last = len(times) - 1
        if times[0] > 0:
            yield Piece(0.0, min(times[0], duration), self.poses[0], _AT_REST)
        for k, start in enumerate(times):
            if start > duration:
                return
            end = duration if k == last else min(times[k + 1], duration)
            after = None if k == last else (self.poses[k + 1], times[k + 1] - start)
            yield Piece(start, end, self.poses[k], self.piece(k), after)

    def moment(
        self,
        time: float,
        pose: Pose,  # noqa: ARG002
        pivot: NDArray[np.float64] | None,  # noqa: ARG002
    ) -> Moment:
        """Return where the body is at a time, exact at the times of poses and at rest."""
        index = self.index_at(time)
        first = max(index, 0)
        piece, here = self.piece(index), self.poses[first]
        if piece.is_at_rest or time == self.times[first]:
            return Moment(here, piece)
        there = self.pose_at(time)
        onward = Motion(piece.linear_velocity, piece.angular_velocity, there.translation)
        return Moment(there, onward, (here.translation, there.translation))

    def jump(self, time: float) -> Jump | None:
        """Return how the piece that ends at a time misses the pose after it."""
        index = self.index_at(time)
        if index < 1 or self.times[index] != time:
            return None
        here, there = self.poses[index - 1 : index + 1]
        # A piece between equal poses is rest, which ends exactly at the pose after it.
        if is_same_pose(here, there):
            return None
        end = self.piece(index - 1).pose_at(time - float(self.times[index - 1]), here)
        return Jump(end, there, (here.translation, there.translation))

    def told(
        self,
        pose: Pose,  # noqa: ARG002
        centroid: NDArray[np.float64] | None,  # noqa: ARG002
    ) -> dict[str, object]:
        """Return times and poses as documents show them."""
        poses = [through.told() for through in self.poses]
        return {"pose": poses[0], "times": self.times.tolist(), "poses": poses}

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
        time = as_time(t, "t")
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
