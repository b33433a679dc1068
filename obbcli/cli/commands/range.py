"""`obbtree range`: for how long are two bodies free around t = 0, and what stops them?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.boundary import ExitCode
from obbcli.cli.options.option import Command, option
from obbcli.cli.options.two_bodies import QUESTION, about_two, naming_options, with_load_time
from obbcli.cli.options.unused import WHOLE_MOTION, hide_unused, refuse_unused
from obbcli.cli.output import emit

if TYPE_CHECKING:
    from obbcli.cli.inputs import Input
    from obbcli.cli.options.placement import QuestionOptions
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.report.record import Record


@click.command(
    "range",
    cls=Command,
    short_help="For how long are two bodies free around t = 0?",
    epilog="""\b
Examples:
  obbtree range door.stl frame.stl --omega 0 0 1 --pivot 0 0 0 --duration 3.14
  obbtree range finger.stl part.stl --vel 0 -10 0 --duration 5 --json
""",
)
@option(QUESTION, "--solid", is_flag=True, help="A body inside another is contact too.")
@about_two("Exit with 1 where they touch at t = 0, 0 where free around it.")
def command(asked: TwoBodyOptions, **flags: Any) -> int:
    """For how long are A and B free around t = 0, in both directions of time?

    A and B are mesh files or .obbt trees; one of them may be - for standard input. The answer is
    the interval in which they are proven free, and what stops them at either end. A body that moves
    through poses rests before t = 0.
    """
    from obbcli.report.free_range import range_bare, range_tables

    about = "proven pieces of a motion"
    refuse_unused(
        asked.accuracy.given(),
        WHOLE_MOTION,
        about,
        clearance="move the bodies apart, or see obbtree clearance",
    )
    question = asked.question()
    files = asked.read()
    with naming_options(question):
        record = _ask(asked, question, files, solid=flags["solid"])
    emit(record, range_tables, asked.common, bare=range_bare)
    return _exit_code(record["result"], asked=asked.exit_code)


def _ask(
    asked: TwoBodyOptions, question: QuestionOptions, files: tuple[Input, Input], *, solid: bool
) -> Record:
    """Put the question and return its record."""
    from obbcli.questions.intervals.free_range import free_range_of
    from obbcli.report.free_range import range_record

    pair = question.pair(files)
    answer = free_range_of(pair, solid=solid)
    return with_load_time(range_record(asked.setting(files, pair, solid), answer), files)


def _exit_code(result: Record, *, asked: bool) -> int:
    """Return the exit code of an answer; `asked` is whether contact at 0 has one of its own."""
    if not result["complete"]:
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and result["free"] is None else ExitCode.ANSWERED


hide_unused(command, WHOLE_MOTION)
