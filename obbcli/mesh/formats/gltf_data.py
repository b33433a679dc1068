"""The bytes behind a glTF document: chunks, buffers and accessors, each checked before use."""

from __future__ import annotations

import base64
import binascii
import struct
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np

if TYPE_CHECKING:
    from typing import TypeGuard

    from numpy.typing import NDArray

    from obbcli.mesh.source import Source

_JSON, _BIN = 0x4E4F534A, 0x004E4942
_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

Json = dict[str, Any]


class NotAsExpectedError(Exception):
    """Something in the document is not what glTF says; `place` names it as JSON does."""

    def __init__(self, place: str, fault: str) -> None:
        super().__init__(place, fault)
        self.place = place
        self.fault = fault


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
        raise source.error(f"is GLB version {version}, only 2 is read", at="byte 4")
    if length != len(data):
        raise source.error(
            f"claims {length} bytes, but the file has {len(data)}",
            "it was cut short, or bytes follow it",
            at="byte 8",
        )
    chunks: dict[int, bytes] = {}
    position = 12
    while position < length:
        if position + 8 > length:
            raise source.error("ends inside a chunk's header", at=f"byte {position}")
        size, kind = struct.unpack_from("<2I", data, position)
        if position + 8 + size > length:
            raise source.error(
                f"a chunk claims {size} bytes, but {length - position - 8} are left",
                at=f"byte {position}",
            )
        chunks.setdefault(kind, data[position + 8 : position + 8 + size])
        position += 8 + size
    if _JSON not in chunks:
        raise source.error("has no JSON chunk", at="byte 12")
    return chunks[_JSON], chunks.get(_BIN)


