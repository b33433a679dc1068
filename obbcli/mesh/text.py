"""What text formats share: numbers that must be numbers, byte order marks, lines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from obbcli.mesh.source import Source

_UTF8_MARK = b"\xef\xbb\xbf"


def strip_mark(data: bytes) -> bytes:
    """Return `data` without the byte order mark that some editors put first."""
    return data[len(_UTF8_MARK) :] if data.startswith(_UTF8_MARK) else data


def number(source: Source, word: bytes, line: int) -> float:
    """Return the finite number that `word` spells.

    Raises:
        MeshError: no number, or not finite; Python's digit underscores are not taken.
    """
    shown = word.decode("latin-1")
    try:
        value = float(word)
    except ValueError:
        value = None
    if value is None or b"_" in word:
        raise source.error(f"'{shown}' is not a number", at=str(line))
    if not math.isfinite(value):
        raise source.error(f"coordinate is {shown}", "coordinates must be finite", at=str(line))
    return value


def whole(source: Source, word: bytes, line: int, what: str) -> int:
    """Return the whole number that `word` spells; `what` names it in errors."""
    try:
        if b"_" in word:
            raise ValueError
        return int(word)
    except ValueError as fault:
        shown = word.decode("latin-1")
        raise source.error(f"{what} '{shown}' is not a whole number", at=str(line)) from fault
