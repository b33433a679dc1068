"""`load_mesh`: the mesh in a file, in bytes, or in parts of a file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from obbcli.files import file_and_pattern
from obbcli.mesh.formats import suffix_of
from obbcli.mesh.reading import content_of, mesh_of, reader_of, reading, source_of_bytes
from obbcli.mesh.source import Source, check_file

if TYPE_CHECKING:
    from collections.abc import Callable

    from obbcli.mesh.mesh import Mesh
    from obbcli.mesh.source import MeshArrays


def load_mesh(
    path: str | os.PathLike[str], *, hashed: bool = True, sag: float | None = None
) -> Mesh:
    """Return the mesh in a file: its suffix, in any case, says which format is expected.

    Triangle ids are rows of the file's faces after triangulation, in the file's order; polygons
    of n corners become n - 2 rows, cells the faces that `cell_surface.surface` lists.

    Args:
        path: the file, which gzip may have packed where it is STL, OBJ, PLY or STEP; or
            `"FILE#PATTERN"`, the parts of it whose paths match, placed and joined.
        hashed: whether the mesh's `sha256` is found, which for a large file costs as much time as
            to read it.
        sag: how far triangles may be from the exact surfaces of a STEP file, in the file's unit;
            None: 1e-3 of each product's size.

    Raises:
        MeshError: it cannot be read, is not what its name says, holds no usable surface, no part
            matches, or a sag is given for a file without exact surfaces.

    Example:
        >>> load_mesh("sample_meshes/gear.stl")
        Mesh(34560 vertices, 11520 triangles, source='gear.stl')
    """
    measure: Callable[[Mesh], Mesh] | None = getattr(path, "measure", None)  # of `MeasuredFile`
    if measure is not None:
        own = getattr(path, "sag", None) if sag is None else sag
        return measure(load_mesh(os.fspath(path), hashed=hashed, sag=own))
    name, pattern = file_and_pattern(os.fspath(path))
    if pattern is not None:
        from obbcli.mesh.parts.load import load_selection

        return load_selection(name, pattern, hashed=hashed, sag=sag)
    path = Path(path)
    # Before the suffix: of a file that is not there nothing else is worth saying.
    check_file(path)
    suffix = suffix_of(path.name)
    if suffix == ".stl" and not hashed and sag is None and path.is_file():
        arrays = _read_binary_stl(path)
        if arrays is not None:
            return mesh_of(arrays, Source(str(path), path.name, b"", path), None)
    return _load(content_of(path, suffix, sag), suffix, hashed=hashed)


def load_mesh_bytes(
    data: bytes,
    suffix: str | None = None,
    *,
    name: str = "<stdin>",
    hashed: bool = True,
    sag: float | None = None,
) -> Mesh:
    """Return the mesh in `data`, which is what a file with `suffix` would hold.

    Without a suffix the beginning must say what it is: STL, OBJ, PLY, OFF, GLB, STEP, VTK, VTU and
    Gmsh do.

    Raises:
        MeshError: as in `load_mesh`; `name` is the place named.
    """
    source, known = source_of_bytes(data, suffix, name, sag)
    return _load(source, known, hashed=hashed)


def _load(source: Source, suffix: str, *, hashed: bool) -> Mesh:
    with reading(source, suffix, hashed=hashed) as (told, digest):
        vertices, triangles = reader_of(told)(source)
        if len(triangles) == 0:
            raise source.error("has no faces", "a mesh is a surface of triangles")
    return mesh_of((vertices, triangles), source, None if digest is None else digest())


def _read_binary_stl(path: Path) -> MeshArrays | None:
    """Return a binary STL file's arrays; None where reading it whole tells more, or why not."""
    from obbcli.mesh.formats.stl import read_binary_file

    try:
        return read_binary_file(path)
    except (OSError, MemoryError):
        return None
