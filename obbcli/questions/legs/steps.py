"""Steps of frozen orientation, the model of the sampled method. Eberly 2008 §5.

In each of N equal parts of [0, duration] the bodies keep the frames that they have at its start,
and their pivots go straight to where they are at its end. (The paper's difference of two positions
is no velocity before it is divided by the time between them.)

How far a modelled path is from the true one is proven. Take a point at `y` from the pivot, of a
body whose frame is integrated to F where it should be R, and which turns on by R' until some time
of the step. There the two are `(F - R) y + (R - R' R) y` apart, and by what the pivot is off its
chord. The first is measured: it is convex in y, so largest at a corner of the body's box. The
second, where R' turns by an angle a, is at most `2 rho sin(min(a, pi) / 2)` with rho the largest
distance of the body from the axis; through several turns, their sum. At constant velocities the
pivot goes straight, and the chord is its path. Through poses it goes straight from one to the next,
so that it is furthest from the chord at one of them.
"""

from __future__ import annotations

import itertools
import math
from bisect import bisect_right
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from obbcli.errors import MotionError
from obbcli.motion.body import Body, pivot_of
from obbcli.motion.integrators import euler_step, rk4_step
from obbcli.motion.motion import Motion
from obbcli.motion.pose import Pose
from obbcli.motion.rotation import axis_of, turn_after
from obbcli.questions.legs.leg import Leg, length_of
from obbcli.questions.legs.slack import ROUNDING, jump_at, norm, rounding_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from obbcli.questions.pair_question import PairQuestion
    from obbcli.tree.tree import ObbTree

    Array = NDArray[np.float64]
    # Makes the body of the step between two times, and bounds how far it is off its path.
    Step = Callable[[float, float], tuple[Body, float]]

_INTEGRATORS = {"euler": euler_step, "rk4": rk4_step}
# For the rounding of a bound itself: some 20 operations.
_UP = 1 + 2.0**-45
# By how much poses, orthonormal to 1e-9, may lengthen a vector.
_STRETCH = 1 + 2.0**-28


def steps_of(pair: PairQuestion) -> Iterator[Leg]:
    """Yield the steps of [0, duration], earliest first: legs of bodies that do not turn.

    Their slack bounds how far the modelled paths of any points of both bodies together are from the
    true ones, until the end of the step. Where neither body turns, one step is exact.

    Raises:
        MotionError: positions leave the range of double, or a step turns by so much that an
            integrator makes no frame of it.
    """
    bodies, duration, accuracy = pair.bodies, pair.duration, pair.accuracy
    if all(body.motion.goes_straight for body in bodies):
        yield Leg(0.0, duration, bodies, 0.0)
        return
    step_a, step_b = (
        _step_of(body, tree, duration, accuracy.integrator)
        for body, tree in zip(bodies, pair.trees, strict=True)
    )
    count = accuracy.steps
    for k in range(count):
        start, end = duration * (k / count), duration * ((k + 1) / count)
        if start == end:  # the duration holds fewer doubles than steps
            continue
        with np.errstate(over="ignore", invalid="ignore"):  # `_beyond_doubles` refuses it
            (a, error_a), (b, error_b) = step_a(start, end), step_b(start, end)
        error = error_a + error_b
        if not math.isfinite(error):
            raise _beyond_doubles()
        yield Leg(start, length_of(start, end), (a, b), error)


def _beyond_doubles() -> MotionError:
    return MotionError(
        "motion", "positions leave the range of double", "move, slow or scale the bodies"
    )


def _step_of(body: Body, tree: ObbTree, duration: float, integrator: str) -> Step:
    motion = body.motion
    if motion.steady is None:
        return _Frozen(_Pieces(body, tree, duration), tree, integrator)
    if motion.is_turning:
        return _Frozen(_Screw(body, tree), tree, integrator)

    def step(start: float, end: float) -> tuple[Body, float]:
        if motion.is_at_rest or start == 0:
            return body, 0.0
        shift = end * motion.linear_velocity
        error = rounding_of(tree, body.pose.translation, shift)
        return Body(tree, motion.pose_at(start, body.pose), motion), error

    return step


class _Chord(NamedTuple):
    """The straight way of a center from one time to another."""

    start: float
    end: float
    here: Array
    there: Array

    def at(self, time: float) -> Array:
        """Return where it is at a time in between."""
        share = (time - self.start) / (self.end - self.start)
        return (1 - share) * self.here + share * self.there


class _Path(Protocol):
    """The true path of a body that turns: all points at `center + frame @ y`.

    Attributes:
        first: the frame at t = 0.
        corners: of a box that holds the body, as y, (8, 3).
    """

    first: Array
    corners: Array

    def place(self, time: float, /) -> tuple[Array, Array]:
        """Return frame and center at a time."""

    def pose(self, frame: Array, center: Array, /) -> Pose:
        """Return the pose of the mesh."""

    def turns(self, start: float, end: float, /) -> list[tuple[float, Array, float]]:
        """Return for how long which W turns it, and its largest distance from that axis."""

    def motion(self, chord: _Chord, /) -> Motion:
        """Return the center's velocity along a chord."""

    def bend(self, chord: _Chord, /) -> float:
        """Bound how far the path is off a chord of its center but for turns, rounding included."""


