"""The surface of a mesh of cells: its faces, and of its volume cells those met only once.

Node numbering is VTK's, which meshio turns every format into; of cells with more nodes than corners
(quadratic ones) the corners are used, which come first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.polygons import fans
from obbcli.mesh.formats.text import counted, its

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

#: Faces of each volume cell, corners counter-clockwise seen from outside (VTK).
_VOLUMES: dict[str, tuple[tuple[int, ...], ...]] = {
    "tetra": ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    "hexahedron": (
        (0, 4, 7, 3),
        (1, 2, 6, 5),
        (0, 1, 5, 4),
        (3, 7, 6, 2),
        (0, 3, 2, 1),
        (4, 5, 6, 7),
    ),
}
_SURFACES = {"triangle": 3, "quad": 4}
#: Cells without area, which no surface is made of.
_IGNORED = ("vertex", "line", "VTK_LAGRANGE_CURVE")
#: VTK's names of cells of any order, by those of first order.
_LAGRANGE = {
    "VTK_LAGRANGE_TRIANGLE": "triangle",
    "VTK_LAGRANGE_QUADRILATERAL": "quad",
    "VTK_LAGRANGE_TETRAHEDRON": "tetra",
    "VTK_LAGRANGE_PYRAMID": "pyramid",
    "VTK_LAGRANGE_WEDGE": "wedge",
    "VTK_LAGRANGE_HEXAHEDRON": "hexahedron",
}

#: Rows of corners, and how many of each row count; the rest is -1.
Faces = tuple["NDArray[np.int64]", "NDArray[np.int64]"]


class UnknownCellError(Exception):
    """A cell's type is none of those whose faces are known."""


