"""Seeded mutations of bytes, text and documents, for targets that no coverage guides."""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from random import Random

LONGEST = 1 << 16
WHOLE = (0, 1, -1, 2, 127, 255, 65535, 2**31 - 1, 2**31, 2**32 - 1, 2**40, 2**63, 2**64 - 1)
WORDS = (
    *(str(value).encode() for value in WHOLE),
    *(b"nan", b"inf", b"-inf", b"1e309", b"-0.0", b"1e-320", b"1_0", b"0x10", b"", b"9" * 5000),
    *(b"true", b"null", b'""', b"[]", b"{}", b"\x00", b"\xff", b"\xef\xbb\xbf", b"[" * 3000),
    *(b"{", b"}", b"[", b"]", b'"', b",", b":", b"=", b"#", b"\n", b"\r\n", b" ", b"\t"),
)
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
WORD = re.compile(rb"[A-Za-z_]{3,}")


def mutated(random: Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Return `data` after one to four changes; `others` lend their parts."""
    for _ in range(random.choice((1, 1, 1, 2, 4))):
        data = random.choice(_CHANGES)(random, data, random.choice(others))
    return data[:LONGEST]


def _place(random: Random, data: bytes) -> int:
    return random.randrange(len(data) + 1)


def _spliced(data: bytes, start: int, end: int, new: bytes) -> bytes:
    return data[:start] + new + data[end:]


def _flip(random: Random, data: bytes, _: bytes) -> bytes:
    at = _place(random, data)
    return _spliced(data, at, at + 1, bytes([random.randrange(256)]))


def _cut(random: Random, data: bytes, _: bytes) -> bytes:
    at = _place(random, data)
    return (
        data[:at] if random.random() < 0.3 else _spliced(data, at, at + random.randrange(40), b"")
    )


def _insert(random: Random, data: bytes, _: bytes) -> bytes:
    at = _place(random, data)
    return _spliced(data, at, at, random.choice(WORDS))


def _whole(random: Random, data: bytes, _: bytes) -> bytes:
    """Put a number that breaks readers where one of two, four or eight bytes may stand."""
    kind = random.choice(("<H", ">H", "<I", ">I", "<Q", ">Q", "<d", ">d", "<f"))
    value = random.choice(WHOLE)
    if kind[1] in "HIQ":
        new = struct.pack(kind, value % (1 << 8 * struct.calcsize(kind)))
    else:
        new = struct.pack(kind, random.choice((0.0, 1e30, float("nan"), float("inf"), -1.0)))
    at = _place(random, data)
    return _spliced(data, at, at + len(new), new)


def _replaced(random: Random, data: bytes, pattern: re.Pattern[bytes], new: bytes) -> bytes:
    found = list(pattern.finditer(data))
    if not found:
        return data
    match = random.choice(found)
    return _spliced(data, match.start(), match.end(), new)


def _number(random: Random, data: bytes, _: bytes) -> bytes:
    return _replaced(random, data, NUMBER, random.choice(WORDS))


def _word(random: Random, data: bytes, other: bytes) -> bytes:
    words = WORD.findall(other) or [b"x"]
    return _replaced(random, data, WORD, random.choice(words))


def _lines(random: Random, data: bytes, _: bytes) -> bytes:
    """Double, drop or swap lines, or what stands between commas."""
    mark = random.choice((b"\n", b"\n", b",", b" "))
    lines = data.split(mark)
    first, second = random.randrange(len(lines)), random.randrange(len(lines))
    if random.random() < 0.4:
        lines[first], lines[second] = lines[second], lines[first]
    elif random.random() < 0.5:
        lines[first:first] = [lines[second]] * random.choice((1, 2, 200))
    else:
        del lines[first]
    return mark.join(lines)


def _move(random: Random, data: bytes, other: bytes) -> bytes:
    """Copy a piece of another over a place."""
    start, at = _place(random, other), _place(random, data)
    piece = other[start : start + random.randrange(64)]
    return _spliced(data, at, at + random.choice((0, len(piece))), piece)


_CHANGES = (_flip, _cut, _insert, _whole, _number, _number, _word, _lines, _move)
