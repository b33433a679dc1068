"""OFF (Geomview, ASCII), read by our own strict reader.

trimesh lists quads and polygons apart from triangles and moves the second half of every quad to
the end, so that rows are no longer the file's; meshio believes counts and takes bad indices.
"""

from __future__ import annotations

import re
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.polygons import triangulated
from obbcli.mesh.formats.text import all_numbers, all_whole, number, strip_mark, uniform_rows, whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.source import MeshArrays, Source

#: Texture, colour and normal variants: what they add follows x y z and is passed over.
_HEADER = re.compile(rb"(ST)?C?N?OFF", re.IGNORECASE)

#: A line's number and its words.
Row = tuple[int, list[bytes]]


def read_off(source: Source) -> MeshArrays:
    """Return vertices and triangles of an OFF file; polygons are cut in the file's order.

    Raises:
        MeshError: another header, counts that do not fit the lines, a bad number or index.
    """
    rows = _rows(source.data)
    _take_header(source, rows)
    vertex_count, face_count = _take_counts(source, rows)
    wanted = vertex_count + face_count
    # A row takes a line, so no count can make us reserve more than the file is long.
    if wanted > len(rows):
        raise source.error(
            f"claims {vertex_count} vertices and {face_count} faces, but {len(rows)} lines follow",
            "it was cut short, or its counts are wrong",
        )
    if wanted < len(rows):
        raise source.error(
            f"claims {vertex_count} vertices and {face_count} faces, and more lines follow",
            "correct the counts",
            at=str(rows[wanted][0]),
        )
    vertices = _vertices(source, rows[:vertex_count])
    corners, counts = _faces(source, rows[vertex_count:], vertex_count)
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


def _take_header(source: Source, rows: list[Row]) -> None:
    """Remove the opening word from `rows`; the counts may follow it on its line."""
    line, words = rows[0] if rows else (1, [b""])
    shown = words[0][:20].decode("latin-1")
    if not _HEADER.fullmatch(words[0]):
        raise source.error(f"begins with '{shown}', expected 'OFF'", at=str(line))
    if len(words) > 1 and words[1].upper() == b"BINARY":
        raise source.error("is binary OFF, which is not read", "export it as ASCII", at=str(line))
    if len(words) > 1:
        rows[0] = (line, words[1:])
    else:
        del rows[0]


def _take_counts(source: Source, rows: list[Row]) -> tuple[int, int]:
    """Remove the counts from `rows` and return those of vertices and faces; edges are not used."""
    if not rows:
        raise source.error("has no counts of vertices and faces", "it was cut short")
    line, words = rows.pop(0)
    if len(words) not in (2, 3):
        raise source.error(
            f"found {len(words)} counts, expected vertices, faces and edges", at=str(line)
        )
    counts = [whole(source, word, line, "count") for word in words]
    if min(counts) < 0:
        raise source.error(f"count {min(counts)} is negative", at=str(line))
    return counts[0], counts[1]


def _vertices(source: Source, rows: list[Row]) -> NDArray[np.float64]:
    """Return the first three numbers of each row, (V, 3)."""
    for line, words in rows:
        if len(words) < 3:
            raise source.error(f"vertex has {len(words)} coordinates, 3 wanted", at=str(line))
    values = None
    if b"_" not in source.data:
        values = all_numbers(list(chain.from_iterable(words[:3] for _, words in rows)))
    if values is None:
        values = np.array(
            [number(source, word, line) for line, words in rows for word in words[:3]]
        )
    return values.reshape(-1, 3)


def _faces(
    source: Source, rows: list[Row], vertex_count: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the corners of all faces and how many each has; colours after them are left."""
    table = None if b"_" in source.data else uniform_rows([words for _, words in rows], 4)
    values = None if table is None else all_whole(table)
    if values is not None and len(values):
        square = values.reshape(-1, 4)
        corners = square[:, 1:]
        if (square[:, 0] == 3).all() and corners.min() >= 0 and corners.max() < vertex_count:
            return corners.reshape(-1), square[:, 0]
    flat: list[int] = []
    counts: list[int] = []
    for line, words in rows:
        face = _face(source, words, line, vertex_count)
        flat += face
        counts.append(len(face))
    return np.array(flat, dtype=np.int64), np.array(counts, dtype=np.int64)


def _face(source: Source, words: list[bytes], line: int, vertex_count: int) -> list[int]:
    """Return one face's corners."""
    count = whole(source, words[0], line, "corner count")
    if count < 3:
        raise source.error(f"face has {count} vertices, at least 3 wanted", at=str(line))
    if len(words) - 1 < count:
        raise source.error(f"face has {len(words) - 1} of its {count} vertices", at=str(line))
    face = [whole(source, word, line, "vertex") for word in words[1 : 1 + count]]
    for index in face:
        if not 0 <= index < vertex_count:
            raise source.error(
                f"face uses vertex {index} of {vertex_count}", "indices start at 0", at=str(line)
            )
    return face
