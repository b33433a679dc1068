"""`obbtree clearance`: how near do two moving bodies come to each other?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.boundary import CancelledError, ExitCode, usage_errors
from obbcli.cli.options.option import Command, option
from obbcli.cli.options.two_bodies import QUESTION, about_two, naming_options, with_load_time
from obbcli.cli.options.unused import hide_unused, refuse_unused
from obbcli.cli.options.words import Finite, Whole
from obbcli.cli.output import emit
from obbcli.cli.progress import narrowing

if TYPE_CHECKING:
    from obbcli.accuracy import Accuracy
    from obbcli.answers.clearance import Clearance
    from obbcli.cli.inputs import Input
    from obbcli.cli.options.placement import QuestionOptions
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.questions.clearance.asked import Asked
    from obbcli.questions.clearance.query import ClearanceQuery
    from obbcli.report.record import Record

# The fields of `Accuracy` that say something here; those of `obbcli.questions.clearance.asked`,
# which is not imported for help.
_CONCERNS = frozenset({"max_iterations", "timeout"})
# s between two looks at the clock, where steps of few pops take the time.
_LOOK = 0.1


@click.command(
    "clearance",
    cls=Command,
    short_help="How near do two moving bodies come to each other?",
    epilog="""\b
Examples:
  obbtree clearance gear.stl pinion.stl --omega 0 0 1 --omega-b 0 0 -2 --duration 0.2
  obbtree clearance arm.stl shelf.obbt --vel 0 0 -50 --duration 3 --at-least 5 --exit-code
  obbtree clearance door.ply frame.obj --path door.csv --solid --json
""",
)
@option(
    QUESTION,
    "--at-least",
    type=Finite(0.0),
    metavar="D",
    help="Ask whether they never come nearer than D, in mesh units [default: ask how near].",
)
@option(
    QUESTION,
    "--tolerance",
    type=Finite(0.0),
    metavar="E",
    help="Width of the bracket, as a share of the distance in mesh units [default: 1e-6].",
)
@option(QUESTION, "--greatest", is_flag=True, help="Ask how far apart they come, too.")
@option(
    QUESTION,
    "--curve",
    "intervals",
    type=Whole(1),
    metavar="N",
    help="Ask how near they come in each of N equal intervals, too [default: do not].",
)
@option(QUESTION, "--solid", is_flag=True, help="A body inside another touches it.")
@about_two("Exit with 1 where they touch, or come nearer than D; 0 where proven not to.")
def command(asked: TwoBodyOptions, **flags: Any) -> int:
    """How near do A and B come to each other as they move, when and where?

    A and B are mesh files or .obbt trees; one of them may be - for standard input. The least
    distance comes as a bracket: they are proven never to be nearer than its lower end, and at the
    time told no further apart than its upper end. The first time at which they are within D is what
    first-contact --clearance D tells. Ctrl-C says what is proven.
    """
    from obbcli.report.clearance import clearance_bare, clearance_tables

    remedy = "use --at-least D, or obbtree first-contact --clearance D"
    refuse_unused(asked.accuracy.given(), _CONCERNS, "a least clearance", clearance=remedy)
    question = asked.question()
    wanted = _wanted(flags)
    files = asked.read()
    with naming_options(question):
        record = _ask(asked, question, files, wanted)
    emit(record, clearance_tables, asked.common, bare=clearance_bare)
    return _exit_code(record["result"], asked=asked.exit_code)


def _wanted(flags: dict[str, Any]) -> Asked:
    """Return what is asked about the distance.

    Raises:
        UsageError: a number is refused.
    """
    from obbcli.questions.clearance.asked import Asked

    given = {name: value for name, value in flags.items() if value is not None}
    with usage_errors(tolerance="--tolerance", greatest="--greatest", intervals="--curve"):
        return Asked.of(**given)


def _ask(
    asked: TwoBodyOptions, question: QuestionOptions, files: tuple[Input, Input], wanted: Asked
) -> Record:
    """Put the question and return its record."""
    from obbcli.questions.clearance.query import ClearanceQuery
    from obbcli.report.clearance import clearance_record

    pair = question.pair(files)
    query = ClearanceQuery.about(pair, wanted)
    answer = _run(query, pair.accuracy, progress=asked.common.shows_progress)
    setting = asked.setting(files, pair, wanted.solid)
    return with_load_time(clearance_record(setting, wanted, answer), files)


def _run(query: ClearanceQuery, accuracy: Accuracy, *, progress: bool) -> Clearance:
    """Advance a query to its end or to a limit of `accuracy`, and return its answer.

    Raises:
        CancelledError: Ctrl-C; it says what is proven.
    """
    from obbcli.questions.budget import Budget

    budget = Budget(accuracy.max_iterations, accuracy.timeout).start()
    taken = 0
    try:
        with narrowing(wanted=progress) as show:
            while True:
                # The slices of `ClearanceQuery.advance` itself: a bar changes no answer.
                query.advance(budget.slice(), _LOOK)
                budget.spend(query.iterations - taken)
                taken = query.iterations
                if query.is_finished or budget.is_over:
                    return query.answer()
                show(*query.bounds)
    except KeyboardInterrupt as fault:
        low, high = query.bounds
        proven = f"the least distance is at least {low!r} and at most {high!r}: proven"
        if high == float("inf"):
            proven = "nothing was proven yet"
        raise CancelledError("", "interrupted", proven) from fault


def _exit_code(result: Record, *, asked: bool) -> int:
    """Return the exit code of an answer; `asked` is whether nearness has one of its own."""
    held = result["at_least"]
    if held is not None:
        is_open, is_near = held["verdict"] == "open", held["verdict"] == "violated"
    else:
        low, high = result["minimum"]["bounds"]
        is_near = high == 0
        # Bodies as near as rounding: whether they touch is not known.
        is_open = not result["complete"] or (asked and low == 0 and not is_near)
    if is_open:
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and is_near else ExitCode.ANSWERED


hide_unused(command, _CONCERNS)
