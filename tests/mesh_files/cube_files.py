"""Unit cubes as OBJ and binary STL files: small meshes whose every answer is plain."""

from __future__ import annotations

import hashlib
import struct
from itertools import product
from typing import TYPE_CHECKING

from oracles.still import triangles_intersect

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

# The six sides of the unit cube, two triangles each, by corner numbers with bits x, y, z.
CUBE_SIDES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
CUBE_FACES = [(a, b, c) for a, b, c, _ in CUBE_SIDES] + [(a, c, d) for a, _, c, d in CUBE_SIDES]


def cube(shift: Sequence[float] = (0, 0, 0)) -> list[tuple[float, ...]]:
    """Return the corners of the unit cube, shifted."""
    corners = [(x, y, z) for z, y, x in product((0.0, 1.0), repeat=3)]
    return [tuple(p + s for p, s in zip(corner, shift, strict=True)) for corner in corners]


def all_pairs(shift: tuple[float, float, float]) -> list[list[int]]:
    """Return the pairs of triangles of two cubes that meet, by exact arithmetic."""
    a, b = cube(), cube(shift)
    corners_a = [[a[i] for i in face] for face in CUBE_FACES]
    corners_b = [[b[i] for i in face] for face in CUBE_FACES]
    pairs = product(enumerate(corners_a), enumerate(corners_b))
    return [[i, j] for (i, p), (j, q) in pairs if triangles_intersect(p, q)]


def obj(corners: Sequence[Sequence[float]]) -> str:
    """Return a cube as an OBJ file."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in corners]
    return "\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in CUBE_FACES]) + "\n"


def objects(**shifts: float) -> str:
    """Return an OBJ file of unit cubes by name, each shifted along x."""
    lines = []
    for count, (name, x) in enumerate(shifts.items()):
        lines.append(f"o {name}")
        for line in obj(cube((x, 0, 0))).splitlines():
            letter, *numbers = line.split()
            if letter == "f":
                numbers = [str(int(number) + 8 * count) for number in numbers]
            lines.append(" ".join([letter, *numbers]))
    return "\n".join(lines) + "\n"


def as_input(path: Path) -> dict[str, object]:
    """Return what documents say of a cube's file that was named from its folder."""
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return {"path": path.name, "sha256": digest, "triangle_count": 12, "notes": []}


def stl(corners: Sequence[Sequence[float]]) -> bytes:
    """Return a cube as a binary STL file."""
    records = [
        struct.pack("<12fH", 0, 0, 0, *(x for i in face for x in corners[i]), 0)
        for face in CUBE_FACES
    ]
    return bytes(80) + struct.pack("<I", len(records)) + b"".join(records)
