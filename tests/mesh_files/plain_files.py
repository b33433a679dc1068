"""One small surface in each format that our own readers of plain files take."""

from __future__ import annotations

import struct

import numpy as np

POINTS = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]]
FACES = [[0, 1, 2], [0, 2, 3], [3, 1, 0]]


def binary_stl():
    facets = b"".join(
        struct.pack("<12fH", 0, 0, 1, *np.ravel([POINTS[i] for i in face]), 0) for face in FACES
    )
    return b"solid".ljust(80) + struct.pack("<I", len(FACES)) + facets


def ascii_stl():
    lines = ["solid part"]
    for face in FACES:
        lines += ["facet normal 0 0 1", "outer loop"]
        lines += [f"vertex {x} {y} {z}" for x, y, z in (POINTS[i] for i in face)]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid part\n"]).encode()


def obj():
    lines = [f"v {x} {y} {z}" for x, y, z in POINTS]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in FACES]
    return "\n".join([*lines, ""]).encode()


def off():
    lines = ["OFF", f"{len(POINTS)} {len(FACES)} 0"]
    lines += [f"{x} {y} {z}" for x, y, z in POINTS]
    lines += ["3 " + " ".join(map(str, face)) for face in FACES]
    return "\n".join([*lines, ""]).encode()


def ply(kind):
    head = (
        f"ply\nformat {kind} 1.0\nelement vertex {len(POINTS)}\nproperty double x\n"
        f"property double y\nproperty double z\nelement face {len(FACES)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    ).encode()
    if kind == "ascii":
        rows = [" ".join(map(str, row)) for row in POINTS]
        rows += ["3 " + " ".join(map(str, face)) for face in FACES]
        return head + "\n".join([*rows, ""]).encode()
    order = "<" if "little" in kind else ">"
    body = b"".join(struct.pack(order + "3d", *row) for row in POINTS)
    return head + body + b"".join(struct.pack(order + "B3i", 3, *face) for face in FACES)


FILES = {
    "binary STL": (".stl", binary_stl()),
    "ASCII STL": (".stl", ascii_stl()),
    "OBJ": (".obj", obj()),
    "OFF": (".off", off()),
    "ASCII PLY": (".ply", ply("ascii")),
    "little-endian PLY": (".ply", ply("binary_little_endian")),
    "big-endian PLY": (".ply", ply("binary_big_endian")),
}
