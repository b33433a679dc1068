"""STL, binary and ASCII, read directly and strictly.

Binary files are told from ASCII ones by their size, 84 + 50 n bytes: the word "solid" opens many a
binary header too. Libraries wrap counts, return empty meshes for truncated files, or are slow.
"""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.text import all_numbers, number, shown, strip_mark

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from obbcli.mesh.source import MeshArrays, Source

HEADER_SIZE = 84
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

#: Half a megabyte or so.
_RECORDS_A_PIECE = 10_000

#: The 21 words of a facet; None stands for a number.
_FACET: tuple[bytes | None, ...] = (
    *(b"facet", b"normal", None, None, None, b"outer", b"loop"),
    *(b"vertex", None, None, None) * 3,
    *(b"endloop", b"endfacet"),
)
#: Bytes of text whose words are held at a time.
_BLOCK = 1 << 22
#: Where in a facet the corners' numbers stand; the normal's are never used and may be anything.
_COORDINATES = [k for k, word in enumerate(_FACET) if word is None and k > 4]
#: Begins with letters, which `re` looks for many times as fast as for line starts.
TITLE = rb"solid(?![^\s])[^\r\n]*"
_STARTS_SOLID = rb"(?i)\s*solid\b"
#: Lines that say nothing of the shape: comments, and the colours that some exporters write.
_REMARK = rb"(?i)(?:(?<=[\r\n])|\A)[ \t]*(?:#|;|//|colou?r\b)[^\r\n]*"
#: Closing words written as two.
_CLOSING = rb"(?i)\bend[ \t]+(solid|loop|facet)\b"
#: Bytes no text has; a header is padded with NULs more often than not.
_BINARY_BYTES = rb"[\x00-\x08\x0e-\x1f\x7f]"


def read_stl(source: Source) -> MeshArrays:
    """Return vertices (3 F, 3) and triangles (F, 3) of an STL file, three vertices a facet.

    Raises:
        MeshError: the header's count does not fit the file, or the text is no STL.
    """
    data = source.data
    if is_binary_stl(data):
        return _read_binary(data)
    text = strip_mark(data)
    if re.search(_BINARY_BYTES, text[: 2 * HEADER_SIZE]):
        raise _not_binary(source)
    if re.match(_STARTS_SOLID, text):
        return _read_ascii(source, text)
    plain = without_remarks(text)
    if re.match(_STARTS_SOLID, plain):
        return _read_ascii(source, plain)
    raise _no_solid(source, plain)


def read_binary_file(path: Path) -> MeshArrays | None:
    """Return what `read_stl` would of a binary STL file, or None where that must look at it whole.

    Piece by piece, which takes half the time and memory: the pieces stay in the processor's cache.

    Raises:
        OSError: the file cannot be read.
    """
    with path.open("rb", buffering=0) as file:
        head = file.read(HEADER_SIZE)
        size = os.fstat(file.fileno()).st_size
        count = _claimed(head)
        if count == 0 or size != HEADER_SIZE + RECORD.itemsize * count:
            return None
        vertices = np.empty((3 * count, 3))
        corners = vertices.reshape(-1, 3, 3)
        records = np.empty(min(count, _RECORDS_A_PIECE), RECORD)
        piece = records.view(np.uint8).data
        for start in range(0, count, _RECORDS_A_PIECE):
            wanted = min(count - start, _RECORDS_A_PIECE)
            length = wanted * RECORD.itemsize
            if file.readinto(piece[:length]) != length:
                return None  # it was cut short meanwhile
            with np.errstate(invalid="ignore"):  # a signalling NaN is refused later, by name
                corners[start : start + wanted] = records["corners"][:wanted]
    return vertices, _in_threes(count)


def is_binary_stl(data: bytes) -> bool:
    """Return whether the size is what the count in the header says."""
    if len(data) < HEADER_SIZE:
        return False
    return len(data) == HEADER_SIZE + RECORD.itemsize * _claimed(data)


def _claimed(data: bytes) -> int:
    return int.from_bytes(data[80:HEADER_SIZE], "little")


def _read_binary(data: bytes) -> MeshArrays:
    records = np.frombuffer(data, RECORD, offset=HEADER_SIZE)
    vertices = np.empty((3 * len(records), 3))
    with np.errstate(invalid="ignore"):  # a signalling NaN is refused later, by name
        vertices.reshape(-1, 3, 3)[...] = records["corners"]
    return vertices, _in_threes(len(records))


def _in_threes(count: int) -> NDArray[np.int32]:
    numbers = np.arange(3 * count, dtype=np.int32)
    numbers.setflags(write=False)  # so that `Mesh` takes it without a copy
    return numbers.reshape(count, 3)


