"""Takes long runs of plain vertices and triangles out of a 3MF model without an event for each.

A model of a million triangles has a million and a half elements, and expat calls Python for each of
them. Nearly all files write these elements alike, so that a run of them can be split at its quotes
and compared with its own first element. A run that differs from that in anything is left to expat:
what is taken here is what expat would have brought, and every refusal is expat's way of reading.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

#: Bytes that are looked at together.
_AT_LEAST = 1 << 18
#: How the first element of a run may look: the rest must look the same, but for its numbers.
_SPACE = rb"[ \t\r\n]"
_ELEMENT = rb"(?:" + _SPACE + rb'+[A-Za-z][A-Za-z0-9]*="[^"<&]*")*' + _SPACE + rb"*/>"
_FIRST = {
    name: re.compile(_SPACE + rb"*<" + name.encode() + _ELEMENT) for name in ("vertex", "triangle")
}
_NAME = re.compile(rb'([A-Za-z][A-Za-z0-9]*)="')
_DIGITS = b"0123456789"
_OF_NUMBERS = _DIGITS + b"+-.eE"
_NO_LINE_END = bytes(set(range(256)) - set(b"\r\n"))


class Run:
    """A run of elements of one kind at the beginning of a text.

    Attributes:
        size: how many bytes it is long.
        line_ends: the ends of lines in it, as they stand.
    """

    def __init__(self, text: bytes, kind: str) -> None:
        end = text.find(b"</")
        self.size = text.rfind(b"/>", 0, len(text) if end < 0 else end) + 2
        self._text = text[: self.size]
        self._kind = kind
        self.line_ends = self._text.translate(None, _NO_LINE_END)

    def words(self, wanted: tuple[bytes, bytes, bytes]) -> list[bytes] | None:
        """Return three attributes of every element, element by element; None where it is not plain.

        Args:
            wanted: their names; the values of all others must be whole numbers.
        """
        first = _FIRST[self._kind].match(self._text)
        if first is None or self.line_ends.count(b"\r") != self._text.count(b"\r\n"):
            return None
        names = _NAME.findall(first[0])
        # An `xmlns` would say that the element is none of 3MF's.
        if len({b"xmlns", *names}) != len(names) + 1 or not set(wanted) <= set(names):
            return None
        pieces = self._text.split(b'"')
        if not self._is_uniform(pieces, names):
            return None
        step = 2 * len(names)
        columns = {name: pieces[2 * k + 1 :: step] for k, name in enumerate(names)}
        others = b"".join(b"".join(columns[name]) for name in names if name not in wanted)
        if others.translate(None, _DIGITS):
            return None
        words: list[bytes] = [b""] * (3 * (len(pieces) // step))
        for k, name in enumerate(wanted):
            words[k::3] = columns[name]
        return words

    def _is_uniform(self, pieces: list[bytes], names: list[bytes]) -> bool:
        """Return whether all between the values is what belongs there, element by element."""
        step = 2 * len(names)
        if len(pieces) % step != 1:
            return False
        begins = rb"<" + self._kind.encode() + _SPACE + rb"+" + names[0] + rb"="
        ends = _SPACE + rb"*/>"
        expected = {(0, 1): _SPACE + rb"*" + begins, (-1, None): ends}
        between = [(pieces[step:-1:step], ends + _SPACE + rb"*" + begins)]
        between += [(pieces[a:b], pattern) for (a, b), pattern in expected.items()]
        for k, name in enumerate(names[1:], start=1):
            between.append((pieces[2 * k :: step], _SPACE + rb"+" + name + rb"="))
        # Of each kind of piece few differ, as programs write them.
        return all(
            re.fullmatch(pattern, piece) for found, pattern in between for piece in set(found)
        )


def numbers_of(words: list[bytes]) -> NDArray[np.float64] | None:
    """Return words as the numbers that `model.number` makes of them, or None where one is none."""
    if b"".join(words).translate(None, _OF_NUMBERS):
        return None
    try:
        values = np.fromiter(map(float, words), np.float64, len(words))
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def indices_of(words: list[bytes], count: int) -> NDArray[np.int64] | None:
    """Return words as numbers of vertices, of which there are `count`; None where one is none."""
    text = b" ".join(words)
    if text.translate(None, _DIGITS + b" ") or not text.strip():
        return None
    # Numbers beyond the range become its end, and words without a digit none.
    values = np.fromstring(text, np.int64, sep=" ")
    return values if len(values) == len(words) and values.max() < count else None


def cut_at_ends(pieces: Iterable[bytes]) -> Iterator[bytes]:
    """Yield a text in pieces that end where a tag does, so that no element is cut in two."""
    waiting: list[bytes] = []
    size = 0
    for piece in pieces:
        end = piece.rfind(b">") + 1
        size += len(piece)
        if size < _AT_LEAST or not end:
            waiting.append(piece)
            continue
        yield b"".join([*waiting, piece[:end]])
        waiting, size = [piece[end:]], len(piece) - end
    yield b"".join(waiting)
