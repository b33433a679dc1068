"""The surface of a mesh of cells: its faces, and of its volume cells those met only once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from obbcli.mesh.formats.cells.faces import (
    check_nodes,
    faces_of_cells,
    faces_of_polyhedra,
    faces_of_volumes,
    polygons,
)
from obbcli.mesh.formats.cells.repeats import repeated_volumes
from obbcli.mesh.formats.cells.types import CELLS, WITHOUT_AREA
from obbcli.mesh.formats.polygons import triangulated
from obbcli.mesh.formats.text import counted, its

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from obbcli.mesh.formats.cells.faces import Faces
    from obbcli.mesh.source import Source


class Block(NamedTuple):
    """Cells of one type.

    Attributes:
        kind: a name of `CELLS` or `WITHOUT_AREA`, `polygon` or `polyhedron`.
        nodes: (N, nodes of one cell), rows of the points, numbered as VTK does; -1 stands for a
            middle node that a cell does not have. Of polyhedra a list: cells, their faces, corners.
        places: (N,), where each cell stands among the cells of all blocks, which makes the order
            of the triangles; None: after the blocks before.
    """

    kind: str
    nodes: Any
    places: NDArray[np.int64] | None = None


def surface(
    source: Source, points: NDArray[np.float64], blocks: Iterable[Block]
) -> NDArray[np.int64]:
    """Return the triangles of a mesh of cells, (F, 3).

    First the surface cells in order; then, cell by cell and face by face, the faces that exactly
    one volume cell has and that are not among the surface cells (meshers write both). Faces are
    compared by their corners. Those with middle nodes are cut into flat pieces through all their
    nodes. What is changed is told in the source's notes.

    Args:
        source: the file, which is given the notes.
        points: (V, 3); by them the faces of volume cells are turned outwards.
        blocks: the cells, in the file's order.

    Raises:
        MeshError: a type whose faces are not known, or a node that is no point.
    """
    flat: list[Faces] = []
    solid: list[Faces] = []
    volume_count = 0
    for block in _once_each(source, points, blocks):
        nodes, places = block.nodes, np.asarray(block.places)
        if block.kind == "polyhedron":
            volume_count += len(nodes)
            solid += faces_of_polyhedra(source, nodes, places, len(points))
        elif block.kind == "polygon":
            flat.append(polygons(nodes, places))
        elif (cell := CELLS[block.kind]).is_volume:
            volume_count += len(nodes)
            solid += faces_of_volumes(cell, nodes, places, points)
        else:
            flat += faces_of_cells(cell, nodes, places)
    once = _met_once(flat, solid)
    kept = [faces.only(rows) for faces, rows in zip(solid, once, strict=True)]
    _tell(source, volume_count, flat, kept)
    pieces, counts = _in_order(flat, kept)
    return triangulated(source, points, pieces, counts)


def _once_each(source: Source, points: NDArray[np.float64], blocks: Iterable[Block]) -> list[Block]:
    """Return the cells that have faces, checked and with places, and each volume once."""
    found = []
    start = 0
    for block in blocks:
        count = len(block.nodes)
        places = block.places if block.places is not None else start + np.arange(count)
        start += count
        if block.kind in WITHOUT_AREA or count == 0:
            continue
        is_list = block.kind == "polyhedron"
        nodes = block.nodes if is_list else _checked(source, block, len(points))
        found.append(Block(block.kind, nodes, places))
    repeated = repeated_volumes(source, [(block.kind, block.nodes) for block in found])
    return [
        Block(block.kind, block.nodes[~again], block.places[~again]) if again.any() else block
        for block, again in zip(found, repeated, strict=True)
        if block.places is not None
    ]


def _checked(source: Source, block: Block, point_count: int) -> NDArray[np.int64]:
    """Return the cells of a block as an array of as many columns as their type has nodes."""
    kind = block.kind
    nodes = np.asarray(block.nodes)
    remedy = "convert them to triangles or tetrahedra"
    if kind not in CELLS and kind != "polygon":
        raise source.error(f"cells of type {kind} are not read", remedy)
    wanted = CELLS[kind].node_count if kind in CELLS else max(3, nodes.shape[-1])
    if nodes.ndim != 2 or nodes.dtype.kind not in "iu" or nodes.shape[1] != wanted:
        fault = f"cells of type {kind} with {nodes.shape[-1]} nodes are not read"
        raise source.error(fault, remedy)
    corner_count = 1 + max(max(face.corners) for face in CELLS[kind].faces) if kind in CELLS else 0
    missing = (nodes == -1) & (np.arange(wanted) >= (corner_count or wanted))
    check_nodes(source, kind, np.where(missing, 0, nodes), point_count)
    return nodes.astype(np.int64)


def _met_once(given: list[Faces], faces: list[Faces]) -> list[NDArray[np.bool_]]:
    """Return which of `faces` no other of `faces` and none of `given` has the corners of.

    Corners are compared as sets, so a hexahedron collapsed to a wedge meets its neighbours; a face
    collapsed to fewer than three corners is none.
    """
    width = max([4, *(each.corners.shape[1] for each in (*given, *faces))])
    rows = np.vstack([np.zeros((0, width), np.int64), *(_padded(f.corners, width) for f in faces)])
    rows = np.vstack([rows, *(_padded(f.corners, width) for f in given)])
    rows.sort(axis=1)
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
    real = once & ((rows >= 0).sum(axis=1) >= 3)
    ends = np.cumsum([len(each.corners) for each in faces])
    return np.split(real[: ends[-1] if len(ends) else 0], ends[:-1]) if faces else []


def _padded(corners: NDArray[np.int64], width: int) -> NDArray[np.int64]:
    """Return rows widened by -1."""
    rows = np.full((len(corners), width), -1, dtype=np.int64)
    rows[:, : corners.shape[1]] = corners
    return rows


def _in_order(flat: list[Faces], solid: list[Faces]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the pieces of all faces, end to end, with each one's count of corners.

    Ordered by: surface cells before volumes, cells, faces of a cell, pieces of a face.
    """
    both = [*((0, faces) for faces in flat), *((1, faces) for faces in solid)]
    width = max([4, *(faces.pieces.shape[2] for _, faces in both)])
    rows, keys = [np.zeros((0, width), np.int64)], [np.zeros((0, 3), np.int64)]
    for side, faces in both:
        pieces = faces.pieces.reshape(-1, faces.pieces.shape[2])
        place = np.repeat(faces.places, faces.pieces.shape[1])
        key = np.full((len(place), 3), (side, 0, faces.number))
        key[:, 1] = place
        real = _distinct(pieces) >= 3 if faces.is_cut else np.ones(len(pieces), dtype=bool)
        rows.append(_padded(pieces[real], width))
        keys.append(key[real])
    stacked, key = np.vstack(rows), np.vstack(keys)
    # Stable: the pieces of a face stay in their order.
    order = np.lexsort((key[:, 2], key[:, 1], key[:, 0]))
    return _unpadded(stacked[order])


