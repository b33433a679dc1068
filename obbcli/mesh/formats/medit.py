"""Medit (`.mesh`) and its binary form (`.meshb`) of libMeshb, read by our own reader.

meshio wants counts on lines of their own and takes comments for keywords.
"""

from __future__ import annotations

import re
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from obbcli.mesh.formats.cells.surface import Block, surface
from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.source import MeshArrays, Source

    Ints = NDArray[np.int64]


class _Cells(NamedTuple):
    """A keyword of cells: its number in binary files, and their type in `cell_types`."""

    code: int
    kind: str
    node_count: int


_CELLS = {
    "edges": _Cells(5, "line", 2),
    "triangles": _Cells(6, "triangle", 3),
    "quadrilaterals": _Cells(7, "quad", 4),
    "tetrahedra": _Cells(8, "tetra", 4),
    "prisms": _Cells(9, "wedge", 6),
    "hexahedra": _Cells(10, "hexahedron", 8),
    "pyramids": _Cells(49, "pyramid", 5),
    "edgesp2": _Cells(25, "line3", 3),
    "trianglesp2": _Cells(24, "triangle6", 6),
    "quadrilateralsq2": _Cells(27, "quad9", 9),
    "tetrahedrap2": _Cells(30, "tetra10", 10),
}
#: Marks, normals, links to other geometry, results: of no surface, with their binary numbers.
_PASSED_OVER = {
    "corners": 13,
    "ridges": 14,
    "requiredvertices": 15,
    "requirededges": 16,
    "requiredtriangles": 17,
    "requiredquadrilaterals": 18,
    "tangentatedgevertices": 19,
    "normalatvertices": 20,
    "normalattrianglevertices": 21,
    "angleofcornerbound": 23,
    "normalatquadrilateralvertices": 22,
    "subdomainfromgeom": 29,
    "subdomainfrommesh": -1,
    "verticesongeometricvertices": 40,
    "verticesongeometricedges": 41,
    "boundingbox": 50,
    "verticesongeometrictriangles": 42,
    "verticesongeometricquadrilaterals": 43,
    "edgesongeometricedges": 44,
    "privatetable": 52,
    "tangents": 59,
    "normals": 60,
    "tangentatvertices": 61,
    "iterations": 77,
    "time": 78,
    "comments": 81,
}
_VERTICES, _DIMENSION, _VERSION, _END = "vertices", "dimension", "meshversionformatted", "end"
_CODES = {
    **{cells.code: name for name, cells in _CELLS.items()},
    **{code: name for name, code in _PASSED_OVER.items()},
    1: _VERSION,
    3: _DIMENSION,
    4: _VERTICES,
    54: _END,
}
_COMMENT = re.compile(rb"#[^\n]*")
_KEYWORD = re.compile(rb"(?<![^\s])(?!(?i:nan|inf|infinity)(?!\S))[A-Za-z]\S*")
_CUT = "it was cut short, or its counts are wrong"


class _Part(NamedTuple):
    """What stands under one keyword.

    Attributes:
        keyword: in small letters.
        place: its line, or the byte where it begins.
        rows: (N, numbers a row), or (N,) where the keyword does not tell.
    """

    keyword: str
    place: str
    rows: NDArray[Any]


def read_medit(source: Source) -> MeshArrays:
    """Return points and triangles of a Medit file, flat ones at z = 0.

    Raises:
        MeshError: a keyword that is not known, a count or number that does not fit, a vertex that
            is not there.
    """
    is_binary = source.data[:4] in (b"\1\0\0\0", b"\0\0\0\1")
    parts = _binary_parts(source) if is_binary else _text_parts(source)
    vertices = [part for part in parts if part.keyword == _VERTICES]
    if len(vertices) != 1:
        fault = f"has {len(vertices)} sections Vertices, expected 1"
        raise source.error(fault, "it was cut short, or is no mesh")
    places = vertices[0].rows[:, :-1].astype(np.float64)
    points = np.zeros((len(places), 3))
    points[:, : places.shape[1]] = places
    blocks = [_block(source, part, len(points)) for part in parts if part.keyword in _CELLS]
    return points, surface(source, points, blocks)


def _block(source: Source, part: _Part, point_count: int) -> Block:
    """Return cells with rows of points, counted from 0, and without their marks."""
    tags = part.rows[:, :-1]
    bad = (tags < 1) | (tags > point_count) | (tags != np.floor(tags))
    if bad.any():
        row = int(np.argmax(bad.any(axis=1)))
        found = f"{tags[row][bad[row]][0]:.15g}"
        fault = f"{part.keyword} {row + 1} uses vertex {found} of {point_count}"
        raise source.error(fault, "vertices are counted from 1", at=part.place)
    return Block(_CELLS[part.keyword].kind, tags.astype(np.int64) - 1)