def surface(blocks: Iterable[tuple[str, Any]], points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the triangles of a mesh of cells, (F, 3).

    First the surface cells in order; then, cell by cell and face by face, the faces that exactly
    one volume cell has and that are not among the surface cells (meshers write both).

    Args:
        blocks: type and corners (N, nodes) of each block of cells, in the file's order.
        points: (V, 3), by which the faces of volume cells are turned outwards.

    Raises:
        UnknownCellError: a type whose faces are not known.
    """
    flat, solid = [], []
    for name, cells in blocks:
        kind = _LAGRANGE.get(name, name).rstrip("0123456789")
        if kind in _IGNORED or len(cells) == 0:
            continue
        if kind in _SURFACES or kind == "polygon":
            corners = _corners(name, cells, _SURFACES.get(kind, 3))
            flat.append(_padded(corners[:, : _SURFACES.get(kind, corners.shape[1])]))
        elif kind in _VOLUMES:
            least = 1 + max(corner for face in _VOLUMES[kind] for corner in face)
            solid.append(_faces_of(_corners(name, cells, least), _VOLUMES[kind], points))
        elif kind == "polyhedron":
            solid.append(_ragged([face for cell in cells for face in cell]))
        else:
            raise UnknownCellError(name)
    given, given_counts = _stacked(flat)
    faces, counts = _stacked(solid)
    once = _met_once(given, faces)
    return fans(*_unpadded(*_stacked([(given, given_counts), (faces[once], counts[once])])))


def changes(blocks: Iterable[tuple[str, Any]]) -> list[str]:
    """Return what `surface` does not take as it stands in the file, a sentence each."""
    volumes = curved = 0
    for name, cells in blocks:
        kind = _LAGRANGE.get(name, name).rstrip("0123456789")
        faces = _VOLUMES.get(kind, ())
        least = _SURFACES.get(kind) or len({corner for face in faces for corner in face})
        volumes += len(cells) if kind in _VOLUMES or kind == "polyhedron" else 0
        curved += len(cells) if least and np.shape(cells)[-1] > least else 0
    notes = []
    if volumes:
        notes.append(f"{counted(volumes, 'volume cell')} taken as {its(volumes)} boundary")
    if curved:
        notes.append(f"{counted(curved, 'curved cell')} flattened to {its(curved)} corners")
    return notes


def _corners(name: str, cells: Any, least: int) -> NDArray[np.int64]:
    """Return cells as an array of at least as many columns as their type has corners."""
    corners = np.asarray(cells, dtype=np.int64)
    if corners.ndim != 2 or corners.shape[1] < least:
        raise UnknownCellError(f"{name} with {corners.shape[-1]} corners")
    return corners


def _padded(corners: NDArray[np.int64], wide: int = 4) -> Faces:
    """Return rows of equal length widened by -1 to at least `wide`."""
    count, width = corners.shape
    rows = np.full((count, max(wide, width)), -1, dtype=np.int64)
    rows[:, :width] = corners
    return rows, np.full(count, width, dtype=np.int64)


def _ragged(faces: list[Any]) -> Faces:
    """Return faces of different lengths as padded rows."""
    counts = np.array([len(face) for face in faces], dtype=np.int64)
    rows = np.full((len(faces), max(4, int(counts.max()))), -1, dtype=np.int64)
    for row, face in zip(rows, faces, strict=True):
        row[: len(face)] = face
    return rows, counts


def _faces_of(
    cells: NDArray[np.int64], local: tuple[tuple[int, ...], ...], points: NDArray[np.float64]
) -> Faces:
    """Return the faces of all cells, those of one cell together, turned outwards.

    By the cell's own volume: writers disagree on which way a wedge is numbered.
    """
    rows = np.full((len(cells), len(local), 4), -1, dtype=np.int64)
    for face, corners in enumerate(local):
        rows[:, face, : len(corners)] = cells[:, corners]
    inverted = _signed_volumes(rows, points) < 0
    for face, corners in enumerate(local):
        rows[inverted, face, : len(corners)] = cells[inverted][:, corners[::-1]]
    counts = np.tile([len(corners) for corners in local], len(cells))
    return rows.reshape(-1, 4), counts.astype(np.int64)


def _signed_volumes(rows: NDArray[np.int64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a multiple of each cell's volume by its faces (N, faces, 4): above 0 if outwards."""
    finite = np.where(np.isfinite(points), points, 0.0)
    exponent = np.frexp(np.abs(finite).max(initial=0.0))[1]
    corners = np.ldexp(finite, -exponent)[rows]
    a, b, c, d = np.moveaxis(corners - corners[:, :1, :1], 2, 0)
    # A face of three corners is padded with -1, which no product may see.
    d = np.where((rows[:, :, 3] < 0)[:, :, np.newaxis], c, d)
    products = a * np.cross(b, c) + a * np.cross(c, d)
    return np.asarray(products.sum(axis=(1, 2)))


def _stacked(blocks: list[Faces]) -> Faces:
    """Return all blocks' rows under one another, padded to one width."""
    width = max([4, *(rows.shape[1] for rows, _ in blocks)])
    rows = [_padded(rows, width)[0] for rows, _ in blocks]
    empty = np.zeros((0, width), dtype=np.int64)
    none = np.zeros(0, dtype=np.int64)
    return np.vstack([empty, *rows]), np.hstack([none, *(counts for _, counts in blocks)])


def _met_once(given: NDArray[np.int64], faces: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which of `faces` no other row of `faces` and none of `given` has the corners of.

    Corners are compared as sets, so a hexahedron collapsed to a wedge meets its neighbours; a face
    collapsed to fewer than three corners is none.
    """
    width = max(given.shape[1], faces.shape[1])
    rows = np.sort(np.vstack([_padded(faces, width)[0], _padded(given, width)[0]]), axis=1)
    rows[:, 1:][rows[:, 1:] == rows[:, :-1]] = -1
    rows.sort(axis=1)
    order = np.lexsort(rows.T)
    ordered = rows[order]
    same = (ordered[1:] == ordered[:-1]).all(axis=1)
    alone = np.ones(len(rows), dtype=bool)
    alone[1:][same] = False
    alone[:-1][same] = False
    once = np.empty(len(rows), dtype=bool)
    once[order] = alone
    real = (rows >= 0).sum(axis=1) >= 3
    result: NDArray[np.bool_] = (once & real)[: len(faces)]
    return result


def _unpadded(rows: NDArray[np.int64], counts: NDArray[np.int64]) -> Faces:
    """Return the corners that count, end to end, with each row's count.

    A corner that repeats the one before it is dropped while three are left: formats that know only
    quads write a triangle so.
    """
    inside = np.arange(rows.shape[1]) < counts[:, np.newaxis]
    distinct = inside.copy()
    distinct[:, 1:] &= rows[:, 1:] != rows[:, :-1]
    keep = np.where((distinct.sum(axis=1) >= 3)[:, np.newaxis], distinct, inside)
    return rows[keep], keep.sum(axis=1)
