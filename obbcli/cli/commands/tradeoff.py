"""`obbtree tradeoff`: what speed costs in accuracy, measured on the user's meshes and motion."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from obbcli.cli.boundary import CancelledError, ExitCode, UsageError, writing
from obbcli.cli.inputs import STDIN, keep_inputs, read_shape
from obbcli.cli.options.accuracy import AccuracyOptions, accuracy_options
from obbcli.cli.options.option import (
    Command,
    CommonOptions,
    common_options,
    gathered,
    option,
    verify_option,
)
from obbcli.cli.options.placement import (
    MotionOptions,
    PoseOptions,
    QuestionOptions,
    UnitOptions,
    motion_options,
    pose_options,
    unit_options,
)
from obbcli.cli.options.two_bodies import QUESTION, naming_options
from obbcli.cli.options.words import Finite, PathName
from obbcli.cli.output import emit, remark, tell_interrupted
from obbcli.cli.plot import check_plot
from obbcli.cli.progress import measuring

if TYPE_CHECKING:
    from obbcli.mesh import Mesh
    from obbcli.motion.body import Body
    from obbcli.report.record import Record, Source
    from obbcli.report.tradeoff import Wording
    from obbcli.study.tradeoff.measuring import Study
    from obbcli.tree.tree import ObbTree


class _Wanted(NamedTuple):
    """What the study is for."""

    budget: float
    max_error: float | None
    max_gap: float | None
    max_time: float | None
    plot: str | None


class _TradeoffOptions(NamedTuple):
    """All that the command is told."""

    a: str
    b: str
    wanted: _Wanted
    units: UnitOptions
    pose: PoseOptions
    motion: MotionOptions
    accuracy: AccuracyOptions
    no_verify: bool
    common: CommonOptions


_wanted_options = gathered(
    "wanted",
    _Wanted,
    (
        option(
            QUESTION,
            "--budget",
            type=Finite(0),
            default=60,
            show_default=True,
            metavar="S",
            help="Measure for S seconds at most.",
        ),
        option(
            QUESTION,
            "--max-error",
            type=Finite(0),
            metavar="E",
            help="Name the fastest setting that errs by no more than E, in s [default: name none].",
        ),
        option(
            QUESTION,
            "--max-gap",
            type=Finite(0),
            metavar="D",
            help="Name the fastest setting that says contact of surfaces no further than D apart, "
            "in mesh units [default: name none].",
        ),
        option(
            QUESTION,
            "--max-time",
            type=Finite(0),
            metavar="S",
            help="Name the most accurate setting that takes no longer than S seconds a question "
            "[default: name none].",
        ),
        option(
            QUESTION,
            "--plot",
            type=PathName(),
            metavar="FILE",
            help="Draw error against time into FILE, .svg or .png; needs matplotlib.",
        ),
    ),
)


@click.command(
    "tradeoff",
    cls=Command,
    short_help="What does speed cost in accuracy, measured on A and B?",
    epilog="""\b
Examples:
  obbtree tradeoff gear.stl pinion.stl --omega 0 0 3 --omega-b 0 0 -5.9 --duration 2
  obbtree tradeoff gear.stl pinion.stl --omega 0 0 3 --max-error 1e-6 --budget 20
  obbtree tradeoff arm.stl shelf.obj --vel 0 0 -50 --plot trade.svg --json > trade.json
