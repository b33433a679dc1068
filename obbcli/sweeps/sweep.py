"""`sweep`: the first contacts of one pair in many motions, as one array."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias, cast

import numpy as np

from obbcli.accuracy import Accuracy
from obbcli.arrays import as_floats
from obbcli.errors import MotionError
from obbcli.motion.body import Body, as_body, pivot_of
from obbcli.motion.motion import Motion
from obbcli.questions.pair_question import duration_of, trees_of
from obbcli.sweeps.answer_rows import RAW, as_rows
from obbcli.sweeps.batch import Batch, Outcome, answer_batch, answer_one_by_one
from obbcli.sweeps.solids import answer_solids, require_solids
from obbcli.threads import thread_count

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from obbcli.errors import ObbError
    from obbcli.motion.body import Shape
    from obbcli.questions.pair_question import Trees
    from obbcli.sweeps.answer_rows import Answers

    Floats = NDArray[np.float64]

Motions: TypeAlias = "Motion | Sequence[Motion] | ArrayLike | None"


def sweep(
    a: Body | Shape,
    b: Body | Shape,
    motions_a: Motions,
    motions_b: Motions = None,
    durations: ArrayLike | None = None,
    accuracy: Accuracy | None = None,
    *,
    threads: int | None = None,
    solid: bool = False,
) -> Answers:
    """Return the first contact of one pair of bodies in each of many motions.

    Row by row the same, bit for bit, as `first_contact` says of the same bodies, whatever the
    number of threads. The questions of constant velocities are asked by the kernels, several at a
    time; motions through poses and the sampled method take their turn in Python. Signals are looked
    at every few milliseconds.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file; its pose
            is where every row starts.
        b: the other shape, of the same kinds.
        motions_a: how A moves: a `Motion` a row, or floats (N, 6), V and W a row, or (N, 9) with
            the pivots. One motion stands for all rows. None: as the body itself says.
        motions_b: the same of B.
        durations: s, one for all or (N,). None: 1 where a body moves, else 0, as `first_contact`.
        accuracy: of every row; its limits too. None: the defaults.
        threads: how many rows are asked about at the same time. None: one a core.
        solid: whether a body inside the other at t = 0 is contact too, as of `first_contact`. That
            is asked once for all rows that start alike, outside their counters and limits.

    Returns:
        a structured array (N,) with the fields of `FirstContact`: `status`, `evidence` and
        `feature` its words (empty where none), `time` and its bounds `time_lo` and `time_hi` s,
        `contained`, `point`, `point_a`, `point_b`, `normal`, `normal_a`, `normal_b` (3,),
        `triangle_a`, `triangle_b`, `distance`, `error_bound`, `approximate`, and the counters
        `box_tests`, `triangle_tests`, `exact_triangle_tests`, `pops`, `image_tests`. NaN, or -1 of
        triangles, where a field does not apply. `part_a` and `part_b` are empty unless
        `FILE#PATTERN` selected parts.

    Raises:
        MotionError: motions or durations are no numbers or of another shape, a body moves by itself
            and is given motions too, or positions leave the range of double; the row is named.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.

    Example:
        >>> speeds = [Motion([0, -speed, 0]) for speed in (5, 10, 20)]
        >>> rows = sweep("sample_meshes/finger_left.off", "sample_meshes/workpiece.obj", speeds)
        >>> rows["status"].tolist(), rows["time"].tolist()
        (['contact', 'contact', 'contact'], [1.0, 0.5, 0.25])
    """
    accuracy = Accuracy() if accuracy is None else accuracy
    bodies = as_body(a), as_body(b)
    columns = _column(bodies[0], motions_a, "a"), _column(bodies[1], motions_b, "b")
    seconds = None if durations is None else _durations(durations, bodies)
    count = _row_count(columns, seconds)
    trees = trees_of(bodies)
    placed = tuple(Body(tree, body.pose) for tree, body in zip(trees, bodies, strict=True))
    if solid:
        require_solids(trees)
    question = _SweepQuestion(trees, (placed[0], placed[1]), columns, seconds, count, solid)
    outcome = question.answer(accuracy, thread_count(threads))
    for row, fault in sorted(outcome.errors.items()):
        raise type(fault)(f"row {row}: {fault.where}", fault.fault, fault.remedy)
    return as_rows(outcome.answers, trees)


class _Column(NamedTuple):
    """The motions of one body: in numbers, or as objects where some go through poses."""

    numbers: Floats  # (N, 9), or (N, 6) where all turn about the centroid; NaN: the centroid
    paths: dict[int, Motion]  # those that place the mesh themselves

    def motion(self, row: int) -> Motion:
        row = 0 if len(self.numbers) == 1 else row
        if row in self.paths:
            return self.paths[row]
        velocity, spin, pivot = self.numbers[row].reshape(3, 3)
        return Motion(velocity, spin, None if np.isnan(pivot[0]) else pivot)


class _SweepQuestion(NamedTuple):
    trees: Trees
    placed: tuple[Body, Body]
    columns: tuple[_Column, _Column]
    durations: Floats | None
    row_count: int
    solid: bool

    def answer(self, accuracy: Accuracy, threads: int) -> Outcome:
        slow = sorted({row for column in self.columns for row in self._rows_of(column)})
        if accuracy.method == "sampled":
            slow = list(range(self.row_count))
        quick = np.setdiff1d(np.arange(self.row_count), slow)
        answers = np.zeros(self.row_count, RAW)
        errors: dict[int, ObbError] = {}
        a, b = self.placed
        motions_a, motions_b = (self._numbers(side)[quick] for side in (0, 1))
        batch = Batch([(a.pose, b.pose)], motions_a, motions_b, self._seconds()[quick])
        answer_quick = answer_solids if self.solid else answer_batch
        some = answer_quick(self.trees, batch, accuracy, threads)
        others = answer_one_by_one(map(self._bodies, slow), accuracy, solid=self.solid)
        for rows, outcome in ((quick, some), (np.array(slow, np.intp), others)):
            answers[rows] = outcome.answers
            errors |= {int(rows[row]): fault for row, fault in outcome.errors.items()}
        return Outcome(answers, errors)

    def _rows_of(self, column: _Column) -> range | list[int]:
        if len(column.numbers) == 1 and column.paths:
            return range(self.row_count)
        return list(column.paths)

    def _numbers(self, side: int) -> Floats:
        """Return a body's motions, (N, 9), with the pivots of those that turn about their own."""
        numbers = self.columns[side].numbers.copy()
        pivotless = np.isnan(numbers[:, 6])
        turning = numbers[:, 3:6].any(axis=1)
        numbers[~turning, 6:] = 0.0
        if (pivotless & turning).any():
            numbers[pivotless & turning, 6:] = pivot_of(self.placed[side], self.trees[side])
        return np.broadcast_to(numbers, (self.row_count, 9))

    def _seconds(self) -> Floats:
        if self.durations is not None:
            return np.broadcast_to(self.durations, (self.row_count,))
        moves = [column.numbers[:, :6].any(axis=1) for column in self.columns]
        return np.broadcast_to(moves[0] | moves[1], (self.row_count,)).astype(float)

    def _bodies(self, row: int) -> tuple[Body, Body, float | None]:
        duration = None if self.durations is None else float(self._seconds()[row])
        a, b = (
            Body(body.shape, body.pose, column.motion(row))
            for body, column in zip(self.placed, self.columns, strict=True)
        )
        return a, b, duration


