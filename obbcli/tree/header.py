"""The header of tree files (`.obbt`): what they hold, how it was made, and checksums over it.

All is little-endian: 64 fixed bytes (`FIXED`), the description as JSON, one CRC-32 for each block
of 4096 data bytes, zeros up to a multiple of 64; a CRC-32 of its own guards it. CRC-32 finds every
flipped byte and is known everywhere; blocks are the size of a page, so that a reader can verify
just what it touches.
"""

from __future__ import annotations

import os
import struct
import zlib
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np

from obbcli.errors import TreeFileError
from obbcli.mesh import PartRows
from obbcli.tree.options import FITS, SPLITS, Description

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh import Mesh

# As in PNG: the first byte is no text, and line ends show a transfer in text mode.
MAGIC = b"\x89OBBT\r\n\x1a"
VERSION = 1
BLOCK_BYTES = 4096
ALIGNMENT = 64

# magic, version, header bytes, header CRC, block bytes, file bytes, boxes, triangles, vertices,
# scale exponent, description bytes
FIXED = struct.Struct("<8sIIIIQQQQiI")
_CRC_OFFSET = 16
# What a description may leave out, and what that means.
_UNSAID: dict[str, Any] = {"notes": [], "unit": None, "parts": [], "sag": None, "spacing": None}
NODE_BYTES = 64
_CORNERS_BYTES, _ID_BYTES, _VERTEX_BYTES = 12, 4, 24


class Surface(NamedTuple):
    """What questions ask of a mesh as a whole, so that they need not read all of it.

    Attributes:
        bounds: the corners of its axis-aligned box, mesh units.
        surface_centroid: its area-weighted centroid, mesh units.
    """

    bounds: tuple[tuple[float, ...], tuple[float, ...]]
    surface_centroid: tuple[float, ...]

    @classmethod
    def of(cls, mesh: Mesh) -> Surface:
        """Return that of a mesh."""
        low, high = mesh.bounds.tolist()
        return cls((tuple(low), tuple(high)), tuple(mesh.surface_centroid.tolist()))


def is_tree_file(head: bytes) -> bool:
    """Return whether a file that begins with `head` claims to be a tree file."""
    return head[: len(MAGIC)] == MAGIC


def read_header(file: BinaryIO, name: str) -> Header:
    """Return the header of a tree file that was just opened.

    Raises:
        TreeFileError: no tree file, another version, truncated, or damaged in its header.
        OSError: the file cannot be read.
    """
    size = os.fstat(file.fileno()).st_size
    head = file.read(FIXED.size)
    if len(head) == FIXED.size:
        # The header may claim any length; no more than the file holds is read.
        head += file.read(max(0, min(FIXED.unpack(head)[2], size) - FIXED.size))
    return checked_header(memoryview(head), size, name)


@dataclass(frozen=True, kw_only=True, eq=False)
class Header:
    """What stands before the data of a tree file, checked.

    Attributes:
        header_bytes: where the data begin.
        node_count: boxes.
        triangle_count: triangles.
        vertex_count: vertices.
        scale_exponent: boxes are in mesh units times 2 to the minus this.
        description: how the tree was made.
        surface: of the mesh as a whole.
        checksums: uint32 (B,), the CRC-32 of each block.
    """

    header_bytes: int
    node_count: int
    triangle_count: int
    vertex_count: int
    scale_exponent: int
    description: Description
    surface: Surface
    checksums: NDArray[np.uint32]

    @property
    def section_bytes(self) -> tuple[int, int, int, int]:
        """Bytes of boxes, corners, triangle ids and vertices, without what pads them."""
        return _section_bytes(self.node_count, self.triangle_count, self.vertex_count)


