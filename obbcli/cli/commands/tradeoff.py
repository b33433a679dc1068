"""`obbtree tradeoff`: what speed costs in accuracy, measured on the user's meshes and motion."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from obbcli.cli.boundary import CancelledError, ExitCode, UsageError, writing
from obbcli.cli.inputs import keep_inputs
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
from obbcli.cli.options.two_bodies import QUESTION, naming_options, refuse_what_moves
from obbcli.cli.options.words import Finite, PathName
from obbcli.cli.output import emit, remark, tell_interrupted
from obbcli.cli.plot import check_plot
from obbcli.cli.progress import measuring
from obbcli.cli.unbuilt import read_unbuilt
from obbcli.study.asks import ASKS

if TYPE_CHECKING:
    from obbcli.mesh import Mesh
    from obbcli.motion.body import Body
    from obbcli.report.record import Record, Source
    from obbcli.report.tradeoff import Wording
    from obbcli.study.asks import Ask
    from obbcli.study.tradeoff.at_rest import RestStudy
    from obbcli.study.tradeoff.measuring import Study
    from obbcli.tree.tree import ObbTree


class _Wanted(NamedTuple):
    """What the study is for."""

    budget: float
    max_error: float | None
    max_gap: float | None
    max_time: float | None
    plot: str | None
    ask: Ask


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
        option(
            QUESTION,
            "--ask",
            type=click.Choice(ASKS),
            default=ASKS[0],
            show_default=True,
            help="Which question; all but first-contact are about t = 0.",
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
  obbtree tradeoff pin.stl plate.stl --ask overlap --max-time 0.1
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
    if asked.wanted.ask != "first-contact":
        _refuse_beside_rest(asked)
    question = QuestionOptions.of(asked.pose, asked.motion, asked.accuracy)
    keep_inputs(asked.common.output, (asked.a, asked.b))
    if asked.wanted.plot is not None:
        check_plot(asked.wanted.plot, asked.common.output, (asked.a, asked.b))
    shapes, sources = read_unbuilt(
        (asked.a, asked.b), asked.units, asked.common, verify=not asked.no_verify
    )
    with naming_options(question):
        study = _study(question, shapes, asked.wanted)
        is_interrupted = _run(study, asked)
    if asked.wanted.ask != "first-contact":
        from obbcli.cli.tradeoff_at_rest import answer_at_rest

        words = _words(asked), asked.wanted.max_time
        return answer_at_rest(
            study, (asked.a, asked.b), sources, words, asked.common, is_interrupted=is_interrupted
        )
    record = _record(asked, study, sources, is_interrupted=is_interrupted)
    _show(record, asked)
    return _exit_code(record["result"])


def _refuse_beside_rest(asked: _TradeoffOptions) -> None:
    """Refuse what says nothing about bodies at rest."""
    wanted = asked.wanted
    refuse_what_moves(asked.motion, wanted.ask)
    for name in ("max_error", "max_gap", "plot"):
        if getattr(wanted, name) is not None:
            fault = f"is about times of contact, and {wanted.ask} has none"
            raise UsageError("--" + name.replace("_", "-"), fault, "leave it out")


def _study(
    question: QuestionOptions, shapes: tuple[Mesh | ObbTree, Mesh | ObbTree], wanted: _Wanted
) -> Any:
    """Return the study of the question that is asked, a `Study` or a `RestStudy`."""
    from obbcli.motion.body import Body
    from obbcli.study.tradeoff.tradeoff import study_of

    a, b = (
        Body(shape, pose, motion)
        for shape, pose, motion in zip(shapes, question.poses, question.motions, strict=True)
    )
    duration = question.duration if wanted.ask == "first-contact" else None
    return study_of(a, b, duration, question.accuracy, ask=wanted.ask, budget=wanted.budget)


def _run(study: Study | RestStudy, asked: _TradeoffOptions) -> bool:
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
    from obbcli.report.tradeoff import Wording

    are_trees = (not isinstance(bodies[0].shape, Mesh), not isinstance(bodies[1].shape, Mesh))
    return Wording((asked.a, asked.b), are_trees, _words(asked))


def _words(asked: _TradeoffOptions) -> list[str]:
    """Return the options that place and move the bodies, as command lines repeat them."""
    from obbcli.report.tradeoff import number

    words = []
    for name, value in (asked.pose._asdict() | asked.motion._asdict()).items():
        if value is None or value is False:
            continue
        words.append(f"--{name.replace('_', '-')}")
        if value is not True:
            words += [number(part) for part in (value if isinstance(value, tuple) else (value,))]
    return words


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
