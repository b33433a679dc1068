"""`obbtree first-contact`: when and where do two moving bodies first touch?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.asking import (
    QUESTION,
    about_two,
    exit_code,
    naming_options,
    refuse_unanswered,
    run,
    with_load_time,
)
from obbcli.cli.options import Command, option
from obbcli.cli.output import emit
from obbcli.cli.types import Whole

if TYPE_CHECKING:
    from obbcli.cli.asking import Asked
    from obbcli.cli.inputs import Input
    from obbcli.cli.question import Question
    from obbcli.report.record import Record


@click.command(
    "first-contact",
    cls=Command,
    short_help="When and where do two moving bodies first touch?",
    epilog="""\b
Examples:
  obbtree first-contact gear.stl pinion.stl --omega 0 0 3 --omega-b 0 0 -6 --duration 2
  obbtree first-contact arm.stl shelf.obbt --vel 0 0 -50 --duration 3 --json
  obbtree first-contact a.stl b.stl --omega 0 0 90 --degrees --exit-code --quiet
""",
)
@option(QUESTION, "--all-contacts", is_flag=True, help="List every pair of triangles that meets.")
@option(QUESTION, "--limit", type=Whole(1), metavar="N", help="List N at most.")
@option(QUESTION, "--solid", is_flag=True, help="A body inside another is contact too.")
@about_two("Exit with 1 where they touch, 0 where proven apart, 4 where only sampled so.")
def command(asked: Asked, **flags: Any) -> int:
    """When do A and B first touch as they move, where, and with which triangles?

    A and B are mesh files or .obbt trees; one of them may be - for standard input. The time comes
    as a bracket: no contact before its lower end, which is proven, and contact at its upper end.
    Ctrl-C says up to when contact is ruled out.
    """
    from obbcli.report.first_contact import first_contact_bare, first_contact_tables

    question = asked.question()
    # The contract's options of later versions: known, and refused by name.
    refuse_unanswered(
        (
            ("--all-contacts", flags["all_contacts"], "leave it out to ask about the first"),
            ("--limit", flags["limit"] is not None, "leave it out to ask about the first"),
        )
    )
    files = asked.read()
    with naming_options(question):
        record = _ask(asked, question, files, flags)
    emit(record, first_contact_tables, asked.common, bare=first_contact_bare)
    return exit_code(record["result"], asked=asked.exit_code)


def _ask(
    asked: Asked, question: Question, files: tuple[Input, Input], flags: dict[str, Any]
) -> Record:
    """Put the question and return its record."""
    from obbcli.contact import Query
    from obbcli.report.first_contact import first_contact_record

    bodies = question.bodies(files)
    query = Query(*bodies, question.duration, question.accuracy, solid=flags["solid"])
    answer = run(query, question.accuracy, progress=asked.common.shows_progress)
    record = first_contact_record(asked.setting(files, bodies, question, flags["solid"]), answer)
    return with_load_time(record, files)
