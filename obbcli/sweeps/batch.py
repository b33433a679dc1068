"""Some questions about one pair of trees as arrays, answered by the kernels on several threads."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli import kernels
from obbcli.errors import MotionError, TreeFileError
from obbcli.motion.body import Body
from obbcli.questions.border import limits_of, out_of_range, refused
from obbcli.questions.describe import contact_at_start
from obbcli.questions.first_contact import first_contact
from obbcli.questions.pair_question import time_tolerance
from obbcli.sweeps.answer_rows import (
    RAW,
    REFUSED,
    TRIANGLES_AT_START,
    of_kernels,
    write_answer,
    write_contact,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from obbcli.accuracy import Accuracy
    from obbcli.errors import ObbError
    from obbcli.motion.pose import Pose
    from obbcli.questions.pair_question import Trees
    from obbcli.sweeps.answer_rows import Answers

    Floats = NDArray[np.float64]
    Poses = tuple[Pose, Pose]


class Batch(NamedTuple):
    """Questions about bodies of constant velocities.

    Attributes:
        poses: of A and B at t = 0: one pair for all rows, or one a row.
        motions_a: float64 (N, 9): linear and angular velocity and pivot, world coordinates.
        motions_b: the same of B.
        durations: float64 (N,), s.
    """

    poses: Sequence[Poses]
    motions_a: Floats
    motions_b: Floats
    durations: Floats


class Outcome(NamedTuple):
    """What became of a batch.

    Attributes:
        answers: a row of `RAW` a question; of a refused one nothing can be read.
        errors: of the refused ones, by row.
    """

    answers: Answers
    errors: Mapping[int, ObbError]


def answer_batch(trees: Trees, batch: Batch, accuracy: Accuracy, threads: int) -> Outcome:
    """Return what `first_contact` answers of every row, bit for bit.

    Args:
        trees: of A and B.
        batch: the questions.
        accuracy: of all of them; certified.
        threads: how many rows are asked about at the same time.

    Raises:
        MotionError: the one placement of all leaves the range of double.
        TreeFileError: a tree file is damaged.
    """
    placements = np.array([_numbers(*poses) for poses in batch.poses])
    questions = np.empty((len(batch.durations), 20))
    questions[:, :9] = batch.motions_a
    questions[:, 9:18] = batch.motions_b
    questions[:, 18] = batch.durations
    questions[:, 19] = _time_tolerances(accuracy, batch.durations)
    try:
        found, faults = kernels.sweep(
            trees[0].kernel, trees[1].kernel, placements, questions, limits_of(accuracy), threads
        )
    except (ValueError, kernels.TreeError) as fault:
        raise refused(trees, fault) from fault
    answers = of_kernels(found)
    _say_where_triangles_meet(trees, batch.poses, answers)
    return Outcome(answers, _refusals(trees, faults))


def answer_one_by_one(
    questions: Iterable[tuple[Body, Body, float | None]],
    accuracy: Accuracy,
    *,
    solid: bool = False,
) -> Outcome:
    """Return the same of questions that the kernels answer in steps only: paths, and samples."""
    rows = []
    errors: dict[int, ObbError] = {}
    for index, (a, b, duration) in enumerate(questions):
        row = np.zeros(1, RAW)
        try:
            write_answer(row[0], first_contact(a, b, duration, accuracy, solid))
        except MotionError as fault:
            row["status"] = REFUSED
            errors[index] = fault
        rows.append(row)
    return Outcome(np.concatenate([np.empty(0, RAW), *rows]), errors)


def _numbers(a: Pose, b: Pose) -> Floats:
    """Return two poses as the kernels read them, (24,)."""
    parts = (a.rotation.ravel(), a.translation, b.rotation.ravel(), b.translation)
    return np.concatenate(parts)


def _time_tolerances(accuracy: Accuracy, durations: Floats) -> Floats:
    """Return the width asked of each bracket, s."""
    asked = accuracy.time_tolerance
    return durations * time_tolerance(accuracy, 1.0) if asked is None else np.full(1, asked)


def _say_where_triangles_meet(trees: Trees, poses: Sequence[Poses], answers: Answers) -> None:
    """Complete the rows in which triangles meet at t = 0; of one placement all are alike."""
    known = None
    for row in np.flatnonzero(answers["status"] == TRIANGLES_AT_START).tolist():
        pair = int(answers[row]["triangle_a"]), int(answers[row]["triangle_b"])
        if known is None or len(poses) > 1:
            pose_a, pose_b = poses[row if len(poses) > 1 else 0]
            bodies = Body(trees[0], pose_a), Body(trees[1], pose_b)
            known = contact_at_start(bodies, trees, *pair)
        write_contact(answers[row], known)


def _refusals(trees: Trees, faults: Sequence[tuple[int, bool, str]]) -> dict[int, ObbError]:
    """Return the errors of refused rows; whether a damaged tree is behind them is looked at once.

    Raises:
        TreeFileError: it is.
    """
    errors: dict[int, ObbError] = {}
    remedy: str | None = None
    for row, is_of_pose, text in faults:
        where = "pose" if is_of_pose else "motion"
        if remedy is None:
            first = out_of_range(trees, where, ValueError(text))
            if isinstance(first, TreeFileError):
                raise first
            remedy = first.remedy
        errors[row] = MotionError(where, text, remedy)
    return errors
