"""The options of a question about two bodies: placement, motion, accuracy."""

from __future__ import annotations

import math
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, get_args

import click

from obbcli.accuracy import Accuracy, Integrator, Leaves, Method
from obbcli.cli.boundary import UsageError
from obbcli.cli.options import gathered, option, vector
from obbcli.cli.types import Finite, Whole
from obbcli.errors import MotionError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from obbcli.body import Body
    from obbcli.cli.inputs import Input
    from obbcli.cli.options import Decorator
    from obbcli.motion import Motion, Pose

    Numbers: TypeAlias = tuple[float, float, float]


@contextmanager
def usage_errors() -> Iterator[None]:
    """Turn a refused number into a usage error: what is typed on a command line is usage."""
    try:
        yield
    except MotionError as fault:
        raise UsageError(fault.where, fault.fault, fault.remedy) from fault


class PoseOptions(NamedTuple):
    """Where A and B are at t = 0."""

    translate: Numbers | None
    rotate: Numbers | None
    translate_b: Numbers | None
    rotate_b: Numbers | None
    degrees: bool

    def poses(self) -> tuple[Pose, Pose]:
        """Return the poses of A and B."""
        return self._pose(self.rotate, self.translate), self._pose(self.rotate_b, self.translate_b)

    def _pose(self, rotate: Numbers | None, translate: Numbers | None) -> Pose:
        from obbcli.motion import Pose, rotation_matrix

        with usage_errors():
            turn = None if rotate is None else rotation_matrix(rotate, degrees=self.degrees)
            return Pose(turn, translate)


_POSE = "Placement at t = 0"
pose_options = gathered(
    "pose",
    PoseOptions,
    (
        vector(_POSE, "--translate", "Shift A, in mesh units."),
        vector(_POSE, "--rotate", "Turn A about the origin first: axis times angle, in rad."),
        vector(_POSE, "--translate-b", "Shift B, in mesh units."),
        vector(_POSE, "--rotate-b", "Turn B about the origin first: axis times angle, in rad."),
        option(_POSE, "--degrees", is_flag=True, help="Angles are in degrees, spins in degrees/s."),
    ),
)


class MotionOptions(NamedTuple):
    """How A and B move, and for how long."""

    vel: Numbers | None
    omega: Numbers | None
    pivot: Numbers | None
    vel_b: Numbers | None
    omega_b: Numbers | None
    pivot_b: Numbers | None
    duration: float | None

    def motions(self, *, degrees: bool) -> tuple[Motion, Motion]:
        """Return the motions of A and B.

        Raises:
            UsageError: a pivot of a body that is not told to turn.
        """
        for suffix, pivot, omega in (
            ("", self.pivot, self.omega),
            ("-b", self.pivot_b, self.omega_b),
        ):
            if pivot is not None and omega is None:
                remedy = f"add --omega{suffix}, or leave it out"
                raise UsageError(f"--pivot{suffix}", "is where an axis of rotation passes", remedy)
        return (
            self._motion(self.vel, self.omega, self.pivot, degrees),
            self._motion(self.vel_b, self.omega_b, self.pivot_b, degrees),
        )

    def _motion(
        self, vel: Numbers | None, omega: Numbers | None, pivot: Numbers | None, degrees: bool
    ) -> Motion:
        from obbcli.motion import Motion

        if omega is not None and degrees:
            omega = (math.radians(omega[0]), math.radians(omega[1]), math.radians(omega[2]))
        with usage_errors():
            return Motion(vel, omega, pivot)


_MOTION = "Motion"
motion_options = gathered(
    "motion",
    MotionOptions,
    (
        vector(_MOTION, "--vel", "Linear velocity of A, in mesh units/s."),
        vector(
            _MOTION, "--omega", "Angular velocity of A, world frame: axis times spin, in rad/s."
        ),
        vector(
            _MOTION,
            "--pivot",
            "Where A's axis passes at t = 0, in mesh units [default: A's centroid].",
        ),
        vector(_MOTION, "--vel-b", "Linear velocity of B, in mesh units/s."),
        vector(
            _MOTION, "--omega-b", "Angular velocity of B, world frame: axis times spin, in rad/s."
        ),
        vector(
            _MOTION,
            "--pivot-b",
            "Where B's axis passes at t = 0, in mesh units [default: B's centroid].",
        ),
        option(
            _MOTION,
            "--duration",
            type=Finite(0),
            metavar="T",
            help="Ask about 0 <= t <= T, in s [default: 1 where a body moves, else 0].",
        ),
    ),
)