def _triangle_count(pieces: NDArray[np.int64]) -> int:
    """Return how many triangles the pieces of faces become."""
    counts = _distinct(pieces.reshape(-1, pieces.shape[2])) - 2
    return int(counts[counts > 0].sum())


def _distinct(pieces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return how many different nodes each polygon has."""
    ordered = np.sort(pieces, axis=1)
    new = np.ones(ordered.shape, dtype=bool)
    new[:, 1:] = ordered[:, 1:] != ordered[:, :-1]
    return np.asarray((new & (ordered >= 0)).sum(axis=1))


def _unpadded(rows: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the corners that count, end to end, with each row's count.

    A corner that repeats the one before it is dropped while three are left: formats that know only
    quads write a triangle so.
    """
    inside = rows >= 0
    distinct = inside.copy()
    distinct[:, 1:] &= rows[:, 1:] != rows[:, :-1]
    keep = np.where((distinct.sum(axis=1) >= 3)[:, np.newaxis], distinct, inside)
    return rows[keep], keep.sum(axis=1)


def _tell(source: Source, volume_count: int, flat: list[Faces], solid: list[Faces]) -> None:
    """Write the notes: volumes taken as their boundary, and faces cut at their nodes."""
    if volume_count:
        what = counted(volume_count, "volume cell")
        source.note(f"{what} taken as {its(volume_count)} boundary")
    for name in dict.fromkeys(faces.name for faces in flat):
        _tell_cut(source, name, "", [faces for faces in flat if faces.name == name])
    _tell_cut(source, "quadratic face", " of volume cells", solid)


def _tell_cut(source: Source, name: str, more: str, faces: list[Faces]) -> None:
    """Write the note on faces that are cut at their middle nodes, where there are any."""
    cut = [each for each in faces if each.is_cut]
    count = sum(len(each.corners) for each in cut)
    pieces = sum(_triangle_count(each.pieces) for each in cut)
    if count:
        what = counted(count, name) + more
        source.note(f"{what} cut into {pieces} flat pieces through {its(count)} nodes")
