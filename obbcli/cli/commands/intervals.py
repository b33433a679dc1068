"""`obbtree intervals`: when do two moving bodies touch, and when are they free?"""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.boundary import CancelledError, ExitCode
from obbcli.cli.options.option import Command, option
from obbcli.cli.options.two_bodies import QUESTION, about_two, naming_options, with_load_time
from obbcli.cli.options.unused import WHOLE_MOTION, hide_unused, refuse_unused
from obbcli.cli.options.words import Finite, Whole
from obbcli.cli.output import emit
from obbcli.cli.progress import proving

if TYPE_CHECKING:
    from obbcli.answers.contact_piece import ContactPiece
    from obbcli.cli.inputs import Input
    from obbcli.cli.options.placement import QuestionOptions
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.questions.intervals.stretches import Tally
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.report.intervals import Pieces
    from obbcli.report.record import Record


@click.command(
    "intervals",
    cls=Command,
    short_help="When do two moving bodies touch, and when are they free?",
    epilog="""\b
Examples:
  obbtree intervals door.stl frame.stl --omega 0 0 1 --duration 6.28
  obbtree intervals pin.stl plate.stl --vel 0 0 -10 --duration 3 --solid --json
  obbtree intervals lid.stl box.stl --vel 1 0 0 --omega 0 0 1 --within 1e-3
""",
)
@option(
    QUESTION,
    "--within",
    type=Finite(0.0),
    metavar="D",
    help="Surfaces this close are in contact, in mesh units [default: 0].",
)
@option(QUESTION, "--solid", is_flag=True, help="A body inside another is contact too.")
@option(QUESTION, "--limit", type=Whole(1), metavar="N", help="List N pieces [default: all].")
@about_two("Exit with 1 where they ever touch, 0 where free throughout, 4 where undecided.")
def command(asked: TwoBodyOptions, **flags: Any) -> int:
    """When do A and B touch as they move, and when are they free?

    A and B are mesh files or .obbt trees; one of them may be - for standard input. The duration is
    told in pieces: contact and free ones are proven at every instant, touches are contacts too
    short to be resolved, and what is undecided is called so. Ends come as brackets.
    """
    from obbcli.report.intervals import intervals_bare, intervals_tables

    about = "proven pieces of a motion"
    refuse_unused(asked.accuracy.given(), WHOLE_MOTION, about, clearance="use --within D")
    question = asked.question()
    files = asked.read()
    with naming_options(question):
        record = _ask(asked, question, files, flags)
    emit(record, intervals_tables, asked.common, bare=intervals_bare)
    return _exit_code(record["result"], asked=asked.exit_code)


def _ask(
    asked: TwoBodyOptions,
    question: QuestionOptions,
    files: tuple[Input, Input],
    flags: dict[str, Any],
) -> Record:
    """Put the question and return its record."""
    from obbcli.questions.intervals.stretches import Tally
    from obbcli.report.intervals import intervals_record

    pair, tally = question.pair(files), Tally()
    within, limit = flags["within"] or 0.0, flags["limit"]
    found = _run(pair, flags | {"within": within}, tally, progress=asked.common.shows_progress)
    setting = asked.setting(files, pair, flags["solid"])
    wanted = {"within": within, "limit": limit}
    return with_load_time(intervals_record(setting, wanted, found, tally.stats(pair)), files)


def _run(pair: PairQuestion, flags: dict[str, Any], tally: Tally, *, progress: bool) -> Pieces:
    """Ask for the pieces up to a limit.

    Raises:
        CancelledError: Ctrl-C; it says up to when pieces are known.
    """
    from obbcli.errors import UnresolvedError
    from obbcli.questions.intervals.contact_intervals import intervals_of
    from obbcli.report.intervals import Pieces

    pieces: list[ContactPiece] = []
    until, is_cut = pair.duration, False
    try:
        with proving(pair.duration, "known until", wanted=progress) as show:
            found = intervals_of(pair, within=flags["within"], solid=flags["solid"], tally=tally)
            for piece in islice(found, flags["limit"]):
                pieces.append(piece)
                show(piece.end[0])
            is_cut = len(pieces) == flags["limit"] and pieces[-1].end[0] < pair.duration
    except UnresolvedError as limit:
        until = pieces[-1].end[0] if pieces else 0.0
        return Pieces(pieces, until, limit.time)
    except KeyboardInterrupt as fault:
        known = repr(pieces[-1].end[0]) if pieces else "0"
        said = f"pieces before t = {known} s are proven"
        raise CancelledError("", "interrupted", said) from fault
    return Pieces(pieces, pieces[-1].end[0] if is_cut else until)


def _exit_code(result: Record, *, asked: bool) -> int:
    """Return the exit code of an answer; `asked` is whether contact has one of its own."""
    kinds = {piece["kind"] for piece in result["pieces"]}
    if result["unresolved_after"] is not None or "undecided" in kinds:
        return ExitCode.UNRESOLVED
    touches = not kinds.isdisjoint(("contact", "touch"))
    return ExitCode.CONTACT if asked and touches else ExitCode.ANSWERED


hide_unused(command, WHOLE_MOTION)
