"""How options are made here: typed, grouped in the help, gathered into one value a group.

`@gathered("pose", PoseOptions, ...)` gives the command a `pose=PoseOptions(...)`: signatures name
groups and not thirty options.
"""

from __future__ import annotations

import functools
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import click

from obbcli.cli.boundary import stdout, writing_stdout
from obbcli.cli.options.words import Finite, PathName, spelt_out

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    Decorator: TypeAlias = Callable[[Callable[..., Any]], Callable[..., Any]]


_COMMON = "Common"
TO_FILE = "Write the answer to FILE [default: standard output]."
"""What `-o` does."""


class GroupedOption(click.Option):
    """An option that `--help` lists under a heading."""

    def __init__(self, *args: Any, group: str, **attributes: Any) -> None:
        super().__init__(*args, **attributes)
        self.group = group

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        """Return names and text, a default within the last sentence wherever it was given."""
        record = super().get_help_record(ctx)
        return record and (record[0], re.sub(r"\.  (\[default: .*\])$", r" \1.", record[1]))


class GuardedHelp(click.Command):
    """Prints help and version, which happens while parsing, inside the guard of standard output.

    A command line that cannot be parsed is told with the command's own help.
    """

    def make_context(self, *args: Any, **extra: Any) -> click.Context:
        """Parse; a pipe closed while help was printed ends the command.

        Raises:
            OutputError: help is asked for, and standard output is closed or its disk full.
        """
        with writing_stdout():
            try:
                return super().make_context(*args, **extra)
            except click.exceptions.Exit:
                stdout()  # click prints nothing where there is none
                raise
        raise click.exceptions.Exit(0)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the words of a command line.

        Raises:
            UsageError: they cannot be parsed; it knows the command, which click's parser leaves out
                where words are missing.
        """
        try:
            return super().parse_args(ctx, args)
        except click.UsageError as fault:
            fault.ctx = fault.ctx or ctx
            raise


class Command(GuardedHelp):
    """A command whose help lists options by group; three numbers may be one word."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the words of a command line, `--vel 1,0,0` as `--vel 1 0 0`."""
        vectors = {name: param for param in self.params if _is_vector(param) for name in param.opts}
        return super().parse_args(ctx, list(_with_vectors(ctx, vectors, args)))

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options, one section a group, in the order of their first options."""
        groups: dict[str, list[tuple[str, str]]] = {}
        for param in self.get_params(ctx):
            # Arguments stand in the usage line and in the text above.
            record = param.get_help_record(ctx) if isinstance(param, click.Option) else None
            if record is not None:
                groups.setdefault(getattr(param, "group", _COMMON), []).append(record)
        for group, records in groups.items():
            with formatter.section(group):
                formatter.write_dl(records)


_COORDINATES = 3


def _is_vector(param: click.Parameter) -> bool:
    """Return whether an option takes three numbers."""
    is_option = isinstance(param, click.Option)
    return is_option and param.nargs == _COORDINATES and isinstance(param.type, Finite)


def _with_vectors(
    ctx: click.Context, vectors: Mapping[str, click.Parameter], args: Sequence[str]
) -> Iterator[str]:
    """Yield the words of a command line, each vector that is one word as three.

    Raises:
        BadParameter: such a word does not hold exactly three numbers.
    """
    words = iter(args)
    for word in words:
        name, equals, value = word.partition("=")
        if word == "--":  # what follows names files
            yield from (word, *words)
        elif name in vectors:
            first = value if equals else next(words, None)
            yield name
            if first is not None:  # else click says how many numbers are missing
                yield from _numbers(ctx, vectors[name], first)
        else:
            yield word


def _numbers(ctx: click.Context, param: click.Parameter, first: str) -> list[str]:
    """Return the words that the first word after a vector's name stands for: one, or all three."""
    numbers = spelt_out(first)
    if len(numbers) == _COORDINATES and all(numbers):
        return numbers
    if len(numbers) > 1 and not ctx.resilient_parsing:
        name = param.opts[0]
        fault = f"{first!r} is not three numbers; write {name} X Y Z or {name} X,Y,Z"
        raise click.BadParameter(fault, ctx, param)
    return [first]


def option(group: str, *names: str, **attributes: Any) -> Decorator:
    """Return a click option that belongs to a group of the help."""
    return click.option(*names, cls=GroupedOption, group=group, **attributes)


def vector(group: str, name: str, text: str) -> Decorator:
    """Return an option of three finite numbers; negative ones and exponents are numbers too."""
    whole = text if "[default:" in text else f"{text.removesuffix('.')} [default: 0 0 0]."
    return option(group, name, nargs=3, type=Finite(), metavar="X Y Z", help=whole)


def gathered(name: str, cls: Callable[..., Any], options: tuple[Decorator, ...]) -> Decorator:
    """Return a decorator that adds options and passes them on as one value of `cls`.

    `cls` is a named tuple, or has its `_fields`: a dataclass costs half a millisecond of every
    command's start.
    """
    fields: tuple[str, ...] = cls._fields  # type: ignore[attr-defined]

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(command)
        def run(**values: Any) -> Any:
            own = {field: values.pop(field) for field in fields}
            return command(**values, **{name: cls(**own)})

        wrapped: Callable[..., Any] = run
        for add in reversed(options):
            wrapped = add(wrapped)
        return wrapped

    return decorate


class CommonOptions(NamedTuple):
    """How a command answers, whatever it is asked."""

    json: bool
    quiet: bool
    no_progress: bool
    output: Path | None

    @property
    def shows_progress(self) -> bool:
        """Return whether bars may be drawn at all; they also need a terminal."""
        return not (self.quiet or self.no_progress)


def _path(_context: click.Context, _param: click.Parameter, name: str | None) -> Path | None:
    """Return where an answer goes; `-` is standard output, as if nothing had been said."""
    return None if name in (None, "-") else Path(name)


def _place(context: click.Context, param: click.Parameter, name: str | None) -> Path | None:
    """Return where files go, which are not written to standard output."""
    if name == "-":
        raise click.BadParameter("this goes to a file, not to standard output", context, param)
    return None if name is None else Path(name)


def common_options(
    output: str = TO_FILE,
    *,
    metavar: str = "FILE",
    takes_dash: bool = True,
) -> Decorator:
    """Return the options of every command.

    Args:
        output: the help of `-o`.
        metavar: what it calls its value.
        takes_dash: whether `-` means standard output there.
    """
    return gathered(
        "common",
        CommonOptions,
        (
            option(
                _COMMON,
                "-o",
                "--output",
                type=PathName(),
                callback=_path if takes_dash else _place,
                metavar=metavar,
                help=output,
            ),
            option(_COMMON, "--json", is_flag=True, help="Answer with one JSON document."),
            option(_COMMON, "-q", "--quiet", is_flag=True, help="The bare answer, no notes."),
            option(_COMMON, "--no-progress", is_flag=True, help="Draw no progress bar."),
            option(
                _COMMON,
                "--debug",
                is_flag=True,
                expose_value=False,
                help="Show the traceback of an error.",
            ),
        ),
    )


verify_option = option(
    _COMMON,
    "--no-verify",
    is_flag=True,
    help="Skip the checksums of tree files; their structure is checked all the same.",
)
