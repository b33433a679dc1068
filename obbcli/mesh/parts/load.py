"""The parts of a file as its reader tells them, and those that a pattern selects as one mesh."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from obbcli.mesh.formats import suffix_of
from obbcli.mesh.formats.text import counted
from obbcli.mesh.mesh import PartRows
from obbcli.mesh.parts.placed import joined
from obbcli.mesh.parts.selection import listed_parts, selected
from obbcli.mesh.reading import content_of, mesh_of, parts_reader_of, reading, source_of_bytes
from obbcli.mesh.source import check_file

if TYPE_CHECKING:
    import os

    from obbcli.mesh.mesh import Mesh
    from obbcli.mesh.parts.placed import PlacedPart
    from obbcli.mesh.source import Source


class FileParts(NamedTuple):
    """Holds parts of a file, and what they are made of.

    Attributes:
        source: the file.
        parts: in its order.
        sha256: of its bytes, where it was asked for.
    """

    source: Source
    parts: list[PlacedPart]
    sha256: str | None


def load_selection(
    path: str | os.PathLike[str], pattern: str, *, hashed: bool = True, sag: float | None = None
) -> Mesh:
    """Return the parts of a file that a pattern selects as one mesh; its `parts` tell their rows.

    Raises:
        MeshError: as `load_mesh`.
    """
    contents = read_parts(path, pattern, hashed=hashed, sag=sag)
    source = contents.source
    arrays, rows, first = [], [], 0
    for part in contents.parts:
        placed = part.placed()
        count = len(placed[1])
        if count:
            arrays.append(placed)
            rows.append(PartRows(part.path, first, count))
            first += count
    if not rows:
        fault = f"part '{contents.parts[0].path}' has no faces"
        raise source.error(fault, "leave it out: a mesh is a surface of triangles")
    kind = contents.parts[0].kind
    if kind and len(rows) > 1:
        source.note(f"{counted(len(rows), kind)} taken as one surface")
    return mesh_of(joined(arrays, source), source, contents.sha256, rows)


def read_parts(
    path: str | os.PathLike[str],
    pattern: str | None = None,
    *,
    hashed: bool = True,
    sag: float | None = None,
) -> FileParts:
    """Return the parts of a file in its order, not yet decoded where its format allows that.

    A file whose format knows no parts is one part without a name.

    Args:
        path: the file.
        pattern: which parts; None: all.
        hashed: whether the file's SHA-256 is found.
        sag: how far triangles may be from exact surfaces; None: the default.

    Raises:
        MeshError: as `load_mesh`, or no part matches.
    """
    path = Path(path)
    check_file(path)
    suffix = suffix_of(path.name)
    return _parts_of(content_of(path, suffix, sag), suffix, pattern, hashed=hashed)


def read_parts_bytes(
    data: bytes, suffix: str | None = None, *, name: str, sag: float | None = None
) -> FileParts:
    """Return the parts in `data`, as `read_parts` does of a file; `name` is the place named.

    Raises:
        MeshError: as `load_mesh_bytes`.
    """
    source, known = source_of_bytes(data, suffix, name, sag)
    return _parts_of(source, known, None, hashed=True)


def _parts_of(source: Source, suffix: str, pattern: str | None, *, hashed: bool) -> FileParts:
    with reading(source, suffix, hashed=hashed) as (told, digest):
        parts = listed_parts(parts_reader_of(told)(source), source.place)
        if pattern is not None:
            parts = selected(parts, pattern, source.place)
        parts = [part for part in parts if not part.may_be_bare or len(part.decode()[1])]
        if not parts:
            raise source.error("has no faces", "a mesh is a surface of triangles")
    return FileParts(source, parts, None if digest is None else digest())
