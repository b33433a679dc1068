"""Sweeps of solids: whether a body lies inside the other at t = 0, asked once a placement.

A body that gets inside the other later touches it first. Rows that start from one placement have
one answer therefore: all are in contact at t = 0, or each is what it is as surfaces.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.answers.status import Status
from obbcli.errors import MotionError
from obbcli.motion.body import Body
from obbcli.motion.motion import Motion
from obbcli.questions.containment import require_watertight
from obbcli.questions.first_contact import first_contact
from obbcli.sweeps.answer_rows import REFUSED, write_answer
from obbcli.sweeps.batch import Outcome, answer_batch, answer_one_by_one

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.answers.contact import FirstContact
    from obbcli.questions.pair_question import Trees
    from obbcli.sweeps.batch import Batch, Poses


def require_solids(trees: Trees) -> None:
    """Refuse a pair of which one does not close.

    Raises:
        MeshError: a mesh is not watertight.
    """
    for name, tree in zip("AB", trees, strict=True):
        require_watertight(tree.mesh, f"{name} ({tree.source})" if tree.source else name)


def answer_solids(trees: Trees, batch: Batch, accuracy: Accuracy, threads: int) -> Outcome:
    """Return what `first_contact` answers of every row of solids, as `answer_batch` of surfaces.

    The question at t = 0 counts neither in the counters nor towards the limits of rows that it does
    not decide; where a limit leaves it open, the rows are asked one by one.

    Raises:
        MotionError: the one placement of all leaves the range of double.
        TreeFileError: a tree file is damaged.
    """
    answers, errors = answer_batch(trees, batch, accuracy, threads)
    errors = dict(errors)
    known: dict[tuple[int, int], FirstContact | None] = {}
    for row in np.flatnonzero(answers["status"] != REFUSED).tolist():
        poses = batch.poses[row if len(batch.poses) > 1 else 0]
        key = id(poses[0]), id(poses[1])
        if key not in known:
            known[key] = _at_start(trees, poses, accuracy)
        found = known[key]
        if found is None:
            continue
        if found.status is Status.UNRESOLVED:
            one = answer_one_by_one([_asked(trees, batch, row)], accuracy, solid=True)
            answers[row] = one.answers[0]
            if one.errors:
                errors[row] = one.errors[0]
        elif found.contained is not None:
            write_answer(answers[row], found)
    return Outcome(answers, errors)


def _at_start(trees: Trees, poses: Poses, accuracy: Accuracy) -> FirstContact | None:
    """Return the answer at t = 0; None where the placement is refused, as its rows are."""
    a, b = (Body(tree, pose) for tree, pose in zip(trees, poses, strict=True))
    try:
        return first_contact(a, b, 0.0, accuracy, solid=True)
    except MotionError:
        return None


def _asked(trees: Trees, batch: Batch, row: int) -> tuple[Body, Body, float]:
    """Return the bodies of a row, and its duration."""
    poses = batch.poses[row if len(batch.poses) > 1 else 0]
    bodies = []
    for tree, pose, numbers in zip(
        trees, poses, (batch.motions_a[row], batch.motions_b[row]), strict=True
    ):
        velocity, spin, pivot = numbers.reshape(3, 3)
        motion = Motion(velocity, spin, pivot if spin.any() else None)
        bodies.append(Body(tree, pose, motion))
    return bodies[0], bodies[1], float(batch.durations[row])
