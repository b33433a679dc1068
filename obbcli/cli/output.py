"""Where answers go: standard output or a file that is whole or not there."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from obbcli.cli.boundary import (
    CancelledError,
    OutputError,
    note,
    report,
    stdout,
    writing,
    writing_stdout,
)
from obbcli.files import write_whole

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from obbcli.cli.options.option import CommonOptions
    from obbcli.report.record import Record
    from obbcli.report.table import Table


def emit(
    record: Record,
    tables: Callable[[Record], Iterable[Table]],
    common: CommonOptions,
    bare: Callable[[Record], str] | None = None,
) -> None:
    """Write a record the way it was asked for.

    Args:
        record: the answer.
        tables: what turns it into tables.
        common: which way, and where to.
        bare: what turns it into the little that `--quiet` shows; None shows the tables.

    Raises:
        OutputError: it cannot be written.
    """
    if common.json:
        from obbcli.report.document import to_json

        text = to_json(record)
    elif common.quiet and bare is not None:
        text = bare(record)
    else:
        _draw(tables(record), common.output)
        return
    if common.output is None:
        write_stdout(text)
    else:
        write_file(common.output, text)


def remark(text: str, common: CommonOptions) -> None:
    """Write a note to stderr, unless nobody reads it: documents say the same in their fields."""
    if not (common.quiet or common.json):
        note(f"note: {text}")


def tell_interrupted(kept: str, common: CommonOptions) -> None:
    """Say of a command that Ctrl-C ended what its answer holds.

    As JSON this is an error as of every interrupted command, besides the document.
    """
    if common.json:
        report(CancelledError("", "interrupted", kept), as_json=True)
    else:
        remark(f"interrupted; {kept}", common)


def write_stdout(text: str) -> None:
    """Write text to standard output.

    Raises:
        OutputError: it is closed, or its disk is full.
    """
    with writing_stdout():
        stdout().write(text)


def write_pieces(pieces: Iterable[str]) -> None:
    """Write text to standard output as it comes, until there is no more or nobody reads it.

    Raises:
        OutputError: it is closed, or its disk is full.
    """
    for piece in pieces:
        is_read = False
        with writing_stdout():
            stdout().write(piece)
            stdout().flush()
            is_read = True
        if not is_read:
            return


def write_file(path: Path, text: str) -> None:
    """Write text to a file, whole or not at all.

    Raises:
        OutputError: it cannot be written.
    """
    with writing(path):
        write_whole(path, text.encode("utf-8", errors="backslashreplace"))


def require_free(target: Path, *, force: bool) -> None:
    """Refuse to replace a file unasked, and anything but a file at all.

    Raises:
        OutputError: it may not be written.
    """
    if target.exists() and not target.is_file():
        raise OutputError(str(target), "is not a file", "name a file with -o")
    if target.exists() and not force:
        raise OutputError(str(target), "exists already", "add --force to replace it")


def _draw(tables: Iterable[Table], path: Path | None) -> None:
    """Draw tables on standard output or into a file."""
    from obbcli.report.table import draw

    if path is not None:
        text = io.StringIO()
        draw(tables, text)
        write_file(path, text.getvalue())
        return
    with writing_stdout():
        draw(tables, stdout())
