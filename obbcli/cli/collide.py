"""`obbtree collide`: do two bodies touch, and which triangles?"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from obbcli import __version__
from obbcli.cli.boundary import ExitCode, UsageError, note
from obbcli.cli.inputs import read_pair
from obbcli.cli.options import Command, common_options, option, verify_option
from obbcli.cli.output import emit
from obbcli.cli.question import Question, accuracy_options, motion_options, pose_options

if TYPE_CHECKING:
    from numpy import int64
    from numpy.typing import NDArray

    from obbcli.cli.inputs import Input
    from obbcli.cli.options import CommonOptions
    from obbcli.cli.question import AccuracyOptions, MotionOptions, PoseOptions
    from obbcli.motion import Body
    from obbcli.report.record import Record
    from obbcli.results import Collision

_QUESTION = "Question"


@click.command(
    "collide",
    cls=Command,
    short_help="Do two bodies touch, and which triangles?",
    epilog="""\b
Examples:
  obbtree collide gear.stl shaft.obj --translate-b 0 0 12.5
  obbtree collide part.stl clamp.obbt --all-pairs --limit 20
  obbtree collide a.stl b.stl --exit-code --quiet || echo "they touch"
""",
)
@click.argument("a", metavar="A")
@click.argument("b", metavar="B")
@option(_QUESTION, "--all-pairs", is_flag=True, help="List every intersecting pair of triangles.")
@option(
    _QUESTION,
    "--limit",
    type=click.IntRange(min=1),
    metavar="N",
    help="List at most N pairs (with --all-pairs).",
)
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
    """Do A and B touch? Touching counts; the answer is exact.

    A and B are mesh files or .obbt trees; one of them may be - for standard input. Triangles are
    named by their number in their file, from 0.
    """
    _refuse_contradictions(accuracy, flags)
    question = Question.of(pose, motion, accuracy)
    _refuse_unanswered(question, solid=flags["solid"])
    files = read_pair(a, b, verify=not flags["no_verify"], progress=common.shows_progress)
    record = _ask(question, files, flags, detailed=common.json)
    _show(record, common)
    return _exit_code(record["result"]["status"], asked=flags["exit_code"])


def _refuse_contradictions(accuracy: AccuracyOptions, flags: dict[str, Any]) -> None:
    """Refuse flags of which one would be ignored."""
    if flags["limit"] is not None and not flags["all_pairs"]:
        raise UsageError("--limit", "cuts the list of --all-pairs", "add --all-pairs")
    if flags["all_pairs"] and accuracy.given():
        raise UsageError("--all-pairs", "is always exact", "leave out the accuracy options")


def _refuse_unanswered(question: Question, *, solid: bool) -> None:
    """Refuse what this version cannot answer: to ignore it would make the answer a lie."""
    accuracy = question.accuracy
    unanswered = (
        ("--vel, --omega", question.moves, "leave them out, or ask about t = 0 by --duration 0"),
        ("--solid", solid, "leave it out to ask about the surfaces"),
        ("--method sampled", accuracy.method == "sampled", "leave it out"),
        ("--clearance", accuracy.clearance > 0, "leave it out to ask about contact"),
    )
    for what, is_asked, remedy in unanswered:
        if is_asked:
            raise UsageError(what, f"not answered by version {__version__} yet", remedy)


def _ask(
    question: Question, files: tuple[Input, Input], flags: dict[str, Any], *, detailed: bool
) -> Record:
    """Put the question and return its record; `detailed` adds what only a document shows."""
    from obbcli.query import collide
    from obbcli.report.collide import collide_record
    from obbcli.report.record import motion_part

    bodies = question.bodies(files)
    answer = collide(*bodies, question.duration, question.accuracy)
    return collide_record(
        [file.source(with_sha256=detailed) for file in files],
        motion_part(bodies, question.duration) if detailed else {},
        question.accuracy,
        _with_load_time(answer, sum(file.seconds for file in files)),
        _pairs(bodies, flags["limit"]) if flags["all_pairs"] else None,
    )


def _with_load_time(answer: Collision, load: float) -> Collision:
    """Return the answer with the time that the files took: they were read before the question."""
    seconds = {**answer.stats.seconds, "load": load}
    return replace(answer, stats=answer.stats._replace(seconds=seconds))


def _pairs(bodies: tuple[Body, Body], limit: int | None) -> tuple[NDArray[int64], bool]:
    """Return the intersecting pairs, at most `limit`, and whether these are all."""
    from obbcli.query import triangle_pairs

    # One more than asked for tells whether the list was cut.
    pairs = triangle_pairs(*bodies, limit=None if limit is None else limit + 1)
    return pairs[:limit], limit is None or len(pairs) <= limit


def _show(record: Record, common: CommonOptions) -> None:
    """Write the answer; a list that was cut says so."""
    from obbcli.report.collide import collide_bare, collide_tables

    result = record["result"]
    emit(record, collide_tables, common, bare=collide_bare)
    if not (result.get("pairs_complete", True) or common.quiet):
        note(f"note: {len(result['pairs'])} pairs are listed, more exist; raise --limit")


def _exit_code(status: str, *, asked: bool) -> int:
    """Return the exit code of an answer."""
    if status == "unresolved":
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and status != "separated" else ExitCode.ANSWERED
