"""The header of OFF: its variants, its counts, and what a vertex is made of."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.text import shown, whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.source import Source

#: A line's number and its words.
Row = tuple[int, list[bytes]]

#: ModelNet writes the first count right after the word. `n` and `N` are two things.
_KEYWORD = re.compile(rb"((?:ST)?C?N?4?n?OFF)(\d*)")
#: What stands between a vertex's coordinates and the next vertex, in Geomview's order.
_EXTRAS = ((b"N", 3), (b"C", 4), (b"ST", 2))


class Header(NamedTuple):
    """Holds what a header says.

    Attributes:
        vertex_count: how many vertices follow.
        face_count: how many faces follow these.
        width: numbers that place a vertex: two, three, or four with a homogeneous one.
        extra: numbers of its normal, colour and texture, in a stream of words.
        is_homogeneous: whether the last number divides those before it.
    """

    vertex_count: int
    face_count: int
    width: int
    extra: int
    is_homogeneous: bool

    def places(self, source: Source, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where vertices of `width` numbers stand, (V, 3).

        Raises:
            MeshError: a homogeneous coordinate is zero.
        """
        if self.is_homogeneous:
            weights = values[:, -1:]
            if (weights == 0.0).any():
                row = int(np.flatnonzero(weights[:, 0] == 0.0)[0])
                raise source.error(f"vertex {row} is at infinity: its last coordinate is 0")
            source.note("vertices are divided by their homogeneous coordinate")
            with np.errstate(over="ignore", invalid="ignore"):  # refused later, by name
                values = values[:, :-1] / weights
        if values.shape[1] == 2:
            source.note("vertices of two coordinates lie at z = 0")
            values = np.column_stack([values, np.zeros(len(values))])
        return values


def take_header(source: Source, rows: list[Row]) -> Header:
    """Remove the opening word, dimension and counts from `rows` and return what they say.

    Without an opening word, which may be left out, the file is a plain OFF.

    Raises:
        MeshError: another word, binary OFF, another dimension, counts that are none.
    """
    prefix = _take_keyword(source, rows)
    dimension = 3
    if b"n" in prefix:
        line, word = _take_word(source, rows)
        dimension = whole(source, word, line, "dimension")
        if dimension not in (2, 3) or b"4" in prefix:
            fault = f"has vertices of {dimension + (b'4' in prefix)} numbers, which is not read"
            raise source.error(fault, "export it with x, y and z", at=str(line))
    vertex_count, face_count = _take_counts(source, rows)
    extra = sum(width for letters, width in _EXTRAS if letters in prefix)
    is_homogeneous = b"4" in prefix
    return Header(vertex_count, face_count, dimension + is_homogeneous, extra, is_homogeneous)


def _take_keyword(source: Source, rows: list[Row]) -> bytes:
    """Remove the opening word from `rows` and return the letters before OFF."""
    line, words = rows[0] if rows else (1, [b""])
    if re.fullmatch(rb"\d+", words[0]):
        return b""
    found = _KEYWORD.fullmatch(words[0].upper() if words[0].islower() else words[0])
    if found is None:
        raise source.error(
            f"begins with '{shown(words[0])}', expected 'OFF'", "export it again", at=str(line)
        )
    if len(words) > 1 and words[1].upper() == b"BINARY":
        raise source.error("is binary OFF, which is not read", "export it as ASCII", at=str(line))
    rest = [found[2], *words[1:]] if found[2] else words[1:]
    if rest:
        rows[0] = (line, rest)
    else:
        del rows[0]
    return found[1].removesuffix(b"OFF")


def _take_word(source: Source, rows: list[Row]) -> tuple[int, bytes]:
    """Remove the next word from `rows` and return its line and itself."""
    if not rows:
        raise source.error("has no counts of vertices and faces", "it was cut short")
    line, words = rows[0]
    if len(words) > 1:
        rows[0] = (line, words[1:])
    else:
        del rows[0]
    return line, words[0]


def _take_counts(source: Source, rows: list[Row]) -> tuple[int, int]:
    """Remove the counts from `rows` and return those of vertices and faces.

    That of edges is not used, and may be missing where the line ends.
    """
    wanted = 2 if rows and len(rows[0][1]) == 2 else 3
    counts = []
    for _ in range(wanted):
        line, word = _take_word(source, rows)
        counts.append(whole(source, word, line, "count"))
        if counts[-1] < 0:
            raise source.error(f"count {counts[-1]} is negative", at=str(line))
    return counts[0], counts[1]