def _column(body: Body, motions: Motions, side: str) -> _Column:
    name = f"motions_{side}"
    if motions is None:
        return _of_motions([body.motion], name)
    if not body.motion.is_at_rest:
        raise MotionError(name, "are given beside a body that moves", "leave one of them out")
    if isinstance(motions, Motion):
        return _of_motions([motions], name)
    if isinstance(motions, (list, tuple)) and any(isinstance(m, Motion) for m in motions):
        return _of_motions(motions, name)
    return _Column(_with_pivots(cast("ArrayLike", motions), name), {})


def _of_motions(motions: Sequence[object], name: str) -> _Column:
    numbers = np.full((len(motions), 9), np.nan)
    paths = {}
    for row, motion in enumerate(motions):
        if not isinstance(motion, Motion):
            kind = type(motion).__name__
            raise MotionError(f"{name}[{row}]", f"is of type {kind}", "pass Motion objects")
        if motion.places_mesh:
            paths[row] = motion
            numbers[row] = 0.0
            continue
        numbers[row, :3], numbers[row, 3:6] = motion.linear_velocity, motion.angular_velocity
        if motion.pivot is not None:
            numbers[row, 6:] = motion.pivot
    return _Column(numbers, paths)


def _with_pivots(motions: ArrayLike, name: str) -> Floats:
    """Return rows of numbers as (N, 9); NaN for pivots that were not given."""
    try:
        shape = np.shape(motions)
    except ValueError:
        shape = ()  # a ragged list: the check below refuses it
    rows = np.asarray(motions)[None] if len(shape) == 1 else motions  # one for all of them
    numbers = as_floats(rows, (None, None), name, MotionError)
    if numbers.shape[1] not in (6, 9):
        raise MotionError(
            name, f"has shape {numbers.shape}", "give (N, 6): V and W, or (N, 9) with the pivots"
        )
    wide = np.full((len(numbers), 9), np.nan)
    wide[:, : numbers.shape[1]] = numbers
    return wide


def _durations(durations: ArrayLike, bodies: tuple[Body, Body]) -> Floats:
    """Return s, (1,) or (N,)."""
    if np.ndim(durations) == 0:
        return np.array([duration_of(durations, bodies)])  # type: ignore[arg-type]  # says it best
    seconds = as_floats(durations, (None,), "durations", MotionError)
    for row in np.flatnonzero(seconds < 0)[:1].tolist():
        raise MotionError(f"durations[{row}]", f"is {seconds[row]}", "use at least 0 s")
    return seconds


def _row_count(columns: tuple[_Column, _Column], durations: Floats | None) -> int:
    """Return how many rows there are; one stands for as many as the others have."""
    counts = {"motions_a": len(columns[0].numbers), "motions_b": len(columns[1].numbers)}
    if durations is not None:
        counts["durations"] = len(durations)
    rows = {count for count in counts.values() if count != 1} or {1}
    if len(rows) > 1:
        found = ", ".join(f"{count} {name}" for name, count in counts.items())
        raise MotionError("motions", f"{found} do not go together", "give as many of each, or one")
    return rows.pop()
