"""Large files of every format, of one mesh whose faces may be triangles and quadrilaterals."""

from __future__ import annotations

import zipfile
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray


class Faces(NamedTuple):
    """Holds a mesh: vertices (V, 3), and faces of three or four corners in their order."""

    vertices: NDArray[np.float64]
    faces: list[list[int]]


def faces_of(count: int, *, with_quads: bool) -> Faces:
    """Return a rough floor of about `count` triangles; every tenth cell is one quadrilateral.

    Coordinates are those that 32 bits hold, and their decimals are short.
    """
    side = round((count / 2) ** 0.5)
    heights = np.random.default_rng(7).integers(0, 64, (side + 1, side + 1)) / 64
    y, x = np.mgrid[0 : side + 1, 0 : side + 1] / 8
    vertices = np.stack([x, y, heights], axis=2).reshape(-1, 3)
    faces = []
    for k, a in enumerate(a for a in range(side * (side + 1)) if a % (side + 1) < side):
        b, c, d = a + 1, a + side + 2, a + side + 1
        faces += [[a, b, c, d]] if with_quads and k % 10 == 9 else [[a, b, c], [a, c, d]]
    if with_quads:  # those are cut as they lie: flat ones are convex
        flat = vertices[:, 2]
        for face in faces:
            if len(face) == 4:
                flat[face] = 0.5
    return Faces(vertices, faces)


def triangles_of(mesh: Faces) -> NDArray[np.float64]:
    """Return the corners (F, 3, 3) of a mesh's triangles; quadrilaterals are fans."""
    cut = [(f[0], f[k], f[k + 1]) for f in mesh.faces for k in range(1, len(f) - 1)]
    return mesh.vertices[np.array(cut)]


def _rows(prefix: str, rows: list[list[float]] | list[list[int]], first: int = 0) -> Iterator[str]:
    """Yield lines of numbers; whole ones count from `first`."""
    for row in rows:
        yield prefix + " ".join(repr(x + first) for x in row)


def _text(folder: Path, name: str, *lines: Iterator[str]) -> Path:
    path = folder / name
    path.write_text("\n".join(chain(*lines)) + "\n")
    return path


def _stl(folder: Path, mesh: Faces) -> Path:
    from bench_wall import write_stl

    write_stl(str(folder / "a.stl"), triangles_of(mesh))
    return folder / "a.stl"


def _ascii_stl(folder: Path, mesh: Faces) -> Path:
    def facets() -> Iterator[str]:
        for corners in triangles_of(mesh).tolist():
            yield "facet normal 0 0 1\nouter loop"
            yield from _rows("vertex ", corners)
            yield "endloop\nendfacet"

    return _text(folder, "a.stl", iter(["solid a"]), facets(), iter(["endsolid a"]))


def _obj(folder: Path, mesh: Faces) -> Path:
    return _text(
        folder, "a.obj", _rows("v ", mesh.vertices.tolist()), _rows("f ", mesh.faces, first=1)
    )


def _off(folder: Path, mesh: Faces) -> Path:
    head = iter(["OFF", f"{len(mesh.vertices)} {len(mesh.faces)} 0"])
    faces = [[len(face), *face] for face in mesh.faces]
    return _text(folder, "a.off", head, _rows("", mesh.vertices.tolist()), _rows("", faces))


def _ply_head(mesh: Faces, encoding: str) -> list[str]:
    return [
        f"ply\nformat {encoding} 1.0\nelement vertex {len(mesh.vertices)}",
        *(f"property double {axis}" for axis in "xyz"),
        f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\nend_header",
    ]


def _ascii_ply(folder: Path, mesh: Faces) -> Path:
    faces = [[len(face), *face] for face in mesh.faces]
    head = iter(_ply_head(mesh, "ascii"))
    return _text(folder, "a.ply", head, _rows("", mesh.vertices.tolist()), _rows("", faces))


