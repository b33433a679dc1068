"""Parts of mesh files: placed and joined they are the file, whatever its bytes."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from fuzz.kinds import Target, require
from mesh_files.part_files import WRITERS

from obbcli import Assembly, Mesh, load_mesh, load_parts
from obbcli.errors import MeshError
from obbcli.mesh.parts.pattern import escaped

#: Of VTK several files are one seed, and its index alone reads none.
SUFFIXES = (".glb", ".3mf", ".dae", ".obj", ".stl", ".inp", ".dat", ".su2", ".bdf")
CUBES = [("arm", (0.0, 0.0, 0.0)), ("arm", (0.25, 3.0, 0.5)), ("a/b#*[", (-7.0, 0.1, 0.0))]
TURNED = """*PART, NAME=p\n*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT, TYPE=C3D4
1,1,2,3,4\n*END PART\n*INSTANCE, NAME=a, PART=p\n1,2,3\n0,0,0,0,0,1,30\n*END INSTANCE
*INSTANCE, NAME=b, PART=p\n*NODE\n5,3,3,3\n*ELEMENT, TYPE=S3\n9,1,2,5\n*END INSTANCE
*ELEMENT, TYPE=B31\n1,1,2\n"""
SUPER = """CEND\nBEGIN SUPER=1\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.
GRID,4,,0.,0.,1.\nCTETRA,1,1,1,2,3,4\nCTRIA3,2,1,1,2,4\nBEGIN BULK\nGRID,1,,5.,0.,0.
GRID,2,,6.,0.,0.\nGRID,3,,5.,1.,0.\nCTRIA3,1,1,1,2,3\nENDDATA\n"""


def _seeds() -> list[bytes]:
    """Return files of named cubes in every format, each after a byte that says which it is."""
    files = [(".inp", TURNED.encode()), (".bdf", SUPER.encode())]
    with tempfile.TemporaryDirectory() as folder:
        for kind, write in WRITERS.items():
            path = write(Path(folder), CUBES)
            if kind != "VTK":
                files.append((path.suffix, path.read_bytes()))
    return [bytes([SUFFIXES.index(suffix)]) + data for suffix, data in files]


def _run(data: bytes) -> None:
    suffix = SUFFIXES[data[0] % len(SUFFIXES) if data else 0]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"a{suffix}"
        path.write_bytes(data[1:])
        try:
            whole: Mesh | None = load_mesh(path)
        except MeshError:
            whole = None
        try:
            parts: Assembly | None = load_parts(path)
        except MeshError:
            parts = None
        require(whole is None or parts is not None, "a file that is read has parts")
        if parts is None:
            return
        placed, is_damaged = _placed(parts)
        require(whole is not None or is_damaged, "a file is refused for what a part is refused for")
        if whole is None:
            return
        require(not is_damaged, "parts of a file that is read are read")
        corners = whole.vertices[whole.triangles] + 0.0
        require(placed.tobytes() == corners.tobytes(), "parts, placed and joined, are the file")
        _run_selection(path, parts)


def _placed(parts: Assembly) -> tuple[np.ndarray, bool]:
    """Return the corners of all parts, and whether one of them is refused."""
    found = [np.zeros((0, 3, 3))]
    for part in parts:
        try:
            found.append(part.vertices()[part.mesh.triangles] + 0.0)
        except MeshError as fault:
            # Elements that later ones take the place of are seen when they are read.
            if "has no faces" not in str(fault):
                return np.zeros((0, 3, 3)), True
    return np.concatenate(found), False


def _run_selection(path: Path, parts: Assembly) -> None:
    """Take the last part by its path, and hold it against the same part of all."""
    last = parts.parts[-1]
    try:
        found = load_mesh(f"{path}#{escaped(last.path)}")
    except MeshError as fault:
        require("has no faces" in str(fault), "a part is selected by its path")
        return
    own = [rows for rows in found.parts if rows.path == last.path]
    require(len(own) == 1, "a path is that of one part")
    first, count = own[0].first_triangle, own[0].triangle_count
    corners = found.vertices[found.triangles[first : first + count]] + 0.0
    placed = last.vertices()[last.mesh.triangles] + 0.0
    require(placed.tobytes() == corners.tobytes(), "a selection is the part where it stands")


TARGETS = {"parts": Target(_seeds, _run)}
