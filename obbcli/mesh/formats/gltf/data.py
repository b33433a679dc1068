"""The items, buffer views and accessors of a glTF document, each checked before it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from obbcli.mesh.formats.gltf.buffers import MESHOPT, Buffers
from obbcli.mesh.formats.gltf.compressed import decoded_view
from obbcli.mesh.formats.gltf.json import (
    Json,
    NotAsExpectedError,
    count_in,
    extension_of,
    is_count,
    list_in,
    words_of,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.source import Source

#: 5130 comes with KHR_accessor_float64.
_COMPONENTS = {
    5120: "<i1",
    5121: "<u1",
    5122: "<i2",
    5123: "<u2",
    5125: "<u4",
    5126: "<f4",
    5130: "<f8",
}
#: Matrices of fewer columns have padding, and none of those places a surface.
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class _View(NamedTuple):
    """Holds a range of bytes; `stride` is None where rows follow each other closely."""

    data: bytes
    start: int
    length: int
    stride: int | None


class Document:
    """Gives a document's items and accessors, refusing what is missing or out of place.

    Args:
        source: the file, beside which external buffers lie.
        content: the parsed JSON.
        chunk: the GLB's binary chunk, or None.

    Raises:
        NotAsExpectedError: from every method, with the place.
    """

    def __init__(self, source: Source, content: Json, chunk: bytes | None) -> None:
        self.content = content
        self.source = source
        self.buffers = Buffers(source, list_in(content, "buffers", "document"), chunk)
        self._unpacked: dict[int, bytes] = {}

    def items(self, name: str) -> list[Any]:
        """Return a list at the document's top, empty where there is none."""
        return list_in(self.content, name, "document")

    def names(self, key: str) -> list[str]:
        """Return a list of words at the document's top, such as `extensionsUsed`."""
        names = self.items(key)
        if not all(isinstance(name, str) for name in names):
            raise NotAsExpectedError(key, "holds something that is no name")
        return names

    def item(self, name: str, index: object) -> Json:
        """Return item `index` of a list at the document's top."""
        items = self.items(name)
        if not is_count(index) or index >= len(items) or not isinstance(items[index], dict):
            raise NotAsExpectedError(name, f"has no item {words_of(index)} ({len(items)} in all)")
        item: Json = items[index]
        return item

    def accessor(self, index: object, width: int) -> NDArray[Any]:
        """Return an accessor's values, (count, width), before any normalisation."""
        accessor = self.item("accessors", index)
        place = f"accessors[{index}]"
        count, dtype = self.form(index, width)
        if "bufferView" in accessor:
            offset = count_in(accessor, "byteOffset", place, 0)
            values = self._rows(accessor["bufferView"], offset, (count, width), dtype, place)
        else:
            # Zeros take no bytes of the file, so the bytes there are bound what is reserved.
            total = self.buffers.total()
            if count > total:
                raise NotAsExpectedError(place, f"claims {count} values in {total} bytes")
            values = np.zeros((count, width), dtype)
        return self._with_sparse(accessor, values, place) if "sparse" in accessor else values

    def form(self, index: object, width: int) -> tuple[int, np.dtype[Any]]:
        """Return how many values an accessor of `width` components has, and their type."""
        accessor = self.item("accessors", index)
        place = f"accessors[{index}]"
        kind, form = _component_in(accessor), accessor.get("type")
        if kind is None or not isinstance(form, str) or _WIDTHS.get(form) != width:
            raise NotAsExpectedError(place, f"is not of a known type with {width} components")
        return count_in(accessor, "count", place), np.dtype(kind)

    def scaled(self, index: object, values: NDArray[Any]) -> NDArray[np.float64]:
        """Return an accessor's values as numbers, those of normalised integers scaled back.

        Source: glTF 2.0, 3.6.2.2 and KHR_mesh_quantization: max(c / max, -1).
        """
        numbers = values.astype(np.float64)
        if self.is_normalized(index) and values.dtype.kind in "iu":
            return np.maximum(numbers / np.iinfo(values.dtype).max, -1.0)
        return numbers

    def is_normalized(self, index: object) -> bool:
        """Return whether an accessor's whole numbers stand for fractions of the largest."""
        return self.item("accessors", index).get("normalized") is True

    def numbers(self, index: object, width: int) -> NDArray[np.float64]:
        """Return an accessor's values as `scaled` does."""
        return self.scaled(index, self.accessor(index, width))

    def is_required(self, extension: str) -> bool:
        """Return whether the document cannot be read without an extension."""
        return extension in self.names("extensionsRequired")

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
        if kind is None or "u" not in kind:
            raise NotAsExpectedError(place, "has indices of no unsigned type")
        rows = self._rows(
            where.get("bufferView"),
            count_in(where, "byteOffset", place, 0),
            (count, 1),
            np.dtype(kind),
            place,
        ).reshape(-1)
        if count and int(rows.max()) >= len(values):
            raise NotAsExpectedError(place, f"replaces value {int(rows.max())} of {len(values)}")
        if (rows[1:] <= rows[:-1]).any():
            raise NotAsExpectedError(place, "has indices that do not increase")
        result: NDArray[Any] = values.copy()
        offset = count_in(what, "byteOffset", place, 0)
        shape = (count, values.shape[1])
        result[rows] = self._rows(what.get("bufferView"), offset, shape, values.dtype, place)
        return result

    def _rows(
        self,
        index: object,
        offset: int,
        shape: tuple[int, int],
        dtype: np.dtype[Any],
        place: str,
    ) -> NDArray[Any]:
        """Return rows of a buffer view, which may be interleaved with others."""
        view = self._view(index)
        count, width = shape
        row = width * dtype.itemsize
        stride = row if view.stride is None else view.stride
        needed = offset + (count - 1) * stride + row if count else 0
        if stride < row or needed > view.length:
            raise NotAsExpectedError(
                place,
                f"takes {needed} bytes of bufferViews[{index}], which has {view.length} "
                f"(stride {stride})",
            )
        rows: NDArray[Any] = np.ndarray(
            shape, dtype, view.data, view.start + offset, (stride, dtype.itemsize)
        )
        return rows

    def bytes_of_view(self, index: object) -> bytes:
        """Return the bytes of a buffer view."""
        view = self._view(index)
        return view.data[view.start : view.start + view.length]

    def _view(self, index: object) -> _View:
        """Return where a buffer view's bytes stand, those of compressed ones after unpacking.

        Where a compressed view stands beside a plain one and nothing requires the extension, the
        plain one counts, so that no answer depends on which packages are there.
        """
        view = self.item("bufferViews", index)
        assert isinstance(index, int)
        here = f"bufferViews[{index}]"
        length = count_in(view, "byteLength", here)
        stride = count_in(view, "byteStride", here) if "byteStride" in view else None
        packed = extension_of(view, MESHOPT, here)
        if packed is not None:
            name, content = packed
            plain = not self.is_required(name) and self.buffers.has_data(view.get("buffer"))
            if not plain:
                if index not in self._unpacked:
                    compressed = self._part_of_buffer(content, f"{here}.extensions.{name}")
                    self._unpacked[index] = decoded_view(self.source, compressed, content, here)
                data = self._unpacked[index]
                if len(data) != length:
                    raise NotAsExpectedError(here, f"claims {length} bytes, but has {len(data)}")
                return _View(data, 0, length, stride)
        data = self.buffers.data(view.get("buffer"))
        start = count_in(view, "byteOffset", here, 0)
        _check_range(start, length, len(data), here)
        return _View(data, start, length, stride)

    def _part_of_buffer(self, item: Json, place: str) -> bytes:
        """Return the bytes that an item with `buffer`, `byteOffset` and `byteLength` names."""
        data = self.buffers.data(item.get("buffer"))
        start = count_in(item, "byteOffset", place, 0)
        length = count_in(item, "byteLength", place)
        _check_range(start, length, len(data), place)
        return data[start : start + length]


def _check_range(start: int, length: int, size: int, place: str) -> None:
    if start + length > size:
        raise NotAsExpectedError(place, f"reaches to byte {start + length} of a buffer of {size}")


def _component_in(item: Json) -> str | None:
    """Return the type that a JSON object says its numbers have, None where it says none."""
    component = item.get("componentType")
    return _COMPONENTS.get(component) if is_count(component) else None