def _ply(folder: Path, mesh: Faces) -> Path:
    parts = ["\n".join(_ply_head(mesh, "binary_little_endian")).encode() + b"\n"]
    parts.append(mesh.vertices.astype("<f8").tobytes())
    parts += [bytes([len(face)]) + np.array(face, "<i4").tobytes() for face in mesh.faces]
    (folder / "a.ply").write_bytes(b"".join(parts))
    return folder / "a.ply"


def _glb(folder: Path, mesh: Faces) -> Path:
    import trimesh

    whole = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    whole.export(folder / "a.glb", include_normals=False)
    return folder / "a.glb"


def _threemf(folder: Path, mesh: Faces) -> Path:
    from mesh_files.threemf_files import archive, model
    from mesh_files.threemf_files import mesh as object_of

    vertices = "\n".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in mesh.vertices.tolist())
    rows = "\n".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in mesh.faces)
    content = f"<mesh><vertices>{vertices}</vertices><triangles>{rows}</triangles></mesh>"
    data = archive(model(object_of(content=content)), zipfile.ZIP_DEFLATED)
    (folder / "a.3mf").write_bytes(data)
    return folder / "a.3mf"


COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries>
<geometry id="g"><mesh><source id="s"><float_array id="a" count="{n}">{numbers}</float_array>
<technique_common><accessor source="#a" count="{v}" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="p"><input semantic="POSITION" source="#s"/></vertices><triangles count="{f}">
<input semantic="VERTEX" source="#p" offset="0"/><p>{corners}</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="w"><node id="o">
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>"""


def _collada(folder: Path, mesh: Faces) -> Path:
    numbers = " ".join(_rows("", mesh.vertices.tolist()))
    corners = " ".join(_rows("", mesh.faces))
    v, f = len(mesh.vertices), len(mesh.faces)
    path = folder / "a.dae"
    path.write_text(COLLADA.format(n=3 * v, numbers=numbers, v=v, f=f, corners=corners))
    return path


def _su2(folder: Path, mesh: Faces) -> Path:
    faces = [[5, *face] for face in mesh.faces]
    head = iter([f"NDIME= 3\nNELEM= {len(faces)}"])
    points = iter([f"NPOIN= {len(mesh.vertices)}"])
    rows = _rows("", mesh.vertices.tolist())
    return _text(folder, "a.su2", head, _rows("", faces), points, rows, iter(["NMARK= 0"]))


def _by_meshio(suffix: str, kind: str) -> Callable[[Path, Faces], Path]:
    def write(folder: Path, mesh: Faces) -> Path:
        import meshio

        path = folder / f"a{suffix}"
        cells = [("triangle", np.array(mesh.faces))]
        meshio.Mesh(mesh.vertices, cells).write(path, file_format=kind)
        return path

    return write


class File(NamedTuple):
    """Tells how a file of a format is written, and whether it may hold quadrilaterals."""

    write: Callable[[Path, Faces], Path]
    has_quads: bool = False


FILES = {
    "STL binary": File(_stl),
    "STL ASCII": File(_ascii_stl),
    "OBJ": File(_obj),
    "OBJ, quads": File(_obj, has_quads=True),
    "PLY binary": File(_ply),
    "PLY binary, quads": File(_ply, has_quads=True),
    "PLY ASCII": File(_ascii_ply),
    "PLY ASCII, quads": File(_ascii_ply, has_quads=True),
    "OFF": File(_off),
    "OFF, quads": File(_off, has_quads=True),
    "GLB": File(_glb),
    "3MF": File(_threemf),
    "COLLADA": File(_collada),
    "Gmsh": File(_by_meshio(".msh", "gmsh")),
    "Medit": File(_by_meshio(".mesh", "medit")),
    "Abaqus": File(_by_meshio(".inp", "abaqus")),
    "Nastran": File(_by_meshio(".bdf", "nastran")),
    "SU2": File(_su2),
    "UCD": File(_by_meshio(".avs", "avsucd")),
}
