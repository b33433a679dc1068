"""OFF (Geomview, ASCII), read by our own strict reader.

trimesh lists quads and polygons apart from triangles and moves the second half of every quad to
the end, so that rows are no longer the file's; meshio believes counts and takes bad indices.
Source: Geomview's manual, "OFF: Object File Format"; ModelNet and CGAL for what others write.
"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from obbcli.errors import MeshError
from obbcli.mesh.formats.off.header import Header, take_header
from obbcli.mesh.formats.polygons import triangulated
from obbcli.mesh.formats.text import (
    all_numbers,
    counted,
    counted_rows,
    number,
    strip_mark,
    whole,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.off.header import Row
    from obbcli.mesh.source import MeshArrays, Source

#: A face's colour is an index, or three or four numbers, up to the end of its line.
_MOST_COLOUR = 4


def read_off(source: Source) -> MeshArrays:
    """Return vertices and triangles of an OFF file; polygons are cut in the file's order.

    A vertex and a face a line where there are as many lines, whatever follows x y z; else a stream
    of words as Geomview reads it, in which only a face's colour ends with its line. Faces of one or
    two corners have no surface.

    Raises:
        MeshError: another header, counts that do not fit the lines, a bad number or index.
    """
    rows = _rows(source.data)
    header = take_header(source, rows)
    if header.vertex_count + header.face_count == len(rows):
        try:
            vertices, corners, counts = _by_lines(source, header, rows)
        except MeshError as fault:
            # Lines may be broken anywhere, and still be as many as that by chance.
            try:
                vertices, corners, counts = _by_words(source, header, rows)
            except MeshError:
                raise fault from None
    else:
        vertices, corners, counts = _by_words(source, header, rows)
    vertices = header.places(source, vertices)
    if (counts < 3).any():
        corners, counts = _with_surface(source, corners, counts)
    return vertices, triangulated(source, vertices, corners, counts)


def _rows(data: bytes) -> list[Row]:
    """Return line number and words of every line that says something, comments cut."""
    rows = []
    for line, content in enumerate(strip_mark(data).splitlines(), start=1):
        if b"#" in content:
            content = content[: content.index(b"#")]
        words = content.split()
        if words:
            rows.append((line, words))
    return rows


def _by_lines(
    source: Source, header: Header, rows: list[Row]
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Return coordinates, corners of all faces and how many each has: a row a line."""
    vertices = _vertices(source, rows[: header.vertex_count], header.width)
    corners, counts = _faces(source, rows[header.vertex_count :], header.vertex_count)
    return vertices, corners, counts


def _vertices(source: Source, rows: list[Row], width: int) -> NDArray[np.float64]:
    """Return the first `width` numbers of each row, (V, width)."""
    for line, words in rows:
        if len(words) < width:
            raise source.error(f"vertex has {len(words)} coordinates, {width} wanted", at=str(line))
    values = None
    if b"_" not in source.data:
        values = all_numbers(list(chain.from_iterable(words[:width] for _, words in rows)))
    if values is None:
        values = np.array(
            [number(source, word, line) for line, words in rows for word in words[:width]]
        )
    return values.reshape(-1, width)


def _faces(
    source: Source, rows: list[Row], vertex_count: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the corners of all faces and how many each has; colours after them are left."""
    found = None if b"_" in source.data else counted_rows([words for _, words in rows])
    if found is not None:
        corners, sizes = found
        if sizes.min() >= 1 and corners.min() >= 0 and corners.max() < vertex_count:
            return found
    flat: list[int] = []
    counts: list[int] = []
    for line, words in rows:
        count = _corner_count(source, words[0], line)
        if len(words) - 1 < count:
            raise source.error(f"face has {len(words) - 1} of its {count} vertices", at=str(line))
        flat += [_corner(source, word, line, vertex_count) for word in words[1 : 1 + count]]
        counts.append(count)
        _check_colour(source, words[1 + count :], line)
    return np.array(flat, dtype=np.int64), np.array(counts, dtype=np.int64)


def _by_words(
    source: Source, header: Header, rows: list[Row]
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Return coordinates, corners of all faces and how many each has: a stream of words."""
    words = [word for _, row in rows for word in row]
    lines = [line for line, row in rows for _ in row]
    claims = f"claims {header.vertex_count} vertices and {header.face_count} faces"
    width = header.width + header.extra
    end = header.vertex_count * width
    # A number takes a word, so no count can make us reserve more than the file is long.
    if end + header.face_count > len(words):
        raise source.error(
            f"{claims}, but {len(rows)} lines follow", "it was cut short, or its counts are wrong"
        )
    values = [number(source, words[k], lines[k]) for k in range(end)]
    vertices = np.array(values).reshape(-1, width)[:, : header.width]
    flat: list[int] = []
    counts: list[int] = []
    position = end
    for face in range(header.face_count):
        if position >= len(words):
            raise source.error(f"{claims}, but ends at face {face}", "it was cut short")
        count = _corner_count(source, words[position], lines[position])
        last = position + count
        if last >= len(words):
            raise source.error(f"{claims}, but ends inside face {face}", "it was cut short")
        flat += [
            _corner(source, words[k], lines[k], header.vertex_count)
            for k in range(position + 1, last + 1)
        ]
        counts.append(count)
        position = last + 1
        while position < len(words) and lines[position] == lines[last]:
            position += 1
        _check_colour(source, words[last + 1 : position], lines[last])
    if position < len(words):
        fault = f"{claims}, and more lines follow"
        raise source.error(fault, "correct the counts", at=str(lines[position]))
    return vertices, np.array(flat, dtype=np.int64), np.array(counts, dtype=np.int64)


def _corner_count(source: Source, word: bytes, line: int) -> int:
    """Return how many corners a face says it has."""
    count = whole(source, word, line, "corner count")
    if count < 1:
        raise source.error(f"face has {count} vertices, at least 3 wanted", at=str(line))
    return count


def _corner(source: Source, word: bytes, line: int, vertex_count: int) -> int:
    """Return a corner of a face."""
    index = whole(source, word, line, "vertex")
    if not 0 <= index < vertex_count:
        raise source.error(
            f"face uses vertex {index} of {vertex_count}", "indices start at 0", at=str(line)
        )
    return index


def _check_colour(source: Source, words: list[bytes], line: int) -> None:
    """Refuse more words after a face's corners than a colour has: they may be another face's."""
    if len(words) > _MOST_COLOUR:
        raise source.error(
            f"{len(words)} words follow a face's vertices, a colour has at most {_MOST_COLOUR}",
            "write a face a line",
            at=str(line),
        )


def _with_surface(
    source: Source, corners: NDArray[np.int64], counts: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return faces without those of one or two corners, which are points and lines."""
    keep = counts >= 3
    left = counted(int((~keep).sum()), "face")
    source.note(f"{left} of one or two corners, which have no surface, passed over")
    return corners[np.repeat(keep, counts)], counts[keep]