def _text_parts(source: Source) -> list[_Part]:
    """Return what stands under the keywords of a text file that make or place surface."""
    text = _COMMENT.sub(lambda found: b" " * len(found[0]), source.data)
    words = list(_KEYWORD.finditer(text))
    if text[: words[0].start() if words else len(text)].strip():
        raise source.error("does not begin with a keyword", "it is no Medit file", at="1")
    parts: list[_Part] = []
    dimension = 0
    for number, word in enumerate(words):
        keyword = word[0].decode("latin-1").lower()
        line = str(text.count(b"\n", 0, word.start()) + 1)
        if keyword == _END:
            break
        _refuse_unknown(source, keyword, line)
        if keyword in _PASSED_OVER:
            continue
        stop = words[number + 1].start() if number + 1 < len(words) else len(text)
        values = _numbers(source, text[word.end() : stop], keyword, line)
        if keyword in (_DIMENSION, _VERSION):
            if len(values) != 1 or (keyword == _DIMENSION and values[0] not in (2, 3)):
                raise source.error(f"{keyword} is not one number, 2 or 3", _CUT, at=line)
            dimension = int(values[0]) if keyword == _DIMENSION else dimension
            continue
        width = _width(source, keyword, dimension, line)
        count = values[0] if len(values) else -1
        if len(values) != 1 + count * width:
            fault = f"{keyword} claims {count:.15g} rows of {width} numbers, and "
            fault += f"{max(0, len(values) - 1)} numbers follow"
            raise source.error(fault, _CUT, at=line)
        parts.append(_Part(keyword, line, values[1:].reshape(-1, width)))
    return parts


def _numbers(source: Source, text: bytes, keyword: str, line: str) -> NDArray[np.float64]:
    with warnings.catch_warnings():  # before NumPy 2.3 a warning says that it stopped early
        warnings.simplefilter("error")
        try:
            return np.fromstring(text, sep=" ")
        except (ValueError, DeprecationWarning) as fault:
            what = f"a word under {keyword} is no number"
            raise source.error(what, "export it again", at=line) from fault


def _width(source: Source, keyword: str, dimension: int, place: str) -> int:
    """Return how many numbers a row has, its mark among them."""
    if keyword != _VERTICES:
        return _CELLS[keyword].node_count + 1
    if not dimension:
        raise source.error("has vertices before their dimension", "export it again", at=place)
    return dimension + 1


def _refuse_unknown(source: Source, keyword: str, place: str) -> None:
    known = (_DIMENSION, _VERSION, _VERTICES, _END)
    if keyword not in (*known, *_CELLS, *_PASSED_OVER):
        fault = f"'{shown(keyword.encode())}' is no keyword that is read"
        raise source.error(fault, "remove it if it is no part of the shape", at=place)


def _binary_parts(source: Source) -> list[_Part]:
    """Return what stands under the keywords of a binary file that make or place surface."""
    return _BinaryReader(source).parts()


class _BinaryReader:
    """Reads a binary file keyword by keyword; each says where the next begins."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._data = source.data
        self._order = "<" if source.data[0] == 1 else ">"
        self._at = 4
        self._version = int(self._take("i4")[0])
        if not 1 <= self._version <= 4:
            raise self._error(f"is of version {self._version}, 1 to 4 are read")
        self._whole = "i8" if self._version == 4 else "i4"
        self._dimension = 0

    def parts(self) -> list[_Part]:
        """Return the parts."""
        parts: list[_Part] = []
        while self._at < len(self._data):
            start = self._at
            code = int(self._take("i4")[0])
            keyword = _CODES.get(code, f"number {code}")
            if keyword == _END:
                return parts
            following = int(self._take("i8" if self._version >= 3 else "i4")[0])
            if keyword == _VERSION:
                keyword = "a second version"
            _refuse_unknown(self._source, keyword, f"byte {start}")
            if keyword == _DIMENSION:
                self._dimension = int(self._take("i4")[0])
                if self._dimension not in (2, 3):
                    raise self._error(f"has {self._dimension} dimensions, 2 or 3 are read")
            elif keyword not in _PASSED_OVER:
                parts.append(_Part(keyword, f"byte {start}", self._rows(keyword, start)))
            if following and (following < self._at or following > len(self._data)):
                raise self._error(f"says that the next keyword begins at byte {following}")
            self._at = following or len(self._data)
        raise self._error("has no keyword End")

    def _rows(self, keyword: str, start: int) -> NDArray[Any]:
        """Return the rows of one keyword as numbers of one type."""
        count = int(self._take(self._whole)[0])
        width = _width(self._source, keyword, self._dimension, f"byte {start}")
        if keyword != _VERTICES:
            return self._take(self._whole, count * width).reshape(-1, width)
        real = "f4" if self._version == 1 else "f8"
        order = self._order
        row = [("place", f"{order}{real}", (width - 1,)), ("mark", f"{order}{self._whole}")]
        rows = self._take(row, count)
        return np.column_stack([rows["place"].astype(np.float64), rows["mark"]])

    def _take(self, kind: Any, count: int = 1) -> NDArray[Any]:
        item = np.dtype(kind).newbyteorder(self._order)
        left = len(self._data) - self._at
        if not 0 <= count * item.itemsize <= left:
            raise self._error(f"claims {count * item.itemsize} bytes, and {left} follow")
        found = np.frombuffer(self._data, item, count, self._at)
        self._at += count * item.itemsize
        return found

    def _error(self, fault: str) -> MeshError:
        return self._source.error(fault, _CUT, at=f"byte {self._at}")
