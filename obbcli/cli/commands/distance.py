"""`obbtree distance`: how far apart are two bodies, and where?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from obbcli.accuracy import ASPECTS
from obbcli.cli.boundary import ExitCode
from obbcli.cli.options.option import Command
from obbcli.cli.options.two_bodies import (
    about_two,
    naming_options,
    refuse_what_moves,
    with_load_time,
)
from obbcli.cli.options.unused import hide_motion, hide_unused, refuse_unused
from obbcli.cli.output import emit

if TYPE_CHECKING:
    from obbcli.cli.inputs import Input
    from obbcli.cli.options.accuracy import AccuracyOptions
    from obbcli.cli.options.placement import MotionOptions, QuestionOptions
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.report.record import Record


# The fields of `Accuracy` that say something of bodies at rest, and what stands for two of them.
_CONCERNS = frozenset(name for name, aspect in ASPECTS.items() if aspect.concerns == "all") | {
    "max_depth"
}


@click.command(
    "distance",
    cls=Command,
    short_help="How far apart are two bodies, and where?",
    epilog="""\b
Examples:
  obbtree distance gear.stl shaft.obj --translate-b 0 0 12.5
  obbtree distance part.stl clamp.obbt --distance-tolerance 1e-3 --json
  obbtree distance a.stl b.stl --quiet
""",
)
@about_two("Exit with 1 where they touch, 0 where not.")
def command(asked: TwoBodyOptions) -> int:
    """How far apart are the surfaces of A and B, and where are they nearest?

    A and B are mesh files or .obbt trees; one of them may be - for standard input. The distance
    comes with two bounds, both proven, with every rounding counted; it is 0 where the surfaces
    touch or cross, and only there.
    """
    from obbcli.report.distance import distance_bare, distance_tables

    _refuse_what_says_nothing(asked.motion, asked.accuracy)
    question = asked.question()
    files = asked.read()
    with naming_options(question):
        record = _ask(asked, question, files)
    emit(record, distance_tables, asked.common, bare=distance_bare)
    if not record["result"]["complete"]:
        return ExitCode.UNRESOLVED
    touches = record["result"]["distance"] == 0
    return ExitCode.CONTACT if asked.exit_code and touches else ExitCode.ANSWERED


def _refuse_what_says_nothing(motion: MotionOptions, accuracy: AccuracyOptions) -> None:
    """Refuse options that other questions know: to ignore them would make the answer a lie."""
    refuse_what_moves(motion, "distance")
    refuse_unused(accuracy.given(), _CONCERNS, "a distance")


def _ask(asked: TwoBodyOptions, question: QuestionOptions, files: tuple[Input, Input]) -> Record:
    """Put the question and return its record."""
    from obbcli.questions.distance import measure
    from obbcli.report.distance import distance_record

    pair = question.pair(files)
    answer, is_complete = measure(pair)
    setting = asked.setting(files, pair)
    record = distance_record(setting, answer, is_complete=is_complete)
    return with_load_time(record, files)


hide_unused(command, _CONCERNS)
hide_motion(command)
