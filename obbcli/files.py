"""Files that are written whole or not at all: trees, and answers that go to a file.

Light on purpose: the command line has it at hand before anything heavy is imported.
"""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

TEMPORARY = ".obbtree-"
"""How names of files begin that are not yet whole; `kill -9` can leave one behind."""
# Bytes. A mesh of 20,000 triangles, which takes some milliseconds to read.
_LARGE = 1_000_000


def write_whole(path: str | os.PathLike[str], *parts: bytes) -> None:
    """Write a file under a temporary name, then rename it over what was there.

    A link stays, and what it points to is replaced. A file that is replaced hands its mode on. A
    device or a pipe is written to as it is: there is nothing to rename.

    Args:
        path: where to.
        parts: what is written, one after the other.

    Raises:
        OSError: the place cannot be written to; nothing is left behind.
    """
    try:
        _write(Path(os.path.realpath(path)), parts)
    except OSError as fault:
        # Under the name that was asked for: nobody knows the temporary one.
        raise OSError(fault.errno, fault.strerror, os.fspath(path)) from fault


def file_and_pattern(name: str) -> tuple[str, str | None]:
    """Return the file in `FILE#PATTERN`, and the pattern; a file whose own name holds `#` wins."""
    cut = len(name) if "#" in name else 0
    while cut > 0:
        # A pattern may be too long for the name of a file; of one that stays so its reader says it.
        with suppress(OSError, ValueError):
            if Path(name[:cut]).exists():
                return name[:cut], None if cut == len(name) else name[cut + 1 :]
        cut = name.rfind("#", 0, cut)
    return name, None


def file_of(name: str | os.PathLike[str]) -> str:
    """Return the file in `FILE` or `FILE#PATTERN`."""
    return file_and_pattern(os.fspath(name))[0]


def stamp_of(path: str | os.PathLike[str]) -> tuple[int, ...] | None:
    """Return what tells whether a file is still what it was; None where there is none."""
    try:
        found = Path(path).stat()
    except (OSError, ValueError):
        return None  # whoever opens it says why
    return (found.st_dev, found.st_ino, found.st_size, found.st_mtime_ns)


def is_device(stream: IO[str] | IO[bytes]) -> bool:
    """Return whether a stream is a terminal or another device: such never end, or hold nothing."""
    if stream.isatty():
        return True
    try:
        kind = os.fstat(stream.fileno()).st_mode
    except OSError:
        return False  # no file of the system's at all
    return stat.S_ISCHR(kind) or stat.S_ISBLK(kind)


def _write(target: Path, parts: tuple[bytes, ...]) -> None:
    mode = _mode_of(target)
    if mode is not None and not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        with target.open("wb") as file:
            file.writelines(parts)
        return
    # In the same directory, since only there is a rename atomic. Its name is its own, as one made
    # from the target's could be longer than names may be. It is known before the file is there, so
    # that no moment is left in which an interruption would forget it.
    temporary = target.parent / f"{TEMPORARY}{os.urandom(8).hex()}"
    try:
        # What replaces a private file is private while it is written.
        with open(temporary, "xb", opener=_opener(0o666 if mode is None else 0o600)) as file:
            file.writelines(parts)
            file.flush()
            os.fsync(file.fileno())
        if mode is not None:
            temporary.chmod(stat.S_IMODE(mode))
        temporary.replace(target)
    except BaseException:
        # What went wrong first is what is told.
        with suppress(OSError):
            temporary.unlink()
        raise


def _opener(mode: int) -> Callable[[str, int], int]:
    return lambda name, flags: os.open(name, flags, mode)


def _mode_of(target: Path) -> int | None:
    """Return the kind and permissions of what is there; None where nothing is."""
    try:
        return target.stat().st_mode
    except FileNotFoundError:
        return None


def is_large_file(name: str | os.PathLike[str]) -> bool:
    """Return whether a regular file is so large that a thread pays for reading it."""
    try:
        found = Path(file_of(name)).stat()
    except (OSError, ValueError):
        return False
    return stat.S_ISREG(found.st_mode) and found.st_size >= _LARGE
