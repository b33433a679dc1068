"""The numbers of a section of a Gmsh file, text or binary, one after the other."""

from __future__ import annotations

import re
import warnings
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Ints = NDArray[np.int64]

_COUNT = re.compile(rb"\s*(\d+)[ \t\r]*\n")


class GmshFault(Exception):  # noqa: N818 - said of a file, and caught where its line is known
    """What is wrong with a section, in words."""


class Values(Protocol):
    """What both kinds of files give."""

    def first_count(self) -> int:
        """Return the count that begins a section of version 2."""

    def totals(self) -> tuple[int, int]:
        """Return how many blocks, and how many things in all, a section of version 4 claims."""

    def ints(self, count: int) -> Ints:
        """Return so many small whole numbers."""

    def size(self) -> int:
        """Return a count of things that follow."""

    def sizes(self, count: int) -> Ints:
        """Return so many tags of nodes as version 4.1 writes them."""

    def tags(self, count: int) -> Ints:
        """Return so many tags, as the file's version writes those of elements."""

    def doubles(self, count: int) -> NDArray[np.float64]:
        """Return so many coordinates."""

    def tagged_points(self, count: int) -> tuple[Ints, NDArray[np.float64]]:
        """Return so many nodes: tags, and places (N, 3)."""

    def run(self, most: int, width_of: Callable[[int], int]) -> tuple[int, Ints]:
        """Return elements of version 2 that follow one another with one type and count of tags."""

    def is_at_end(self) -> bool:
        """Return whether nothing is left of the section."""


