"""What rows ask of a pair: poses, motions and durations, with defaults for what they leave out."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.errors import MotionError
from obbcli.motion.body import Body
from obbcli.motion.motion import Motion
from obbcli.motion.pose import Pose
from obbcli.motion.rotation import rotation_matrix
from obbcli.sweeps.answer_rows import RAW
from obbcli.sweeps.batch import Batch, Outcome, answer_batch, answer_one_by_one
from obbcli.sweeps.solids import answer_solids

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from obbcli.accuracy import Accuracy
    from obbcli.questions.pair_question import Trees
    from obbcli.sweeps.row_fields import Values, Vector

_NOTHING: Vector = (0.0, 0.0, 0.0)


class SweepSetting(NamedTuple):
    """What all rows of a sweep have in common; it travels to where they are answered.

    Attributes:
        defaults: what rows leave out, by the names of their fields.
        degrees: whether angles and spins are in degrees.
        accuracy: of every answer.
        solid: whether a body inside the other at t = 0 is in contact with it.
    """

    defaults: Values
    degrees: bool
    accuracy: Accuracy
    solid: bool = False


class RowQuestion(NamedTuple):
    """A row, understood.

    Attributes:
        poses: of A and B at t = 0.
        motions: their velocities and pivots; None stands for the centroid.
        duration: s.
    """

    poses: tuple[Pose, Pose]
    motions: tuple[tuple[Vector, Vector, Vector | None], tuple[Vector, Vector, Vector | None]]
    duration: float


def question_of(values: Values, setting: SweepSetting, where: str) -> RowQuestion:
    """Return what a row asks.

    Args:
        values: of its fields.
        setting: of the sweep.
        where: the place named in errors.

    Raises:
        MotionError: a pivot of a body that does not turn, a duration less than 0, or a turn of so
            many radians that a double cannot tell the angle.
    """
    known = {**setting.defaults, **values}
    motions = tuple(_motion(known, side, setting, where) for side in ("", "_b"))
    poses = tuple(_pose(known, side, setting, where) for side in ("", "_b"))
    moves = any(any(velocity) or any(spin) for velocity, spin, _ in motions)
    duration = known.get("duration", 1.0 if moves else 0.0)
    assert isinstance(duration, float)
    if duration < 0:
        raise MotionError(f"{where}, duration", f"is {duration!r}", "use at least 0 s")
    return RowQuestion((poses[0], poses[1]), (motions[0], motions[1]), duration)


def _motion(
    known: Mapping[str, Vector | float], side: str, setting: SweepSetting, where: str
) -> tuple[Vector, Vector, Vector | None]:
    spin, pivot = known.get(f"omega{side}"), known.get(f"pivot{side}")
    if pivot is not None and spin is None:
        place = f"{where}, pivot{side}"
        remedy = f"give omega{side} too, or leave it out"
        raise MotionError(place, "is where an axis of rotation passes", remedy)
    velocity, spin = known.get(f"vel{side}", _NOTHING), _NOTHING if spin is None else spin
    assert isinstance(velocity, tuple)
    assert isinstance(spin, tuple)
    assert not isinstance(pivot, float)
    if setting.degrees:
        spin = (math.radians(spin[0]), math.radians(spin[1]), math.radians(spin[2]))
    return velocity, spin, pivot


def _pose(
    known: Mapping[str, Vector | float], side: str, setting: SweepSetting, where: str
) -> Pose:
    try:
        return _posed(known.get(f"rotate{side}"), known.get(f"translate{side}"), setting.degrees)
    except MotionError as fault:
        raise MotionError(f"{where}, rotate{side}", fault.fault, fault.remedy) from fault


# Most sweeps have few poses; that they are the same objects tells which rows start alike.
@lru_cache(maxsize=1024)
def _posed(rotate: Vector | None, translate: Vector | None, degrees: bool) -> Pose:
    turn = None if rotate is None else rotation_matrix(rotate, degrees=degrees)
    return Pose(turn, translate)


def answer_questions(
    trees: Trees, questions: Sequence[RowQuestion], setting: SweepSetting, threads: int
) -> Outcome:
    """Return the answers of understood rows.

    Args:
        trees: of A and B.
        questions: the rows.
        setting: of the sweep.
        threads: how many rows are asked about at the same time.

    Raises:
        TreeFileError: a tree file is damaged.
    """
    accuracy, answer = setting.accuracy, answer_solids if setting.solid else answer_batch
    if accuracy.method == "sampled":
        bodies = (_bodies(trees, asked) for asked in questions)
        return answer_one_by_one(bodies, accuracy, solid=setting.solid)
    poses = [asked.poses for asked in questions]
    if not poses:
        return Outcome(np.empty(0, RAW), {})
    if all(pair[0] is poses[0][0] and pair[1] is poses[0][1] for pair in poses):
        try:
            return answer(trees, _batch(trees, questions, poses[:1]), accuracy, threads)
        except MotionError:
            pass  # the shared placement is refused: row by row, each row gets its own error
    return answer(trees, _batch(trees, questions, poses), accuracy, threads)


def _batch(
    trees: Trees, questions: Sequence[RowQuestion], poses: Sequence[tuple[Pose, Pose]]
) -> Batch:
    pivots: dict[tuple[int, int], Vector] = {}

    def numbers(asked: RowQuestion, side: int) -> tuple[float, ...]:
        velocity, spin, pivot = asked.motions[side]
        if not any(spin):
            pivot = _NOTHING  # nothing turns about it
        elif pivot is None:
            pose = asked.poses[side]
            key = side, id(pose)
            if key not in pivots:
                x, y, z = pose.apply(trees[side].surface_centroid[None])[0].tolist()
                pivots[key] = x, y, z
            pivot = pivots[key]
        return *velocity, *spin, *pivot

    motions_a, motions_b = (
        np.array([numbers(asked, side) for asked in questions]) for side in (0, 1)
    )
    durations = np.array([asked.duration for asked in questions])
    return Batch(poses, motions_a, motions_b, durations)


def _bodies(trees: Trees, asked: RowQuestion) -> tuple[Body, Body, float]:
    a, b = (
        Body(tree, pose, Motion(*motion))
        for tree, pose, motion in zip(trees, asked.poses, asked.motions, strict=True)
    )
    return a, b, asked.duration
