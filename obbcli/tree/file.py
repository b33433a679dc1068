"""Tree files (`.obbt`): the arrays of a tree as bytes that can be read in part and trusted.

After the header (`header`) stand boxes, corners, triangle ids and vertices, each padded with
zeros to a multiple of 64, laid out as the kernels use them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli import kernels
from obbcli.errors import TreeFileError
from obbcli.files import write_whole
from obbcli.tree.header import (
    ALIGNMENT,
    BLOCK_BYTES,
    NODE_BYTES,
    checked_header,
    pack_header,
    round_up,
)
from obbcli.tree.whole import TreeArrays

if TYPE_CHECKING:
    import os

    from numpy.typing import NDArray

    from obbcli.tree.header import Header, Surface


def write_tree(path: str | os.PathLike[str], arrays: TreeArrays, surface: Surface) -> int:
    """Write a tree file whole or not at all, and return its size in bytes.

    Args:
        path: where to.
        arrays: the tree.
        surface: of its mesh.

    Raises:
        OSError: the place cannot be written to; nothing is left behind.
    """
    header, data = tree_bytes(arrays, surface)
    write_whole(path, header, data)
    return len(header) + len(data)


def tree_bytes(arrays: TreeArrays, surface: Surface) -> tuple[bytes, bytes]:
    """Return the two parts of a tree file: its header, and what follows.

    Args:
        arrays: the tree.
        surface: of its mesh.
    """
    data = b"".join(_padded(_little_endian(array)) for array in _sections(arrays))
    header = pack_header(
        (len(arrays.nodes), len(arrays.corners), len(arrays.vertices)),
        arrays.scale_exponent,
        arrays.description,
        surface,
        kernels.block_checksums(np.frombuffer(data, np.uint8)),
        len(data),
    )
    return header, data


def parse_tree(
    data: bytes | bytearray | memoryview, name: str, *, verify: bool = True
) -> TreeArrays:
    """Return the arrays in the bytes of a tree file, copied.

    Args:
        data: the bytes.
        name: the place named in errors.
        verify: whether the data's checksums are compared; the header's always is.

    Raises:
        TreeFileError: no tree file, another version, truncated, or damaged.
    """
    plain = data.tobytes() if isinstance(data, memoryview) else data
    buffer = _aligned_bytes(len(plain))
    buffer[:] = np.frombuffer(plain, np.uint8)
    header = checked_header(buffer.data, len(buffer), name)
    content = buffer[header.header_bytes :]
    if verify:
        _verify_blocks(content, header, name)
    arrays = []
    start = 0
    for length in header.section_bytes:
        section = content[start : start + length]
        section.setflags(write=False)
        arrays.append(section)
        start += round_up(length)
    nodes, corners, ids, vertices = arrays
    return TreeArrays(
        nodes=nodes.reshape(-1, NODE_BYTES),
        corners=corners.view("<u4").reshape(-1, 3),
        triangle_ids=ids.view("<u4"),
        vertices=vertices.view("<f8").reshape(-1, 3),
        scale_exponent=header.scale_exponent,
        description=header.description,
        surface=header.surface,
    )


def _verify_blocks(data: NDArray[np.uint8], header: Header, name: str) -> None:
    """Compare every block with its checksum."""
    bad = np.flatnonzero(kernels.block_checksums(data) != header.checksums)
    if len(bad):
        start = header.header_bytes + int(bad[0]) * BLOCK_BYTES
        end = min(start + BLOCK_BYTES, header.header_bytes + len(data))
        raise TreeFileError(
            name,
            f"is damaged between bytes {start} and {end}",
            "build it again from the mesh",
        )


def _sections(arrays: TreeArrays) -> tuple[NDArray[np.generic], ...]:
    return (arrays.nodes, arrays.corners, arrays.triangle_ids, arrays.vertices)


def _little_endian(array: NDArray[np.generic]) -> bytes:
    return array.astype(array.dtype.newbyteorder("<"), copy=False).tobytes()


def _padded(data: bytes) -> bytes:
    return data + bytes(round_up(len(data)) - len(data))


def _aligned_bytes(count: int) -> NDArray[np.uint8]:
    """Return an array of bytes that begins at a multiple of the alignment."""
    raw = np.empty(count + ALIGNMENT, np.uint8)
    start = -raw.ctypes.data % ALIGNMENT
    return raw[start : start + count]
