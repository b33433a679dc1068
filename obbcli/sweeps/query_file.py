"""Rows of questions out of a CSV or JSONL file, one at a time, whatever their number.

A fault of the file as a whole is raised; that of a row is the row's own.
"""

from __future__ import annotations

import hashlib
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Literal, TypeAlias

from obbcli.errors import ObbError
from obbcli.files import is_device
from obbcli.sweeps.csv_rows import rows_of_csv
from obbcli.sweeps.jsonl_rows import rows_of_jsonl

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.sweeps.row_fields import Row

Format: TypeAlias = Literal["csv", "jsonl"]

_STDIN = "-"
_SUFFIXES: dict[str, Format] = {".csv": "csv", ".jsonl": "jsonl", ".ndjson": "jsonl"}
_CHUNK = 1 << 20


class Queries:
    """A file of questions that can be read more than once.

    Attributes:
        name: as the user wrote it; `-` for standard input.
        format: `"csv"` or `"jsonl"`, told by the suffix, else by the first letter.
        sha256: of its bytes, in hexadecimal.
        size: in bytes.
    """

    def __init__(self, name: str, file: IO[bytes]) -> None:
        self.name = name
        self._file = file
        digest = hashlib.sha256()
        self.size = 0
        start = b""
        while chunk := file.read(_CHUNK):
            digest.update(chunk)
            self.size += len(chunk)
            start = start or chunk.removeprefix(b"\xef\xbb\xbf").lstrip()[:1]
        self.sha256 = digest.hexdigest()
        by_content: Format = "jsonl" if start in (b"{", b"[") else "csv"
        self.format: Format = _SUFFIXES.get(Path(name).suffix.lower(), by_content)
        self._read = 0

    @property
    def share(self) -> float:
        """How much of the file was read, 0 to 1."""
        return self._read / max(self.size, 1)

    def rows(self) -> Iterator[Row]:
        """Yield the rows, first to last.

        Raises:
            ObbError: the file has no rows, its columns are not those of questions, or it is no
                longer what it was.
            OSError: it cannot be read.
        """
        self._file.seek(0)
        self._read = 0
        digest = hashlib.sha256()
        place = "<stdin>" if self.name == _STDIN else self.name
        read = rows_of_csv if self.format == "csv" else rows_of_jsonl
        is_empty = True
        for row in read(self._lines(digest), place):
            is_empty = False
            yield row
        if is_empty:
            raise ObbError(place, "holds no questions", "write one a line")
        if digest.hexdigest() != self.sha256:
            raise ObbError(place, "changed while it was read", "sweep it again, from the start")

    def _lines(self, digest: hashlib._Hash) -> Iterator[str]:
        """Yield the lines as text, with their ends; a byte-order mark is no part of them."""
        mark = b"\xef\xbb\xbf"
        for line in self._file:
            digest.update(line)
            text = line.removeprefix(mark) if self._read == 0 else line
            self._read += len(line)
            yield text.decode("utf-8", errors="replace")


@contextmanager
def opened(name: str) -> Iterator[Queries]:
    """Open a file of questions; `-` is standard input, which is kept on disk meanwhile.

    Raises:
        ObbError: it is a folder or device, or standard input is a terminal or closed.
        OSError: it cannot be read.
    """
    if name != _STDIN:
        if Path(name).is_dir():
            raise ObbError(name, "is a folder", "name a file of questions")
        with Path(name).open("rb") as file:
            if is_device(file):
                raise ObbError(name, "is a device", "name a file of questions")
            if file.seekable():
                yield Queries(name, file)
                return
            with _spooled(file) as copy:
                yield Queries(name, copy)
                return
    if sys.stdin is None or is_device(sys.stdin):
        raise ObbError("<stdin>", "is no file or pipe", "pipe questions into it, or name a file")
    with _spooled(sys.stdin.buffer) as copy:
        yield Queries(name, copy)


@contextmanager
def _spooled(stream: IO[bytes]) -> Iterator[IO[bytes]]:
    """Give a stream's bytes as a file: they are read twice, and may be more than memory holds."""
    import shutil
    import tempfile

    with tempfile.TemporaryFile() as copy:
        shutil.copyfileobj(stream, copy, _CHUNK)
        copy.seek(0)
        yield copy
