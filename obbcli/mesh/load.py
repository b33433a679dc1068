"""`load_mesh`: which suffix goes to which reader, and where a file becomes a `Mesh`."""

from __future__ import annotations

import os
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from obbcli.errors import MeshError
from obbcli.files import file_and_pattern
from obbcli.mesh.formats import FORMATS, known_suffixes, suffix_of
from obbcli.mesh.formats.sniff import HEAD_BYTES, beginning, is_packed
from obbcli.mesh.mesh import Mesh, PartRows
from obbcli.mesh.source import (
    Source,
    check_file,
    checked_source,
    digest_of,
    read_head,
    read_source,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from obbcli.mesh.parts.placed import PlacedPart
    from obbcli.mesh.source import MeshArrays


class FileParts(NamedTuple):
    """Holds what a file's parts are made of.

    Attributes:
        source: the file.
        parts: in its order.
        sha256: of its bytes, where it was asked for.
    """

    source: Source
    parts: list[PlacedPart]
    sha256: str | None


def load_mesh(path: str | os.PathLike[str], *, hashed: bool = True) -> Mesh:
    """Return the mesh in a file: its suffix, in any case, says which format is expected.

    Triangle ids are rows of the file's faces after triangulation, in the file's order; polygons
    of n corners become n - 2 rows, cells the faces that `cell_surface.surface` lists.

    Args:
        path: the file, which gzip may have packed where it is STL, OBJ or PLY; or `"FILE#PATTERN"`,
            the parts of it whose paths match, placed and joined.
        hashed: whether the mesh's `sha256` is found, which for a large file costs as much time as
            to read it.

    Raises:
        MeshError: it cannot be read, is not what its name says, holds no usable surface, or no
            part matches.

    Example:
        >>> load_mesh("sample_meshes/gear.stl")
        Mesh(34560 vertices, 11520 triangles, source='gear.stl')
    """
    measure: Callable[[Mesh], Mesh] | None = getattr(path, "measure", None)  # of `MeasuredFile`
    if measure is not None:
        return measure(load_mesh(os.fspath(path), hashed=hashed))
    name, pattern = file_and_pattern(os.fspath(path))
    if pattern is not None:
        return load_selection(name, pattern, hashed=hashed)
    path = Path(path)
    # Before the suffix: of a file that is not there nothing else is worth saying.
    check_file(path)
    suffix = suffix_of(path.name)
    if suffix == ".stl" and not hashed and path.is_file():
        arrays = _read_binary_stl(path)
        if arrays is not None:
            return mesh_of(arrays, Source(str(path), path.name, b"", path), None)
    return _load(_content(path, suffix), suffix, hashed=hashed)


def _content(path: Path, suffix: str) -> Source:
    """Return what a file holds, unpacked.

    Raises:
        MeshError: it cannot be read, or is no mesh by its beginning.
    """
    if suffix not in FORMATS:
        # By its beginning alone: a file that is no mesh may be of any size.
        head = read_head(path, HEAD_BYTES)
        if is_packed(head.data):
            from obbcli.mesh.packed import unpacked_head

            inside = unpacked_head(head)
            if inside is not None:
                _refuse_other(inside, suffix)
        else:
            _suffix_told(head, suffix)
    return _plain(read_source(path))


def _plain(source: Source) -> Source:
    """Return a source, unpacked where it is packed."""
    if not is_packed(source.data):
        return source
    from obbcli.mesh.packed import unpacked

    return unpacked(source)


def load_selection(path: str | os.PathLike[str], pattern: str, *, hashed: bool = True) -> Mesh:
    """Return the parts of a file that a pattern selects as one mesh; its `parts` tell their rows.

    Raises:
        MeshError: as `load_mesh`.
    """
    from obbcli.mesh.parts.placed import joined
    from obbcli.mesh.parts.selection import selected

    contents = read_parts(path, hashed=hashed)
    source = contents.source
    arrays, rows, first = [], [], 0
    for part in selected(contents.parts, pattern, source.place):
        arrays.append(part.placed())
        count = len(arrays[-1][1])
        rows.append(PartRows(part.path, first, count))
        first += count
    return mesh_of(joined(arrays, source), source, contents.sha256, rows)


def read_parts(path: str | os.PathLike[str], *, hashed: bool = True) -> FileParts:
    """Return the parts of a file in its order, not yet decoded where its format allows that.

    A file whose format knows no parts is one part without a name.

    Raises:
        MeshError: as `load_mesh`.
    """
    from obbcli.mesh.parts.selection import listed_parts

    path = Path(path)
    check_file(path)
    suffix = suffix_of(path.name)
    source = _content(path, suffix)
    with _reading(source, suffix, hashed=hashed) as (told, digest):
        parts = listed_parts(_parts_reader(told)(source), source.place)
    return FileParts(source, parts, None if digest is None else digest())


def load_mesh_bytes(
    data: bytes, suffix: str | None = None, *, name: str = "<stdin>", hashed: bool = True
) -> Mesh:
    """Return the mesh in `data`, which is what a file with `suffix` would hold.

    Without a suffix the beginning must say what it is: STL, OBJ, PLY, OFF, GLB, VTK, VTU and Gmsh
    do.

    Raises:
        MeshError: as in `load_mesh`; `name` is the place named.
    """
    source = _plain(checked_source(Source(name, name, bytes(data))))
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
        if FORMATS[found.suffix] != FORMATS.get(suffix):
            source.note(f"is {found.words} by its content, and is read as such")
        return found.suffix
    _refuse_other(source, suffix)
    if suffix not in FORMATS:
        known = " ".join(known_suffixes())
        fault = f"unknown mesh suffix '{suffix}'" if suffix else "has no suffix to tell its format"
        raise source.error(fault, f"known are {known}")
    return suffix


def _refuse_other(source: Source, suffix: str) -> None:
    """Refuse what is no mesh, and say what it is."""
    from obbcli.mesh.formats.not_meshes import not_a_mesh

    other = not_a_mesh(source.data, suffix if suffix in FORMATS else "")
    if other is not None:
        raise source.error(*other)


def _reader(suffix: str) -> Callable[[Source], MeshArrays]:
    """Return the reader of files with a known suffix."""
    form = FORMATS[suffix]
    module = import_module(f"obbcli.mesh.formats.{form.module}")
    if form.kind is not None:
        reader: Callable[[Source], MeshArrays] = module.cell_reader(form.kind, suffix)
    else:
        reader = getattr(module, f"read_{form.key}")
    return reader


def _parts_reader(suffix: str) -> Callable[[Source], Iterable[PlacedPart]]:
    """Return what reads the parts of files with a known suffix."""
    from obbcli.mesh.parts.placed import whole

    form = FORMATS[suffix]
    if form.parts is None:
        read = _reader(suffix)
        return lambda source: whole(read, source)
    module = import_module(f"obbcli.mesh.formats.{form.parts}")
    reader: Callable[[Source], Iterable[PlacedPart]] = getattr(module, f"parts_{form.key}")
    return reader


def _load(source: Source, suffix: str, *, hashed: bool) -> Mesh:
    with _reading(source, suffix, hashed=hashed) as (told, digest):
        vertices, triangles = _reader(told)(source)
        if len(triangles) == 0:
            raise source.error("has no faces", "a mesh is a surface of triangles")
    return mesh_of((vertices, triangles), source, None if digest is None else digest())


@contextmanager
def _reading(
    source: Source, suffix: str, *, hashed: bool
) -> Iterator[tuple[str, Callable[[], str] | None]]:
    """Yield a file's suffix as its content tells it, and what waits for its hash."""
    told = _suffix_told(source, suffix)
    stored = source.data
    if source.stored is not None:
        from obbcli.mesh.packed import refuse_other_formats

        refuse_other_formats(source, told)
        stored = source.stored
    digest = digest_of(stored) if hashed else None
    try:
        yield told, digest
    except MeshError as fault:
        raise _with_guess(source, suffix, fault) from fault.__cause__
    except MemoryError as fault:
        raise source.error("does not fit into memory") from fault
    finally:
        if digest is not None:
            digest()


def mesh_of(
    arrays: MeshArrays, source: Source, sha256: str | None, parts: Iterable[PartRows] = ()
) -> Mesh:
    """Return the mesh of a file, which errors call by its place."""
    vertices, triangles = arrays
    # Read-only arrays are adopted, not copied.
    vertices.setflags(write=False)
    triangles.setflags(write=False)
    try:
        return Mesh(
            vertices,
            triangles,
            source.name,
            sha256,
            source.notes,
            unit=source.unit,
            parts=parts,
        )
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
    if found is None or FORMATS[found.suffix] == FORMATS.get(suffix):
        return fault
    looks = f"the file looks like {found.words} ({found.suffix})"
    remedy = f"{looks}; {fault.remedy}" if fault.remedy else looks
    return MeshError(fault.where, fault.fault, remedy)
