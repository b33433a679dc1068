"""Tables for people: aligned lines in files and pipes, drawn by rich on a terminal.

Both look alike. Lines cost nothing; rich folds and styles, and costs a third of NumPy's import.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, NamedTuple, TextIO

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rich.console import Console

# rich takes 0.2 ms a row, and nobody looks at the layout of a list this long.
_LONG = 1000
_GAP = "   "
# Names folded to fewer letters a line than this cannot be read.
_FOLDED = 12


class Table(NamedTuple):
    """A table to be drawn.

    Attributes:
        rows: cells; every row has as many as there are columns.
        columns: headings; None for a list of names and values without any.
        title: a line above; may be empty.
        name_count: how many columns hold names, flush left; the rest hold numbers, flush right.
    """

    rows: Sequence[Sequence[str]]
    columns: Sequence[str] | None = None
    title: str = ""
    name_count: int = 1


def draw(tables: Iterable[Table], file: TextIO) -> None:
    """Write tables to a file, styled and folded where it is a terminal.

    `NO_COLOR` and `FORCE_COLOR` are honoured.

    Raises:
        OSError: the file cannot be written.
    """
    console = _console(file) if file.isatty() or os.environ.get("FORCE_COLOR") else None
    for index, table in enumerate(tables):
        if index:
            file.write("\n")
        if console is None or len(table.rows) > _LONG:
            file.writelines(line.rstrip() + "\n" for line in _lines(table, file))
        elif not table.rows:
            console.print(table.title, style="bold")
        elif table.columns is None or _least_width(table) <= console.width:
            _draw_rich(table, console)
        else:
            # Too narrow for the numbers of one row side by side: a list a row.
            lists = [Table(list(zip(table.columns, row, strict=True))) for row in table.rows]
            draw([lists[0]._replace(title=table.title), *lists[1:]], file)


def _lines(table: Table, file: TextIO) -> Iterator[str]:
    """Yield a table's lines: names flush left, and numbers flush right under headings."""
    if table.title:
        yield table.title
    if not table.rows:
        return
    widths = _widths(table)
    if table.columns is None:
        for name, value in table.rows:
            yield f"{name}{' ' * (widths[0] - _width(name))}  {value}"
        return
    rule = "─" if (file.encoding or "utf-8").lower().startswith("utf") else "-"
    for number, row in enumerate((table.columns, *table.rows)):
        cells = []
        for index, cell in enumerate(row):
            space = " " * (widths[index] - _width(cell))
            cells.append(cell + space if index < table.name_count else space + cell)
        yield _GAP.join(cells)
        if number == 0:
            yield rule * (sum(widths) + len(_GAP) * (len(widths) - 1))


def _widths(table: Table) -> list[int]:
    """Return how many columns of a terminal each column takes."""
    rows = [*([table.columns] if table.columns else []), *table.rows]
    return [max(map(_width, cells)) for cells in zip(*rows, strict=True)]


def _least_width(table: Table) -> int:
    """Return what a table needs at least: numbers whole, names folded to a few letters."""
    widths = _widths(table)
    names = [min(width, _FOLDED) for width in widths[: table.name_count]]
    return sum(names) + sum(widths[table.name_count :]) + len(_GAP) * (len(widths) - 1)


def _width(text: str) -> int:
    """Return how many columns of a terminal a text takes: wide letters take two."""
    if text.isascii():
        return len(text)
    from unicodedata import combining, east_asian_width

    return sum(
        0 if combining(letter) else 2 if east_asian_width(letter) in "WF" else 1 for letter in text
    )


def _console(file: TextIO) -> Console:
    from rich.console import Console

    return Console(file=file, markup=False, highlight=False, emoji=False)


def _draw_rich(table: Table, console: Console) -> None:
    """Draw a table as `_lines` would, folded to the width of the terminal."""
    from rich import box
    from rich.table import Table as RichTable

    if table.title:
        console.print(table.title, style="bold")
    if table.columns is None:
        drawn = RichTable(box=None, show_header=False, pad_edge=False)
        drawn.add_column(style="dim", no_wrap=True)
        drawn.add_column(overflow="fold")
    else:
        drawn = RichTable(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
        for index, heading in enumerate(table.columns):
            is_name = index < table.name_count
            # Names fold where space is short; a folded number would be another number.
            drawn.add_column(
                heading,
                justify="left" if is_name else "right",
                overflow="fold",
                no_wrap=not is_name,
            )
    for row in table.rows:
        drawn.add_row(*row)
    console.print(drawn)


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