def _not_binary(source: Source) -> Exception:
    """Return the error of a file that is neither kind of STL, with the figures that show it."""
    size = len(source.data)
    if size < HEADER_SIZE:
        return source.error(
            f"has {size} bytes; a binary STL has at least {HEADER_SIZE}, an ASCII STL begins with "
            "'solid'",
            "export or download it again",
        )
    claimed = _claimed(source.data)
    wanted = HEADER_SIZE + RECORD.itemsize * claimed
    kind = "truncated" if size < wanted else "bytes after the last triangle"
    return source.error(
        f"the header counts {claimed} triangles, which takes {wanted} bytes, but the file has "
        f"{size} ({kind}, a wrong count, or no STL)",
        "export or download it again",
        at="byte 80",
    )


def _no_solid(source: Source, text: bytes) -> Exception:
    """Return the error of text that is no STL, with the line: it is no truncated binary file."""
    for line, word, _ in _words(text):
        return source.error(
            f"is text, but no STL: found '{shown(word)}', expected 'solid'",
            "export it again, or give its name the suffix of its format",
            at=str(line),
        )
    return source.error("holds comments alone, expected 'solid'", "export it again")


def without_remarks(text: bytes) -> bytes:
    """Return text without comments and colours, closing words as one; lines keep their numbers."""
    return re.sub(_CLOSING, rb"end\1", re.sub(_REMARK, b"", text))


def _read_ascii(source: Source, text: bytes) -> MeshArrays:
    """Return the facets of all solids: by whole columns where all is regular, else word by word."""
    vertices = _read_regular(text)
    if vertices is None:
        plain = without_remarks(text)
        vertices = None if plain == text else _read_regular(plain)
        if vertices is None:
            vertices = _read_words(source, plain)
    return vertices, _in_threes(len(vertices) // 3)


def _read_regular(text: bytes) -> NDArray[np.float64] | None:
    """Return the corners where the words repeat exactly as in `_FACET`, or None."""
    body = _without_titles(text.lower())
    if body is None or b"_" in body:
        return None
    found = [np.zeros((0, 3))]
    for block in _blocks(body):
        corners = _regular_corners(block.split())
        if corners is None:
            return None
        found.append(corners)
    return np.concatenate(found) if len(found) > 1 else None


def _blocks(body: bytes) -> Iterator[bytes]:
    """Yield a text in blocks that end where facets do: words take ten times the text's memory."""
    start = 0
    while start < len(body):
        end = body.find(b"endfacet", start + _BLOCK)
        end = len(body) if end < 0 or body[end + 8 : end + 9].strip() else end + 8
        block, start = body[start:end], end
        if block.strip():
            yield block


def _regular_corners(words: list[bytes]) -> NDArray[np.float64] | None:
    """Return the corners (3 F, 3) where words repeat exactly as in `_FACET`, or None."""
    count = len(words) // len(_FACET)
    if count == 0 or count * len(_FACET) != len(words):
        return None
    for k, word in enumerate(_FACET):
        if word is not None and words[k :: len(_FACET)].count(word) != count:
            return None
    columns = [all_numbers(words[k :: len(_FACET)]) for k in _COORDINATES]
    if any(column is None for column in columns):
        return None
    return np.stack([c for c in columns if c is not None], axis=1).reshape(-1, 3)


def _without_titles(text: bytes) -> bytes | None:
    """Return lower-case text without `solid` and `endsolid` lines; None if the last is no end."""
    pieces = []
    position = 0
    word = b""
    for match in re.finditer(TITLE, text):
        start = match.start()
        ends = text[start - 3 : start] == b"end"
        start -= 3 * ends
        line_start = 1 + max(text.rfind(end, position, start) for end in (b"\n", b"\r"))
        if text[max(line_start, position) : start].strip():
            return None
        pieces.append(text[position:start])
        position = match.end()
        word = b"endsolid" if ends else b"solid"
    return b"".join([*pieces, text[position:]]) if word == b"endsolid" else None


def _read_words(source: Source, text: bytes) -> NDArray[np.float64]:
    """Return the corners word by word: any line breaks, and errors that name their line.

    Raises:
        MeshError: a word out of place, a number that is none, an end inside a solid.
    """
    numbers: list[float] = []
    place = 0
    inside = False
    line = 1
    for line, word, starts_line in _words(text):
        wanted = _FACET[place]
        if place == 0 and starts_line and word.lower() in (b"solid", b"endsolid"):
            inside = word.lower() == b"solid"
        elif wanted is None:
            if place > 4:
                numbers.append(number(source, word, line))
            place += 1
        elif word.lower() != wanted:
            raise source.error(f"found '{shown(word)}', expected '{wanted.decode()}'", at=str(line))
        else:
            place = (place + 1) % len(_FACET)
    if place or inside:
        raise source.error("the file ends inside a solid", "it was cut short", at=str(line))
    return np.array(numbers, dtype=np.float64).reshape(-1, 3)


def _words(text: bytes) -> Iterator[tuple[int, bytes, bool]]:
    """Yield line, word and whether it opens its line; a solid's name is passed over."""
    for line, content in enumerate(text.splitlines(), start=1):
        for index, word in enumerate(content.split()):
            yield line, word, index == 0
            if index == 0 and word.lower() in (b"solid", b"endsolid"):
                break
