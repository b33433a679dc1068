"""Faces of the cells of a mesh as arrays: one face of each of several cells at a time."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from obbcli.mesh.formats.cells.types import Cell
    from obbcli.mesh.source import Source


class Faces(NamedTuple):
    """One face of each of several cells.

    Attributes:
        corners: (N, corners).
        pieces: the polygons each is cut into, (N, pieces, corners), -1 where a piece has fewer.
        places: (N,), of the cells.
        number: which face of its cell it is.
        name: of the cells, as notes call them.
        is_cut: whether the face has middle nodes.
    """

    corners: NDArray[np.int64]
    pieces: NDArray[np.int64]
    places: NDArray[np.int64]
    number: int
    name: str
    is_cut: bool

    def only(self, rows: NDArray[np.bool_]) -> Faces:
        """Return those of some of the cells."""
        return self._replace(
            corners=self.corners[rows], pieces=self.pieces[rows], places=self.places[rows]
        )


def polygons(nodes: NDArray[np.int64], places: NDArray[np.int64]) -> Faces:
    """Return cells that are polygons, (N, corners)."""
    return Faces(nodes, nodes[:, np.newaxis], places, 0, "polygon", is_cut=False)


def faces_of_cells(cell: Cell, nodes: NDArray[np.int64], places: NDArray[np.int64]) -> list[Faces]:
    """Return each face of cells of one type.

    A middle node that is missing is taken to be the corner after it: the pieces around it then
    leave the straight edge.
    """
    found = []
    for number, face in enumerate(cell.faces):
        full = nodes
        if (nodes < 0).any():
            full = nodes.copy()
            for node, after in zip(face.nodes, (*face.nodes[1:], face.nodes[0]), strict=True):
                full[:, node] = np.where(full[:, node] < 0, full[:, after], full[:, node])
            if face.center is not None:
                center = full[:, face.center]
                full[:, face.center] = np.where(center < 0, full[:, face.corners[0]], center)
        width = max(len(piece) for piece in face.pieces)
        pieces = np.full((len(nodes), len(face.pieces), width), -1, dtype=np.int64)
        for k, piece in enumerate(face.pieces):
            pieces[:, k, : len(piece)] = full[:, piece]
        corners = nodes[:, face.corners]
        is_cut = not face.is_flat
        found.append(Faces(corners, pieces, places, number, cell.name, is_cut))
    return found


def faces_of_volumes(
    cell: Cell, nodes: NDArray[np.int64], places: NDArray[np.int64], points: NDArray[np.float64]
) -> list[Faces]:
    """Return the faces of volume cells of one type, turned outwards.

    By each cell's own volume: writers disagree on which way a wedge is numbered.
    """
    inverted = signed_volumes(nodes, [face.corners for face in cell.faces], points) < 0
    found = []
    for faces in faces_of_cells(cell, nodes, places):
        corners, pieces = faces.corners.copy(), faces.pieces.copy()
        corners[inverted] = corners[inverted, ::-1]
        pieces[inverted] = _turned(pieces[inverted])
        found.append(faces._replace(corners=corners, pieces=pieces))
    return found


def _turned(pieces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return polygons, (N, pieces, corners), the other way round; what pads them stays last."""
    turned = pieces[:, :, ::-1].copy()
    short = turned[:, :, 0] < 0
    while short.any():
        turned[short] = np.roll(turned[short], -1, axis=1)
        short = turned[:, :, 0] < 0
    return np.asarray(turned)


def signed_volumes(
    nodes: NDArray[np.int64], faces: Sequence[tuple[int, ...]], points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return a multiple of each cell's volume by its corners: above 0 if faces point outwards."""
    finite = np.where(np.isfinite(points), points, 0.0)
    exponent = np.frexp(np.abs(finite).max(initial=0.0))[1]
    places = np.ldexp(finite, -exponent)
    origin = places[nodes[:, faces[0][0]]]
    total = np.zeros(len(nodes))
    for face in faces:
        ring = [places[nodes[:, corner]] - origin for corner in face]
        for b, c in pairwise(ring[1:]):
            total += (ring[0] * np.cross(b, c)).sum(axis=1)
    return total


def faces_of_polyhedra(
    source: Source, cells: Sequence[Any], places: NDArray[np.int64], point_count: int
) -> list[Faces]:
    """Return the faces of polyhedra as the file turns them, those of equally many corners at once.

    Each is numbered by its place in its cell.
    """
    alike: dict[tuple[int, int], tuple[list[Any], list[int]]] = {}
    for place, cell in zip(places.tolist(), cells, strict=True):
        for number, face in enumerate(cell):
            rows, of_cells = alike.setdefault((number, len(face)), ([], []))
            rows.append(face)
            of_cells.append(place)
    found = []
    for (number, count), (rows, of_cells) in alike.items():
        if count < 3:
            raise source.error(f"a polyhedron has a face of {count} corners", "export it again")
        corners = np.asarray(rows, dtype=np.int64)
        check_nodes(source, "polyhedron's face", corners, point_count)
        found.append(polygons(corners, np.array(of_cells))._replace(number=number))
    return found


def check_nodes(source: Source, kind: str, nodes: NDArray[Any], point_count: int) -> None:
    """Refuse cells that use points the file does not have, also inside of a volume.

    Raises:
        MeshError: with the first of them.
    """
    outside = (nodes < 0) | (nodes >= point_count)
    if outside.any():
        row = int(np.flatnonzero(outside.any(axis=1))[0])
        worst = nodes[row][outside[row]][0]
        raise source.error(
            f"{kind} {row} uses point {worst} of {point_count} (counted from 0)", "export it again"
        )