class _Frozen:
    """The steps of a body that turns."""

    def __init__(self, path: _Path, tree: ObbTree, integrator: str) -> None:
        self._path, self._tree = path, tree
        self._integrate = _INTEGRATORS.get(integrator)
        self._turn = np.eye(3)
        self._diameter = 2 * _STRETCH * max(map(norm, path.corners))
        self._next: tuple[float, tuple[Array, Array]] = (0.0, path.place(0.0))

    def __call__(self, start: float, end: float) -> tuple[Body, float]:
        path = self._path
        known, (true, center) = self._next
        assert known == start
        self._next = end, path.place(end)
        frame, drift, turned = true, 0.0, 0.0
        if self._integrate is not None:
            frame = self._turn @ path.first
            drift = max(map(math.hypot, *((frame - true) @ path.corners.T).tolist()))
        for time, spin, radius in path.turns(start, end):
            turned += 2 * radius * math.sin(0.5 * min(norm(spin) * time, math.pi))
            if self._integrate is not None:
                self._turn = self._integrate(self._turn, spin, time)
        chord = _Chord(start, end, center, self._next[1][1])
        if not math.isfinite(norm(chord.there)):
            raise _beyond_doubles()
        error = _UP * (drift + min(turned, self._diameter) + path.bend(chord))
        return Body(self._tree, path.pose(frame, center), path.motion(chord)), error


class _Screw:
    """The path at constant velocities: y from the pivot, at t = 0."""

    def __init__(self, body: Body, tree: ObbTree) -> None:
        self.first = np.eye(3)
        self._pose, self._pivot = body.pose, pivot_of(body, tree)
        self._spin, self._velocity = body.motion.angular_velocity, body.motion.linear_velocity
        self.corners = body.pose.apply(_corners(tree)) - self._pivot
        self._offset = body.pose.translation - self._pivot
        used = tree.vertices[np.unique(tree.mesh.triangles)]
        self._radius = _radius(body.pose.apply(used) - self._pivot, self._spin)
        self._rounding = rounding_of(tree, self._pivot, self._pivot, body.pose.translation)
        self._motion = Motion(self._velocity)

    def place(self, time: float, /) -> tuple[Array, Array]:
        return turn_after(self._spin, time).matrix, self._pivot + time * self._velocity

    def pose(self, frame: Array, center: Array, /) -> Pose:
        return Pose.carried(frame @ self._pose.rotation, center + frame @ self._offset)

    def turns(self, start: float, end: float, /) -> list[tuple[float, Array, float]]:
        return [(end - start, self._spin, self._radius)]

    def motion(self, _: _Chord, /) -> Motion:
        return self._motion

    def bend(self, chord: _Chord, /) -> float:
        return self._rounding + ROUNDING * norm(chord.end * self._velocity)


class _Pieces:
    """The path in pieces: y in the coordinates of the mesh."""

    def __init__(self, body: Body, tree: ObbTree, duration: float) -> None:
        self._body, self._motion, self._tree = body, body.motion, tree
        pieces = list(body.motion.pieces(duration, body.pose))
        self._starts = [piece.start for piece in pieces]
        self._pieces = pieces
        self.first = pieces[0].pose.rotation
        self.corners = _corners(tree)
        afters = [piece.after[0] for piece in pieces if piece.after is not None]
        poses = [*(piece.pose for piece in pieces), *afters]
        furthest = max((pose.translation for pose in poses), key=norm)
        self._rounding = rounding_of(tree, furthest, furthest, furthest)

    def place(self, time: float, /) -> tuple[Array, Array]:
        pose = self._motion.pose_at(time)
        return pose.rotation, pose.translation

    def pose(self, frame: Array, center: Array, /) -> Pose:
        return Pose.carried(frame, center)

    def turns(self, start: float, end: float, /) -> list[tuple[float, Array, float]]:
        found = []
        for here, there in itertools.pairwise((start, *self._times(start, end), end)):
            piece = self._pieces[bisect_right(self._starts, here) - 1]
            spin = piece.motion.angular_velocity
            if spin.any():
                arms = self.corners @ piece.pose.rotation.T
                found.append((there - here, spin, _radius(arms, spin)))
        return found

    def motion(self, chord: _Chord, /) -> Motion:
        return Motion((chord.there - chord.here) / (chord.end - chord.start))

    def bend(self, chord: _Chord, /) -> float:
        times = self._times(chord.start, chord.end)
        places = ((time, self._motion.pose_at(time).translation) for time in times)
        off = max((norm(place - chord.at(time)) for time, place in places), default=0.0)
        jumps = sum(jump_at(self._body, self._tree, time) for time in (*times, chord.end))
        return off + jumps + self._rounding

    def _times(self, start: float, end: float) -> list[float]:
        """Return the times in between at which pieces start."""
        return [time for time in self._motion.breaks(start, end) if time < end]


def _corners(tree: ObbTree) -> Array:
    """Return the corners of the mesh's own box, (8, 3)."""
    return np.array(list(itertools.product(*tree.bounds.T.tolist())))


def _radius(points: Array, spin: Array) -> float:
    """Return the largest distance of points from the axis through the origin."""
    across = np.cross(axis_of(spin), points)
    # Scaling keeps the squares of very large numbers from overflowing.
    scale = float(np.abs(across).max())
    return scale * float(np.linalg.norm(across / scale, axis=1).max()) if scale > 0 else 0.0
