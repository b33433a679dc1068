"""Tree files (`.obbt`): the arrays of a tree as bytes that can be mapped, checked and trusted.

Everything is little-endian. The header: 64 fixed bytes (`_FIXED`), the description as JSON, one
CRC-32 for each block of 4096 data bytes, zeros up to a multiple of 64; a CRC-32 of its own guards
it. The data: boxes, corners, triangle ids and vertices, each padded with zeros to a multiple of 64,
laid out as the kernels use them. CRC-32 finds every flipped byte and needs no library; blocks are
the size of a page, so that a reader can verify just what it touches.
"""

from __future__ import annotations

import os
import struct
import zlib
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from obbcli.errors import TreeFileError
from obbcli.files import write_whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

# As in PNG: the first byte is no text, and line ends show a transfer in text mode.
MAGIC = b"\x89OBBT\r\n\x1a"
VERSION = 1
BLOCK_BYTES = 4096
ALIGNMENT = 64

Fit = Literal["triangles", "points", "hull", "min-volume", "axis-aligned"]
Split = Literal["median", "center"]

# magic, version, header bytes, header CRC, block bytes, file bytes, boxes, triangles, vertices,
# scale exponent, description bytes
_FIXED = struct.Struct("<8sIIIIQQQQiI")
_CRC_OFFSET = 16
_NODE_BYTES, _CORNERS_BYTES, _ID_BYTES, _VERTEX_BYTES = 64, 12, 4, 24


@dataclass(frozen=True, kw_only=True)
class Description:
    """How a tree was made, and from what.

    Attributes:
        fit: how boxes were oriented.
        split: how nodes were parted.
        leaf_size: a node of so many triangles is a leaf.
        max_depth: the depth at which a node is a leaf; None: no limit.
        source: name of the mesh file; None for a mesh made in code.
        source_sha256: SHA-256 of the mesh file's bytes, hexadecimal; None likewise.
        tool_version: the obbtree that built it.
    """

    fit: str
    split: str
    leaf_size: int
    max_depth: int | None
    source: str | None
    source_sha256: str | None
    tool_version: str


@dataclass(frozen=True, kw_only=True, eq=False)
class TreeArrays:
    """A tree as plain arrays, all read-only.

    Attributes:
        nodes: uint8 (N, 64), the boxes in depth-first order (`kernels/node.hpp`), aligned to 64.
        corners: uint32 (F, 3), vertices of the triangles in tree order.
        triangle_ids: uint32 (F,), their rows in the mesh file.
        vertices: float64 (V, 3), mesh units.
        scale_exponent: boxes are in mesh units times 2 to the minus this.
        description: how the tree was made.
    """

    nodes: NDArray[np.uint8]
    corners: NDArray[np.uint32]
    triangle_ids: NDArray[np.uint32]
    vertices: NDArray[np.float64]
    scale_exponent: int
    description: Description


def is_tree_file(head: bytes) -> bool:
    """Return whether a file that begins with `head` claims to be a tree file."""
    return head[: len(MAGIC)] == MAGIC


def write_tree(path: str | os.PathLike[str], arrays: TreeArrays) -> int:
    """Write a tree file whole or not at all, and return its size in bytes.

    Raises:
        OSError: the place cannot be written to; nothing is left behind.
    """
    data = b"".join(_padded(_little_endian(array)) for array in _sections(arrays))
    header = _header(arrays, data)
    write_whole(path, header, data)
    return len(header) + len(data)


def read_tree(path: str | os.PathLike[str], *, verify: bool = True) -> TreeArrays:
    """Return the arrays of a tree file.

    Args:
        path: the file.
        verify: whether the data's checksums are compared; the header's always is.

    Raises:
        TreeFileError: no tree file, another version, truncated, or damaged.
        OSError: the file cannot be read.
    """
    with Path(path).open("rb") as file:
        size = os.fstat(file.fileno()).st_size
        # Aligned as the kernels want the boxes to be.
        buffer = _aligned_bytes(size)
        found = file.readinto(buffer.data)
    if found != size:
        raise TreeFileError(str(path), f"ends at byte {found} of {size}", "was it being written?")
    return _parse(buffer, str(path), verify=verify)


