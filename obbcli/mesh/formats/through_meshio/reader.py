"""Netgen, FLAC3D and DOLFIN, and plain VTK grids where VTK is not there, through meshio.

meshio reads these right, but believes counts, takes indices that are out of range and ends the
process on some errors: everything is checked before and after it.
"""

from __future__ import annotations

import tempfile
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.cells.surface import Block, surface
from obbcli.mesh.formats.through_meshio.claimed_counts import listed_cells
from obbcli.mesh.formats.through_meshio.guard import ending_files, fenced

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.source import MeshArrays, Source


#: VTK's cells of any order with so many nodes that these are numbered as in others.
_SAME_AS = {
    ("VTK_LAGRANGE_TRIANGLE", 3): "triangle",
    ("VTK_LAGRANGE_TRIANGLE", 6): "triangle6",
    ("VTK_LAGRANGE_QUADRILATERAL", 4): "quad",
    ("VTK_LAGRANGE_QUADRILATERAL", 9): "quad9",
    ("VTK_LAGRANGE_TETRAHEDRON", 4): "tetra",
    ("VTK_LAGRANGE_TETRAHEDRON", 10): "tetra10",
    ("VTK_LAGRANGE_PYRAMID", 5): "pyramid",
    ("VTK_LAGRANGE_WEDGE", 6): "wedge",
    ("VTK_LAGRANGE_HEXAHEDRON", 8): "hexahedron",
}
#: Cells whose middle nodes meshio sorts in a way that no document confirms.
_UNSURE = {"netgen": ("quad8", "hexahedron20")}


def cell_reader(kind: str, suffix: str) -> Callable[[Source], MeshArrays]:
    """Return a reader of one of meshio's formats.

    The reader returns the points and triangles of `cell_surface.surface`, or raises a MeshError.

    Args:
        kind: meshio's module of the format.
        suffix: the suffix meshio expects.
    """

    def read(source: Source) -> MeshArrays:
        return read_cells(source, kind, suffix, listed_cells(source, kind))

    return read


def read_cells(source: Source, kind: str, suffix: str, cell_count: int) -> MeshArrays:
    """Return the points and triangles of what meshio reads.

    Args:
        source: the file, all of whose keywords are known.
        kind: meshio's module of the format.
        suffix: the suffix meshio expects.
        cell_count: how many cells the file lists.

    Raises:
        MeshError: meshio cannot read it, or reads fewer or more cells.
    """
    module = fenced(source, "meshio", lambda: import_module(f"meshio.{kind}"))
    with _as_file(source, suffix) as path, ending_files("meshio.", path):
        mesh = fenced(source, "meshio", lambda: module.read(str(path)))
    points = _points(source, mesh.points)
    blocks = [_block(source, kind, block.type, block.data) for block in mesh.cells]
    read = sum(len(block.nodes) for block in blocks)
    if cell_count != read:
        fault = f"claims {cell_count} cells, but {read} could be read"
        raise source.error(fault, "it was cut short, or its counts are wrong")
    return points, surface(source, points, blocks)


def _block(source: Source, module: str, name: str, nodes: Any) -> Block:
    """Return cells as VTK numbers them; those of any order by the type of so many nodes."""
    if name in _UNSURE.get(module, ()):
        fault = f"cells of type {name} are not read from this format"
        raise source.error(fault, "save it with cells of first order")
    kind = name.rstrip("0123456789")
    if kind not in ("polygon", "polyhedron"):
        kind = _SAME_AS.get((name, np.shape(nodes)[-1]), name)
    return Block(kind, nodes)


@contextmanager
def _as_file(source: Source, suffix: str) -> Iterator[Path]:
    """Give the path of a file with exactly the bytes that were hashed.

    The file itself, where it is one; it is compared again afterwards. Bytes from a stream go to a
    temporary file.
    """
    if source.path is not None and source.path.is_file():
        yield source.path
        if source.path.read_bytes() != source.data:
            raise source.error("changed while it was read", "load it again")
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"stream{suffix}"
        path.write_bytes(source.data)
        yield path


def _points(source: Source, points: object) -> NDArray[np.float64]:
    """Return points as (V, 3); flat meshes lie at z = 0."""
    array = np.asarray(points)
    if array.dtype.kind not in "fiu" or array.ndim != 2 or array.shape[1] not in (2, 3):
        raise source.error(f"has points of shape {array.shape}, expected (N, 3)")
    vertices = np.zeros((len(array), 3))
    vertices[:, : array.shape[1]] = array
    return vertices