def checked_header(data: memoryview, size: int, name: str) -> Header:
    """Return the header after comparing everything in it with the file and with itself.

    Args:
        data: the file's bytes, at least those of its header where it has so many.
        size: of the file.
        name: the place named in errors.
    """
    if len(data) < FIXED.size or not is_tree_file(bytes(data[: len(MAGIC)])):
        raise TreeFileError(name, "is not a tree file", "make one with obbtree build")
    (_, version, header_bytes, crc, block_bytes, file_bytes, *counts, exponent, text_bytes) = (
        FIXED.unpack_from(data)
    )
    if version != VERSION:
        fault = f"is of version {version}, this obbtree reads version {VERSION}"
        raise TreeFileError(name, fault, "build it again, or use a newer obbtree")
    if file_bytes != size:
        fault = f"is {size} bytes long, its header says {file_bytes}"
        raise TreeFileError(name, fault, "build it again")
    if not FIXED.size <= header_bytes <= len(data) or crc != _header_crc(data[:header_bytes]):
        raise TreeFileError(name, "is damaged in its header", "build it again")
    nodes, triangles, vertices = counts
    data_bytes = sum(map(round_up, _section_bytes(nodes, triangles, vertices)))
    blocks = -(-data_bytes // BLOCK_BYTES)
    wanted = round_up(FIXED.size + text_bytes + 4 * blocks)
    if (
        (block_bytes, header_bytes, file_bytes) != (BLOCK_BYTES, wanted, wanted + data_bytes)
        or not 1 <= triangles < 2**31
        or not min(1, triangles - 1) <= nodes < triangles
        or not abs(exponent) <= 1100
    ):
        raise TreeFileError(name, "has counts that contradict each other", "build it again")
    text = bytes(data[FIXED.size : FIXED.size + text_bytes])
    description, surface = _description(text, name, triangles)
    return Header(
        header_bytes=header_bytes,
        node_count=nodes,
        triangle_count=triangles,
        vertex_count=vertices,
        scale_exponent=exponent,
        description=description,
        surface=surface,
        checksums=np.frombuffer(data, "<u4", blocks, FIXED.size + text_bytes),
    )


def _description(text: bytes, name: str, triangles: int) -> tuple[Description, Surface]:
    """Return what the JSON says, whose every field must be there, of its type and of use."""
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
        "bounds": list,
        "surface_centroid": list,
        "notes": list,
        "unit": optional_text,
        "parts": list,
        "sag": (float, type(None)),
        "spacing": (float, type(None)),
    }
    try:
        fields = _UNSAID | json.loads(text)
        sound = fields.keys() == types.keys() and all(
            isinstance(fields[key], kind) and not isinstance(fields[key], bool)
            for key, kind in types.items()
        )
    except (ValueError, TypeError, RecursionError) as fault:
        raise TreeFileError(name, "has a description that is no JSON object") from fault
    if not sound:
        raise TreeFileError(name, "lacks something in its description", "build it again")
    bounds, centroid = fields.pop("bounds"), fields.pop("surface_centroid")
    if not _is_surface(bounds, centroid):
        raise TreeFileError(name, "says of its surface what no mesh has", "build it again")
    notes = tuple(fields["notes"])
    parts = _parts(fields["parts"], triangles)
    description = Description(**fields | {"notes": notes, "parts": parts or ()})
    allowed = {
        "fit": description.fit in FITS,
        "split": description.split in SPLITS,
        "leaf_size": description.leaf_size >= 1,
        "max_depth": description.max_depth is None or description.max_depth >= 0,
        # Sentences that a terminal can show.
        "notes": all(isinstance(note, str) and note.isprintable() for note in notes),
        "unit": (fields["unit"] or "").isprintable(),
        "parts": parts is not None,
        "sag": description.sag is None or 0.0 < description.sag < inf,
        "spacing": description.spacing is None or 0.0 <= description.spacing < inf,
    }
    for field, is_allowed in allowed.items():
        if not is_allowed:
            wrong = f"says that {field} is {fields[field]!r}, which no tree has"
            raise TreeFileError(name, wrong, "build it again")
    return description, Surface((tuple(bounds[0]), tuple(bounds[1])), tuple(centroid))


def _parts(rows: list[Any], triangles: int) -> tuple[PartRows, ...] | None:
    """Return the parts that a tree's mesh was selected from; None where they do not add up."""
    first, found = 0, []
    for row in rows:
        if not isinstance(row, list) or list(map(type, row)) != [str, int, int]:
            return None
        found.append(PartRows(*row))
        if not found[-1].path.isprintable() or found[-1].first_triangle != first:
            return None
        first += max(found[-1].triangle_count, 0)
    return tuple(found) if first == triangles or not rows else None


def _is_surface(bounds: list[object], centroid: list[object]) -> bool:
    """Return whether these are the corners of a box and a point in it."""
    if len(bounds) != 2:
        return False
    points = [bounds[0], centroid, bounds[1]]
    for point in points:
        if not isinstance(point, list) or list(map(type, point)) != [float] * 3:
            return False
    # Infinities and NaN fail these comparisons.
    return all(-inf < low <= x <= high < inf for low, x, high in zip(*points, strict=True))


def pack_header(
    counts: tuple[int, int, int],
    scale_exponent: int,
    description: Description,
    surface: Surface,
    checksums: NDArray[np.uint32],
    data_bytes: int,
) -> bytes:
    """Return a whole header, its own checksum included.

    Args:
        counts: of boxes, triangles and vertices.
        scale_exponent: as in `Header`.
        description: how the tree was made.
        surface: of the mesh as a whole.
        checksums: of each block of data.
        data_bytes: length of all data.
    """
    # Questions about meshes start without this import.
    import json

    fields = vars(description) | surface._asdict()
    # What is not said is no key, so that every reader of version 1 takes the file.
    text = json.dumps({k: v for k, v in fields.items() if v or k not in _UNSAID}).encode()
    table = checksums.astype("<u4", copy=False).tobytes()
    header_bytes = round_up(FIXED.size + len(text) + len(table))
    fixed = FIXED.pack(
        MAGIC,
        VERSION,
        header_bytes,
        0,
        BLOCK_BYTES,
        header_bytes + data_bytes,
        *counts,
        scale_exponent,
        len(text),
    )
    header = bytearray((fixed + text + table).ljust(header_bytes, b"\0"))
    struct.pack_into("<I", header, _CRC_OFFSET, _header_crc(memoryview(header)))
    return bytes(header)


def _section_bytes(nodes: int, triangles: int, vertices: int) -> tuple[int, int, int, int]:
    return (
        nodes * NODE_BYTES,
        triangles * _CORNERS_BYTES,
        triangles * _ID_BYTES,
        vertices * _VERTEX_BYTES,
    )


def _header_crc(header: memoryview) -> int:
    """Return the CRC-32 of a header, its own four bytes left out."""
    return zlib.crc32(header[_CRC_OFFSET + 4 :], zlib.crc32(header[:_CRC_OFFSET]))


def round_up(count: int) -> int:
    """Return the next multiple of the alignment of sections."""
    return -(-count // ALIGNMENT) * ALIGNMENT
