"""The question about two bodies that options ask: placement and motion; `accuracy` has the rest."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import click

from obbcli.cli.boundary import UsageError, usage_errors
from obbcli.cli.options.option import gathered, option, vector
from obbcli.cli.options.words import Finite

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from obbcli.accuracy import Accuracy
    from obbcli.cli.inputs import Input
    from obbcli.cli.lengths import Lengths
    from obbcli.cli.options.accuracy import AccuracyOptions
    from obbcli.cli.options.option import Decorator
    from obbcli.motion.motion import Motion
    from obbcli.motion.pose import Pose
    from obbcli.questions.pair_question import PairQuestion

    Numbers: TypeAlias = tuple[float, float, float]


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
        from obbcli.motion.pose import Pose
        from obbcli.motion.rotation import rotation_matrix

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


class UnitOptions(NamedTuple):
    """In which unit of length A and B are taken, by what they are scaled, how they are welded."""

    unit: str | None
    scale: float | None
    scale_b: float | None
    weld: float | None
    sag: float | None

    def of_a(self) -> Lengths | None:
        """Return what becomes of A's coordinates; None where they are taken as they are."""
        return self._lengths(self.scale, "--scale")

    def of_b(self) -> Lengths | None:
        """Return the same of B."""
        return self._lengths(self.scale_b, "--scale-b")

    def _lengths(self, scale: float | None, name: str) -> Lengths | None:
        if scale is not None and not scale > 0:
            raise UsageError(name, f"is {scale!r}", "use a number above 0")
        if self.weld is not None and not self.weld > 0:
            raise UsageError("--weld", f"is {self.weld!r}", "use a number above 0")
        checked_sag(self.sag)
        found = self.unit, scale, self.weld, self.sag
        if found == (None,) * len(found):
            return None
        from obbcli.cli.lengths import Lengths

        return Lengths(*found)


_UNITS = "Units"
UNIT_WORDS = ("m", "cm", "mm", "um", "in", "ft")
unit_option = option(
    _UNITS,
    "--unit",
    type=click.Choice(UNIT_WORDS),
    help="Scale meshes that state another unit to this one; others are taken to be in it "
    "[default: scale nothing].",
)


def scale_option(name: str, what: str) -> Decorator:
    """Return an option that scales A, B or what is built."""
    text = f"Multiply {what} coordinates by F, to be in mesh units [default: leave them]."
    return option(_UNITS, name, type=Finite(), metavar="F", help=text)


weld_option = option(
    _UNITS,
    "--weld",
    type=Finite(),
    metavar="D",
    help="Make vertices within D of each other one, in the file's unit, before scaling "
    "[default: weld nothing].",
)

sag_option = option(
    _UNITS,
    "--sag",
    type=Finite(),
    metavar="D",
    help="Cut exact surfaces (STEP) into triangles within D of them, in the file's unit "
    "[default: 1e-3 of each product's size].",
)


def checked_sag(sag: float | None) -> float | None:
    """Return what `--sag` says.

    Raises:
        UsageError: a number that is not above 0.
    """
    if sag is not None and not sag > 0:
        raise UsageError("--sag", f"is {sag!r}", "use a number above 0")
    return sag


unit_options = gathered(
    "units",
    UnitOptions,
    (
        unit_option,
        scale_option("--scale", "A's"),
        scale_option("--scale-b", "B's"),
        weld_option,
        sag_option,
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
        from obbcli.motion.motion import Motion

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


def _names(options: PoseOptions | MotionOptions) -> list[str]:
    """Return the options that were given values."""
    values = options._asdict().items()
    return [f"--{name.replace('_', '-')}" for name, value in values if value not in (None, False)]


class QuestionOptions(NamedTuple):
    """What is asked about two bodies, all of it understood and checked before a file is read."""

    poses: tuple[Pose, Pose]
    motions: tuple[Motion, Motion]
    duration: float | None
    accuracy: Accuracy
    given: Mapping[str, Sequence[str]]

    @classmethod
    def of(
        cls, pose: PoseOptions, motion: MotionOptions, accuracy: AccuracyOptions
    ) -> QuestionOptions:
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

    def pair(self, files: tuple[Input, Input]) -> PairQuestion:
        """Return the question about A and B, as they are placed and move.

        Raises:
            MotionError: a duration that does not fit the motions.
        """
        from obbcli.motion.body import Body
        from obbcli.questions.pair_question import PairQuestion

        a, b = (
            Body(file.tree, pose, motion)
            for file, pose, motion in zip(files, self.poses, self.motions, strict=True)
        )
        return PairQuestion.of(a, b, self.duration, self.accuracy)
