"""The values of one `DataArray` of a VTK XML file: text, base64 or appended, packed or not."""

from __future__ import annotations

import base64
import binascii
import lzma
import zlib
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

#: Types of values with their NumPy kinds.
KINDS = {
    **{f"Int{bits}": f"i{bits // 8}" for bits in (8, 16, 32, 64)},
    **{f"UInt{bits}": f"u{bits // 8}" for bits in (8, 16, 32, 64)},
    "Float32": "f4",
    "Float64": "f8",
}
#: No packing makes data smaller than a thousandth of what they are.
_MOST_PACKED = 1100
_LARGEST_BLOCK = 1 << 30
_UNPACK: dict[str, Callable[[bytes | memoryview], bytes]] = {
    "vtkZLibDataCompressor": zlib.decompress,
    "vtkLZMADataCompressor": lzma.decompress,
}


class ArrayFault(Exception):  # noqa: N818 - said of a file, and caught where its place is known
    """What is wrong with an array, in words."""


class Coding(NamedTuple):
    """How a file writes its arrays.

    Attributes:
        order: of bytes, `<` or `>`.
        header: NumPy's kind of the numbers before an array.
        compressor: VTK's class, empty for none.
    """

    order: str
    header: str
    compressor: str


def text_values(text: bytes, kind: str) -> NDArray[Any]:
    """Return the values of an ASCII array.

    Raises:
        ArrayFault: a word that is no number.
    """
    try:
        return np.array(text.split(), dtype="f8" if kind[0] == "f" else "i8")
    except (ValueError, OverflowError) as fault:
        raise ArrayFault("holds a word that is no number") from fault


def binary_values(
    data: bytes | memoryview, coding: Coding, kind: str, *, is_base64: bool
) -> NDArray[Any]:
    """Return the values of a binary array.

    Args:
        data: the file from where the array begins on.
        coding: how the file writes arrays.
        kind: NumPy's, of the values.
        is_base64: whether the bytes are text; the numbers before packed values are on their own.

    Raises:
        ArrayFault: it goes beyond the file, or is damaged.
    """
    reader = _Base64(data) if is_base64 else _Raw(data)
    header = np.dtype(coding.order + coding.header)
    if coding.compressor:
        content = _unpacked(reader, header, coding.compressor)
    else:
        size = int(np.frombuffer(reader.take(header.itemsize), header)[0])
        content = bytes(reader.take(size))
    item = np.dtype(coding.order + kind)
    if len(content) % item.itemsize:
        raise ArrayFault(f"has {len(content)} bytes, which are no whole number of values")
    return np.frombuffer(content, item)


def _unpacked(reader: _Raw, header: np.dtype[Any], compressor: str) -> bytes:
    """Return packed bytes: how many blocks, the size of each and the last, packed sizes, blocks."""
    unpack = _UNPACK.get(compressor)
    if unpack is None:
        raise ArrayFault(f"is packed by {compressor}")
    count, size, last = np.frombuffer(reader.take(3 * header.itemsize), header).tolist()
    if count * header.itemsize > len(reader.data):
        raise ArrayFault(f"claims {count} blocks, which are more than the file holds")
    packed_sizes = np.frombuffer(reader.take(count * header.itemsize), header).tolist()
    reader.begin_part()
    total = count * size if not last else (count - 1) * size + last
    if total > _MOST_PACKED * (1 + sum(packed_sizes)) or not 0 <= last <= size <= _LARGEST_BLOCK:
        fault = f"claims {count} blocks of {size} bytes, which are more than the file holds"
        raise ArrayFault(fault)
    blocks = []
    for number, packed in enumerate(packed_sizes):
        wanted = last if number == count - 1 and last else size
        try:
            block = unpack(reader.take(packed))
        except (zlib.error, lzma.LZMAError) as fault:
            raise ArrayFault("is damaged where it is packed") from fault
        if len(block) != wanted:
            raise ArrayFault(f"claims a block of {wanted} bytes and has one of {len(block)}")
        blocks.append(block)
    return b"".join(blocks)


class _Raw:
    """Gives bytes one after the other."""

    def __init__(self, data: bytes | memoryview) -> None:
        self.data = data
        self._at = 0

    def take(self, count: int) -> bytes | memoryview:
        """Return the next bytes."""
        if count > len(self.data) - self._at:
            left = len(self.data) - self._at
            raise ArrayFault(f"claims {count} bytes, and {left} are left: cut short")
        self._at += count
        return self.data[self._at - count : self._at]

    def begin_part(self) -> None:
        """Begin another part, which base64 writes on its own."""


class _Base64(_Raw):
    """The same of bytes that are written as text."""

    def __init__(self, data: bytes | memoryview) -> None:
        super().__init__(data)
        self._start = 0  # of the part, in the text
        self._taken = 0  # of the part, in bytes

    def take(self, count: int) -> bytes:
        """Return the next bytes."""
        end = self._taken + count
        letters = -(-end // 3) * 4
        first = self._taken // 3
        text = self.data[self._start + 4 * first : self._start + letters]
        try:
            part = base64.b64decode(text, validate=True)[self._taken - 3 * first :][:count]
        except (binascii.Error, ValueError):
            part = b""
        if len(part) != count:
            raise ArrayFault(f"claims {count} bytes, which are not there: cut short or no base64")
        self._taken = end
        return part

    def begin_part(self) -> None:
        """Begin another part, which base64 writes on its own."""
        self._start += -(-self._taken // 3) * 4
        self._taken = 0
