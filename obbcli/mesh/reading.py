"""How a file is read whatever is asked of it: its content, its format, its errors, its mesh."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from importlib import import_module
from typing import TYPE_CHECKING

from obbcli.errors import MeshError
from obbcli.mesh.formats import FORMATS, known_suffixes
from obbcli.mesh.formats.sniff import HEAD_BYTES, beginning, is_packed
from obbcli.mesh.mesh import Mesh
from obbcli.mesh.source import Source, checked_source, digest_of, read_head, read_source

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

    from obbcli.mesh.mesh import PartRows
    from obbcli.mesh.parts.placed import PlacedPart
    from obbcli.mesh.source import MeshArrays


def content_of(path: Path, suffix: str, sag: float | None = None) -> Source:
    """Return what a file holds, unpacked; `sag` is what exact surfaces of it are cut with.

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
                refuse_other(inside, suffix)
        else:
            _suffix_told(head, suffix)
    return plain(_cut_with(sag, read_source(path)))


def source_of_bytes(
    data: bytes, suffix: str | None, name: str, sag: float | None = None
) -> tuple[Source, str]:
    """Return what a stream brought, unpacked, and the suffix of its format, in lower case.

    Raises:
        MeshError: it is empty, or there is no suffix and its beginning says not what it is.
    """
    source = plain(_cut_with(sag, checked_source(Source(name, name, bytes(data)))))
    if suffix is not None:
        return source, suffix.lower()
    found = beginning(source.data)
    if found is None:
        refuse_other(source, "")
        fault = "does not begin as any known format does"
        raise source.error(fault, "put it into a file whose suffix tells its format")
    return source, found.suffix


def _cut_with(sag: float | None, source: Source) -> Source:
    """Return a source whose exact surfaces are to be cut with a sag."""
    if sag is None:
        return source
    from obbcli.mesh.sag import checked_sag

    return replace(source, sag=checked_sag(sag))


def plain(source: Source) -> Source:
    """Return a source, unpacked where it is packed."""
    if not is_packed(source.data):
        return source
    from obbcli.mesh.packed import unpacked

    return unpacked(source)


def parts_reader_of(suffix: str) -> Callable[[Source], Iterable[PlacedPart]]:
    """Return what reads the parts of files with a known suffix."""
    from obbcli.mesh.parts.placed import whole

    form = FORMATS[suffix]
    if form.parts is None:
        read = reader_of(suffix)
        return lambda source: whole(read, source)
    module = import_module(f"obbcli.mesh.formats.{form.parts}")
    reader: Callable[[Source], Iterable[PlacedPart]] = getattr(module, f"parts_{form.key}")
    return reader


@contextmanager
def reading(
    source: Source, suffix: str, *, hashed: bool
) -> Iterator[tuple[str, Callable[[], str] | None]]:
    """Yield a file's suffix as its content tells it, and what waits for its hash."""
    told = _suffix_told(source, suffix)
    if source.sag is not None and not FORMATS[told].is_exact:
        from obbcli.mesh.sag import no_exact_surfaces

        raise no_exact_surfaces(source)
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
            sag=source.stated_sag,
        )
    except MeshError as fault:
        where = fault.where.replace(source.name, source.place, 1)
        raise MeshError(where, fault.fault, fault.remedy) from fault


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
    refuse_other(source, suffix)
    if suffix not in FORMATS:
        known = " ".join(known_suffixes())
        fault = f"unknown mesh suffix '{suffix}'" if suffix else "has no suffix to tell its format"
        raise source.error(fault, f"known are {known}")
    return suffix


def refuse_other(source: Source, suffix: str) -> None:
    """Refuse what is no mesh, and say what it is."""
    from obbcli.mesh.formats.not_meshes import not_a_mesh

    other = not_a_mesh(source.data, suffix if suffix in FORMATS else "")
    if other is not None:
        raise source.error(*other)


def reader_of(suffix: str) -> Callable[[Source], MeshArrays]:
    """Return the reader of files with a known suffix."""
    form = FORMATS[suffix]
    module = import_module(f"obbcli.mesh.formats.{form.module}")
    if form.kind is not None:
        reader: Callable[[Source], MeshArrays] = module.cell_reader(form.kind, suffix)
    else:
        reader = getattr(module, f"read_{form.key}")
    return reader


def _with_guess(source: Source, suffix: str, fault: MeshError) -> MeshError:
    """Return the error, with what the file seems to be where that is not what its name says."""
    found = beginning(source.data)
    if found is None or FORMATS[found.suffix] == FORMATS.get(suffix):
        return fault
    looks = f"the file looks like {found.words} ({found.suffix})"
    remedy = f"{looks}; {fault.remedy}" if fault.remedy else looks
    return MeshError(fault.where, fault.fault, remedy)
