"""`obbtree collide`: do two bodies touch, at rest or moving, and which triangles?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.boundary import UsageError
from obbcli.cli.options.option import Command, option
from obbcli.cli.options.two_bodies import (
    QUESTION,
    about_two,
    exit_code,
    naming_options,
    run,
    with_load_time,
)
from obbcli.cli.options.words import Whole, byte_count
from obbcli.cli.output import emit, remark, write_pieces
from obbcli.errors import UnresolvedError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy import int64
    from numpy.typing import NDArray

    from obbcli.answers.collision import Collision
    from obbcli.cli.inputs import Input
    from obbcli.cli.options.accuracy import AccuracyOptions
    from obbcli.cli.options.option import CommonOptions
    from obbcli.cli.options.placement import QuestionOptions
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.motion.body import Body
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.report.record import Record


# What a pair takes in a table or a document, and as an array on the way there.
_BYTES_A_PAIR = 512
_LINES = 10_000  # that are written at once


@click.command(
    "collide",
    cls=Command,
    short_help="Do two bodies touch, and which triangles?",
    epilog="""\b
Examples:
  obbtree collide gear.stl shaft.obj --translate-b 0 0 12.5
  obbtree collide part.stl clamp.obbt --all-pairs --limit 20
  obbtree collide robot.stl shelf.stl --vel 0 0 -50 --duration 3
  obbtree collide lid.stl box.stl --solid --relation
  obbtree collide a.stl b.stl --exit-code --quiet || echo "they touch"
