"""VTK, VTU, Gmsh, Abaqus and other formats of finite elements, through meshio.

meshio reads these right, but believes counts, takes indices that are out of range and ends the
process on some errors: everything is checked before and after it.
"""

from __future__ import annotations

import tempfile
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.cell_surface import UnknownCellError, changes, surface
from obbcli.mesh.formats.claimed_counts import check_claims, check_count
from obbcli.mesh.formats.meshio_guard import ending_files, fenced

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.source import MeshArrays, Source


def cell_reader(kind: str, suffix: str) -> Callable[[Source], MeshArrays]:
    """Return a reader of one of meshio's formats.

    The reader returns the points and triangles of `cell_surface.surface`, or raises a MeshError.

    Args:
        kind: meshio's module of the format.
        suffix: the suffix meshio expects.
    """

    def read(source: Source) -> MeshArrays:
        chosen = kind
        if kind == "gmsh" and not source.data.lstrip().startswith(b"$"):
            chosen = "ansys"  # Fluent's format, of the same suffix
        check_claims(source, chosen)
        module = fenced(source, "meshio", lambda: import_module(f"meshio.{chosen}"))
        with _as_file(source, suffix) as path, ending_files("meshio.", path):
            mesh = fenced(source, "meshio", lambda: module.read(str(path)))
        points = _points(source, mesh.points)
        blocks = [(block.type, block.data) for block in mesh.cells]
        check_count(source, chosen, sum(len(data) for _, data in blocks))
        for number, (name, data) in enumerate(blocks):
            _check_indices(source, f"cell block {number} ({name})", data, len(points))
        try:
            triangles = surface(blocks, points)
        except UnknownCellError as fault:
            raise source.error(
                f"cells of type {fault} are not read", "convert them to triangles or tetrahedra"
            ) from fault
        for note in changes(blocks):
            source.note(note)
        return points, triangles

    return read


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


def _check_indices(source: Source, place: str, data: object, count: int) -> None:
    """Refuse cells that use points the file does not have, also inside of a volume."""
    if isinstance(data, list):  # polyhedra: cells of faces of corners
        for number, cell in enumerate(data):
            for face in cell:
                _check_indices(source, f"{place}, cell {number}", np.asarray([face]), count)
        return
    array = np.asarray(data)
    if array.size == 0:
        return
    if array.ndim != 2 or array.dtype.kind not in "iu":
        raise source.error(f"cells of shape {array.shape} and type {array.dtype}", at=place)
    outside = (array < 0) | (array >= count)
    if outside.any():
        row = int(np.flatnonzero(outside.any(axis=1))[0])
        worst = array[row][outside[row]][0]
        raise source.error(
            f"cell {row} uses point {worst} of {count} (counted from 0)",
            "export it again",
            at=place,
        )
