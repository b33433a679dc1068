"""An independent reading of tree files: the documented bytes, and containment in exact integers.

Shares no code with the package: `struct` and NumPy read the format, the axes follow from the
float32 quaternion in doubles as `kernels/tree/node.hpp` defines them; from there nothing rounds.
"""

from __future__ import annotations

import json
import struct
import zlib
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from oracles.exact import Vector, cross, dot, subtract

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

MAGIC = b"\x89OBBT\r\n\x1a"
FIXED = struct.Struct("<8sIIIIQQQQiI")
BLOCK = 4096
NODE = np.dtype(
    [
        ("center", "<f8", 3),
        ("half_extents", "<f4", 3),
        ("rotation", "<f4", 4),
        ("split", "<u4"),
        ("right", "<u4"),
        ("reserved", "<u4"),
    ]
)


class TreeFile(NamedTuple):
    """What a tree file says."""

    description: dict[str, Any]
    scale_exponent: int
    nodes: Any
    corners: Any
    triangle_ids: Any
    vertices: Any


class Visit(NamedTuple):
    """A node of a walk: its range of triangles, its box or None, its depth, whether it ends."""

    begin: int
    end: int
    slot: int | None
    depth: int
    is_leaf: bool


def parse(data: bytes) -> TreeFile:
    """Return the content of a tree file after comparing every count and checksum with it."""
    magic, version, header_bytes, crc, block, size, *counts, exponent, text_bytes = (
        FIXED.unpack_from(data)
    )
    assert (magic, version, block, size) == (MAGIC, 1, BLOCK, len(data))
    assert crc == zlib.crc32(data[20:header_bytes], zlib.crc32(data[:16]))
    payload = data[header_bytes:]
    crcs = [zlib.crc32(payload[i : i + BLOCK]) for i in range(0, len(payload), BLOCK)]
    table = FIXED.size + text_bytes
    assert list(struct.unpack_from(f"<{len(crcs)}I", data, table)) == crcs
    assert header_bytes == _padded(table + 4 * len(crcs))
    boxes, triangles, vertices = counts
    starts = np.cumsum([0, *map(_padded, (64 * boxes, 12 * triangles, 4 * triangles))]).tolist()
    assert len(payload) == starts[3] + _padded(24 * vertices)

    def section(index: int, kind: Any, count: int) -> Any:
        return np.frombuffer(payload, kind, count, starts[index])

    return TreeFile(
        description=json.loads(data[FIXED.size : table]),
        scale_exponent=exponent,
        nodes=section(0, NODE, boxes),
        corners=section(1, "<u4", 3 * triangles).reshape(-1, 3),
        triangle_ids=section(2, "<u4", triangles),
        vertices=section(3, "<f8", 3 * vertices).reshape(-1, 3),
    )


def forge(data: bytes) -> bytes:
    """Return a file's bytes with all checksums made to fit what it now holds."""
    forged = bytearray(data)
    header_bytes, text_bytes = FIXED.unpack_from(data)[2], FIXED.unpack_from(data)[-1]
    payload = data[header_bytes:]
    for index, start in enumerate(range(0, len(payload), BLOCK)):
        crc = zlib.crc32(payload[start : start + BLOCK])
        struct.pack_into("<I", forged, FIXED.size + text_bytes + 4 * index, crc)
    crc = zlib.crc32(forged[20:header_bytes], zlib.crc32(forged[:16]))
    struct.pack_into("<I", forged, 16, crc)
    return bytes(forged)


def axes_of(rotation: Any) -> list[list[float]]:
    """Return the axes of a box as rows, computed in doubles exactly as the format defines."""
    w, x, y, z = (float(q) for q in rotation)
    s = 2.0 / (w * w + x * x + y * y + z * z)
    wx, wy, wz = s * w * x, s * w * y, s * w * z
    xx, xy, xz = s * x * x, s * x * y, s * x * z
    yy, yz, zz = s * y * y, s * y * z, s * z * z
    return [
        [1 - yy - zz, xy + wz, xz - wy],
        [xy - wz, 1 - xx - zz, yz + wx],
        [xz + wy, yz - wx, 1 - xx - yy],
    ]


def walk(tree: TreeFile) -> Iterator[Visit]:
    """Yield every node, parents first and left before right, following the stored links alone."""
    stack = [(0, len(tree.corners), 0, 0)]
    while stack:
        begin, end, slot, depth = stack.pop()
        if end - begin == 1:
            yield Visit(begin, end, None, depth, is_leaf=True)
            continue
        split, right = int(tree.nodes[slot]["split"]), int(tree.nodes[slot]["right"])
        yield Visit(begin, end, slot, depth, is_leaf=split == 0)
        if split:
            assert begin < split < end
            stack.append((split, end, right, depth + 1))
            stack.append((begin, split, slot + 1, depth + 1))