def parse_tree(
    data: bytes | bytearray | memoryview, name: str, *, verify: bool = True
) -> TreeArrays:
    """Return the arrays in the bytes of a tree file, copied; `name` is the place named in errors.

    Raises:
        TreeFileError: as `read_tree`.
    """
    plain = data.tobytes() if isinstance(data, memoryview) else data
    buffer = _aligned_bytes(len(plain))
    buffer[:] = np.frombuffer(plain, np.uint8)
    return _parse(buffer, name, verify=verify)


def _parse(buffer: NDArray[np.uint8], name: str, *, verify: bool) -> TreeArrays:
    """Return the arrays as views of a buffer that is aligned and nobody else's."""
    header = _checked_header(buffer.data, name)
    data = buffer[header.header_bytes :]
    if verify:
        _verify_blocks(data.data, header.block_crcs, name)
    arrays = []
    start = 0
    for length in header.section_bytes:
        section = data[start : start + length]
        section.setflags(write=False)
        arrays.append(section)
        start += _round_up(length)
    nodes, corners, ids, vertices = arrays
    return TreeArrays(
        nodes=nodes.reshape(-1, _NODE_BYTES),
        corners=corners.view("<u4").reshape(-1, 3),
        triangle_ids=ids.view("<u4"),
        vertices=vertices.view("<f8").reshape(-1, 3),
        scale_exponent=header.scale_exponent,
        description=header.description,
    )


@dataclass(frozen=True, kw_only=True)
class _Header:
    header_bytes: int
    section_bytes: tuple[int, ...]
    scale_exponent: int
    description: Description
    block_crcs: tuple[int, ...]


