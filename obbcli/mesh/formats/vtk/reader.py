"""VTK files, legacy (`.vtk`) and XML (`.vtu`, `.vtp`, `.vti`, `.vts`, `.vtr`, `.vtm`).

Through VTK itself, where the package `vtk` is there. Without it grids of listed cells go through
meshio, and the rest is refused. Either way the file is walked first, element by element.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.cells.surface import surface
from obbcli.mesh.formats.vtk.legacy_guard import walk_legacy
from obbcli.mesh.formats.vtk.modules import has_vtk, legacy_data_set, xml_data_set
from obbcli.mesh.formats.vtk.xml_guard import walk_xml

if TYPE_CHECKING:
    from obbcli.mesh.source import MeshArrays, Source

_GRIDS = ("ImageData", "StructuredPoints", "StructuredGrid", "RectilinearGrid", "UniformGrid")
_BLOCKS = re.compile(rb"<VTKFile[^>]*\btype\s*=\s*[\"'](vtkMultiBlockDataSet)[\"']")


def read_vtk(source: Source) -> MeshArrays:
    """Return points and triangles of a VTK file.

    Raises:
        MeshError: it is damaged, holds what is not understood, or needs the package `vtk`.
    """
    if not source.data.lstrip().startswith(b"<"):
        return _read_legacy(source)
    if is_index(source):
        from obbcli.mesh.formats.vtk.blocks import read_blocks

        return read_blocks(source, read_xml)
    return read_xml(source)


def is_index(source: Source) -> bool:
    """Return whether a file is an index of blocks, which stand in other files."""
    return _BLOCKS.search(source.data) is not None


def _read_legacy(source: Source) -> MeshArrays:
    claimed = walk_legacy(source)
    if not has_vtk():
        return _without_vtk(
            source, "vtk", claimed.data_set == "unstructured_grid", claimed.cell_count
        )
    data = source.data if claimed.has_ghosts else source.data[: claimed.end]
    data_set = legacy_data_set(source, data)
    _compare(source, data_set, claimed.point_count, claimed.cell_count)
    return _surface_of(source, data_set)


def read_xml(source: Source) -> MeshArrays:
    """Return points and triangles of one XML file that is no index.

    Raises:
        MeshError: as `read_vtk`.
    """
    claimed = walk_xml(source)
    if not has_vtk():
        is_plain = claimed.data_set == "UnstructuredGrid" and claimed.piece_count == 1
        return _without_vtk(source, "vtu", is_plain, claimed.cell_count)
    data_set = xml_data_set(source, claimed.data_set, claimed.text)
    # Pieces of grids repeat the points between them.
    points = claimed.point_count if claimed.piece_count == 1 else data_set.GetNumberOfPoints()
    _compare(source, data_set, points, claimed.cell_count)
    return _surface_of(source, data_set)


def _without_vtk(source: Source, kind: str, is_plain: bool, cell_count: int) -> MeshArrays:
    """Return what meshio reads of a file, if that is all of it."""
    from obbcli.mesh.formats.through_meshio.reader import read_cells

    if not is_plain:
        fault = "needs VTK, as it holds more than one grid of listed cells"
        raise source.error(fault, "install it: pip install vtk")
    return read_cells(source, kind, f".{kind}", cell_count)


def _compare(source: Source, data_set: Any, point_count: int, cell_count: int) -> None:
    """Refuse what VTK read fewer or more of than the file says."""
    for what, claimed, read in (
        ("points", point_count, data_set.GetNumberOfPoints()),
        ("cells", cell_count, data_set.GetNumberOfCells()),
    ):
        if claimed != read:
            fault = f"claims {claimed} {what}, but {read} could be read"
            raise source.error(fault, "it was cut short, or its counts are wrong")


def _surface_of(source: Source, data_set: Any) -> MeshArrays:
    """Return the surface of a data set that VTK read."""
    from obbcli.mesh.formats.vtk import cells as vtk_cells
    from obbcli.mesh.formats.vtk import grids as vtk_grids

    kept = vtk_cells.kept_cells(source, data_set)
    name = data_set.GetClassName().removeprefix("vtk")
    if name not in _GRIDS:
        blocks_of = vtk_cells.surface_blocks if name == "PolyData" else vtk_cells.grid_blocks
        points = vtk_cells.points_of(data_set)
        return points, surface(source, points, blocks_of(source, data_set, kept))
    points = vtk_grids.grid_points(data_set)
    blocks = vtk_grids.outer_blocks(source, vtk_grids.grid_sides(data_set), points, kept)
    triangles = surface(source, points, blocks)
    if name == "StructuredGrid":
        return points, triangles
    # The points of an image are implied: only those of its surface are kept.
    used, rows = np.unique(triangles, return_inverse=True)
    return points[used], rows.reshape(-1, 3)