""",
)
@gathered(
    "asked",
    _TradeoffOptions,
    (
        click.argument("a", metavar="A", type=PathName()),
        click.argument("b", metavar="B", type=PathName()),
        _wanted_options,
        unit_options,
        pose_options,
        motion_options,
        accuracy_options,
        verify_option,
        common_options(),
    ),
)
def command(asked: _TradeoffOptions) -> int:
    """Measure what speed costs in accuracy: tolerances, depth limits, samples, ways to build trees.

    Errors are against the certified answer, and every bound that an answer claims is put to the
    test; one that is broken is a fault of obbtree, and ends with exit code 6. A setting given in
    accuracy options is measured as well. Trees (.obbt) are used as they are. Ctrl-C prints what was
    measured by then.
    """
    question = QuestionOptions.of(asked.pose, asked.motion, asked.accuracy)
    keep_inputs(asked.common.output, (asked.a, asked.b))
    if asked.wanted.plot is not None:
        check_plot(asked.wanted.plot, asked.common.output, (asked.a, asked.b))
    shapes, sources = _read(asked)
    with naming_options(question):
        study = _study(question, shapes, asked.wanted.budget)
        is_interrupted = _run(study, asked)
    record = _record(asked, study, sources, is_interrupted=is_interrupted)
    _show(record, asked)
    return _exit_code(record["result"])


def _read(
    asked: _TradeoffOptions,
) -> tuple[tuple[Mesh | ObbTree, Mesh | ObbTree], tuple[Source, Source]]:
    """Return A and B, and what a record says of them."""
    from obbcli.cli.lengths import shared_sag
    from obbcli.files import file_of, stamp_of
    from obbcli.report.record import Source, file_sha256
    from obbcli.report.rows import about_units

    if asked.a == asked.b == STDIN:
        raise UsageError("B", "is standard input, and so is A", "name a file for one of them")
    found: dict[object, tuple[Mesh | ObbTree, Source]] = {}
    units = asked.units.of_a(), asked.units.of_b()
    own_a, own_b = shared_sag((asked.a, asked.b), units)
    keys = (asked.a, own_a), (asked.b, own_b)
    for key in keys:
        name, own = key
        if key in found:
            continue
        stamp = stamp_of(file_of(name))
        sag = None if own is None else own.sag
        shape, digest = read_shape(name, verify=not asked.no_verify, sag=sag)
        shape = shape if own is None else own.measured(shape, name)
        if digest is None and asked.common.json:
            digest = file_sha256(file_of(name), stamp)
        source = Source.of(name, digest, shape)
        more = () if own is None else own.remarks
        found[key] = shape, source._replace(notes=(*source.notes, *more))
    (a, source_a), (b, source_b) = found[keys[0]], found[keys[1]]
    if asked.common.quiet:
        return (a, b), (source_a, source_b)
    return (a, b), about_units((source_a, source_b), (a, b))


def _study(
    question: QuestionOptions, shapes: tuple[Mesh | ObbTree, Mesh | ObbTree], budget: float
) -> Study:
    from obbcli.motion.body import Body
    from obbcli.study.tradeoff.measuring import Study

    a, b = (
        Body(shape, pose, motion)
        for shape, pose, motion in zip(shapes, question.poses, question.motions, strict=True)
    )
    return Study(a, b, question.duration, question.accuracy, budget=budget)


def _run(study: Study, asked: _TradeoffOptions) -> bool:
    """Measure; return whether Ctrl-C ended it.

    Raises:
        CancelledError: before the reference was known.
    """
    try:
        with measuring(asked.wanted.budget, wanted=asked.common.shows_progress) as show:
            study.run(show)
    except KeyboardInterrupt as fault:
        if not study.has_reference:
            remedy = "nothing was measured yet"
            raise CancelledError("", "interrupted", remedy) from fault
        return True
    return False


def _record(
    asked: _TradeoffOptions,
    study: Study,
    sources: tuple[Source, Source],
    *,
    is_interrupted: bool,
) -> Record:
    from obbcli.report.record import Setting, shown_motion
    from obbcli.report.tradeoff import Limits, tradeoff_record

    found = study.result()
    motion = shown_motion(study.bodies, study.duration, in_document=asked.common.json)
    setting = Setting(sources, motion, found.reference_accuracy)
    wanted = asked.wanted
    limits = Limits(wanted.max_error, wanted.max_gap, wanted.max_time)
    wording = _wording(asked, study.bodies)
    return tradeoff_record(setting, found, wording, limits, is_interrupted=is_interrupted)


def _wording(asked: _TradeoffOptions, bodies: tuple[Body, Body]) -> Wording:
    """Return what command lines repeat of this one."""
    from obbcli.mesh import Mesh
    from obbcli.report.tradeoff import Wording, number

    words = []
    for name, value in (asked.pose._asdict() | asked.motion._asdict()).items():
        if value is None or value is False:
            continue
        words.append(f"--{name.replace('_', '-')}")
        if value is not True:
            words += [number(part) for part in (value if isinstance(value, tuple) else (value,))]
    are_trees = (not isinstance(bodies[0].shape, Mesh), not isinstance(bodies[1].shape, Mesh))
    return Wording((asked.a, asked.b), are_trees, words)


def _show(record: Record, asked: _TradeoffOptions) -> None:
    """Write the answer and the plot."""
    from obbcli.report.tradeoff_tables import tradeoff_bare, tradeoff_tables

    result, common = record["result"], asked.common
    if asked.wanted.plot is not None:
        from obbcli.files import write_whole
        from obbcli.report.plots.tradeoff import tradeoff_plot

        kind = Path(asked.wanted.plot).suffix.lower().removeprefix(".")
        with writing(asked.wanted.plot):
            write_whole(asked.wanted.plot, tradeoff_plot(record, kind))
    emit(record, tradeoff_tables, common, bare=tradeoff_bare)
    if result["interrupted"]:
        tell_interrupted("what was measured by then is shown", common)
    if result["reference"]["status"] == "unresolved":
        remark("no certified answer within the limits, so that no error is known; "
               "raise --budget, --max-iterations or --timeout", common)  # fmt: skip


def _exit_code(result: Record) -> int:
    if result["interrupted"]:
        return ExitCode.INTERRUPTED
    if result["claims_broken"]:
        return ExitCode.BROKEN
    is_open = result["reference"]["status"] == "unresolved"
    return ExitCode.UNRESOLVED if is_open else ExitCode.ANSWERED
