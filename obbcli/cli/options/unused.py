"""Options of accuracy that a question has no use for: refused by name, and not in its help."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from obbcli.cli.boundary import UsageError

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

WHOLE_MOTION = frozenset({"time_tolerance", "max_iterations", "timeout"})
"""The fields of `Accuracy` that say something of pieces of a motion."""


def refuse_unused(
    given: Iterable[str], concerns: Collection[str], about: str, clearance: str | None = None
) -> None:
    """Refuse options of accuracy that say nothing here: to ignore them would make the answer a lie.

    Args:
        given: the fields of `Accuracy` that the command line names.
        concerns: those that say something.
        about: what the others say nothing about.
        clearance: where `--clearance` would mean two things, what to do instead.

    Raises:
        UsageError: one is given.
    """
    for name in given:
        if name not in concerns:
            fault, remedy = f"says nothing about {about}", "leave it out"
            if name == "clearance" and clearance is not None:
                fault, remedy = "would mean two things here", clearance
            raise UsageError("--" + name.replace("_", "-"), fault, remedy)


def hide_unused(command: click.Command, concerns: Collection[str]) -> None:
    """Keep options of accuracy that are only known to be refused by name out of the help."""
    for param in command.params:
        if getattr(param, "group", "") == "Accuracy" and param.name not in concerns:
            _hide(param)


def hide_motion(command: click.Command) -> None:
    """Keep options of motions that are only known to be refused by name out of the help."""
    for param in command.params:
        if getattr(param, "group", "") == "Motion":
            _hide(param)


def _hide(param: click.Parameter) -> None:
    assert isinstance(param, click.Option)
    param.hidden = True