class AccuracyOptions(NamedTuple):
    """Every field of `Accuracy`, None where it was not given, and `--max-depth` for both trees."""

    time_tolerance: float | None
    distance_tolerance: float | None
    max_depth: int | None
    max_depth_a: int | None
    max_depth_b: int | None
    leaves: Leaves | None
    method: Method | None
    integrator: Integrator | None
    steps: int | None
    clearance: float | None
    max_iterations: int | None
    timeout: float | None

    def given(self) -> dict[str, Any]:
        """Return the fields of `Accuracy` that were given, by name."""
        values = self._asdict()
        both = values.pop("max_depth")
        for name in ("max_depth_a", "max_depth_b"):
            if values[name] is None:
                values[name] = both
        return {name: value for name, value in values.items() if value is not None}

    def accuracy(self) -> Accuracy:
        """Return the accuracy asked for.

        Raises:
            UsageError: an option that has no meaning with the method.
        """
        given = self.given()
        for name in ("integrator", "steps"):
            if name in given and self.method != "sampled":
                raise UsageError(f"--{name}", "has a meaning with --method sampled alone")
        with usage_errors():
            return Accuracy(**given)


def _accuracy(name: str, **attributes: Any) -> Decorator:
    return option("Accuracy", name, **attributes)


_COUNT = Whole(1)
_DEPTH = Whole(0)
accuracy_options = gathered(
    "accuracy",
    AccuracyOptions,
    (
        _accuracy(
            "--time-tolerance",
            type=Finite(0),
            metavar="S",
            help="Bracket a first contact this closely, in s [default: 1e-9 of the duration].",
        ),
        _accuracy(
            "--distance-tolerance",
            type=Finite(0),
            metavar="D",
            help="Stop at points this close, in mesh units [default: go on until proven].",
        ),
        _accuracy(
            "--max-depth",
            type=_DEPTH,
            metavar="N",
            help="Use trees down to level N only, 0 the root boxes [default: to the triangles].",
        ),
        _accuracy(
            "--max-depth-a",
            type=_DEPTH,
            metavar="N",
            help="The same for A alone [default: as --max-depth].",
        ),
        _accuracy(
            "--max-depth-b",
            type=_DEPTH,
            metavar="N",
            help="The same for B alone [default: as --max-depth].",
        ),
        _accuracy(
            "--leaves",
            type=click.Choice(get_args(Leaves)),
            help=f"What a leaf of several triangles stands for [default: {Accuracy.leaves}].",
        ),
        _accuracy(
            "--method",
            type=click.Choice(get_args(Method)),
            help=f"Prove the answer, or sample it [default: {Accuracy.method}].",
        ),
        _accuracy(
            "--integrator",
            type=click.Choice(get_args(Integrator)),
            help=f"How sampling turns a frame [default: {Accuracy.integrator}].",
        ),
        _accuracy(
            "--steps",
            type=_COUNT,
            metavar="N",
            help=f"Sample in N equal steps of time [default: {Accuracy.steps}].",
        ),
        _accuracy(
            "--clearance",
            type=Finite(0),
            metavar="D",
            help="Surfaces this close count as contact, in mesh units [default: 0].",
        ),
        _accuracy(
            "--max-iterations",
            type=_COUNT,
            metavar="N",
            help="Give up, unresolved, after N pops of the queue "
            f"[default: {Accuracy.max_iterations:,}].",
        ),
        _accuracy(
            "--timeout",
            type=Finite(0),
            metavar="S",
            help="Give up, unresolved, after S seconds of work [default: never].",
        ),
    ),
)


def _names(options: PoseOptions | MotionOptions) -> list[str]:
    """Return the options that were given values."""
    values = options._asdict().items()
    return [f"--{name.replace('_', '-')}" for name, value in values if value not in (None, False)]


class Question(NamedTuple):
    """What is asked about two bodies, all of it understood and checked before a file is read."""

    poses: tuple[Pose, Pose]
    motions: tuple[Motion, Motion]
    duration: float | None
    accuracy: Accuracy
    given: Mapping[str, Sequence[str]]

    @classmethod
    def of(cls, pose: PoseOptions, motion: MotionOptions, accuracy: AccuracyOptions) -> Question:
        """Return the question that options ask; `given` names the options of pose and motion.

        Raises:
            UsageError: a number is refused, or an option has no meaning with the others.
        """
        motions = motion.motions(degrees=pose.degrees)
        given = {"pose": _names(pose), "motion": _names(motion), "steps": ["--steps"]}
        return cls(pose.poses(), motions, motion.duration, accuracy.accuracy(), given)

    @property
    def moves(self) -> bool:
        """Return whether anything moves while the question runs."""
        return self.duration != 0 and not all(motion.is_at_rest for motion in self.motions)

    def bodies(self, files: tuple[Input, Input]) -> tuple[Body, Body]:
        """Return A and B as they are placed and move."""
        from obbcli.body import Body

        a, b = (
            Body(file.tree, pose, motion)
            for file, pose, motion in zip(files, self.poses, self.motions, strict=True)
        )
        return a, b
