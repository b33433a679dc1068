"""A fence around a library's reader: its errors become ours, its prints and appetites stay inside.

Readers of the wild end the process, print, recurse and reserve what a header claims.
"""

from __future__ import annotations

import contextlib
import io
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from obbcli.mesh.source import Source

Result = TypeVar("Result")

#: What a reader may take beside a multiple of the file's size: NumPy and XML trees cost so much.
_LEAST_ROOM = 1 << 30
_ROOM_PER_BYTE = 64
#: How often a reader may ask for more at the end of a file; looking ahead takes a few.
_MOST_IDLE = 1000
#: NumPy's words where numbers end early in a text, which libraries take for the end of the data.
_CUT_SHORT = "string or file could not be read to its end"


def fenced(source: Source, library: str, read: Callable[[], Result]) -> Result:
    """Return what `read` returns; whatever it raises becomes a MeshError that quotes none of it.

    KeyboardInterrupt and the like pass. Output and warnings are swallowed; memory is bounded by
    the file's size where the system can do so.

    Raises:
        MeshError: the reader raised, called `sys.exit`, recursed too deep or ran out of its room.
    """
    printed = io.StringIO()
    try:
        with (
            contextlib.redirect_stdout(printed),
            contextlib.redirect_stderr(printed),
            warnings.catch_warnings(),
            _bounded_memory(_LEAST_ROOM + _ROOM_PER_BYTE * len(source.data)),
        ):
            warnings.simplefilter("ignore")
            warnings.filterwarnings("error", message=_CUT_SHORT)
            return read()
    except MemoryError as fault:
        raise source.error(
            "claims more than the file can hold (out of memory)", "its counts are wrong"
        ) from fault
    except _OtherFileError as fault:
        raise source.error(f"names another file, '{fault}'", "copy that into it") from fault
    except _EndsEarlyError as fault:
        raise source.error("ends too early", "it was cut short") from fault
    except ImportError as fault:
        name = fault.name or "that reads it"
        raise source.error(
            f"needs the package {name}, which is not installed", f"pip install {name}"
        ) from fault
    except (Exception, SystemExit) as fault:
        # What a library says of it is written for its authors: `--debug` shows that.
        raise source.error(
            f"{library} cannot read it: it is not what a file of this format holds",
            "export it again or in another format",
        ) from fault


class _EndsEarlyError(EOFError):
    """A reader asks for more after the end of a file, again and again."""


class _OtherFileError(PermissionError):
    """A reader opens another file than the one that was given."""


class _EndingBytes(io.BufferedReader):
    """A file that raises where its reader goes on asking after the end."""

    _idle = 0

    def readline(self, size: int | None = -1, /) -> bytes:
        line = super().readline(-1 if size is None else size)
        self._idle = _counted(self._idle, line)
        return line

    def read(self, size: int | None = -1, /) -> bytes:
        data = super().read(size)
        self._idle = _counted(self._idle, data)
        return data


class _EndingText(io.TextIOWrapper):
    """The same for text; bytes that are no UTF-8 pass as they are."""

    _idle = 0

    def readline(self, size: int = -1, /) -> str:  # type: ignore[override]
        line = super().readline(size)
        self._idle = _counted(self._idle, line)
        return line

    def read(self, size: int | None = -1, /) -> str:
        data = super().read(size)
        self._idle = _counted(self._idle, data)
        return data


def _counted(idle: int, data: str | bytes) -> int:
    """Return how often in a row nothing was read."""
    if data:
        return 0
    if idle > _MOST_IDLE:
        raise _EndsEarlyError
    return idle + 1


def _ending_open(path: str | Path, mode: str = "r") -> io.BufferedIOBase | io.TextIOBase:
    """Return an opened file whose end is an error to those who do not look for it."""
    file = _EndingBytes(io.FileIO(path))
    return file if "b" in mode else _EndingText(file, "utf-8", "surrogateescape")


@contextlib.contextmanager
def ending_files(package: str, only: Path) -> Iterator[None]:
    """Give the modules of a package files that end; several of meshio's readers never look.

    A module's own `open` hides the built-in one, which no other code notices. It opens no file but
    one: a mesh may not name any file there is, and its digest is to tell all that was read.
    """

    def open_only(path: str | Path, mode: str = "r") -> io.BufferedIOBase | io.TextIOBase:
        if Path(path) != only:
            raise _OtherFileError(str(path))
        return _ending_open(path, mode)

    modules = [module for name, module in sys.modules.items() if name.startswith(package)]
    for module in modules:
        vars(module)["open"] = open_only
    try:
        yield
    finally:
        for module in modules:
            vars(module).pop("open", None)


@contextlib.contextmanager
def _bounded_memory(room: int) -> Iterator[None]:
    """Let the process grow by at most `room` bytes meanwhile; where /proc is missing, do nothing.

    A count of billions then fails at once instead of being written to until the system gives up.
    """
    statm = Path("/proc/self/statm")
    if not sys.platform.startswith("linux") or not statm.exists():
        yield
        return
    import resource

    used = int(statm.read_text().split()[0]) * resource.getpagesize()
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    limits = [used + room, *(limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY)]
    resource.setrlimit(resource.RLIMIT_AS, (min(limits), hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
