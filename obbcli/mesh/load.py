"""`load_mesh`: which suffix goes to which reader, and where a file becomes a `Mesh`."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from obbcli.errors import MeshError
from obbcli.mesh.mesh import Mesh
from obbcli.mesh.source import Source, checked_source, digest_of, read_source

if TYPE_CHECKING:
    import os

#: Suffix: (format, module of this package, function). Modules are imported when first needed.
_READERS: dict[str, tuple[str, str, str]] = {
    ".stl": ("STL", "stl", "read_stl"),
    ".obj": ("OBJ", "obj", "read_obj"),
}


def known_suffixes() -> tuple[str, ...]:
    """Return the suffixes that can be read, sorted."""
    return tuple(sorted(_READERS))


def load_mesh(path: str | os.PathLike[str]) -> Mesh:
    """Return the mesh in a file: its suffix says which format is expected.

    Raises:
        MeshError: it cannot be read, is not what its name says, or holds no usable surface.
    """
    path = Path(path)
    _reader(str(path), path.suffix)
    return _load(read_source(path), path.suffix)


def load_mesh_bytes(data: bytes, suffix: str, *, name: str = "<stdin>") -> Mesh:
    """Return the mesh in `data`, which is what a file with `suffix` would hold.

    Raises:
        MeshError: as in `load_mesh`; `name` is the place named.
    """
    return _load(checked_source(Source(name, name, data)), suffix)


def _reader(place: str, suffix: str) -> tuple[str, str, str]:
    reader = _READERS.get(suffix.lower())
    if reader is None:
        known = " ".join(known_suffixes())
        fault = f"unknown mesh suffix '{suffix}'" if suffix else "has no suffix to tell its format"
        raise MeshError(place, fault, f"known are {known}")
    return reader


def _load(source: Source, suffix: str) -> Mesh:
    _, module, function = _reader(source.place, suffix)
    read = getattr(import_module(f"obbcli.mesh.{module}"), function)
    digest = digest_of(source.data)
    try:
        vertices, triangles = read(source)
    finally:
        sha256 = digest()
    if len(triangles) == 0:
        raise source.error("has no faces", "a mesh is a surface of triangles")
    vertices.setflags(write=False)
    triangles.setflags(write=False)
    return Mesh(vertices, triangles, source=source.name, sha256=sha256)
