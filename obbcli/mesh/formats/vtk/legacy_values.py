"""The words and values of a legacy VTK file, text or binary, one after the other."""

from __future__ import annotations

import re
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.source import Source

#: Types of values with their NumPy kinds in binary files, big-endian.
KINDS = {
    **dict.fromkeys(("char", "signed_char", "bit"), "i1"),
    **dict.fromkeys(("unsigned_char", "vtktypeuint8"), "u1"),
    **dict.fromkeys(("short", "vtktypeint16"), ">i2"),
    **dict.fromkeys(("unsigned_short", "vtktypeuint16"), ">u2"),
    **dict.fromkeys(("int", "vtkidtype", "vtktypeint32"), ">i4"),
    **dict.fromkeys(("unsigned_int", "vtktypeuint32"), ">u4"),
    **dict.fromkeys(("long", "vtktypeint64"), ">i8"),
    **dict.fromkeys(("unsigned_long", "vtktypeuint64"), ">u8"),
    "float": ">f4",
    "double": ">f8",
}
#: A longer word is no keyword, nor a number.
_MOST_LETTERS = 200
_WORD = re.compile(rb"\s*(\S+)")
_STARTS_WORD = re.compile(rb"(?<!\S)(?!(?:nan|inf|infinity)(?:\s|\Z))[A-Za-z_]", re.IGNORECASE)


class Cursor:
    """Goes through a file word by word.

    Attributes:
        data: the file.
        at: the byte behind what was read last.
        start: the byte where the last word began, whose line errors name.
        is_binary: whether values are, big-endian.
    """

    def __init__(self, source: Source) -> None:
        self.source = source
        self.data = source.data
        self.at = self.start = 0
        self.is_binary = False

    def keyword(self) -> str:
        """Return the next word in small letters, empty at the end."""
        found = _WORD.match(self.data, self.at)
        if found is None:
            self.start = self.at = len(self.data)
            return ""
        self.start, self.at = found.start(1), found.end()
        if len(found[1]) > _MOST_LETTERS:
            raise self.error(f"found '{shown(found[1])}', expected a keyword")
        return found[1].decode("latin-1").lower()

    def count(self) -> int:
        """Return the next word, which counts things that take a byte each at least."""
        word = self.keyword()
        if not word.isascii() or not word.isdigit() or int(word[:30]) > len(self.data):
            fault = f"claims {shown(word.encode())} of something"
            if word.isdigit():
                fault += f", but the file has {len(self.data)} bytes"
            raise self.error(fault, "it was cut short, or its counts are wrong")
        return int(word)

    def kind(self) -> str:
        """Return the next word, which is a type of values."""
        kind = self.keyword()
        if kind not in KINDS:
            raise self.error(f"values of type {shown(kind.encode())} are not read")
        return kind

    def values(self, count: int, kind: str) -> NDArray[Any]:
        """Return the values that follow."""
        if self.is_binary:
            return self._binary_values(count, np.dtype(KINDS[kind]), is_bits=kind == "bit")
        end = _STARTS_WORD.search(self.data, self.at)
        stop = end.start() if end else len(self.data)
        try:
            with warnings.catch_warnings():  # before NumPy 2.3 a warning says that it stopped early
                warnings.simplefilter("error")
                values = np.fromstring(self.data[self.at : stop], sep=" ")
        except (ValueError, DeprecationWarning) as cause:
            raise self.error(f"{count} numbers are claimed, and words stand among them") from cause
        if len(values) != count:
            fault = f"{count} numbers are claimed, and {len(values)} follow"
            raise self.error(fault, "it was cut short, or its counts are wrong")
        self.at = stop
        return values

    def _binary_values(self, count: int, kind: np.dtype[Any], *, is_bits: bool) -> NDArray[Any]:
        line = self.data.find(b"\n", self.at)
        start = line + 1 if line >= 0 else len(self.data)
        size = (count + 7) // 8 if is_bits else count * kind.itemsize
        if start + size > len(self.data):
            fault = f"{size} bytes are claimed, and {len(self.data) - start} follow"
            raise self.error(fault, "it was cut short, or its counts are wrong")
        self.at = start + size
        return np.frombuffer(self.data, kind, size // kind.itemsize, start)

    def error(self, fault: str, remedy: str = "export it again") -> MeshError:
        """Return an error at the line of the last word."""
        return self.source.error(fault, remedy, at=self._line())

    def _line(self) -> str:
        return str(self.data.count(b"\n", 0, self.start) + 1)
