"""Files as gzip packs them, for tests of what reads them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesh_files.cube_files import cube, obj

if TYPE_CHECKING:
    from pathlib import Path

    from obbcli import Mesh

OBJ = obj(cube()).encode()
OFF = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
SOLID = (
    b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    b"endloop\nendfacet\nendsolid x\n"
)


def placed(folder: Path, name: str, data: bytes) -> Path:
    """Return the path of a new file."""
    path = folder / name
    path.write_bytes(data)
    return path


def same(mesh: Mesh, plain: Mesh) -> bool:
    """Return whether two meshes have the same bits."""
    return (
        mesh.vertices.tobytes() == plain.vertices.tobytes()
        and mesh.triangles.tobytes() == plain.triangles.tobytes()
    )
