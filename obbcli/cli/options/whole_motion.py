"""What commands that prove something of a whole motion have in common: what they refuse."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from obbcli.cli.boundary import UsageError

if TYPE_CHECKING:
    from obbcli.cli.options.two_bodies import TwoBodyOptions

CONCERNS = frozenset({"time_tolerance", "max_iterations", "timeout"})
"""The fields of `Accuracy` that say something of pieces of a motion."""


def refuse_what_says_nothing(asked: TwoBodyOptions, instead: str) -> None:
    """Refuse options that other questions know: to ignore them would make the answer a lie.

    Args:
        asked: the command line.
        instead: what to use in place of `--clearance`.

    Raises:
        UsageError: one is given.
    """
    for name in asked.accuracy.given():
        if name not in CONCERNS:
            fault, remedy = "says nothing about proven pieces of a motion", "leave it out"
            if name == "clearance":
                fault, remedy = "would mean two things here", instead
            raise UsageError("--" + name.replace("_", "-"), fault, remedy)


def hide_what_says_nothing(command: click.Command) -> None:
    """Keep options that are only known to be refused by name out of the help."""
    for param in command.params:
        if getattr(param, "group", "") == "Accuracy" and param.name not in CONCERNS:
            assert isinstance(param, click.Option)
            param.hidden = True
