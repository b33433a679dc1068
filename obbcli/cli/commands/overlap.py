"""`obbtree overlap`: do two solids touch or overlap, and how deep?"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.boundary import ExitCode, UsageError, usage_errors
from obbcli.cli.options.option import Command, option
from obbcli.cli.options.two_bodies import (
    QUESTION,
    about_two,
    naming_options,
    refuse_what_moves,
    with_load_time,
)
from obbcli.cli.options.unused import hide_motion, hide_unused, refuse_unused
from obbcli.cli.options.words import Finite, PathName
from obbcli.cli.output import emit
from obbcli.cli.shared_mesh import check_mesh_file, require_solids, write_shared_mesh

if TYPE_CHECKING:
    from obbcli.cli.inputs import Input
    from obbcli.cli.options.placement import QuestionOptions
    from obbcli.cli.options.two_bodies import TwoBodyOptions
    from obbcli.questions.overlap.asked import Asked
    from obbcli.report.record import Record

# The fields of `Accuracy` that say something here; those of `obbcli.questions.overlap.asked`, which
# is not imported for help.
_CONCERNS = frozenset({"clearance", "max_iterations", "timeout"})


@click.command(
    "overlap",
    cls=Command,
    short_help="Do two solids touch or overlap, and how deep?",
    epilog="""\b
Examples:
  obbtree overlap pin.stl plate.stl
  obbtree overlap lid.stl box.stl --deeper-than 0.1 --exit-code --quiet
  obbtree overlap bolt.ply nut.obj --translate-b 0 0 0.1 --along 0 0 1 --json
""",
)
@option(
    QUESTION,
    "--tolerance",
    type=Finite(0.0),
    metavar="E",
    help="Relative width of brackets, never below 1e-9 sizes, in mesh units [default: 0.01].",
)
@option(
    QUESTION,
    "--deeper-than",
    type=Finite(0.0),
    metavar="O",
    help="Ask whether a depth exceeds O, in mesh units [default: ask for values].",
)
@option(
    QUESTION,
    "--touch",
    nargs=2,
    type=Finite(0.0),
    metavar="GAP OVERLAP",
    help="What still counts as touching, in mesh units [default: the files' own rounding].",
)
@option(
    QUESTION,
    "--along",
    nargs=3,
    type=Finite(),
    metavar="X Y Z",
    help="Ask how far, in mesh units, A has to go this way to be free for good [default: do not].",
)
@option(QUESTION, "--regions", is_flag=True, help="Ask for the parts of what both share.")
@option(
    QUESTION,
    "--resolution",
    type=Finite(0.0),
    metavar="R",
    help="With --regions: told apart by boxes of at most R, in mesh units [default: by size].",
)
@option(
    QUESTION,
    "--mesh",
    type=PathName(),
    metavar="FILE",
    help="Write what both share into a .glb FILE, by manifold3d, not proven [default: do not].",
)
@about_two("Exit with 1 where they overlap, or are deeper than O; 0 where not.")
def command(asked: TwoBodyOptions, **flags: Any) -> int:
    """Do A and B, as solids, touch or overlap, and how deep is one in the other?

    A and B are mesh files or .obbt trees; one of them may be - for standard input. The relation is
    one of clear, near, touching, overlapping, contained, duplicate, crossing and unresolved; every
    number is a proven bracket. Surfaces that do not close have no depths.
    """
    from obbcli.report.overlap import overlap_bare, overlap_tables

    refuse_what_says_nothing(asked)
    question = asked.question()
    mesh_file = flags.pop("mesh")
    if mesh_file is not None:
        check_mesh_file(mesh_file, asked.common.output, (asked.a, asked.b))
    wanted = _wanted(flags)
    files = asked.read()
    with naming_options(question):
        record = _ask(asked, question, files, wanted, mesh_file)
    emit(record, overlap_tables, asked.common, bare=overlap_bare)
    limit = record["asked"]["deeper_than"]
    return overlap_exit_code(record["result"], asked=asked.exit_code, limit=limit)


def refuse_what_says_nothing(asked: TwoBodyOptions) -> None:
    """Refuse options that other questions know: to ignore them would make the answer a lie."""
    refuse_what_moves(asked.motion, "overlap")
    refuse_unused(asked.accuracy.given(), _CONCERNS, "an overlap")


def _wanted(flags: dict[str, Any]) -> Asked:
    """Return what is asked about the overlap.

    Raises:
        UsageError: a number is refused.
    """
    from obbcli.questions.overlap.asked import Asked

    resolution = flags.pop("resolution")
    if resolution is not None and not flags["regions"]:
        raise UsageError("--resolution", "is that of --regions", "add --regions, or leave it out")
    flags["regions"] = (resolution or flags["regions"]) if resolution != 0 else 0.0
    given = {name: value for name, value in flags.items() if value is not None}
    with usage_errors(tolerance="--tolerance", along="--along", touch="--touch"):
        return Asked.of(**given)


def _ask(
    asked: TwoBodyOptions,
    question: QuestionOptions,
    files: tuple[Input, Input],
    wanted: Asked,
    mesh_file: str | None,
) -> Record:
    """Put the question, write the mesh that is asked for, and return the record."""
    from obbcli.questions.overlap.overlap import overlap_of
    from obbcli.report.overlap import overlap_record

    pair = question.pair(files)
    if mesh_file is not None:
        require_solids(pair)
    answer = overlap_of(pair, wanted)
    record = overlap_record(asked.setting(files, pair), wanted, answer)
    if mesh_file is not None:
        record["result"]["mesh"] = write_shared_mesh(mesh_file, pair, answer)
    return with_load_time(record, files)


def overlap_exit_code(result: Record, *, asked: bool, limit: float | None = None) -> int:
    """Return the exit code of an answer.

    Args:
        result: of the record.
        asked: whether overlap has a code of its own.
        limit: mesh units; whether a depth exceeds it was asked. None: it was not.
    """
    from obbcli.answers.overlap import MEETING

    if limit is None:
        is_open, is_deep = result["relation"] == "unresolved", result["relation"] in MEETING
    else:
        is_open, is_deep = result["deeper"] is None, bool(result["deeper"])
    if is_open:
        return ExitCode.UNRESOLVED
    return ExitCode.CONTACT if asked and is_deep else ExitCode.ANSWERED


def _tell_of_clearance() -> None:
    """Say in the help what a clearance means here: it is asked about otherwise elsewhere."""
    for param in command.params:
        if param.name == "clearance":
            assert isinstance(param, click.Option)
            param.help = "Bodies no further apart are near, in mesh units [default: 0]."


_tell_of_clearance()
hide_unused(command, _CONCERNS)
hide_motion(command)
