"""`obbtree stability`: the same question at the extremes, and which answers hold."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from obbcli.cli.boundary import ExitCode, UsageError, writing
from obbcli.cli.options.option import Command, option
from obbcli.cli.options.two_bodies import (
    QUESTION,
    about_two,
    meeting_of,
    naming_options,
    refuse_what_moves,
)
from obbcli.cli.options.words import PathName
from obbcli.cli.output import emit, tell_interrupted
from obbcli.cli.plot import check_plot
from obbcli.cli.progress import trying
from obbcli.files import write_whole
from obbcli.study.asks import ASKS

if TYPE_CHECKING:
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.report.record import Record
    from obbcli.report.stability import Studied
    from obbcli.study.asks import Ask
    from obbcli.study.stability.at_rest import RestBattery
    from obbcli.study.stability.battery import Battery


@click.command(
    "stability",
    cls=Command,
    short_help="Which answers hold when the question is taken to extremes?",
    epilog="""\b
Examples:
  obbtree stability gear.stl pinion.stl --omega 0 0 0.1
  obbtree stability arm.stl shelf.obbt --vel 0 0 -50 --duration 3 --json
  obbtree stability arm.stl shelf.obbt --vel 0 0 -50 --plot held.svg
  obbtree stability pin.stl plate.stl --ask overlap
""",
)
@option(
    QUESTION,
    "--ask",
    type=click.Choice(ASKS),
    default=ASKS[0],
    show_default=True,
    help="Which question; all but first-contact are about t = 0.",
)
@option(
    QUESTION,
    "--plot",
    type=PathName(),
    metavar="FILE",
    help="Draw what held into FILE, .svg or .png; needs matplotlib.",
)
@about_two("Exit with 1 where they touch, 0 where proven apart; 6 where anything is broken.")
def command(asked: TwoBodyOptions, ask: Ask, plot: str | None) -> int:
    """Ask a question about A and B again at the extremes, and say which answers hold.

    The world is scaled to the ends of the doubles, shifted, turned and hurried; bodies swapped,
    triangles reordered, split, repeated and reversed; time scaled and cut; bodies spun and tilted;
    digits taken away. What may change is bounded by what that did to the input, and beyond it
    nothing may: exit code 6 says that something did, which is a defect of obbtree. Ctrl-C keeps
    what was done.
    """
    if ask != "first-contact":
        refuse_what_moves(asked.motion, ask)
    question = asked.question()
    if question.accuracy.method == "sampled":
        fault = "proves nothing that could be held to"
        raise UsageError("--method sampled", fault, "ask for --method certified")
    if plot is not None:
        check_plot(plot, asked.common.output, (asked.a, asked.b))
    files = asked.read()
    with naming_options(question):
        from obbcli.study.stability.stability import battery_of

        pair = question.pair(files)
        battery = battery_of(*pair.bodies, pair.duration, pair.accuracy, ask=ask)
        studied = _run(battery, progress=asked.common.shows_progress)
        setting = asked.setting(files, pair)
    from obbcli.report.stability import stability_bare, stability_record, stability_tables

    record = stability_record(setting, studied, ask)
    if plot is not None:
        _draw(record, plot)
    emit(record, stability_tables, asked.common, bare=stability_bare)
    if studied.is_interrupted:
        not_tried = battery.count - len(battery.rows)
        tell_interrupted(f"not tried: {not_tried} extremes", asked.common)
    return _exit_code(record["result"], asked=asked.exit_code)


def _draw(record: Record, name: str) -> None:
    """Write the picture, whole or not at all."""
    from obbcli.report.plots.stability import stability_plot

    picture = stability_plot(record, Path(name).suffix.lower().removeprefix("."))
    with writing(name):
        write_whole(Path(name), picture)


def _run(battery: Battery | RestBattery, *, progress: bool) -> Studied:
    """Try all extremes; after Ctrl-C what was tried by then."""
    from obbcli.report.stability import Studied

    start = time.perf_counter()
    is_interrupted = False
    with trying(battery.count, wanted=progress) as show:
        try:
            while not battery.is_finished:
                show(len(battery.rows), battery.next_extreme)
                battery.advance()
        except KeyboardInterrupt:
            is_interrupted = True
    spent = time.perf_counter() - start
    return Studied(battery.result(), battery.count, is_interrupted, spent)


def _exit_code(result: Record, *, asked: bool) -> int:
    if result["interrupted"]:
        return ExitCode.INTERRUPTED
    if result["broken_count"]:
        return ExitCode.BROKEN
    is_open, meets = meeting_of(result["answer"])
    if is_open:
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and meets else ExitCode.ANSWERED
