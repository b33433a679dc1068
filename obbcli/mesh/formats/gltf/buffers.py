"""Where a glTF document's bytes come from: the chunks of a GLB, base64, files beside it."""

from __future__ import annotations

import base64
import binascii
import struct
from typing import TYPE_CHECKING
from urllib.parse import unquote

from obbcli.mesh.formats.gltf.json import (
    NotAsExpectedError,
    count_in,
    extension_of,
    is_count,
    words_of,
)

if TYPE_CHECKING:
    from obbcli.mesh.formats.gltf.json import Json
    from obbcli.mesh.source import Source

_JSON, _BIN = 0x4E4F534A, 0x004E4942
#: Both names of one extension: the second came with its ratification.
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")


def split_glb(source: Source) -> tuple[bytes, bytes | None]:
    """Return the JSON text and the binary chunk of a GLB file, or the whole of a glTF file.

    Raises:
        MeshError: another version, or lengths that do not fit the file.
    """
    data = source.data
    if not data.startswith(b"glTF"):
        return data, None
    if len(data) < 20:
        raise source.error(f"has {len(data)} bytes, a GLB file at least 20", "it was cut short")
    _, version, length = struct.unpack_from("<3I", data)
    if version != 2:
        raise source.error(
            f"is GLB version {version} (glTF {version}.0), only 2 is read",
            "convert it to glTF 2.0",
            at="byte 4",
        )
    if length != len(data):
        raise source.error(
            f"claims {length} bytes, but the file has {len(data)}",
            "it was cut short, or bytes follow it",
            at="byte 8",
        )
    chunks = _chunks(source, length)
    if _JSON not in chunks:
        raise source.error("has no JSON chunk", at="byte 12")
    return chunks[_JSON], chunks.get(_BIN)


def _chunks(source: Source, length: int) -> dict[int, bytes]:
    """Return the first chunk of each kind."""
    chunks: dict[int, bytes] = {}
    position = 12
    while position < length:
        if position + 8 > length:
            raise source.error("ends inside a chunk's header", at=f"byte {position}")
        size, kind = struct.unpack_from("<2I", source.data, position)
        if position + 8 + size > length:
            raise source.error(
                f"a chunk claims {size} bytes, but {length - position - 8} are left",
                at=f"byte {position}",
            )
        chunks.setdefault(kind, source.data[position + 8 : position + 8 + size])
        position += 8 + size
    return chunks


class Buffers:
    """Gives the bytes of a document's buffers, each looked up once.

    Args:
        source: the file, beside which external buffers lie.
        items: the document's `buffers`.
        chunk: the GLB's binary chunk, or None.
    """

    def __init__(self, source: Source, items: list[Json], chunk: bytes | None) -> None:
        self._source = source
        self._items = items
        self._chunk = chunk
        self._found: dict[int, bytes] = {}

    def data(self, index: object) -> bytes:
        """Return a buffer's bytes.

        Raises:
            NotAsExpectedError: it is missing, shorter than it claims, or lies where no mesh may
                point to.
        """
        item = self._item(index)
        assert isinstance(index, int)
        if index not in self._found:
            place = f"buffers[{index}]"
            length = count_in(item, "byteLength", place)
            data = self._bytes_of(item.get("uri"), index, place)
            if len(data) < length:
                raise NotAsExpectedError(place, f"claims {length} bytes, but has {len(data)}")
            self._found[index] = data
        return self._found[index]

    def has_data(self, index: object) -> bool:
        """Return whether a buffer has bytes of its own; fallbacks of compressed ones may not."""
        item = self._item(index)
        return isinstance(item.get("uri"), str) or (index == 0 and self._chunk is not None)

    def total(self) -> int:
        """Return how many bytes all buffers hold together."""
        return sum(len(self.data(i)) for i in range(len(self._items)) if self.has_data(i))

    def _item(self, index: object) -> Json:
        items = self._items
        if not is_count(index) or index >= len(items) or not isinstance(items[index], dict):
            fault = f"has no item {words_of(index)} ({len(items)} in all)"
            raise NotAsExpectedError("buffers", fault)
        return items[index]

    def _bytes_of(self, uri: object, index: int, place: str) -> bytes:
        if uri is None and index == 0 and self._chunk is not None:
            return self._chunk
        if not isinstance(uri, str):
            fallback = extension_of(self._items[index], MESHOPT, place) is not None
            raise NotAsExpectedError(
                place,
                "has no data: it stands for a compressed one" if fallback else "has no data",
            )
        if uri.startswith("data:"):
            try:
                return base64.b64decode(uri.partition(",")[2], validate=True)
            except (binascii.Error, ValueError) as fault:
                raise NotAsExpectedError(place, "its data is no base64") from fault
        return self._file(unquote(uri), place)

    def _file(self, name: str, place: str) -> bytes:
        """Return a file at or below the document's folder: no mesh may name any file there is."""
        shown = name if len(name) <= 80 else f"{name[:80]}..."
        if self._source.path is None:
            raise NotAsExpectedError(
                place, f"lies in the file '{shown}'", "name the file instead of a stream"
            )
        if (
            ":" in name
            or name.startswith(("/", "\\"))
            or ".." in name.replace("\\", "/").split("/")
        ):
            raise NotAsExpectedError(
                place,
                f"lies in '{shown}', which is not a path beside the file",
                "put it into the document's folder",
            )
        try:
            return (self._source.path.parent / name).read_bytes()
        except (OSError, ValueError) as fault:
            reason = getattr(fault, "strerror", None) or "no name of a file"
            raise NotAsExpectedError(
                place,
                f"lies in the file '{shown}', which cannot be read: {reason}",
                "put that file beside this one",
            ) from fault
