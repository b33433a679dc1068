"""`obbtree first-contact`: when and where do two moving bodies first touch?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.asking import exit_code, naming_options, refuse_unanswered, run, with_load_time
from obbcli.cli.inputs import keep_inputs, read_pair
from obbcli.cli.options import Command, common_options, option, verify_option
from obbcli.cli.output import emit
from obbcli.cli.question import Question, accuracy_options, motion_options, pose_options
from obbcli.cli.types import PathName, Whole

if TYPE_CHECKING:
    from obbcli.cli.inputs import Input
    from obbcli.cli.options import CommonOptions
    from obbcli.cli.question import AccuracyOptions, MotionOptions, PoseOptions
    from obbcli.report.record import Record

_QUESTION = "Question"


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
@click.argument("a", metavar="A", type=PathName())
@click.argument("b", metavar="B", type=PathName())
@option(_QUESTION, "--all-contacts", is_flag=True, help="List every pair of triangles that meets.")
@option(_QUESTION, "--limit", type=Whole(1), metavar="N", help="List N at most.")
@option(_QUESTION, "--solid", is_flag=True, help="A body inside another is contact too.")
@option(
    _QUESTION,
    "--exit-code",
    is_flag=True,
    help="Exit with 1 where they touch, 0 where they are proven apart.",
)
@pose_options
@motion_options
@accuracy_options
@verify_option
@common_options()
def command(
    a: str,
    b: str,
    pose: PoseOptions,
    motion: MotionOptions,
    accuracy: AccuracyOptions,
    common: CommonOptions,
    **flags: Any,
) -> int:
    """When do A and B first touch as they move, where, and with which triangles?

    A and B are mesh files or .obbt trees; one of them may be - for standard input. The time comes
    as a bracket: no contact before its lower end, which is proven, and contact at its upper end.
    Ctrl-C says up to when contact is ruled out.
    """
    from obbcli.report.first_contact import first_contact_bare, first_contact_tables

    question = Question.of(pose, motion, accuracy)
    # The contract's options of later versions: known, and refused by name.
    refuse_unanswered(
        (
            ("--all-contacts", flags["all_contacts"], "leave it out to ask about the first"),
            ("--limit", flags["limit"] is not None, "leave it out to ask about the first"),
            ("--method sampled", question.accuracy.method == "sampled", "leave it out"),
        )
    )
    keep_inputs(common.output, (a, b))
    files = read_pair(a, b, verify=not flags["no_verify"], progress=common.shows_progress)
    with naming_options(question):
        record = _ask(question, files, flags, common)
    emit(record, first_contact_tables, common, bare=first_contact_bare)
    return exit_code(record["result"]["status"], asked=flags["exit_code"])


def _ask(
    question: Question,
    files: tuple[Input, Input],
    flags: dict[str, Any],
    common: CommonOptions,
) -> Record:
    """Put the question and return its record."""
    from obbcli.contact import Query
    from obbcli.report.first_contact import first_contact_record
    from obbcli.report.record import motion_part

    bodies = question.bodies(files)
    query = Query(*bodies, question.duration, question.accuracy, solid=flags["solid"])
    answer = run(query, question.accuracy, progress=common.shows_progress)
    # Hashes and centroids cost time, and only a document shows them.
    record = first_contact_record(
        [file.source(with_sha256=common.json) for file in files],
        motion_part(bodies, question.duration) if common.json else {},
        question.accuracy,
        answer,
        flags["solid"],
    )
    return with_load_time(record, files)
