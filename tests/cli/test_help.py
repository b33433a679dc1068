"""Help tells what a reader needs: units, defaults, an example a command, and what comes out."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import click

from obbcli.cli.app import app
from obbcli.cli.boundary import ExitCode

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

COMMANDS = app.list_commands(click.Context(app))
UNITS = re.compile(r"mesh units|\brad\b|\bs\b|seconds|bytes|pixels|[Ll]evel \w|\bN\b|max-depth")


def options() -> Iterator[tuple[str, click.Option, str]]:
    """Yield every option of every command that takes a value, and what help says of it."""
    for name in COMMANDS:
        command = app.get_command(click.Context(app), name)
        assert command is not None
        context = click.Context(command, info_name=name)
        for param in command.get_params(context):
            if isinstance(param, click.Option) and not (param.is_flag or param.hidden):
                record = param.get_help_record(context)
                assert record is not None
                yield f"{name} {param.opts[0]}", param, record[1]


def test_options_of_numbers_tell_their_unit() -> None:
    numbers = (click.types.FloatParamType, click.types.IntParamType)
    told = [(name, text) for name, param, text in options() if isinstance(param.type, numbers)]

    assert told
    assert [(name, text) for name, text in told if not UNITS.search(text)] == []


def test_options_tell_what_holds_without_them() -> None:
    # Of a file, address or node that nobody names there is nothing to say.
    told = [
        (name, text)
        for name, param, text in options()
        if param.opts[0] not in {"--plot", "--scheduler"} and "required" not in text
    ]

    assert told
    assert [(name, text) for name, text in told if "[default: " not in text] == []


def test_no_arguments_show_three_commands(obbtree: Callable[..., Any]) -> None:
    shown = re.findall(r"^  obbtree (\S+)", obbtree().out, re.MULTILINE)
    assert shown == ["collide", "first-contact", "scene"]


def test_commands_stand_in_groups(obbtree: Callable[..., Any]) -> None:
    out = obbtree("--help").out
    before = out.partition("\nOptions:\n")[0]
    headings = re.findall(r"^(\w.*):$", before, re.MULTILINE)
    assert headings[0] == "Two bodies"
    assert len(headings) > 3
    assert all(f"\n  {name} " in before for name in COMMANDS)


def test_exit_codes_are_told(obbtree: Callable[..., Any]) -> None:
    listed = obbtree("--help").out.partition("Exit codes:\n")[2]
    assert re.findall(r"^ +(\d+) ", listed, re.MULTILINE) == [str(int(code)) for code in ExitCode]


def test_short_help_fits_a_line(obbtree: Callable[..., Any]) -> None:
    listed = obbtree("--help").out.partition("\nOptions:\n")[0]
    assert all(len(line) <= 80 for line in listed.splitlines())
    assert listed.count("\n  ") >= len(COMMANDS)
