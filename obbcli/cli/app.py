"""The `obbtree` command itself: its subcommands, imported when first named, and its help."""

from __future__ import annotations

from importlib import import_module

import click

from obbcli.cli.options.option import GuardedHelp
from obbcli.version import __version__

# Heading: the commands under it, and their modules here; in the order a newcomer meets them.
_GROUPS = {
    "Two bodies": {
        "collide": "collide",
        "first-contact": "first_contact",
        "distance": "distance",
        "overlap": "overlap",
        "clearance": "clearance",
        "intervals": "intervals",
        "range": "range",
    },
    "Many bodies, many motions": {"scene": "scene", "sweep": "sweep"},
    "How far answers can be trusted": {"tradeoff": "tradeoff", "stability": "stability"},
    "Pictures": {"view": "view"},
    "Files": {"build": "build", "info": "info", "schema": "schema"},
    "Reading": {"manual": "manual"},
}
_COMMANDS = {name: module for group in _GROUPS.values() for name, module in group.items()}

_WELCOME = """\
obbtree: do these two triangle meshes touch while they move, and when and where first?

  obbtree collide gear.stl shaft.obj
      do they touch, and which triangles?
  obbtree first-contact gear.stl pinion.stl --omega 0 0 3 --omega-b 0 0 -6
      when and where do they first touch, with proof that they do not before?
  obbtree scene cell.toml
      the same of many bodies, earliest first

obbtree --help lists all commands; obbtree COMMAND --help tells all of one;
obbtree manual lists what there is to read.
"""

_EPILOG = """\b
Examples:
  obbtree collide housing.stl board.vtk --exit-code && echo "it fits"
  obbtree first-contact gear.stl pinion.stl --omega 0 0 180 --degrees --duration 2
  obbtree distance part.stl clamp.obbt --json | jq .result.bounds

\b
Exit codes:
  0    answered, whatever the answer; with --exit-code: proven apart
  1    with --exit-code: they touch; of overlap: they overlap
  2    the command line is wrong
  3    an input cannot be read, or is refused
  4    unresolved, as a limit was reached; with --exit-code also: apart, but not proven so
  5    an output cannot be written
  6    tradeoff and stability: a guarantee of obbtree's own was seen broken
  70   an error of obbtree's own
  130  interrupted
"""


class _App(GuardedHelp, click.Group):
    """Imports a command's module only when that command is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002  # click's signature
        return list(_COMMANDS)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands, and then the few options that stand before them."""
        self.format_commands(ctx, formatter)
        click.Command.format_options(self, ctx, formatter)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands, one section a group, all in columns of one width."""
        width = max(map(len, _COMMANDS))
        for heading, names in _GROUPS.items():
            commands = [(name, self.get_command(ctx, name)) for name in names]
            with formatter.section(heading):
                formatter.write_dl(
                    [
                        (name.ljust(width), one.get_short_help_str(80))
                        for name, one in commands
                        if one
                    ]
                )

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in _COMMANDS:
            return super().get_command(ctx, cmd_name)
        module = import_module(f"obbcli.cli.commands.{_COMMANDS[cmd_name]}")
        command: click.Command = module.command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command; of a misspelt one say what it is nearest to."""
        if args and args[0] not in _COMMANDS and not args[0].startswith("-"):
            from obbcli.spelling import meant

            hint = meant(args[0], _COMMANDS)
            ctx.fail(f"No such command {args[0]!r}" + (f", {hint}" if hint else ""))
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
    subcommand_metavar="COMMAND ...",
    options_metavar="",
    epilog=_EPILOG,
)
@click.version_option(__version__, "-V", "--version", message="%(prog)s %(version)s")
@click.pass_context
def app(context: click.Context) -> int:
    """Do two triangle meshes touch while they move, and if so, when and where first?

    Answers are proven: apart means apart at every instant, and a time of contact is a bracket with
    no contact before it. What is not proven says so, and by how much it may be off.

    A, B and FILE are meshes (STL, OBJ, PLY, OFF, glTF, VTK, Gmsh, Abaqus and more), trees made of
    them by build (.obbt), or - for standard input. Lengths are in the meshes' own unit, times in
    s, angles in rad or, with --degrees, in degrees.
    """
    if context.invoked_subcommand is None:
        from obbcli.cli.output import write_stdout

        write_stdout(_WELCOME)
    return 0
