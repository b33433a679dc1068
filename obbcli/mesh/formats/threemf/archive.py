"""The archive of a 3MF file: its parts by name, unpacked piece by piece and never without bound."""

from __future__ import annotations

import io
import os
import struct
import zipfile
import zlib
from typing import TYPE_CHECKING
from urllib.parse import unquote

from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.errors import MeshError
    from obbcli.mesh.source import Source

_PIECE = 1 << 16
#: Parts below this size may be packed as tightly as they like.
_SMALL = 1 << 26
#: Models are text that shrinks to a tenth or a fiftieth; more than this is made to do harm.
_TIGHTEST = 200
#: All parts together may unpack to this share of the machine's memory.
_SHARE = 4
_PLAIN = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_CUT = "it was cut short or damaged: copy or download it again"
#: What zipfile raises of damaged archives; RuntimeError of packings that it does not know.
_DAMAGED = (
    *(zipfile.BadZipFile, zlib.error, struct.error),
    *(EOFError, ValueError, OSError, OverflowError, RuntimeError),
)


class Archive:
    """Gives the parts of a package by their names.

    Args:
        source: the file.

    Raises:
        MeshError: it is no whole zip archive; from every method as well.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        self._room = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // _SHARE
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(source.data))
            infos = self._zip.infolist()
        except _DAMAGED as fault:
            raise source.error("is no whole zip archive", _CUT) from fault
        self._members: dict[str, list[zipfile.ZipInfo]] = {}
        for info in infos:
            # Names of parts differ in more than case (Open Packaging Conventions).
            self._members.setdefault(info.filename.lower().lstrip("/"), []).append(info)

    def error(self, fault: str, remedy: str = "", at: str = "") -> MeshError:
        """Return an error at this file, or at a part of it."""
        return self._source.error(fault, remedy, at=at)

    def name_of(self, target: str, at: str) -> str:
        """Return the name of the part that a link names from the archive's root.

        Args:
            target: the link.
            at: where it stands.
        """
        name = unquote(target).lstrip("/")
        if not name or ":" in name or "\\" in name or ".." in name.split("/"):
            fault = f"names '{shown(target.encode())}', which is no part of the archive"
            raise self.error(fault, "export it again", at)
        return name

    def __contains__(self, name: str) -> bool:
        return name.lower() in self._members

    def pieces(self, name: str, at: str = "") -> Iterator[bytes]:
        """Yield the bytes of a part.

        Args:
            name: of the part.
            at: what asks for it.
        """
        found = self._members.get(name.lower(), [])
        part = shown(name.encode())
        if len(found) != 1:
            fault = f"the archive holds '{part}' {len(found)} times, not once"
            raise self.error(fault, "export it again", at)
        info = found[0]
        if info.flag_bits & 1 or info.compress_type not in _PLAIN:
            fault = "is encrypted" if info.flag_bits & 1 else "is packed in a way that 3MF forbids"
            raise self.error(fault, "export it again", part)
        self._room -= info.file_size
        if info.file_size > _SMALL + _TIGHTEST * info.compress_size or self._room < 0:
            fault = f"unpacks {info.compress_size} bytes to {info.file_size}"
            raise self.error(fault, "no model does: it would fill the memory", part)
        yield from self._unpacked(info, part)

    def _unpacked(self, info: zipfile.ZipInfo, part: str) -> Iterator[bytes]:
        left = info.file_size
        try:
            with self._zip.open(info) as stream:
                while piece := stream.read(_PIECE):
                    left -= len(piece)
                    yield piece
        except _DAMAGED as fault:
            raise self.error("cannot be unpacked from the archive", _CUT, part) from fault
        if left:
            raise self.error("is shorter or longer than the archive says", _CUT, part)
