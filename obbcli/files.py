"""Files that are written whole or not at all: trees, and answers that go to a file.

Light on purpose: the command line has it at hand before anything heavy is imported.
"""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from pathlib import Path


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


def _write(target: Path, parts: tuple[bytes, ...]) -> None:
    mode = _mode_of(target)
    if mode is not None and not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        with target.open("wb") as file:
            file.writelines(parts)
        return
    # Costs as much to import as all else here.
    import tempfile

    # In the same directory, since only there is a rename atomic. Its name is its own, as one made
    # from the target's could be longer than names may be.
    handle, name = tempfile.mkstemp(prefix=".obbtree-", dir=target.parent)
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.writelines(parts)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask() if mode is None else stat.S_IMODE(mode))
        temporary.replace(target)
    except BaseException:
        with suppress(FileNotFoundError):
            temporary.unlink()
        raise


def _mode_of(target: Path) -> int | None:
    """Return the kind and permissions of what is there; None where nothing is."""
    try:
        return target.stat().st_mode
    except FileNotFoundError:
        return None


def _umask() -> int:
    """Return the process's file mode mask, which can only be read by setting it."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
