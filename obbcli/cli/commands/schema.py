"""`obbtree schema`: what scripts may count on in documents."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from obbcli.cli.options.option import Command, common_options
from obbcli.cli.output import write_file, write_stdout
from obbcli.report.schema import NAMES

if TYPE_CHECKING:
    from obbcli.cli.options.option import CommonOptions


@click.command(
    "schema",
    cls=Command,
    short_help="The JSON Schema of what commands print with --json.",
    epilog="""\b
Examples:
  obbtree schema first-contact
  obbtree schema -o obbtree.schema.json
""",
)
@click.argument("name", metavar="[COMMAND]", required=False, type=click.Choice(NAMES))
@common_options("Write the schema to FILE [default: standard output].")
def command(name: str | None, common: CommonOptions) -> int:
    """Print the JSON Schema (draft 2020-12) of a command's documents, or one of them all.

    COMMAND is build, collide, distance, first-contact, info, scene, stability, tradeoff or view; of
    a sweep there are three: sweep, the first line of its results, sweep-row, all others, and
    sweep-summary, what it prints; error is what any command writes to standard error.

    Keys keep their meaning as long as the number at the end of "schema" stays; new ones may come.
    """
    from obbcli.report.schema import schema_of, schema_of_all

    schema = schema_of_all() if name is None else schema_of(name)
    text = json.dumps(schema, indent=None if common.json else 2, allow_nan=False) + "\n"
    if common.output is None:
        write_stdout(text)
    else:
        write_file(common.output, text)
    return 0