class Document:
    """Gives a document's items and accessors, refusing what is missing or out of place.

    Args:
        source: the file, beside which external buffers lie.
        content: the parsed JSON.
        chunk: the GLB's binary chunk, or None.

    Raises:
        NotAsExpectedError: from every method, with the place.
    """

    def __init__(self, source: Source, content: object, chunk: bytes | None) -> None:
        if not isinstance(content, dict) or not isinstance(content.get("asset"), dict):
            raise NotAsExpectedError("asset", "is missing; this is no glTF document")
        self.content: Json = content
        self._source = source
        self._chunk = chunk
        self._buffers: dict[int, bytes] = {}

    def items(self, name: str) -> list[Any]:
        """Return a list at the document's top, empty where there is none."""
        return list_in(self.content, name, "document")

    def item(self, name: str, index: object) -> Json:
        """Return item `index` of a list at the document's top."""
        items = self.items(name)
        if not is_count(index) or index >= len(items) or not isinstance(items[index], dict):
            raise NotAsExpectedError(name, f"has no item {index!r} ({len(items)} in all)")
        return dict(items[index])

    def accessor(self, index: object, width: int) -> NDArray[Any]:
        """Return an accessor's values, (count, width), before any normalisation."""
        accessor = self.item("accessors", index)
        place = f"accessors[{index}]"
        kind, form = _component_in(accessor), accessor.get("type")
        if kind is None or not isinstance(form, str) or _WIDTHS.get(form) != width:
            raise NotAsExpectedError(place, f"is not of a known type with {width} components")
        count = count_in(accessor, "count", place)
        dtype = np.dtype(kind)
        if "bufferView" in accessor:
            offset = count_in(accessor, "byteOffset", place, 0)
            values = self._view(accessor["bufferView"], offset, (count, width), dtype, place)
        else:
            # Zeros take no bytes of the file, so the bytes there are bound what is reserved.
            total = sum(len(self.buffer(i)) for i in range(len(self.items("buffers"))))
            if count > total:
                raise NotAsExpectedError(place, f"claims {count} values in {total} bytes")
            values = np.zeros((count, width), dtype)
        return self._with_sparse(accessor, values, place) if "sparse" in accessor else values

    def _with_sparse(self, accessor: Json, values: NDArray[Any], place: str) -> NDArray[Any]:
        """Return `values` with the accessor's listed replacements."""
        sparse = accessor["sparse"]
        place = f"{place}.sparse"
        if not isinstance(sparse, dict) or not all(
            isinstance(sparse.get(key), dict) for key in ("indices", "values")
        ):
            raise NotAsExpectedError(place, "has no indices and values")
        count = count_in(sparse, "count", place)
        where, what = sparse["indices"], sparse["values"]
        kind = _component_in(where)
        if kind in (None, "<f4"):
            raise NotAsExpectedError(place, "has indices of no whole type")
        rows = self._view(
            where.get("bufferView"),
            count_in(where, "byteOffset", place, 0),
            (count, 1),
            np.dtype(kind),
            place,
        ).reshape(-1)
        if count and int(rows.max()) >= len(values):
            raise NotAsExpectedError(place, f"replaces value {int(rows.max())} of {len(values)}")
        result: NDArray[Any] = values.copy()
        offset = count_in(what, "byteOffset", place, 0)
        shape = (count, values.shape[1])
        result[rows] = self._view(what.get("bufferView"), offset, shape, values.dtype, place)
        return result

    def _view(
        self,
        index: object,
        offset: int,
        shape: tuple[int, int],
        dtype: np.dtype[Any],
        place: str,
    ) -> NDArray[Any]:
        """Return rows of a buffer view, which may be interleaved with others."""
        view = self.item("bufferViews", index)
        here = f"bufferViews[{index}]"
        data = self.buffer(view.get("buffer"))
        start = count_in(view, "byteOffset", here, 0)
        length = count_in(view, "byteLength", here)
        if start + length > len(data):
            raise NotAsExpectedError(
                here, f"reaches to byte {start + length} of a buffer of {len(data)}"
            )
        count, width = shape
        row = width * dtype.itemsize
        stride = count_in(view, "byteStride", here, row)
        needed = offset + (count - 1) * stride + row if count else 0
        if stride < row or needed > length:
            raise NotAsExpectedError(
                place, f"takes {needed} bytes of {here}, which has {length} (stride {stride})"
            )
        rows: NDArray[Any] = np.ndarray(
            shape, dtype, data, start + offset, (stride, dtype.itemsize)
        )
        return rows

    def buffer(self, index: object) -> bytes:
        """Return a buffer's bytes: the GLB's chunk, base64 in the document, or a file beside it."""
        buffer = self.item("buffers", index)
        assert isinstance(index, int)
        if index not in self._buffers:
            place = f"buffers[{index}]"
            length = count_in(buffer, "byteLength", place)
            data = self._bytes_of(buffer.get("uri"), index, place)
            if len(data) < length:
                raise NotAsExpectedError(place, f"claims {length} bytes, but has {len(data)}")
            self._buffers[index] = data
        return self._buffers[index]

    def _bytes_of(self, uri: object, index: int, place: str) -> bytes:
        if uri is None and index == 0 and self._chunk is not None:
            return self._chunk
        if not isinstance(uri, str):
            raise NotAsExpectedError(place, "has no data")
        if uri.startswith("data:"):
            try:
                return base64.b64decode(uri.partition(",")[2], validate=True)
            except (binascii.Error, ValueError) as fault:
                raise NotAsExpectedError(place, f"is no base64: {fault}") from fault
        name = unquote(uri)
        if self._source.path is None:
            raise NotAsExpectedError(place, f"lies in '{name}'; name the file instead of a stream")
        # Only files at or below the document's folder: a mesh may not name any file there is.
        if (
            ":" in name
            or name.startswith(("/", "\\"))
            or ".." in name.replace("\\", "/").split("/")
        ):
            raise NotAsExpectedError(place, f"'{name}' is not a path beside the file")
        try:
            return (self._source.path.parent / name).read_bytes()
        except (OSError, ValueError) as fault:
            raise NotAsExpectedError(place, f"'{name}' cannot be read: {fault}") from fault


def is_count(value: object) -> TypeGuard[int]:
    """Return whether a JSON value is a whole number that can count or index."""
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2**53


def _component_in(item: Json) -> str | None:
    """Return the type that a JSON object says its numbers have, None where it says none."""
    component = item.get("componentType")
    return _COMPONENTS.get(component) if is_count(component) else None


def count_in(item: Json, key: str, place: str, default: int | None = None) -> int:
    """Return a count in a JSON object."""
    value = item.get(key, default)
    if not is_count(value):
        raise NotAsExpectedError(f"{place}.{key}", f"is {value!r}, expected a whole number")
    return value


def list_in(item: Json, key: str, place: str) -> list[Any]:
    """Return a list in a JSON object, empty where there is none."""
    value = item.get(key, [])
    if not isinstance(value, list):
        raise NotAsExpectedError(f"{place}.{key}", "is no list")
    return value


def numbers_in(item: Json, key: str, place: str, default: list[float]) -> NDArray[np.float64]:
    """Return a list of finite numbers in a JSON object, as many as `default` has."""
    value = item.get(key, default)
    if (
        not isinstance(value, list)
        or len(value) != len(default)
        or not all(isinstance(x, (int, float)) and not isinstance(x, bool) for x in value)
        or not all(abs(x) < 1e308 for x in value)
    ):
        raise NotAsExpectedError(f"{place}.{key}", f"expected {len(default)} finite numbers")
    return np.array(value, dtype=np.float64)
