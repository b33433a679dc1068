"""`load_mesh`: which suffix goes to which reader, and where a file becomes a `Mesh`."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from obbcli.errors import MeshError
from obbcli.mesh.formats.sniff import HEAD_BYTES, beginning
from obbcli.mesh.mesh import Mesh
from obbcli.mesh.source import Source, check_file, checked_source, digest_of, read_head, read_source

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    from obbcli.mesh.source import MeshArrays


class _Format(NamedTuple):
    """Holds a format's name and reader.

    Args:
        name: as people call it.
        module: of this package, imported when first needed, or `cells` for meshio's formats.
        kind: meshio's module of the format; None where the reader is ours.
    """

    name: str
    module: str
    kind: str | None = None


_STL = _Format("STL", "stl")
_OBJ = _Format("OBJ", "obj")
_PLY = _Format("PLY", "ply")
_OFF = _Format("OFF", "off")
_GLTF = _Format("glTF", "gltf")
_VTK = _Format("VTK", "vtk")
_GMSH = _Format("Gmsh", "gmsh")
_NASTRAN = _Format("Nastran, OptiStruct", "nastran")
_MEDIT = _Format("Medit", "medit")
_TECPLOT = _Format("Tecplot", "tecplot")

#: The one table of suffixes. Those of our own readers first, then what goes through meshio.
_FORMATS = {
    ".stl": _STL,
    ".obj": _OBJ,
    ".ply": _PLY,
    ".off": _OFF,
    ".glb": _GLTF,
    ".gltf": _GLTF,
    ".vtk": _VTK,
    ".vtu": _VTK,
    ".vtp": _VTK,
    ".vti": _VTK,
    ".vts": _VTK,
    ".vtr": _VTK,
    ".vtm": _VTK,
    ".msh": _GMSH,
    ".inp": _Format("Abaqus, CalculiX, AVS UCD", "inp"),
    ".avs": _Format("AVS UCD", "ucd"),
    ".bdf": _NASTRAN,
    ".fem": _NASTRAN,
    ".nas": _NASTRAN,
    ".mesh": _MEDIT,
    ".meshb": _MEDIT,
    ".vol": _Format("Netgen", "cells", "netgen"),
    ".su2": _Format("SU2", "su2"),
    ".dat": _TECPLOT,
    ".tec": _TECPLOT,
    ".plt": _TECPLOT,
    ".f3grid": _Format("FLAC3D", "cells", "flac3d"),
    ".xml": _Format("DOLFIN XML", "cells", "dolfin"),
}


def known_suffixes() -> tuple[str, ...]:
    """Return the suffixes that can be read, sorted."""
    return tuple(sorted(_FORMATS))


def load_mesh(path: str | os.PathLike[str], *, hashed: bool = True) -> Mesh:
    """Return the mesh in a file: its suffix, in any case, says which format is expected.

    Triangle ids are rows of the file's faces after triangulation, in the file's order; polygons
    of n corners become n - 2 rows, cells the faces that `cell_surface.surface` lists.

    Args:
        path: the file.
        hashed: whether the mesh's `sha256` is found, which for a large file costs as much time as
            to read it.

    Raises:
        MeshError: it cannot be read, is not what its name says, or holds no usable surface.

    Example:
        >>> load_mesh("sample_meshes/gear.stl")
        Mesh(34560 vertices, 11520 triangles, source='gear.stl')
    """
    path = Path(path)
    # Before the suffix: of a file that is not there nothing else is worth saying.
    check_file(path)
    suffix = path.suffix.lower()
    if suffix == ".stl" and not hashed and path.is_file():
        arrays = _read_binary_stl(path)
        if arrays is not None:
            return _mesh(arrays, Source(str(path), path.name, b"", path), None)
    if suffix not in _FORMATS:
        # By its beginning alone: a file that is no mesh may be of any size.
        _suffix_told(read_head(path, HEAD_BYTES), suffix)
    return _load(read_source(path), suffix, hashed=hashed)


def load_mesh_bytes(
    data: bytes, suffix: str | None = None, *, name: str = "<stdin>", hashed: bool = True
) -> Mesh:
    """Return the mesh in `data`, which is what a file with `suffix` would hold.

    Without a suffix the beginning must say what it is: STL, OBJ, PLY, OFF, GLB, VTK, VTU and Gmsh
    do.

    Raises:
        MeshError: as in `load_mesh`; `name` is the place named.
    """
    source = checked_source(Source(name, name, bytes(data)))
    if suffix is None:
        found = beginning(source.data)
        suffix = found.suffix if found else None
        if suffix is None:
            _refuse_other(source, "")
            fault = "does not begin as any known format does"
            raise source.error(fault, "put it into a file whose suffix tells its format")
    return _load(source, suffix.lower(), hashed=hashed)


def _suffix_told(source: Source, suffix: str) -> str:
    """Return the suffix of the format that a file's content shows, else its own.

    Raises:
        MeshError: it is no mesh, or neither content nor suffix tells its format.
    """
    found = beginning(source.data)
    if found and found.is_sure:
        if _FORMATS[found.suffix] != _FORMATS.get(suffix):
            source.note(f"is {found.words} by its content, and is read as such")
        return found.suffix
    _refuse_other(source, suffix)
    if suffix not in _FORMATS:
        known = " ".join(known_suffixes())
        fault = f"unknown mesh suffix '{suffix}'" if suffix else "has no suffix to tell its format"
        raise source.error(fault, f"known are {known}")
    return suffix


def _refuse_other(source: Source, suffix: str) -> None:
    """Refuse what is no mesh, and say what it is."""
    from obbcli.mesh.formats.not_meshes import not_a_mesh

    other = not_a_mesh(source.data, suffix if suffix in _FORMATS else "")
    if other is not None:
        raise source.error(*other)


def _reader(suffix: str) -> Callable[[Source], MeshArrays]:
    """Return the reader of files with a known suffix."""
    form = _FORMATS[suffix]
    module = import_module(f"obbcli.mesh.formats.{form.module}")
    if form.kind is not None:
        reader: Callable[[Source], MeshArrays] = module.cell_reader(form.kind, suffix)
    else:
        reader = getattr(module, f"read_{form.module}")
    return reader


def _load(source: Source, suffix: str, *, hashed: bool) -> Mesh:
    read = _reader(_suffix_told(source, suffix))
    digest = digest_of(source.data) if hashed else None
    try:
        vertices, triangles = read(source)
        if len(triangles) == 0:
            raise source.error("has no faces", "a mesh is a surface of triangles")
    except MeshError as fault:
        raise _with_guess(source, suffix, fault) from fault.__cause__
    except MemoryError as fault:
        raise source.error("does not fit into memory") from fault
    finally:
        sha256 = None if digest is None else digest()
    return _mesh((vertices, triangles), source, sha256)


def _mesh(arrays: MeshArrays, source: Source, sha256: str | None) -> Mesh:
    """Return the mesh of a file, which errors call by its place."""
    vertices, triangles = arrays
    # Read-only arrays are adopted, not copied.
    vertices.setflags(write=False)
    triangles.setflags(write=False)
    try:
        return Mesh(vertices, triangles, source.name, sha256, source.notes)
    except MeshError as fault:
        where = fault.where.replace(source.name, source.place, 1)
        raise MeshError(where, fault.fault, fault.remedy) from fault


def _read_binary_stl(path: Path) -> MeshArrays | None:
    """Return a binary STL file's arrays; None where reading it whole tells more, or why not."""
    from obbcli.mesh.formats.stl import read_binary_file

    try:
        return read_binary_file(path)
    except (OSError, MemoryError):
        return None


def _with_guess(source: Source, suffix: str, fault: MeshError) -> MeshError:
    """Return the error, with what the file seems to be where that is not what its name says."""
    found = beginning(source.data)
    if found is None or _FORMATS[found.suffix] == _FORMATS.get(suffix):
        return fault
    looks = f"the file looks like {found.words} ({found.suffix})"
    remedy = f"{looks}; {fault.remedy}" if fault.remedy else looks
    return MeshError(fault.where, fault.fault, remedy)
