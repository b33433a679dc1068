"""Mesh files packed by gzip: unpacked in memory, to a size that is bounded."""

from __future__ import annotations

import io
import re
import zlib
from dataclasses import replace
from typing import TYPE_CHECKING

from obbcli.mesh.formats import FORMATS, PACKED_SUFFIXES
from obbcli.mesh.formats.sniff import HEAD_BYTES
from obbcli.mesh.source import checked_source, most_bytes

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.source import Source

#: Suffixes of the formats that are read packed.
FORMATS_READ = (".stl", ".obj", ".ply", ".step", ".stp", ".stpz")
_NAMES = "STL, OBJ, PLY and STEP"
#: What may always be unpacked, bytes; more only up to this many times the file's own size. Meshes
#: pack to a third or a tenth, texts that repeat themselves to a fiftieth, and a bomb of zeros to a
#: thousandth.
_ALWAYS = 64 << 20
_RATIO = 200
#: Bytes that are packed and unpacked at a time; a member begins with less, as many are small.
_PIECE, _CHUNK = 1 << 16, 1 << 20
_FIRST_PIECE = 1 << 9
#: What tells zlib that its data stand in gzip's frame: 16 more than its largest window.
_GZIP = 31
_BLANK = b"\0 \t\r\n"
#: Zeros fill a file up on media that hold whole blocks.
_NO_FILLING = re.compile(rb"[^\0]")
_AGAIN = "copy or download it again"


def unpacked(source: Source) -> Source:
    """Return the content of a gzip file, all of its members; `stored` are the bytes of the file.

    Raises:
        MeshError: it is cut off or damaged, unpacks to nothing, or to more than 64 MiB and 200
            times its size, or than a quarter of this machine's memory.
    """
    try:
        data = _unpacked(source)
    except EOFError as fault:
        raise source.error("is a gzip file that ends too soon", _AGAIN) from fault
    except zlib.error as fault:
        raise source.error("is a gzip file that is damaged", _AGAIN) from fault
    except MemoryError as fault:
        raise source.error("does not fit into memory when it is unpacked") from fault
    if source.path is not None and source.path.suffix.lower() not in PACKED_SUFFIXES:
        source.note("is packed by gzip by its content, and is read as such")
    return checked_source(replace(source, data=data, stored=source.data))


def unpacked_head(head: Source) -> Source | None:
    """Return what the beginning of a gzip file begins with; None where that says nothing."""
    try:
        data = zlib.decompressobj(_GZIP).decompress(head.data, HEAD_BYTES)
    except zlib.error:
        return None  # whoever reads all of it says what is wrong
    return replace(head, data=data) if data.strip(_BLANK) else None


def _unpacked(source: Source) -> bytes:
    """Return what a gzip file holds; memory for what lies beyond the bound is never taken."""
    most = min(most_bytes(), max(_ALWAYS, _RATIO * len(source.data)))
    whole = io.BytesIO()
    for part in _members(source.data):
        if whole.tell() + len(part) > most:
            fault = f"is a gzip file that unpacks to more than {most:,} bytes"
            raise source.error(fault, "unpack it first where you trust it: gunzip")
        whole.write(part)
    return whole.getvalue()


def _members(data: bytes) -> Iterator[bytes]:
    """Yield what the members of a gzip file hold, a little at a time.

    Python's own module reads headers and fillings byte by byte, which files can make very long.

    Raises:
        EOFError: the last member is not whole.
        zlib.error: one is damaged, or what follows is none.
    """
    place = 0
    while found := _NO_FILLING.search(data, place):
        place, step = found.start(), _FIRST_PIECE
        member = zlib.decompressobj(_GZIP)
        while not member.eof:
            piece = data[place : place + step]
            if not piece:
                raise EOFError
            part = member.decompress(piece, _CHUNK)
            # At a member's end the tail may still be that of the call before.
            rest = member.unused_data if member.eof else member.unconsumed_tail
            place += len(piece) - len(rest)
            step = min(2 * step, _PIECE)
            yield part


def refuse_other_formats(source: Source, suffix: str) -> None:
    """Refuse a packed file of a format that is not read packed; `suffix` is the format's.

    Raises:
        MeshError: it is one.
    """
    if source.stored is not None and suffix not in FORMATS_READ:
        fault = f"holds {FORMATS[suffix].name}, packed by gzip; read packed are {_NAMES}"
        raise source.error(fault, "unpack it first: gunzip")
