"""The file of a sweep's results: a header, then a line a row, only ever appended to.

Whole lines are handed to the system chunk by chunk, so that whatever ends the process leaves all of
them but the last, which may be torn; whoever resumes cuts that off.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import stat
from collections import Counter
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from obbcli.answers.status import Status
from obbcli.errors import ObbError
from obbcli.sweeps.result_lines import ERROR, tallied

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from obbcli.sweeps.result_lines import Block

_NEW = "remove it, or add --force to start again"

# What makes one sweep another, and where a header says it.
_DECISIVE = {
    "A is not the file it was": ("inputs", "a", "sha256"),
    "B is not the file it was": ("inputs", "b", "sha256"),
    "the queries are not those they were": ("inputs", "queries", "sha256"),
    "it had other options": ("options",),
    "it had another accuracy": ("accuracy",),
    "another version of obbtree wrote it": ("tool_version",),
}


def with_digest(header: dict[str, Any]) -> dict[str, Any]:
    """Return a header with the digest of all in it that decides answers: no names, no notes."""
    inputs = {
        name: {key: value for key, value in source.items() if key not in ("path", "notes")}
        for name, source in header["inputs"].items()
    }
    text = json.dumps(header | {"inputs": inputs}, sort_keys=True, allow_nan=False)
    return header | {"digest": hashlib.sha256(text.encode()).hexdigest()}


class ResultsFile:
    """Results that are being written.

    Attributes:
        row_count: how many rows the file holds.
        resumed_from: how many it held when it was opened.
        tally: how many of them have which status.
    """

    def __init__(self, path: Path, handle: int) -> None:
        self._path = path
        self._handle = handle
        self.row_count = self.resumed_from = 0
        self.tally: Counter[str] = Counter()

    def append(self, block: Block) -> None:
        """Write some rows.

        Raises:
            OSError: the place is full, or cannot be written to; the file can be resumed.
        """
        self._write(block.lines)
        self.row_count += block.row_count
        self.tally.update(block.tally)

    def begin(self, header: dict[str, Any]) -> None:
        """Write the header into an empty file.

        Raises:
            OSError: the place is full, or cannot be written to.
        """
        self._write(_line_of(header))

    def go_on(self, header: dict[str, Any]) -> None:
        """Take over what an earlier run of the same sweep wrote, and cut off a torn line.

        Raises:
            ObbError: the file holds no results, or those of another sweep, or rows out of sequence.
            OSError: it cannot be read or cut.
        """
        end = 0
        with os.fdopen(os.dup(self._handle), "rb") as file:
            file.seek(0)
            for number, line in enumerate(file, start=1):
                if not line.endswith(b"\n"):
                    if number == 1 and not _line_of(header).startswith(line):
                        self._compare(line, header)
                    break
                if number == 1:
                    self._compare(line, header)
                else:
                    self._count(line, number)
                end += len(line)
        os.ftruncate(self._handle, end)
        self.resumed_from = self.row_count
        if end == 0:
            self.begin(header)

    def _compare(self, line: bytes, header: dict[str, Any]) -> None:
        """Refuse the results of another sweep; say what is other."""
        found = _parsed(line)
        if not (isinstance(found, dict) and found.get("schema") == header["schema"]):
            raise ObbError(str(self._path), "holds no results of a sweep", _NEW)
        if found.get("digest") == header["digest"]:
            return
        other = [name for name, keys in _DECISIVE.items() if _at(found, keys) != _at(header, keys)]
        what = other[0] if other else "its inputs differ"
        raise ObbError(str(self._path), f"holds the results of another sweep: {what}", _NEW)

    def _count(self, line: bytes, number: int) -> None:
        row = _parsed(line)
        if not isinstance(row, dict) or row.get("row") != self.row_count:
            fault = f"is not row {self.row_count} of the results"
            raise ObbError(f"{self._path}:{number}", fault, _NEW)
        if not _is_result(row):
            raise ObbError(f"{self._path}:{number}", "is no result of a question", _NEW)
        self.row_count += 1
        self.tally[tallied(row)] += 1

    def _write(self, data: bytes) -> None:
        view = memoryview(data)
        while view:
            view = view[os.write(self._handle, view) :]


def _line_of(header: dict[str, Any]) -> bytes:
    return json.dumps(header, allow_nan=False).encode() + b"\n"


def _at(record: object, keys: tuple[str, ...]) -> object:
    """Return what stands in nested objects; None where they have none of that name."""
    for key in keys:
        record = record.get(key) if isinstance(record, dict) else None
    return record


def _is_result(row: dict[str, Any]) -> bool:
    """Return whether a row says how its question ended, or why it was not asked."""
    if ERROR in row:
        return True
    statuses = [status.value for status in Status]
    return row.get("status") in statuses and isinstance(row.get("approximate"), bool)


def _parsed(line: bytes) -> object:
    try:
        return json.loads(line)
    except (ValueError, RecursionError):
        return None


@contextmanager
def opened_results(path: Path, header: dict[str, Any], *, resumed: bool) -> Iterator[ResultsFile]:
    """Open a results file for writing: an empty one, or as an earlier run left it.

    Args:
        path: where; a device or pipe cannot be resumed.
        header: of this sweep, with its digest.
        resumed: whether what is there is to be kept.

    Raises:
        ObbError: what is there is not of this sweep, or is being written to.
        OSError: it cannot be opened, read or written.
    """
    handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
    try:
        is_file = stat.S_ISREG(os.fstat(handle).st_mode)
        if is_file:
            _lock(path, handle)
        file = ResultsFile(path, handle)
        if resumed and is_file:
            file.go_on(header)
        else:
            if is_file:
                os.ftruncate(handle, 0)
            file.begin(header)
        yield file
    finally:
        os.close(handle)


def _lock(path: Path, handle: int) -> None:
    """Keep out others until this process ends, in whatever way."""
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as fault:
        raise ObbError(str(path), "is being written by another sweep", "wait for it") from fault