class TextValues:
    """Of a text file: all numbers of a section at once."""

    def __init__(self, text: bytes, version: tuple[int, int]) -> None:
        with warnings.catch_warnings():  # before NumPy 2.3 a warning says that it stopped early
            warnings.simplefilter("error")
            try:
                self._values = np.fromstring(text, sep=" ")
            except (ValueError, DeprecationWarning) as fault:
                raise GmshFault("holds a word that is no number") from fault
        self._at = 0
        self._has_ranges = version == (4, 1)

    def _take(self, count: int) -> NDArray[np.float64]:
        found = self._values[self._at : self._at + count]
        if len(found) != count:
            raise GmshFault(f"{count} numbers are claimed, and {len(found)} follow")
        self._at += count
        return found

    def first_count(self) -> int:
        """Return the count that begins a section of version 2."""
        return self.size()

    def totals(self) -> tuple[int, int]:
        """Return how many blocks, and how many things in all, a section of version 4 claims."""
        blocks, count = self.size(), self.size()
        if self._has_ranges:
            self._take(2)
        return blocks, count

    def ints(self, count: int) -> Ints:
        """Return so many small whole numbers."""
        return _whole(self._take(count))

    def sizes(self, count: int) -> Ints:
        """Return so many tags of nodes as version 4.1 writes them."""
        return self.ints(count)

    def tags(self, count: int) -> Ints:
        """Return so many tags, as the file's version writes those of elements."""
        return self.ints(count)

    def size(self) -> int:
        """Return a count of things that follow."""
        count = int(self.ints(1)[0])
        if not 0 <= count <= len(self._values):
            raise GmshFault(f"claims {count} of something, which the file cannot hold")
        return count

    def doubles(self, count: int) -> NDArray[np.float64]:
        """Return so many coordinates."""
        return self._take(count)

    def tagged_points(self, count: int) -> tuple[Ints, NDArray[np.float64]]:
        """Return so many nodes: tags, and places (N, 3)."""
        rows = self._take(4 * count).reshape(-1, 4)
        return _whole(rows[:, 0]), rows[:, 1:]

    def run(self, most: int, width_of: Callable[[int], int]) -> tuple[int, Ints]:
        """Return elements of version 2 that follow one another with one type and count of tags."""
        _, kind, tag_count = self.ints(3).tolist()
        self._at -= 3
        if not 0 <= tag_count <= len(self._values):
            raise GmshFault(f"claims {tag_count} tags of an element")
        width = 3 + tag_count + width_of(kind)
        rest = self._values[self._at :]
        rows = rest[: len(rest) // width * width].reshape(-1, width)[:most]
        alike = (rows[:, 1] == kind) & (rows[:, 2] == tag_count)
        length = len(rows) if alike.all() else int(np.argmin(alike))
        if length == 0:
            raise GmshFault("ends inside of an element")
        return kind, self.ints(length * width).reshape(length, width)[:, 3 + tag_count :]

    def is_at_end(self) -> bool:
        """Return whether nothing is left of the section."""
        return self._at == len(self._values)


def _whole(values: NDArray[np.float64]) -> Ints:
    if not ((values == np.floor(values)) & (np.abs(values) < 2.0**53)).all():
        raise GmshFault("holds a number that is not whole where a tag or count stands")
    return values.astype(np.int64)


class BinaryValues:
    """Of a binary file."""

    def __init__(self, data: bytes, start: int, order: str, version: tuple[int, int]) -> None:
        self._data = data
        self._at = start
        self._order = order
        self._version = version

    def _take(self, count: int, kind: Any) -> NDArray[Any]:
        item = np.dtype(kind).newbyteorder(self._order)
        left = len(self._data) - self._at
        if not 0 <= count * item.itemsize <= left:
            raise GmshFault(f"{count * item.itemsize} bytes are claimed, and {left} follow")
        found = np.frombuffer(self._data, item, count, self._at)
        self._at += count * item.itemsize
        return found

    def first_count(self) -> int:
        """Return the count that begins a section of version 2."""
        found = _COUNT.match(self._data, self._at)
        if found is None or len(found[1]) > 18:
            raise GmshFault("has no count where one is expected")
        self._at = found.end()
        return int(found[1])

    def totals(self) -> tuple[int, int]:
        """Return how many blocks, and how many things in all, a section of version 4 claims."""
        blocks, count = self.size(), self.size()
        if self._version == (4, 1):
            self._take(2, "u8")
        return blocks, count

    def ints(self, count: int) -> Ints:
        """Return so many small whole numbers."""
        return self._take(count, "i4").astype(np.int64)

    def size(self) -> int:
        """Return a count of things that follow."""
        count = int(self._take(1, "u8")[0])
        if count > len(self._data):
            raise GmshFault(f"claims {count} of something, which the file cannot hold")
        return count

    def sizes(self, count: int) -> Ints:
        """Return so many tags of nodes as version 4.1 writes them."""
        return self._take(count, "u8").astype(np.int64)

    def tags(self, count: int) -> Ints:
        """Return so many tags, as the file's version writes those of elements."""
        return self.sizes(count) if self._version == (4, 1) else self.ints(count)

    def doubles(self, count: int) -> NDArray[np.float64]:
        """Return so many coordinates."""
        return self._take(count, "f8").astype(np.float64)

    def tagged_points(self, count: int) -> tuple[Ints, NDArray[np.float64]]:
        """Return so many nodes: tags, and places (N, 3)."""
        order = self._order
        rows = self._take(count, [("tag", f"{order}i4"), ("place", f"{order}f8", (3,))])
        return rows["tag"].astype(np.int64), rows["place"].astype(np.float64)

    def run(self, most: int, width_of: Callable[[int], int]) -> tuple[int, Ints]:
        """Return elements of version 2 that follow one another with one type and count of tags."""
        kind, count, tag_count = self.ints(3).tolist()
        if not 0 < count <= most or not 0 <= tag_count <= len(self._data):
            raise GmshFault(f"has a block of {count} elements where {most} are left")
        width = 1 + tag_count + width_of(kind)
        return kind, self.ints(count * width).reshape(count, width)[:, 1 + tag_count :]

    def is_at_end(self) -> bool:
        """Return whether nothing is left of the section."""
        return self._data[self._at :].lstrip().startswith(b"$End")
