"""The bytes of a mesh file with their place and digest; what every reader is given."""

from __future__ import annotations

import os
import stat
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, BinaryIO

from obbcli.errors import MeshError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    #: What a reader returns: vertices (V, 3) and triangles (F, 3), unchecked.
    MeshArrays = tuple[NDArray[np.float64], NDArray[np.int32] | NDArray[np.int64]]

#: Below this many bytes a thread costs more than the hash.
_THREAD_FROM = 1 << 20
#: Bytes read at a time from a stream, and which share of all memory it may fill.
_CHUNK = 1 << 20
_SHARE = 4


@dataclass(frozen=True, eq=False)
class Source:
    """Holds what was read, once: readers parse these bytes and the digest is of these bytes.

    Args:
        place: what errors name: the path as the caller gave it.
        name: the file's name.
        data: the whole file.
        path: where it lies, or None where the bytes came from a stream.
        notes: what readers said of it so far; they become `Mesh.notes`.
        units: the length unit that the file or its format states, as `Mesh.unit`; empty or one.
        stored: the bytes as they lie in the file, where `data` was unpacked from them, else None.
        sag: how far triangles may be from exact surfaces that they are cut from, in the file's
            unit; None: 1e-3 of the size.
        sags: the sag that exact surfaces were cut with; empty or one.
    """

    place: str
    name: str
    data: bytes
    path: Path | None = None
    notes: list[str] = field(default_factory=list)
    units: list[str] = field(default_factory=list)
    stored: bytes | None = None
    sag: float | None = None
    sags: list[float] = field(default_factory=list)

    @property
    def unit(self) -> str | None:
        """The unit of length that is stated, None where none is."""
        return self.units[0] if self.units else None

    def state_unit(self, unit: str) -> None:
        """Tell the unit of length that the file or its format states, such as `"mm"`."""
        self.units[:] = [unit]

    @property
    def stated_sag(self) -> float | None:
        """How far triangles are from exact surfaces; None where the file has none."""
        return self.sags[0] if self.sags else None

    def state_sag(self, sag: float) -> None:
        """Tell how far triangles are, at most, from the exact surfaces that they were cut from."""
        self.sags[:] = [sag]

    def note(self, text: str) -> None:
        """Tell what is taken with a change, such as "12 quads cut into 24 triangles".

        Args:
            text: one sentence, without a full stop and without the file's name; said twice it is
                kept once.
        """
        if text not in self.notes:
            self.notes.append(text)

    def error(self, fault: str, remedy: str = "", *, at: str = "") -> MeshError:
        """Return an error at this file; `at` is a line number, or words such as `byte 84`."""
        where = (
            f"{self.place}:{at}" if at.isdigit() else f"{self.place}: {at}" if at else self.place
        )
        return MeshError(where, fault, remedy)


def check_file(path: Path) -> None:
    """Refuse what is no file or pipe, without reading it.

    Raises:
        MeshError: it does not exist, is no file, or may not be looked at.
    """
    with _naming(path):
        kind = path.stat().st_mode
        if stat.S_ISDIR(kind):
            raise MeshError(str(path), "is a directory, expected a file", "name one file in it")
        if not (stat.S_ISREG(kind) or stat.S_ISFIFO(kind)):
            raise MeshError(str(path), "is a device or socket, expected a file")


def read_source(path: Path) -> Source:
    """Return the contents of a file, or of a pipe.

    Raises:
        MeshError: it does not exist, is no file, may not be read, or is empty.
    """
    check_file(path)
    with _naming(path):
        data = _drained(path) if path.is_fifo() else path.read_bytes()
    return checked_source(Source(str(path), path.name, data, path))


def read_head(path: Path, size: int) -> Source:
    """Return at most `size` bytes of a file's beginning; of a pipe nothing, as it runs once.

    Raises:
        MeshError: as in `read_source`.
    """
    check_file(path)
    with _naming(path):
        if path.is_fifo():
            return Source(str(path), path.name, b"", path)
        with path.open("rb") as file:
            return checked_source(Source(str(path), path.name, file.read(size), path))


def _drained(pipe: Path) -> bytes:
    with pipe.open("rb") as stream:
        return read_stream(stream, str(pipe))


def most_bytes() -> int:
    """Return how much of this machine's memory an input of unknown size may fill."""
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // _SHARE


def read_stream(stream: BinaryIO, place: str) -> bytes:
    """Return all that a pipe or standard input brings.

    Args:
        stream: what is read.
        place: what errors call it.

    Raises:
        MeshError: it brings more than a quarter of this machine's memory; some never end.
        OSError: it cannot be read.
    """
    most = most_bytes()
    parts = []
    while part := stream.read(_CHUNK):
        parts.append(part)
        most -= len(part)
        if most < 0:
            fault = "goes on after a quarter of this machine's memory"
            raise MeshError(place, fault, "put it into a file, or build its tree where it fits")
    return b"".join(parts)


@contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Turn the system's refusals into errors that name the file."""
    place = str(path)
    try:
        yield
    except MeshError:
        raise
    except FileNotFoundError as fault:
        raise MeshError(place, "no such file", "check the path") from fault
    except PermissionError as fault:
        raise MeshError(
            place, "may not be read (permission denied)", f"chmod +r {place}"
        ) from fault
    except (OSError, ValueError) as fault:
        # ValueError: a path that holds a NUL. OSError: too long a name, a failing disk, ...
        reason = getattr(fault, "strerror", None) or "its name is none of a file"
        raise MeshError(place, f"cannot be read: {reason}") from fault
    except MemoryError as fault:
        raise MeshError(place, "does not fit into memory") from fault


def checked_source(source: Source) -> Source:
    """Return `source` unless it is empty."""
    if not source.data:
        raise source.error("is empty, expected a mesh", "write the file again")
    return source


def digest_of(data: bytes) -> Callable[[], str]:
    """Start to hash `data` and return what waits for the SHA-256 in hexadecimal.

    Hashing runs beside parsing (hashlib releases the interpreter's lock) and always on the bytes
    parsed: a later look at the file could find another one. The caller must wait before it returns,
    so that no thread outlives a load and no bytes are kept.
    """
    # Imported where it is needed: start-up counts, and few who ask questions look at digests.
    import hashlib
    import threading

    if len(data) < _THREAD_FROM:
        return hashlib.sha256(data).hexdigest
    digest = hashlib.sha256()
    thread = threading.Thread(target=digest.update, args=(data,), name="sha256", daemon=True)
    try:
        thread.start()
    except RuntimeError:  # the system gives no more threads
        digest.update(data)
        return digest.hexdigest

    def wait() -> str:
        thread.join()
        return digest.hexdigest()

    return wait
