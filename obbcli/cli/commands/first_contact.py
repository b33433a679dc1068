"""`obbtree first-contact`: when and where do two moving bodies first touch?"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.boundary import CancelledError, UsageError
from obbcli.cli.options.option import Command, option
from obbcli.cli.options.two_bodies import (
    QUESTION,
    about_two,
    exit_code,
    naming_options,
    run,
    with_load_time,
)
from obbcli.cli.options.words import Finite, Whole
from obbcli.cli.output import emit, remark

if TYPE_CHECKING:
    from obbcli.cli.inputs import Input
    from obbcli.cli.options.option import CommonOptions
    from obbcli.cli.options.placement import QuestionOptions
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.report.record import Record


@click.command(
    "first-contact",
    cls=Command,
    short_help="When and where do two moving bodies first touch?",
    epilog="""\b
Examples:
  obbtree first-contact gear.stl pinion.stl --omega 0 0 3 --omega-b 0 0 -6 --duration 2
  obbtree first-contact arm.stl shelf.obbt --vel 0 0 -50 --duration 3 --json
  obbtree first-contact lid.stl box.stl --vel 0 0 -10 --all-contacts --limit 20
  obbtree first-contact a.stl b.stl --omega 0 0 90 --degrees --exit-code --quiet
""",
)
@option(QUESTION, "--all-contacts", is_flag=True, help="List every pair that meets in it.")
@option(
    QUESTION,
    "--limit",
    type=Whole(1),
    metavar="N",
    help="List the first N pairs that meet, or N of --all-contacts [default: none, or all].",
)
@option(QUESTION, "--solid", is_flag=True, help="A body inside another is contact too.")
@option(
    QUESTION, "--after-release", is_flag=True, help="Count no contact before they have been apart."
)
@option(
    QUESTION,
    "--released-by",
    type=Finite(0.0),
    metavar="D",
    help="With --after-release: apart by more than D, in mesh units [default: 0].",
)
@about_two("Exit with 1 where they touch, 0 where proven apart, 4 where only sampled so.")
def command(asked: TwoBodyOptions, **flags: Any) -> int:
    """When do A and B first touch as they move, where, and with which triangles?

    A and B are mesh files or .obbt trees; one of them may be - for standard input. The time comes
    as a bracket: no contact before its lower end, which is proven, and contact at its upper end.
    Ctrl-C says up to when contact is ruled out.
    """
    question = asked.question()
    _refuse_release(flags)
    if question.accuracy.method == "sampled":
        _refuse_lists(flags)
    files = asked.read()
    with naming_options(question):
        record = _ask(asked, question, files, flags)
    _show(record, asked.common)
    return exit_code(record["result"], asked=asked.exit_code)


def _refuse_lists(flags: dict[str, Any]) -> None:
    """Refuse to list what sampling does not find."""
    for name in ("all_contacts", "limit"):
        if flags[name]:
            fault = "lists contacts of pairs, and sampling finds the first contact alone"
            raise UsageError(f"--{name.replace('_', '-')}", fault, "leave out --method sampled")


def _refuse_release(flags: dict[str, Any]) -> None:
    """Refuse what does not go with a release, or only with one."""
    if not flags["after_release"]:
        if flags["released_by"] is not None:
            fault = "says when bodies are released, and no release is asked for"
            raise UsageError("--released-by", fault, "add --after-release")
        return
    for name in ("all_contacts", "limit"):
        if flags[name]:
            fault = "lists contacts from t = 0 on, whether released or not"
            remedy = "leave it out, or see obbtree intervals"
            raise UsageError(f"--{name.replace('_', '-')}", fault, remedy)


def _ask(
    asked: TwoBodyOptions,
    question: QuestionOptions,
    files: tuple[Input, Input],
    flags: dict[str, Any],
) -> Record:
    """Put the question and return its record."""
    from obbcli.cli.listing import list_contacts
    from obbcli.questions.query import Query
    from obbcli.report.first_contact import first_contact_record

    pair = question.pair(files)
    if flags["after_release"]:
        return _ask_after_release(asked, pair, files, flags)
    query = Query.about(pair, solid=flags["solid"])
    answer = run(query, pair.accuracy, progress=asked.common.shows_progress)
    listing = None
    if flags["all_contacts"] or flags["limit"] is not None:
        listing, stats = list_contacts(
            pair,
            answer,
            flags["limit"],
            is_patch=flags["all_contacts"],
            progress=asked.common.shows_progress,
        )
        answer = replace(answer, stats=stats)
    setting = asked.setting(files, pair, flags["solid"])
    return with_load_time(first_contact_record(setting, answer, listing), files)


def _ask_after_release(
    asked: TwoBodyOptions, pair: PairQuestion, files: tuple[Input, Input], flags: dict[str, Any]
) -> Record:
    """Put the question about contact after release, and return its record."""
    from obbcli.questions.intervals.after_release import contact_after_release
    from obbcli.report.first_contact import first_contact_record

    distance = flags["released_by"] or 0.0
    try:
        answer = contact_after_release(pair, released_by=distance, solid=flags["solid"])
    except KeyboardInterrupt as fault:
        raise CancelledError("", "interrupted", "nothing was proven yet") from fault
    setting = asked.setting(files, pair, flags["solid"])
    record = first_contact_record(setting, answer, released_by=distance)
    return with_load_time(record, files)


def _show(record: Record, common: CommonOptions) -> None:
    """Write the answer; a list that may not be all says so."""
    from obbcli.report.contacts import open_end
    from obbcli.report.first_contact import first_contact_bare, first_contact_tables

    emit(record, first_contact_tables, common, bare=first_contact_bare)
    result = record["result"]
    if not result.get("contacts_complete", True):
        remark(f"{len(result['contacts'])} contacts are listed{open_end(result)}", common)
