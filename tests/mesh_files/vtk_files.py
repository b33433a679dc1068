"""VTK files of every kind of data set, written by VTK, and how VTK itself finds their surface."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules import vtkIOLegacy, vtkIOXML
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkGenericCell,
    vtkImageData,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkStructuredGrid,
    vtkUnstructuredGrid,
)

if TYPE_CHECKING:
    from pathlib import Path

#: Text files have fewer digits than doubles.
DIGITS = 6
_KINDS = {
    "vtkUnstructuredGrid": "UnstructuredGrid",
    "vtkPolyData": "PolyData",
    "vtkImageData": "ImageData",
    "vtkStructuredPoints": "ImageData",
    "vtkRectilinearGrid": "RectilinearGrid",
    "vtkStructuredGrid": "StructuredGrid",
}
_SUFFIXES = {
    "UnstructuredGrid": ".vtu",
    "PolyData": ".vtp",
    "ImageData": ".vti",
    "RectilinearGrid": ".vtr",
    "StructuredGrid": ".vts",
}


def points_of(rows: Any) -> vtkPoints:
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.asarray(rows, dtype=float), deep=True))
    return points


def cells_of(rows: list[list[int]]) -> vtkCellArray:
    cells = vtkCellArray()
    offsets = np.cumsum([0, *map(len, rows)]).astype(np.int64)
    flat = np.array([node for row in rows for node in row], dtype=np.int64)
    cells.SetData(
        numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(flat, deep=True)
    )
    return cells


def grid(points: Any, cells: list[tuple[int, list[int]]]) -> vtkUnstructuredGrid:
    """Return an unstructured grid of (type, nodes)."""
    found = vtkUnstructuredGrid()
    found.SetPoints(points_of(points))
    found.SetCells([kind for kind, _ in cells], cells_of([nodes for _, nodes in cells]))
    return found


def poly_data(points: Any, polygons: Any = (), strips: Any = (), lines: Any = ()) -> vtkPolyData:
    found = vtkPolyData()
    found.SetPoints(points_of(points))
    found.SetPolys(cells_of([list(row) for row in polygons]))
    found.SetStrips(cells_of([list(row) for row in strips]))
    found.SetLines(cells_of([list(row) for row in lines]))
    return found


def image(sides: tuple[int, int, int], first: tuple[int, int, int] = (0, 0, 0)) -> vtkImageData:
    found = vtkImageData()
    ends = [end for low, side in zip(first, sides, strict=True) for end in (low, low + side - 1)]
    found.SetExtent(*ends)
    found.SetOrigin(1.0, -2.0, 0.5)
    found.SetSpacing(0.5, 0.25, 2.0)
    return found


def rectilinear(*axes: list[float]) -> vtkRectilinearGrid:
    found = vtkRectilinearGrid()
    found.SetDimensions(*map(len, axes))
    for name, axis in zip("XYZ", axes, strict=True):
        values = vtkDoubleArray()
        for value in axis:
            values.InsertNextValue(value)
        getattr(found, f"Set{name}Coordinates")(values)
    return found


def structured(sides: tuple[int, int, int]) -> vtkStructuredGrid:
    found = vtkStructuredGrid()
    found.SetDimensions(*sides)
    z, y, x = np.meshgrid(*(np.arange(side) for side in sides[::-1]), indexing="ij")
    rows = np.stack([x, y, z], axis=-1).reshape(-1, 3).astype(float)
    found.SetPoints(points_of(rows + 0.1 * np.sin(rows[:, [1, 2, 0]])))
    return found


def write_legacy(path: Path, data_set: Any, binary: bool, version: int) -> Path:
    name = _KINDS[data_set.GetClassName()].replace("ImageData", "StructuredPoints")
    writer = getattr(vtkIOLegacy, f"vtk{name}Writer")()
    writer.SetFileName(str(path))
    writer.SetInputData(data_set)
    writer.SetFileType(2 if binary else 1)
    if hasattr(writer, "SetFileVersion"):
        writer.SetFileVersion(version)
    assert writer.Write() == 1
    return path


def write_xml(folder: Path, data_set: Any, mode: str, compressor: str) -> Path:
    kind = _KINDS[data_set.GetClassName()]
    path = folder / f"a{_SUFFIXES[kind]}"
    writer = getattr(vtkIOXML, f"vtkXML{kind}Writer")()
    writer.SetFileName(str(path))
    writer.SetInputData(data_set)
    getattr(writer, f"SetDataModeTo{mode.split()[0].title()}")()
    if mode == "appended raw":
        writer.EncodeAppendedDataOff()
    getattr(writer, f"SetCompressorTypeTo{compressor.upper().replace('ZLIB', 'ZLib')}")() if (
        compressor != "none"
    ) else writer.SetCompressorTypeToNone()
    assert writer.Write() == 1
    return path


def faces_by_vtk(data_set: Any) -> Counter[tuple[tuple[float, ...], ...]]:
    """Return the outer faces of a data set as sets of corners' places, by VTK's own cells.

    Surface cells as they are, and the faces of volume cells that one cell alone has.
    """
    cell = vtkGenericCell()
    flat: Counter[tuple[tuple[float, ...], ...]] = Counter()
    solid: Counter[tuple[tuple[float, ...], ...]] = Counter()
    for number in range(data_set.GetNumberOfCells()):
        data_set.GetCell(number, cell)
        if cell.GetCellDimension() == 2:
            flat[_corners(data_set, cell)] += 1
        for face in range(cell.GetNumberOfFaces()):
            solid[_corners(data_set, cell.GetFace(face))] += 1
    once = {face: 1 for face, count in solid.items() if count == 1 and face not in flat}
    return flat + Counter(once)


def _corners(data_set: Any, cell: Any) -> tuple[tuple[float, ...], ...]:
    ids = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
    places = {tuple(round(x, DIGITS) + 0.0 for x in data_set.GetPoint(k)) for k in ids}
    return tuple(sorted(places))


def ids_of(numbers: list[int]) -> vtkIdList:
    found = vtkIdList()
    for number in numbers:
        found.InsertNextId(number)
    return found


CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
TWO_CUBES = [*CUBE, (2, 0, 0), (2, 1, 0), (2, 0, 1), (2, 1, 1)]
DATA_SETS = {
    "grid": lambda: grid(
        TWO_CUBES,
        [
            *((12, list(range(8))), (3, [0, 6]), (12, [1, 8, 9, 2, 5, 10, 11, 6])),
            *((5, [0, 1, 6]), (1, [3]), (9, [0, 3, 7, 4]), (7, [8, 9, 11, 10])),
        ],
    ),
    "voxels": lambda: grid(TWO_CUBES, [(11, [0, 1, 3, 2, 4, 5, 7, 6]), (8, [8, 9, 10, 11])]),
    "surface": lambda: poly_data(CUBE, [[0, 1, 2, 3], [4, 5, 6]], lines=[[0, 6]]),
    "strips": lambda: poly_data(CUBE, strips=[[0, 1, 3, 2, 7, 6]]),
    "image": lambda: image((3, 4, 2)),
    "moved image": lambda: image((3, 2, 2), (5, -3, 1)),
    "flat image": lambda: image((3, 1, 4)),
    "rectilinear": lambda: rectilinear([0, 1, 4], [2, 3], [-1, 0, 0.5]),
    "structured": lambda: structured((4, 3, 2)),
    "flat structured": lambda: structured((4, 3, 1)),
}
