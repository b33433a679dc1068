"""`obbtree manual`: the pages that explain obbtree, of this very version."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.boundary import UsageError, stdout, writing_stdout
from obbcli.cli.options.option import Command, common_options
from obbcli.cli.output import write_file, write_stdout
from obbcli.manual import TOPICS, page, summary

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from obbcli.cli.options.option import CommonOptions

_WIDTH = max(map(len, TOPICS)) + 2


class _Topic(click.types.StringParamType):
    """The name of a topic; of an unknown one the error names the nearest."""

    name = "topic"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return the topic's name, which may come as that of its file."""
        topic = str(value).lower().removesuffix(".md")
        if topic not in TOPICS:
            from obbcli.spelling import nearest

            self.fail(f"there is no topic {value!r}: {nearest(topic, TOPICS)}", param, ctx)
        return topic

    def shell_complete(
        self,
        ctx: click.Context,  # noqa: ARG002  # click's signature
        param: click.Parameter,  # noqa: ARG002
        incomplete: str,
    ) -> list[CompletionItem]:
        """Return the topics that begin so, each with what it is about."""
        from click.shell_completion import CompletionItem

        return [
            CompletionItem(topic, help=summary(topic))
            for topic in TOPICS
            if topic.startswith(incomplete)
        ]


@click.command(
    "manual",
    cls=Command,
    short_help="What there is to read, page by page.",
    epilog="""\b
Examples:
  obbtree manual
  obbtree manual scenes
  obbtree manual options | less
""",
)
@click.argument("topic", metavar="[TOPIC]", required=False, type=_Topic())
@common_options("Write the Markdown text to FILE [default: standard output].")
def command(topic: str | None, common: CommonOptions) -> int:
    """Print a topic of the manual, or without TOPIC the list of all.

    A terminal gets the page laid out; a pipe or a file gets its Markdown text. With --quiet the
    list is the bare names. The manual is prose and has no JSON.
    """
    if common.json:
        raise UsageError(
            "obbtree manual --json",
            "the manual is prose and has no JSON document",
            "leave --json out; obbtree schema prints the JSON Schema",
        )
    text = _list(bare=common.quiet) if topic is None else page(topic)
    if common.output is not None:
        write_file(common.output, text)
    elif topic is None or common.quiet:
        write_stdout(text)
    else:
        from obbcli.report.prose import draw_page

        with writing_stdout():
            draw_page(text, stdout())
    return 0


def _list(*, bare: bool) -> str:
    """Return all topics, one a line."""
    if bare:
        return "".join(f"{topic}\n" for topic in TOPICS)
    lines = [f"{topic:{_WIDTH}}{summary(topic)}\n" for topic in TOPICS]
    return "".join(lines) + "\nobbtree manual TOPIC prints one.\n"