def faults(tree: TreeFile, vertices: Any, triangles: Any) -> list[str]:
    """Return what is wrong with a tree over a mesh; nothing where it is proven sound."""
    found = []
    if not np.array_equal(tree.vertices, vertices):
        found.append("vertices differ from the mesh's")
    if sorted(tree.triangle_ids.tolist()) != list(range(len(triangles))):
        found.append("ids are no permutation")
    elif not np.array_equal(np.asarray(triangles)[tree.triangle_ids], tree.corners):
        found.append("corners differ from the mesh's")
    return found + list(_structure_faults(tree)) + list(_containment_faults(tree))


def _structure_faults(tree: TreeFile) -> Iterator[str]:
    leaf_size, max_depth = tree.description["leaf_size"], tree.description["max_depth"]
    next_slot = next_triangle = 0
    for visit in walk(tree):
        count = visit.end - visit.begin
        if visit.slot is not None:
            if visit.slot != next_slot:
                yield f"box {visit.slot} stands where {next_slot} should"
            next_slot += 1
            too_deep = max_depth is not None and visit.depth >= max_depth
            if visit.is_leaf != (count <= leaf_size or too_deep):
                yield f"box {visit.slot} of {count} triangles at depth {visit.depth} splits wrongly"
        if visit.is_leaf:
            if visit.begin != next_triangle:
                yield f"leaf begins at {visit.begin}, not {next_triangle}"
            next_triangle = visit.end
    if (next_slot, next_triangle) != (len(tree.nodes), len(tree.corners)):
        yield f"{next_slot} boxes and {next_triangle} triangles are reached"


def _containment_faults(tree: TreeFile) -> Iterator[str]:
    points, unit = _on_grid(tree)
    names = {point: index for index, point in enumerate(dict.fromkeys(points))}
    distinct = list(names)
    corners = np.array([names[point] for point in points])[tree.corners]
    for visit in walk(tree):
        if visit.slot is not None:
            used = np.unique(corners[visit.begin : visit.end]).tolist()
            if not contains(tree.nodes[visit.slot], (distinct[i] for i in used), unit):
                yield f"box {visit.slot} does not hold triangles {visit.begin} to {visit.end}"


def contains(node: Any, points: Iterable[Vector], unit: int) -> bool:
    """Return whether the box of a node holds points, integers in units of 2**-unit, exactly.

    The coordinates along the literal axes solve a 3x3 system; Cramer's rule keeps them integral.
    """
    flat = [x for row in axes_of(node["rotation"]) for x in row]
    axes_unit = max(_denominator_bits(x) for x in flat)
    scaled = [_integer(x, axes_unit) for x in flat]
    a, b, c = ((*scaled[i : i + 3],) for i in (0, 3, 6))
    normals = cross(b, c), cross(c, a), cross(a, b)
    determinant = abs(dot(a, normals[0]))
    center = tuple(_integer(float(x), unit) for x in node["center"])
    limits = [determinant * _integer(float(h), unit) for h in node["half_extents"]]
    return all(
        abs(dot(normal, subtract(point, center))) << axes_unit <= limit  # type: ignore[arg-type]
        for point in points
        for normal, limit in zip(normals, limits, strict=True)
    )


def _on_grid(tree: TreeFile) -> tuple[list[Vector], int]:
    """Return the vertices in the tree's unit as integers times 2**-unit, a grid for boxes too."""
    flat = tree.vertices.ravel().tolist()
    centers = tree.nodes["center"].ravel().tolist()
    finest = max((_denominator_bits(x) for x in flat), default=0) + max(tree.scale_exponent, 0)
    unit = max([149, finest, *map(_denominator_bits, centers)])
    # A vertex x in mesh units is x 2**-exponent in the tree's.
    integers = [_integer(x, unit - tree.scale_exponent) for x in flat]
    return list(zip(integers[0::3], integers[1::3], integers[2::3], strict=True)), unit


def _denominator_bits(value: float) -> int:
    return value.as_integer_ratio()[1].bit_length() - 1


def _integer(value: float, unit: int) -> int:
    """Return value times 2**unit, which must be whole."""
    top, bottom = value.as_integer_ratio()
    shift = unit - (bottom.bit_length() - 1)
    whole = top << shift if shift >= 0 else top >> -shift
    assert shift >= 0 or whole << -shift == top
    return whole


def _padded(count: int) -> int:
    return -(-count // 64) * 64
