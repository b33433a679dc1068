"""VTK's data sets as blocks of cells: grids of cells and surfaces, with the number of each cell."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.formats.text import counted
from obbcli.mesh.formats.vtk.modules import GHOSTS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.source import Source

    Ints = NDArray[np.int64]

#: VTK's numbers of types by the names of `cell_types`.
_NAMES = {
    0: "empty",
    1: "vertex",
    2: "polyvertex",
    3: "line",
    4: "polyline",
    21: "line3",
    35: "line4",
    68: "VTK_LAGRANGE_CURVE",
    75: "VTK_LAGRANGE_CURVE",
    5: "triangle",
    7: "polygon",
    9: "quad",
    10: "tetra",
    12: "hexahedron",
    13: "wedge",
    14: "pyramid",
    15: "penta_prism",
    16: "hexa_prism",
    22: "triangle6",
    23: "quad8",
    24: "tetra10",
    25: "hexahedron20",
    26: "wedge15",
    27: "pyramid13",
    28: "quad9",
    29: "hexahedron27",
    30: "quad6",
    31: "wedge12",
    32: "wedge18",
    33: "hexahedron24",
    34: "triangle7",
    37: "pyramid19",
}
_STRIP, _PIXEL, _VOXEL, _QUADRATIC_POLYGON, _POLYHEDRON = 6, 8, 11, 36, 42
_PIXEL_AS_QUAD = [0, 1, 3, 2]
_VOXEL_AS_HEXAHEDRON = [0, 1, 3, 2, 4, 5, 7, 6]
#: Cells of any order (number, nodes), where so many nodes are numbered as in other types.
_ANY_ORDER = {
    (69, 3): "triangle",
    (69, 6): "triangle6",
    (70, 4): "quad",
    (70, 9): "quad9",
    (71, 4): "tetra",
    (71, 10): "tetra10",
    (72, 8): "hexahedron",
    (73, 6): "wedge",
    (74, 5): "pyramid",
}
#: Marks of cells that are copies of another piece's, refined away, or hidden; and of hidden points.
_LEFT_OUT, _HIDDEN_POINT = 1 | 8 | 32, 2


def points_of(data_set: Any) -> NDArray[np.float64]:
    """Return the points of a data set that lists them, (V, 3)."""
    points = data_set.GetPoints()
    if points is None:
        return np.zeros((0, 3))
    return np.array(numbers(points.GetData()), dtype=np.float64).reshape(-1, 3)


def kept_cells(source: Source, data_set: Any) -> NDArray[np.bool_] | None:
    """Return which cells of a data set are its own, (N,); None where all are.

    Copies of the cells of other pieces, and those that are hidden, are left out and told.

    Raises:
        MeshError: points are hidden.
    """
    of_points = data_set.GetPointData().GetArray(GHOSTS)
    if of_points is not None and (numbers(of_points) & _HIDDEN_POINT).any():
        raise source.error("hides some of its points (vtkGhostType)", "extract its surface")
    of_cells = data_set.GetCellData().GetArray(GHOSTS)
    if of_cells is None:
        return None
    kept = np.asarray((numbers(of_cells) & _LEFT_OUT) == 0)
    left = int(np.count_nonzero(~kept))
    if left:
        source.note(f"{counted(left, 'cell')} left out that {GHOSTS} marks as copied or hidden")
    return kept


def grid_blocks(source: Source, grid: Any, kept: NDArray[np.bool_] | None) -> Iterator[Block]:
    """Yield the cells of an unstructured grid, those of one type and count of nodes together.

    Args:
        source: the file.
        grid: VTK's.
        kept: which cells to take; None for all.

    Raises:
        MeshError: a type that is not known.
    """
    starts, nodes = _list_of(grid.GetCells())
    types = _types(grid)
    counts = np.diff(starts)
    wanted = np.ones(len(types), dtype=bool) if kept is None else kept
    _tell(source, types[wanted], counts[wanted])
    for kind, count in np.unique(np.stack([types, counts]), axis=1).T.tolist():
        places = np.flatnonzero((types == kind) & (counts == count) & wanted)
        if len(places) == 0:
            continue
        if kind == _POLYHEDRON:
            yield Block("polyhedron", [_faces(grid, cell) for cell in places.tolist()], places)
        else:
            rows = nodes[starts[places, np.newaxis] + np.arange(count)]
            yield _block(source, kind, rows, places)


def surface_blocks(source: Source, surface: Any, kept: NDArray[np.bool_] | None) -> Iterator[Block]:
    """Yield the polygons and strips of a surface data set; its points and lines have no area.

    Args:
        source: the file.
        surface: VTK's.
        kept: which cells to take, of points, lines, polygons and strips in this order.

    Raises:
        MeshError: a polygon of fewer than three corners.
    """
    before = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
    for cells, kind in ((surface.GetPolys(), 7), (surface.GetStrips(), _STRIP)):
        starts, nodes = _list_of(cells)
        counts = np.diff(starts)
        numbers = before + np.arange(len(counts))
        before += len(counts)
        own = np.ones(len(counts), dtype=bool) if kept is None else kept[numbers]
        _tell(source, np.full(len(counts), kind)[own], counts[own])
        for count in np.unique(counts).tolist():
            same = np.flatnonzero((counts == count) & own)
            if len(same):
                rows = nodes[starts[same, np.newaxis] + np.arange(count)]
                yield _block(source, kind, rows, numbers[same])


def _block(source: Source, kind: int, rows: Ints, places: Ints) -> Block:
    """Return cells of one type, numbered as `cell_types` has them."""
    count = rows.shape[1]
    if kind in (7, _STRIP, _QUADRATIC_POLYGON) and count < 3:
        raise source.error(f"has a polygon of {counted(count, 'corner')}", "export it again")
    if (kind, count) not in ((_PIXEL, 4), (_VOXEL, 8)) and kind in (_PIXEL, _VOXEL):
        return Block(f"{_title(kind)} with {count} nodes", rows, places)
    if kind == _STRIP:
        return _strips(rows, places)
    if kind == _PIXEL:
        return Block("quad", rows[:, _PIXEL_AS_QUAD], places)
    if kind == _VOXEL:
        return Block("hexahedron", rows[:, _VOXEL_AS_HEXAHEDRON], places)
    if kind == _QUADRATIC_POLYGON and count % 2 == 0:
        around = np.arange(count).reshape(2, -1).T.ravel()
        return Block("polygon", rows[:, around], places)
    name = _NAMES.get(kind) or _ANY_ORDER.get((kind, count))
    return Block(name or f"{_title(kind)} with {count} nodes", rows, places)


def _tell(source: Source, types: Ints, counts: Ints) -> None:
    """Write the notes on cells whose nodes are taken in another order or number."""
    strips = counts[types == _STRIP]
    if len(strips):
        into = counted(int((strips - 2).sum()), "triangle")
        source.note(f"{counted(len(strips), 'triangle strip')} taken as {into}")
    curved = int(np.count_nonzero(types == _QUADRATIC_POLYGON))
    if curved:
        source.note(f"{counted(curved, 'quadratic polygon')} taken as polygons of all their nodes")


def _strips(rows: Ints, places: Ints) -> Block:
    """Return strips as triangles, every other one turned."""
    count = rows.shape[1] - 2
    steps = np.arange(count)[:, np.newaxis] + np.arange(3)
    steps[1::2, :2] = steps[1::2, 1::-1]
    return Block("triangle", rows[:, steps].reshape(-1, 3), np.repeat(places, count))


def _title(kind: int) -> str:
    """Return what errors call a type that is not read."""
    shapes = ("triangle", "quadrilateral", "tetrahedron", "hexahedron", "wedge", "pyramid")
    names = {41: "convex point set"}
    for first, family in ((61, "higher-order"), (69, "Lagrange"), (76, "Bezier")):
        names |= {first + k: f"{family} {shape}" for k, shape in enumerate(shapes)}
    return f"{names[kind]} (VTK's {kind})" if kind in names else f"VTK's {kind}"


def _faces(grid: Any, cell: int) -> list[list[int]]:
    """Return the faces of a polyhedron."""
    from vtkmodules.vtkCommonCore import vtkIdList

    stream = vtkIdList()
    grid.GetFaceStream(cell, stream)
    values = [stream.GetId(k) for k in range(stream.GetNumberOfIds())]
    faces, at = [], 1
    while at < len(values):
        faces.append(values[at + 1 : at + 1 + values[at]])
        at += 1 + values[at]
    return faces


def _list_of(cells: Any) -> tuple[Ints, Ints]:
    """Return where the nodes of each cell begin, (N + 1,), and all nodes."""
    if cells is None or cells.GetNumberOfCells() == 0:
        return np.zeros(1, np.int64), np.zeros(0, np.int64)
    starts = np.array(numbers(cells.GetOffsetsArray()), dtype=np.int64)
    return starts, np.array(numbers(cells.GetConnectivityArray()), dtype=np.int64)


def _types(grid: Any) -> Ints:
    """Return the type of each cell."""
    count = grid.GetNumberOfCells()
    if count == 0:
        return np.zeros(0, np.int64)
    try:
        types = grid.GetCellTypes()
    except TypeError:  # before VTK 9.6 the name was another method's
        types = grid.GetCellTypesArray()
    return np.array(numbers(types), dtype=np.int64)


def numbers(array: Any) -> NDArray[Any]:
    """Return VTK's array as NumPy has it."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    found: NDArray[Any] = vtk_to_numpy(array)
    return found
