"""Wavefront OBJ, read by our own strict reader.

trimesh groups faces by material and lists quads apart from triangles, so that rows are no longer
the file's; it takes index 0 and skips what it cannot read. meshio takes indices out of range.
"""

from __future__ import annotations

import math
from functools import partial
from itertools import compress
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.obj.statements import PASSED_OVER, OtherLines, is_passed_over, statements
from obbcli.mesh.formats.polygons import triangulated
from obbcli.mesh.formats.text import (
    all_numbers,
    all_whole,
    number,
    shown,
    strip_mark,
    uniform_words,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.source import MeshArrays, Source


#: Lines whose words are held at a time.
_LINES = 1 << 16


def read_obj(source: Source) -> MeshArrays:
    """Return vertices and triangles of all objects and groups, in the file's order.

    Indices may be negative (counted back from the last vertex so far) and carry `/vt/vn` parts;
    polygons are cut as `triangulated` says. Free-form surfaces are refused, not skipped; lines that
    are no statement are passed over with a note where they cannot be part of the shape.

    Raises:
        MeshError: no number, an index out of range, a line that may be part of the shape; with the
            line.
    """
    regular = _read_regular(source)
    return regular or _read_statements(source)


def _read_regular(source: Source) -> MeshArrays | None:
    """Return the mesh where all vertices are alike, and faces have vertices before them, or None.

    Whole columns at a time, three times as fast; anything odd is left to `_read_statements`, which
    knows what to do or what to say.
    """
    data = strip_mark(source.data)
    if b"\\" in data:
        return None
    lines = data.splitlines()
    vertices = [line for line in lines if line.startswith(b"v ")]
    faces = [line for line in lines if line.startswith(b"f ")]
    rest = [line for line in lines if not line.startswith((b"v ", b"f ", b"#"))]
    if not vertices or not faces or not PASSED_OVER.issuperset(filter(None, map(_keyword, rest))):
        return None
    places = _by_blocks(partial(_places, width=len(vertices[0].split())), vertices)
    named = None if places is None else _by_blocks(_corners_named, faces)
    if places is None or named is None:
        return None
    (points,), (corners, counts) = places, named
    if counts.min() < 3 or corners.min() < 1 or corners.max() > len(vertices):
        return None
    return points, triangulated(source, points, corners - 1, counts)


def _by_blocks(
    read: Callable[[list[bytes]], tuple[NDArray[Any], ...] | None], lines: list[bytes]
) -> tuple[NDArray[Any], ...] | None:
    """Return what is read of lines, some at a time, as their words take ten times the memory."""
    found = []
    for start in range(0, len(lines), _LINES):
        arrays = read(lines[start : start + _LINES])
        if arrays is None:
            return None
        found.append(arrays)
    return tuple(np.concatenate(column) for column in zip(*found, strict=True))


def _places(vertices: list[bytes], width: int) -> tuple[NDArray[np.float64]] | None:
    """Return the places (V, 3) of vertices whose lines have `width` words each, else None."""
    words = uniform_words(vertices, width)
    if words is None or width < 4:
        return None
    # Beside x, y and z there may be a weight or a colour, which must be numbers as well.
    columns = [all_numbers(words[axis::width]) for axis in range(1, width)]
    if any(column is None for column in columns):
        return None
    return (np.stack([column for column in columns[:3] if column is not None], axis=1),)


def _corners_named(faces: list[bytes]) -> tuple[NDArray[np.int64], NDArray[np.int64]] | None:
    """Return the vertices that faces name, line by line, and how many each names.

    None where a name is none, or holds an underscore, which Python takes within numbers.
    """
    widths = np.fromiter(map(len, map(bytes.split, faces)), np.int64, len(faces))
    text = b" ".join(faces)
    words = text.split()
    is_corner = np.ones(len(words), np.uint8)
    is_corner[np.cumsum(widths) - widths] = 0  # the letter that every line begins with
    names: Iterable[bytes] = compress(words, is_corner.tobytes())
    if b"/" in text:
        names = (name.partition(b"/")[0] for name in names)
    corners = None if b"_" in text else all_whole(list(names))
    return None if corners is None else (corners, widths - 1)


def _keyword(line: bytes) -> bytes:
    """Return a line's first word, empty for blank lines and comments."""
    word = line.split(None, 1)[:1]
    return b"" if not word or word[0].startswith(b"#") else word[0]


def _read_statements(source: Source) -> MeshArrays:
    """Return the mesh statement by statement."""
    coordinates: list[float] = []
    corners: list[int] = []
    counts: list[int] = []
    others = OtherLines(source)
    opens = True
    for line, words in statements(source.data):
        keyword = words[0]
        if keyword == b"v":
            coordinates += _vertex(source, words, line)
        elif keyword in (b"f", b"fo"):
            count = len(coordinates) // 3
            face = [_index(source, word, line, count) for word in words[1:]]
            if len(face) < 3:
                raise source.error(
                    f"face has {len(face)} vertices, at least 3 wanted", at=str(line)
                )
            corners += face
            counts.append(len(face))
        elif not is_passed_over(keyword):
            others.meet(words, line, opens=opens)
            continue
        opens = False
    others.tell(has_faces=bool(counts))
    vertices = np.array(coordinates, dtype=np.float64).reshape(-1, 3)
    if corners and max(corners) >= len(vertices):
        raise _out_of_range(source, len(vertices))
    rows, widths = (np.array(values, dtype=np.int64) for values in (corners, counts))
    return vertices, triangulated(source, vertices, rows, widths)


def _vertex(source: Source, words: list[bytes], line: int) -> tuple[float, float, float]:
    """Return the coordinates of a vertex; a weight or a colour may follow them."""
    try:
        x, y, z = map(float, words[1:4])
        total = sum(map(float, words[4:]), start=x + y + z)
    except ValueError:
        raise _bad_vertex(source, words, line) from None
    if not math.isfinite(total) or b"_" in b"".join(words):
        _check_numbers(source, words, line)
    return x, y, z


def _index(source: Source, word: bytes, line: int, count: int) -> int:
    """Return the 0-based vertex that a face's word names; later vertices are checked at the end."""
    part = word.partition(b"/")[0]
    try:
        index = int(part) if len(part) < 40 else None
    except ValueError:
        index = None
    if index is None or b"_" in part:
        raise source.error(f"'{shown(word)}' is not a vertex of a face", at=str(line))
    if index > 0:
        return index - 1
    if index < 0 and index >= -count:
        return count + index
    raise source.error(
        f"face uses vertex {index} of {count}",
        "indices start at 1" if index == 0 else "negative indices count back from the last vertex",
        at=str(line),
    )


def _out_of_range(source: Source, count: int) -> MeshError:
    """Return the error of the first face that uses a vertex the file does not have."""
    line, worst = next(
        (line, worst)
        for line, words in statements(source.data)
        if words[0] in (b"f", b"fo")
        and (worst := max(int(word.partition(b"/")[0]) for word in words[1:])) > count
    )
    return source.error(f"face uses vertex {worst} of {count}", "indices start at 1", at=str(line))


def _bad_vertex(source: Source, words: list[bytes], line: int) -> MeshError:
    """Return the error of a vertex that is not three numbers."""
    if len(words) < 4:
        return source.error(f"vertex has {len(words) - 1} coordinates, 3 wanted", at=str(line))
    _check_numbers(source, words, line)
    return source.error("vertex is not three numbers", at=str(line))


def _check_numbers(source: Source, words: list[bytes], line: int) -> None:
    """Raise the error of the first of a vertex's words that is not a finite number."""
    for word in words[1:]:
        number(source, word, line)
