"""Tables for people: plain data here, drawn by rich only when one is shown."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rich.console import Console
    from rich.table import Table as RichTable

# Lines of a file or a pipe are as long as they need to be; only a terminal has an edge.
_NO_EDGE = 1 << 16


@dataclass(frozen=True)
class Table:
    """A table to be drawn.

    Attributes:
        rows: cells; every row has as many as there are columns.
        columns: headings; None for a list of names and values without any.
        title: a line above; may be empty.
    """

    rows: Sequence[Sequence[str]]
    columns: Sequence[str] | None = None
    title: str = ""


def draw(tables: Iterable[Table], file: TextIO) -> None:
    """Write tables to a file, coloured and folded where it is a terminal.

    `NO_COLOR` is honoured.

    Raises:
        OSError: the file cannot be written.
    """
    from rich.console import Console

    console = Console(file=file, markup=False, highlight=False, emoji=False)
    if console.is_terminal:
        _draw_on(console, tables)
    else:
        text = io.StringIO()
        plain = Console(
            file=text, markup=False, highlight=False, emoji=False, width=_NO_EDGE, no_color=True,
            force_terminal=False,
        )  # fmt: skip
        _draw_on(plain, tables)
        file.writelines(line.rstrip() + "\n" for line in text.getvalue().splitlines())


def _draw_on(console: Console, tables: Iterable[Table]) -> None:
    """Draw the tables with an empty line between two."""
    for index, table in enumerate(tables):
        if index:
            console.print()
        if table.title:
            console.print(table.title, style="bold")
        console.print(_rich_table(table))


def _rich_table(table: Table) -> RichTable:
    """Return the rich table of the same cells: numbers flush right under headings."""
    from rich import box
    from rich.table import Table as RichTable

    if table.columns is None:
        drawn = RichTable(box=None, show_header=False, pad_edge=False)
        drawn.add_column(style="dim", no_wrap=True)
        drawn.add_column(overflow="fold")
    else:
        drawn = RichTable(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
        for index, heading in enumerate(table.columns):
            drawn.add_column(heading, justify="right" if index else "left", overflow="fold")
    for row in table.rows:
        drawn.add_row(*row)
    return drawn


def count(value: int) -> str:
    """Return a whole number with its thousands apart."""
    return f"{value:,}"


def length(value: float | None) -> str:
    """Return a length in mesh units, six digits of it."""
    return "beyond the largest double" if value is None else f"{value:.6g}"


def point(values: Sequence[float]) -> str:
    """Return coordinates, six digits each."""
    return " ".join(f"{value:.6g}" for value in values)


def seconds(value: float) -> str:
    """Return a time with a unit that suits it."""
    if value >= 1.0:
        return f"{value:.2f} s"
    return f"{value * 1e3:.2f} ms" if value >= 1e-3 else f"{value * 1e6:.0f} us"


def size(value: int) -> str:
    """Return a number of bytes with a unit that suits it."""
    number = float(value)
    for unit in ("B", "KiB", "MiB"):
        if number < 1024:
            return f"{number:.0f} B" if unit == "B" else f"{number:.1f} {unit}"
        number /= 1024
    return f"{number:.1f} GiB"