def _checked_header(data: memoryview, name: str) -> _Header:
    """Return the header after comparing everything in it with the file and with itself."""
    if len(data) < _FIXED.size or not is_tree_file(bytes(data[: len(MAGIC)])):
        raise TreeFileError(name, "is not a tree file", "make one with obbtree build")
    (_, version, header_bytes, crc, block_bytes, file_bytes, *counts, exponent, text_bytes) = (
        _FIXED.unpack_from(data)
    )
    if version != VERSION:
        raise TreeFileError(
            name,
            f"is of version {version}, this obbtree reads version {VERSION}",
            "build it again, or use a newer obbtree",
        )
    if file_bytes != len(data):
        raise TreeFileError(
            name, f"is {len(data)} bytes long, its header says {file_bytes}", "build it again"
        )
    if not _FIXED.size <= header_bytes <= len(data) or crc != _header_crc(data[:header_bytes]):
        raise TreeFileError(name, "is damaged in its header", "build it again")
    nodes, triangles, vertices = counts
    sections = (
        nodes * _NODE_BYTES,
        triangles * _CORNERS_BYTES,
        triangles * _ID_BYTES,
        vertices * _VERTEX_BYTES,
    )
    data_bytes = sum(map(_round_up, sections))
    blocks = -(-data_bytes // BLOCK_BYTES)
    wanted = _round_up(_FIXED.size + text_bytes + 4 * blocks)
    if (
        (block_bytes, header_bytes, file_bytes) != (BLOCK_BYTES, wanted, wanted + data_bytes)
        or not 1 <= triangles < 2**31
        or not min(1, triangles - 1) <= nodes < triangles
        or not abs(exponent) <= 1100
    ):
        raise TreeFileError(name, "has counts that contradict each other", "build it again")
    text = bytes(data[_FIXED.size : _FIXED.size + text_bytes])
    return _Header(
        header_bytes=header_bytes,
        section_bytes=sections,
        scale_exponent=exponent,
        description=_description(text, name),
        block_crcs=struct.unpack_from(f"<{blocks}I", data, _FIXED.size + text_bytes),
    )


def _description(text: bytes, name: str) -> Description:
    """Return the description, whose every field must be there, of its type and of use."""
    import json

    optional_text, optional_number = (str, type(None)), (int, type(None))
    types: dict[str, type | tuple[type, ...]] = {
        "fit": str,
        "split": str,
        "leaf_size": int,
        "max_depth": optional_number,
        "source": optional_text,
        "source_sha256": optional_text,
        "tool_version": str,
    }
    try:
        fields = json.loads(text)
        sound = fields.keys() == types.keys() and all(
            isinstance(fields[key], kind) and not isinstance(fields[key], bool)
            for key, kind in types.items()
        )
    except (ValueError, AttributeError, RecursionError) as fault:
        raise TreeFileError(name, "has a description that is no JSON object") from fault
    if not sound:
        raise TreeFileError(name, "lacks something in its description", "build it again")
    description = Description(**fields)
    allowed = {
        "fit": description.fit in get_args(Fit),
        "split": description.split in get_args(Split),
        "leaf_size": description.leaf_size >= 1,
        "max_depth": description.max_depth is None or description.max_depth >= 0,
    }
    for field, is_allowed in allowed.items():
        if not is_allowed:
            raise TreeFileError(
                name, f"says that {field} is {fields[field]!r}, which no tree has", "build it again"
            )
    return description


def _verify_blocks(data: memoryview, crcs: tuple[int, ...], name: str) -> None:
    """Compare every block with its checksum."""
    for index, crc in enumerate(crcs):
        start = index * BLOCK_BYTES
        if zlib.crc32(data[start : start + BLOCK_BYTES]) != crc:
            raise TreeFileError(
                name,
                f"is damaged between data bytes {start} and {start + BLOCK_BYTES}",
                "build it again from the mesh",
            )


def _header(arrays: TreeArrays, data: bytes) -> bytes:
    """Return the whole header, its own checksum included."""
    # Not at hand before: questions about meshes start without it.
    import json

    text = json.dumps(asdict(arrays.description)).encode()
    view = memoryview(data)
    crcs = [zlib.crc32(view[i : i + BLOCK_BYTES]) for i in range(0, len(data), BLOCK_BYTES)]
    header_bytes = _round_up(_FIXED.size + len(text) + 4 * len(crcs))
    fixed = _FIXED.pack(
        MAGIC,
        VERSION,
        header_bytes,
        0,
        BLOCK_BYTES,
        header_bytes + len(data),
        len(arrays.nodes),
        len(arrays.corners),
        len(arrays.vertices),
        arrays.scale_exponent,
        len(text),
    )
    header = bytearray(_padded(fixed + text + struct.pack(f"<{len(crcs)}I", *crcs)))
    struct.pack_into("<I", header, _CRC_OFFSET, _header_crc(memoryview(header)))
    return bytes(header)


def _header_crc(header: memoryview) -> int:
    """Return the CRC-32 of a header, its own four bytes left out."""
    return zlib.crc32(header[_CRC_OFFSET + 4 :], zlib.crc32(header[:_CRC_OFFSET]))


def _sections(arrays: TreeArrays) -> tuple[NDArray[np.generic], ...]:
    return (arrays.nodes, arrays.corners, arrays.triangle_ids, arrays.vertices)


def _little_endian(array: NDArray[np.generic]) -> bytes:
    return array.astype(array.dtype.newbyteorder("<"), copy=False).tobytes()


def _padded(data: bytes) -> bytes:
    return data + bytes(_round_up(len(data)) - len(data))


def _round_up(count: int) -> int:
    return -(-count // ALIGNMENT) * ALIGNMENT


def _aligned_bytes(count: int) -> NDArray[np.uint8]:
    """Return an array of bytes that begins at a multiple of the alignment."""
    raw = np.empty(count + ALIGNMENT, np.uint8)
    start = -raw.ctypes.data % ALIGNMENT
    return raw[start : start + count]
