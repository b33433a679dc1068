"""The one error boundary: every fault becomes one line (or one JSON object) and an exit code."""

from __future__ import annotations

import io
import os
import sys
from contextlib import contextmanager
from enum import IntEnum
from typing import TYPE_CHECKING, TextIO

import click

from obbcli.cli.process import SIGNALS
from obbcli.errors import MotionError, ObbError, UnresolvedError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence


class ExitCode(IntEnum):
    """What a command's end says to the shell; of several that apply the highest wins."""

    ANSWERED = 0
    CONTACT = 1
    USAGE = 2
    INPUT = 3
    UNRESOLVED = 4
    OUTPUT = 5
    BROKEN = 6
    INTERNAL = 70
    INTERRUPTED = 130


class OutputError(ObbError):
    """An output cannot be written."""


class UsageError(ObbError):
    """The command line asks for what cannot be asked."""


class InternalError(ObbError):
    """A fault of the tool itself."""


class CancelledError(ObbError):
    """Ctrl-C."""


@contextmanager
def usage_errors(**options: str) -> Iterator[None]:
    """Turn a refused number into a usage error: what is typed on a command line is usage.

    Args:
        options: the options that arguments are given by, by the names of the arguments.
    """
    try:
        yield
    except MotionError as fault:
        where = options.get(fault.where, fault.where)
        raise UsageError(where, fault.fault, fault.remedy) from fault


def guarded(command: Callable[[], int], words: Sequence[str]) -> int:
    """Run a command, report whatever it raises, and return the exit code.

    Args:
        command: returns its exit code.
        words: the command line: `--json` shapes errors, `--debug` adds a traceback.
    """
    try:
        SIGNALS.are_heard = True
        code = command()
        with writing_stdout():
            if sys.stdout is not None:
                sys.stdout.flush()
        SIGNALS.are_heard = False
    except click.exceptions.Exit as end:
        SIGNALS.are_heard = False
        return end.exit_code
    except (Exception, KeyboardInterrupt) as fault:  # noqa: BLE001  # the boundary
        SIGNALS.are_heard = False
        trace = None
        if is_among("--debug", words):
            # Imported where faults are rare, like all that only faults need: start-up counts.
            import traceback

            trace = "".join(traceback.format_exception(fault))
        return report(as_error(fault), as_json=is_among("--json", words), trace=trace)
    return code


def is_among(flag: str, words: Sequence[str]) -> bool:
    """Return whether a flag stands on a command line, be it that the line cannot be parsed.

    What cannot be parsed is told by its words alone: an option that misses a value may have taken
    the flag for one. After `--` stand names of files.
    """
    return flag in (words[: words.index("--")] if "--" in words else words)


def report(error: ObbError, *, as_json: bool, trace: str | None = None) -> ExitCode:
    """Write an error to stderr, as one line or as one JSON object, and return its exit code.

    Args:
        error: what is told.
        as_json: which of the two.
        trace: the traceback, where it was asked for.
    """
    code = exit_code(error)
    if as_json:
        from obbcli.report.document import to_json
        from obbcli.report.record import error_document

        note(to_json(error_document(error, int(code), trace)).rstrip())
    else:
        told = str(error).removeprefix(": ")  # what has no place
        note(f"{trace or ''}error: {_in_one_line(told)}")
    return code


def _in_one_line(text: str) -> str:
    """Return a text with the line ends and control characters in names of files escaped."""
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode()
        for letter in text
    )


def note(text: str) -> None:
    """Write one line to stderr; that nobody can read it is no fault."""
    if sys.stderr is None:
        return
    try:
        print(text, file=sys.stderr, flush=True)  # noqa: T201  # the one place that does
    except OSError:
        # Its reader has gone away, or its disk is full: there is nowhere to tell it.
        _silence(sys.stderr)


def exit_code(error: ObbError) -> ExitCode:
    """Return the exit code of an error."""
    codes = (
        (UsageError, ExitCode.USAGE),
        (OutputError, ExitCode.OUTPUT),
        (UnresolvedError, ExitCode.UNRESOLVED),
        (InternalError, ExitCode.INTERNAL),
        (CancelledError, ExitCode.INTERRUPTED),
    )
    return next((code for kind, code in codes if isinstance(error, kind)), ExitCode.INPUT)


def as_error(fault: BaseException) -> ObbError:
    """Return any fault as an error that names place, fault and remedy."""
    if isinstance(fault, ObbError):
        return fault
    if isinstance(fault, (KeyboardInterrupt, click.Abort)):
        return CancelledError("", "interrupted", "nothing was left half written")
    if isinstance(fault, click.ClickException):
        return _usage_error(fault)
    if isinstance(fault, OSError):
        return ObbError(str(fault.filename or "input"), fault.strerror or str(fault))
    if isinstance(fault, MemoryError):
        return ObbError("memory", "not enough for this input", "use a smaller mesh")
    text = f"{type(fault).__name__}: {fault}".replace("\n", " ")
    return InternalError("internal error", text, "run again with --debug and report the traceback")


def _usage_error(fault: click.ClickException) -> UsageError:
    """Return click's complaint in our words' order: place, fault, remedy."""
    context = getattr(fault, "ctx", None)
    path = context.command_path if context is not None else "obbtree"
    message = fault.format_message().replace("\n", " ").rstrip(".")
    return UsageError(path, message, f"see '{path} --help'")


def stdout() -> TextIO:
    """Return standard output; names that its encoding cannot hold are escaped.

    Raises:
        OutputError: it is closed.
    """
    if sys.stdout is None:
        raise OutputError("standard output", "is closed", "use -o FILE")
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    return sys.stdout


@contextmanager
def writing_stdout() -> Iterator[None]:
    """Guard standard output: a closed pipe ends quietly, other faults are an `OutputError`."""
    try:
        yield
    except BrokenPipeError:
        _silence(sys.stdout)
    except OSError as fault:
        _silence(sys.stdout)
        raise OutputError("standard output", f"cannot be written: {fault.strerror}") from fault


@contextmanager
def writing(path: object) -> Iterator[None]:
    """Turn the faults of writing a file into an `OutputError` that names it."""
    try:
        yield
    except OSError as fault:
        reason = fault.strerror or str(fault)
        raise OutputError(str(path), f"cannot be written: {reason}", _mend(fault)) from fault


def _mend(fault: OSError) -> str:
    if isinstance(fault, (FileNotFoundError, NotADirectoryError)):
        return "create its folder first"
    if isinstance(fault, PermissionError):
        return "choose another place with -o"
    return ""


def _silence(stream: TextIO) -> None:
    """Send what is still buffered nowhere, so that closing the stream cannot fail again."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, stream.fileno())
    os.close(null)
