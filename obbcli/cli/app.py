"""The `obbtree` command itself: its subcommands, imported when first named, and its help."""

from __future__ import annotations

from importlib import import_module

import click

from obbcli import __version__
from obbcli.cli.options import GuardedHelp

# Name: module of this package; in the order a newcomer meets them.
_COMMANDS = {
    "collide": "collide",
    "first-contact": "first_contact",
    "distance": "distance",
    "scene": "scene",
    "sweep": "sweep",
    "stability": "stability",
    "tradeoff": "tradeoff",
    "build": "build",
    "info": "info",
    "schema": "schema",
}

_WELCOME = """\
obbtree: do these two triangle meshes touch, and when first?

  obbtree collide gear.stl shaft.obj     do they touch, and which triangles?
  obbtree first-contact gear.stl pinion.stl --omega 0 0 3 --omega-b 0 0 -6
                                         when and where do they first touch?
  obbtree distance gear.stl shaft.obj    how far apart are they, and where?
  obbtree scene cell.toml                the same of many bodies, earliest first
  obbtree sweep gear.stl pinion.stl motions.csv -o contacts.jsonl
                                         first-contact, once a row of a file
  obbtree stability gear.stl pinion.stl --omega 0 0 3
                                         which answers hold at the extremes?
  obbtree tradeoff gear.stl pinion.stl --omega 0 0 3
                                         what speed costs in accuracy, measured
  obbtree info gear.stl                  what is in a mesh or tree file
  obbtree build gear.stl                 keep the tree for later: gear.obbt

Any command with --help tells the rest; obbtree --help lists all commands.
"""


class _App(GuardedHelp, click.Group):
    """Imports a command's module only when that command is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002  # click's signature
        return list(_COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in _COMMANDS:
            return super().get_command(ctx, cmd_name)
        module = import_module(f"obbcli.cli.{_COMMANDS[cmd_name]}")
        command: click.Command = module.command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command; of a misspelt one say what it is nearest to."""
        if args and args[0] not in _COMMANDS and not args[0].startswith("-"):
            from difflib import get_close_matches

            near = get_close_matches(args[0], _COMMANDS, n=1)
            hint = f", did you mean '{near[0]}'?" if near else ""
            ctx.fail(f"No such command {args[0]!r}{hint}")
        return super().resolve_command(ctx, args)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the words before the command's name; options of commands belong after it."""
        try:
            return super().parse_args(ctx, args)
        except click.NoSuchOption as fault:
            name = next((word for word in args if word in _COMMANDS), "COMMAND")
            known = {option for n in _COMMANDS for option in _options(self, ctx, n)}
            if fault.option_name not in known:
                raise
            place = f"belongs after the command: obbtree {name} {fault.option_name}"
            raise click.UsageError(f"{fault.option_name} {place}", ctx) from fault


def _options(app: click.Group, context: click.Context, name: str) -> list[str]:
    """Return the options of a command."""
    command = app.get_command(context, name)
    assert command is not None
    return [option for param in command.params for option in param.opts]


@click.group(
    cls=_App,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, "-V", "--version", message="%(prog)s %(version)s")
@click.pass_context
def app(context: click.Context) -> int:
    """Do two triangle meshes touch, and when and where first? Proven answers from any mesh files.

    Meshes: STL, OBJ, PLY, OFF, glTF, VTK, Gmsh, Abaqus and more; trees: .obbt, made by build.
    Lengths are in the meshes' own unit, angles in radians unless --degrees is given.
    """
    if context.invoked_subcommand is None:
        from obbcli.cli.output import write_stdout

        write_stdout(_WELCOME)
    return 0