""",
)
@option(QUESTION, "--all-pairs", is_flag=True, help="List every intersecting pair of triangles.")
@option(
    QUESTION,
    "--limit",
    type=Whole(1),
    metavar="N",
    help="With --all-pairs: list at most N pairs [default: all].",
)
@option(
    QUESTION,
    "--max-memory",
    callback=byte_count,
    metavar="BYTES",
    help="Refuse a list of pairs that needs more, such as 500M or 2G [default: no limit].",
)
@option(QUESTION, "--solid", is_flag=True, help="A body inside another is contact too.")
@option(
    QUESTION,
    "--relation",
    is_flag=True,
    help="With --solid, at rest: say whether they touch or overlap, and how deep.",
)
@about_two("Exit with 1 where they touch, 0 where proven apart, 4 where only sampled so.")
def command(asked: TwoBodyOptions, **flags: Any) -> int:
    """Do A and B touch, at rest or at any time of a motion? Touching counts; the answer is exact.

    A and B are mesh files or .obbt trees; one of them may be - for standard input. Triangles are
    named by their number in their file, from 0.
    """
    question = asked.question()
    _refuse_contradictions(question, asked.accuracy, flags)
    files = asked.read()
    with naming_options(question):
        record = _ask(asked, question, files, flags)
    if flags["all_pairs"] and _streams(asked.common, flags):
        write_pieces(_lines(question.pair(files).bodies))
    else:
        _show(record, asked.common)
    return exit_code(record["result"], asked=asked.exit_code)


def _streams(common: CommonOptions, flags: dict[str, Any]) -> bool:
    """Return whether pairs are written as they are found, and never held all at once."""
    return common.quiet and not common.json and common.output is None and flags["limit"] is None


def _refuse_contradictions(
    question: QuestionOptions, accuracy: AccuracyOptions, flags: dict[str, Any]
) -> None:
    """Refuse flags of which one would be ignored."""
    for name in ("limit", "max_memory"):
        if flags[name] is not None and not flags["all_pairs"]:
            option_name = "--" + name.replace("_", "-")
            raise UsageError(option_name, "is about the list of --all-pairs", "add --all-pairs")
    if flags["relation"]:
        _refuse_beside_relation(question, accuracy, is_solid=flags["solid"])
    if not flags["all_pairs"]:
        return
    if question.moves:
        remedy = "leave the motion out, or add --duration 0"
        raise UsageError("--all-pairs", "is asked of bodies at rest, at t = 0", remedy)
    for name, value in (
        ("--timeout", accuracy.given().get("timeout")),
        ("--max-iterations", accuracy.given().get("max_iterations")),
    ):
        if value is not None:
            fault = "would cut the list of --all-pairs at any place"
            raise UsageError(name, fault, "leave it out, or cut the list with --limit")
    if accuracy.given():
        fault = "lists triangles that intersect, always exactly"
        raise UsageError("--all-pairs", fault, "leave out the accuracy options")


def _refuse_beside_relation(
    question: QuestionOptions, accuracy: AccuracyOptions, *, is_solid: bool
) -> None:
    """Refuse what says nothing about how two solids at rest lie to each other."""
    from obbcli.questions.overlap.asked import CONCERNS

    if not is_solid:
        raise UsageError("--relation", "is asked of solids", "add --solid")
    if question.moves:
        remedy = "leave the motion out, or add --duration 0"
        raise UsageError("--relation", "is asked of bodies at rest, at t = 0", remedy)
    for name in accuracy.given():
        if name not in CONCERNS:
            fault = "says nothing about a relation"
            raise UsageError("--" + name.replace("_", "-"), fault, "leave out it or --relation")


def _ask(
    asked: TwoBodyOptions,
    question: QuestionOptions,
    files: tuple[Input, Input],
    flags: dict[str, Any],
) -> Record:
    """Put the question and return its record."""
    from obbcli.report.collide import collide_record

    pair = question.pair(files)
    answer = _answer(pair, solid=flags["solid"], progress=asked.common.shows_progress)
    pairs = None
    if flags["all_pairs"] and not _streams(asked.common, flags):
        pairs = _pairs(pair.bodies, flags["limit"], flags["max_memory"])
    record = collide_record(asked.setting(files, pair, flags["solid"]), answer, pairs)
    if flags["relation"]:
        from obbcli.questions.overlap.asked import Asked
        from obbcli.questions.overlap.overlap import overlap_of
        from obbcli.report.overlap import relation_part

        record["result"] |= relation_part(overlap_of(pair, Asked(has_volume=False)))
    return with_load_time(record, files)


def _answer(pair: PairQuestion, *, solid: bool, progress: bool) -> Collision:
    """Return what `obbcli.collide` says; a moving question can be watched and interrupted."""
    from obbcli.questions.collide import collide_pair, collision_of

    if pair.is_at_rest:
        return collide_pair(pair, solid=solid)
    from obbcli.questions.query import Query

    query = Query.about(pair, solid=solid, any_contact=True)
    return collision_of(run(query, pair.accuracy, progress=progress))


def _pairs(
    bodies: tuple[Body, Body], limit: int | None, max_memory: int | None
) -> tuple[NDArray[int64], bool]:
    """Return the intersecting pairs, at most `limit`, and whether these are all.

    Raises:
        UnresolvedError: their list needs more memory than allowed.
    """
    from obbcli.questions.triangle_pairs import triangle_pairs

    room = None if max_memory is None else max_memory // _BYTES_A_PAIR
    # One more than asked for tells whether the list was cut.
    most = min((n + 1 for n in (limit, room) if n is not None), default=None)
    pairs = triangle_pairs(*bodies, limit=most)
    if room is not None and len(pairs) > room:
        raise UnresolvedError(
            "--max-memory",
            f"the list of more than {room} pairs would need more than {max_memory} bytes",
            "allow more, cut the list with --limit, or write it with --quiet, which holds none",
        )
    return pairs[:limit], limit is None or len(pairs) <= limit


def _lines(bodies: tuple[Body, Body]) -> Iterator[str]:
    """Yield every intersecting pair, two numbers a line, thousands of lines at a time."""
    from obbcli.questions.triangle_pairs import triangle_pair_blocks

    for block in triangle_pair_blocks(*bodies):
        for start in range(0, len(block), _LINES):
            piece = block[start : start + _LINES].tolist()
            yield "".join(f"{i} {j}\n" for i, j in piece)


def _show(record: Record, common: CommonOptions) -> None:
    """Write the answer; a list that was cut says so."""
    from obbcli.report.collide import collide_bare, collide_tables

    result = record["result"]
    emit(record, collide_tables, common, bare=collide_bare)
    if not result.get("pairs_complete", True):
        remark(f"{len(result['pairs'])} pairs are listed, more exist; raise --limit", common)
