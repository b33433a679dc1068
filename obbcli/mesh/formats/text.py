"""What text formats share: numbers that must be numbers, byte order marks, lines."""

from __future__ import annotations

import math
from contextlib import suppress
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.source import Source

_UTF8_MARK = b"\xef\xbb\xbf"
#: Of a word that is none of those expected, so much is shown; no whole number is longer.
_SHOWN = 40
_DIGITS_AND_BLANK = b"0123456789 "
#: No number of eight bytes is taken for one that is larger.
_SAFE = 1 << 62


def strip_mark(data: bytes) -> bytes:
    """Return text without the byte order mark that some editors put first, UTF-16 as UTF-8.

    What is marked as UTF-16 but is none stays as it is, and is no text of any format.
    """
    if data.startswith(_UTF8_MARK):
        return data[len(_UTF8_MARK) :]
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        whole = len(data) - len(data) % 2  # the beginning of a file may end inside a letter
        with suppress(UnicodeDecodeError):
            return data[:whole].decode("utf-16").encode()
    return data


def number(source: Source, word: bytes, line: int) -> float:
    """Return the finite number that `word` spells.

    Raises:
        MeshError: no number, or not finite; Python's digit underscores are not taken.
    """
    spelled = shown(word)
    try:
        value = float(word)
    except ValueError:
        value = None
    if value is None or b"_" in word:
        raise source.error(f"'{spelled}' is not a number", at=str(line))
    if not math.isfinite(value):
        raise source.error(f"coordinate is {spelled}", "coordinates must be finite", at=str(line))
    return value


def whole(source: Source, word: bytes, line: int, what: str) -> int:
    """Return the whole number that `word` spells; `what` names it in errors."""
    try:
        if b"_" in word or len(word) > _SHOWN:
            raise ValueError
        return int(word)
    except ValueError as fault:
        spelled = shown(word)
        raise source.error(f"{what} '{spelled}' is not a whole number", at=str(line)) from fault


def shown(word: bytes) -> str:
    """Return a word as errors show it: of a long one, the beginning."""
    text = word[:_SHOWN].decode("latin-1")
    text = "".join(letter if letter.isprintable() else "?" for letter in text)
    return text if len(word) <= _SHOWN else f"{text}..."


def counted(count: int, what: str) -> str:
    """Return a count as notes have it: "1 quad", "12 quads"."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def its(count: int) -> str:
    """Return the word for what belongs to so many things."""
    return "its" if count == 1 else "their"


def uniform_words(lines: list[bytes], width: int) -> list[bytes] | None:
    """Return the words of all lines in one list where each has `width` words and no underscore.

    None otherwise. Split twice, so that no list a line is kept for the garbage collector to walk.
    """
    if set(map(len, map(bytes.split, lines))) - {width}:
        return None
    joined = b" ".join(lines)
    return None if b"_" in joined else joined.split()


def uniform_rows(rows: list[list[bytes]], width: int) -> list[bytes] | None:
    """Return the words of all rows in one list where each has `width` words, or None."""
    if set(map(len, rows)) - {width}:
        return None
    return list(chain.from_iterable(rows))


def counted_rows(
    rows: list[list[bytes]],
) -> tuple[NDArray[np.int64], NDArray[np.int64]] | None:
    """Return the numbers of rows that begin with how many follow, end to end, and these counts.

    None where a row has fewer or more, or a word that is no whole number.
    """
    widths = np.fromiter(map(len, rows), np.int64, len(rows))
    values = all_whole(list(chain.from_iterable(rows)))
    if values is None or not len(values):
        return None
    starts = np.cumsum(widths) - widths
    counts = values[starts]
    if (counts != widths - 1).any():
        return None
    is_count = np.zeros(len(values), bool)
    is_count[starts] = True
    return values[~is_count], counts


def all_numbers(words: list[bytes]) -> NDArray[np.float64] | None:
    """Return all words as finite numbers, or None where one is not: its reader then says which.

    Underscores, which Python takes between digits, are the caller's to look for: once, in the text.
    """
    try:
        values = np.array(list(map(float, words)), dtype=np.float64)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def all_whole(words: list[bytes]) -> NDArray[np.int64] | None:
    """Return all words, as `split` parts them, as whole numbers, or None where one is none.

    See `all_numbers` about underscores.
    """
    text = b" ".join(words)
    if words and not text.translate(None, _DIGITS_AND_BLANK):
        # Three times as fast as word by word; numbers beyond the range become its end.
        values = np.fromstring(text, np.int64, sep=" ")
        if len(values) == len(words) and values.max() < _SAFE:
            return values
    try:
        return np.array(list(map(int, words)), dtype=np.int64)
    except (ValueError, OverflowError):
        return None
