"""Writes surfaces as mesh files, one function a format, byte for byte the same everywhere."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from surfaces import GRID_DECIMALS, Points, Surface, triangulated

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

GLTF_FLOAT, GLTF_UNSIGNED_SHORT = 5126, 5123
GLTF_ARRAY_BUFFER, GLTF_ELEMENT_ARRAY_BUFFER = 34962, 34963
VTK_HEXAHEDRON = 12


@dataclass(frozen=True)
class Node:
    """One glTF node: a mesh by its index, moved and turned (quaternion x, y, z, w)."""

    name: str
    mesh: int
    translation: tuple[float, float, float]
    rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)


def _number(value: float) -> str:
    text = f"{value:.{GRID_DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _row(values: Points) -> str:
    return " ".join(_number(value) for value in values.tolist())


def _write_lines(path: Path, lines: Sequence[str]) -> None:
    path.write_bytes(("\n".join(lines) + "\n").encode("ascii"))


def _corners_and_normals(surface: Surface) -> tuple[Points, Points]:
    corners = surface.points[triangulated(surface)]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    x, y, z = cross.T
    return corners, cross / np.sqrt(x * x + y * y + z * z)[:, None]


def write_stl_binary(path: Path, surface: Surface, title: str) -> None:
    """Write triangles as binary STL (float32)."""
    corners, normals = _corners_and_normals(surface)
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records = np.zeros(len(corners), record)
    records["normal"], records["corners"] = normals, corners
    header = title.encode("ascii").ljust(80) + struct.pack("<I", len(records))
    path.write_bytes(header + records.tobytes())


def write_stl_ascii(path: Path, surface: Surface, name: str) -> None:
    """Write triangles as ASCII STL."""
    lines = [f"solid {name}"]
    for corners, normal in zip(*_corners_and_normals(surface), strict=True):
        lines += [f" facet normal {_row(normal)}", "  outer loop"]
        lines += [f"   vertex {_row(corner)}" for corner in corners]
        lines += ["  endloop", " endfacet"]
    _write_lines(path, [*lines, f"endsolid {name}"])


def write_obj(path: Path, objects: dict[str, Surface], title: str) -> None:
    """Write named objects as OBJ, polygons kept."""
    lines = [f"# {title}"]
    first = 1
    for name, surface in objects.items():
        lines += [f"o {name}", *(f"v {_row(point)}" for point in surface.points)]
        for face in surface.faces:
            lines.append("f " + " ".join(str(first + corner) for corner in face))
        first += len(surface.points)
    _write_lines(path, lines)


def write_off(path: Path, surface: Surface) -> None:
    """Write polygons as OFF."""
    lines = ["OFF", f"{len(surface.points)} {len(surface.faces)} 0"]
    lines += [_row(point) for point in surface.points]
    lines += [" ".join(map(str, (len(face), *face))) for face in surface.faces]
    _write_lines(path, lines)


def _ply_header(surface: Surface, kind: str, scalar: str, title: str) -> list[str]:
    axes = [f"property {scalar} {axis}" for axis in "xyz"]
    return [
        *("ply", f"format {kind} 1.0", f"comment {title}"),
        *(f"element vertex {len(surface.points)}", *axes),
        *(f"element face {len(surface.faces)}", "property list uchar int vertex_indices"),
        "end_header",
    ]


def write_ply_ascii(path: Path, surface: Surface, title: str) -> None:
    """Write polygons as ASCII PLY with double coordinates."""
    lines = _ply_header(surface, "ascii", "double", title)
    lines += [_row(point) for point in surface.points]
    lines += [" ".join(map(str, (len(face), *face))) for face in surface.faces]
    _write_lines(path, lines)


def write_ply_binary(path: Path, surface: Surface, title: str, *, big_endian: bool = False) -> None:
    """Write triangles as binary PLY (float32) of either byte order."""
    order, kind = (">", "binary_big_endian") if big_endian else ("<", "binary_little_endian")
    triangles = triangulated(surface)
    flat = Surface(surface.points, [tuple(row) for row in triangles.tolist()])
    header = "\n".join(_ply_header(flat, kind, "float", title)) + "\n"
    record = np.zeros(len(triangles), np.dtype([("count", "u1"), ("corners", f"{order}i4", 3)]))
    record["count"], record["corners"] = 3, triangles
    points = surface.points.astype(f"{order}f4")
    path.write_bytes(header.encode("ascii") + points.tobytes() + record.tobytes())


def write_vtk_hexahedra(
    path: Path, points: Points, cells: Sequence[Sequence[int]], title: str
) -> None:
    """Write volume cells of eight corners each as a legacy ASCII VTK file."""
    lines = ["# vtk DataFile Version 2.0", title, "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(points)} double", *(_row(point) for point in points)]
    lines += [f"CELLS {len(cells)} {9 * len(cells)}"]
    lines += [" ".join(map(str, (8, *cell))) for cell in cells]
    lines += [f"CELL_TYPES {len(cells)}", *[str(VTK_HEXAHEDRON)] * len(cells)]
    _write_lines(path, lines)


def write_glb(path: Path, meshes: dict[str, Surface], nodes: Sequence[Node]) -> None:
    """Write named meshes and the nodes that place them as binary glTF (float32)."""
    views: list[dict[str, int]] = []
    accessors: list[dict[str, object]] = []
    payload = b""
    for surface in meshes.values():
        points = surface.points.astype("<f4")
        corners = triangulated(surface).astype("<u2").ravel()
        bounds = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
        for values, target, kind, shape, extra in (
            (points, GLTF_ARRAY_BUFFER, GLTF_FLOAT, "VEC3", bounds),
            (corners, GLTF_ELEMENT_ARRAY_BUFFER, GLTF_UNSIGNED_SHORT, "SCALAR", {}),
        ):
            view = {"buffer": 0, "byteOffset": len(payload), "byteLength": values.nbytes}
            accessor = {"bufferView": len(views), "componentType": kind, "count": len(values)}
            views.append({**view, "target": target})
            accessors.append({**accessor, "type": shape, **extra})
            payload += values.tobytes() + b"\0" * (-values.nbytes % 4)
    primitives = [
        {"attributes": {"POSITION": 2 * i}, "indices": 2 * i + 1} for i in range(len(meshes))
    ]
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": [vars(node) for node in nodes],
        "meshes": [
            {"name": name, "primitives": [primitive]}
            for name, primitive in zip(meshes, primitives, strict=True)
        ],
        "buffers": [{"byteLength": len(payload)}],
        "bufferViews": views,
        "accessors": accessors,
    }
    text = json.dumps(document, separators=(",", ":")).encode("ascii")
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(payload), b"BIN\0") + payload
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
