"""Mesh files of every format: a sound mesh, or one MeshError."""

from __future__ import annotations

import base64
import json
import tempfile
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from fuzz.kinds import Target, require
from mesh_files.cell_files import HEXAHEDRON, POINTS, SURFACE_KINDS, TETRA, VOLUME_KINDS, write
from mesh_files.collada_files import COLLADA_SEEDS
from mesh_files.deck_files import DECKS
from mesh_files.gltf_documents import (
    draco_square,
    instanced,
    meshopt_square,
    morphing,
    skinned,
    with_fallback,
)
from mesh_files.gltf_files import DOCUMENT, INDICES, POSITIONS, document, glb
from mesh_files.nastran_decks import SEEDS
from mesh_files.plain_files import FILES
from mesh_files.step_files import STEP_SEEDS
from mesh_files.threemf_files import ASSEMBLY, THREEMF_SEEDS, archive

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes
from obbcli.mesh.formats.nastran.reader import read_nastran
from obbcli.mesh.source import Source, read_source

VTK_TEXT = b"""# vtk DataFile Version 3.0
strips and polygons
ASCII
DATASET POLYDATA
POINTS 5 float
0 0 0 1 0 0 0 1 0 1 1 0 0 0 1
POLYGONS 2 9
4 0 1 3 2
3 0 1 4
TRIANGLE_STRIPS 1 5
4 0 1 2 3
POINT_DATA 5
"""
SUFFIXES = {
    "stl": (".stl",),
    "obj": (".obj",),
    "ply": (".ply",),
    "off": (".off",),
    "gltf": (".glb", ".gltf"),
    "threemf": (".3mf",),
    "collada": (".dae",),
    "step": (".step",),
    "vtk": (".vtk",),
    "vtkxml": (".vtu", ".vtp", ".vti", ".vts", ".vtr", ".vtm"),
    "gmsh": (".msh",),
    "abaqus": (".inp",),
    "nastran": (".bdf", ".fem", ".nas"),
    "medit": (".mesh", ".meshb"),
    "tecplot": (".dat", ".tec"),
    "su2": (".su2",),
    "ucd": (".avs",),
    "others": (".vol", ".f3grid", ".xml"),
}
#: Formats whose readers start a process for each file.
_COSTS = {"step": 20}


def _seeds(suffixes: tuple[str, ...]) -> list[bytes]:
    """Return files of these formats, each after a byte that says which suffix it is for."""
    files = [*FILES.values(), *DECKS]
    body = POSITIONS + INDICES
    uri = "data:;base64," + base64.b64encode(body).decode()
    inline = document(buffers=[{"byteLength": len(body), "uri": uri}])
    files += [(".glb", glb(DOCUMENT)), (".gltf", json.dumps(inline).encode())]
    files += [(".glb", data) for data in _documents()]
    files += [(".3mf", data) for data in (*THREEMF_SEEDS, ASSEMBLY.encode())]
    files += [(".dae", data) for data in COLLADA_SEEDS]
    files += [(".step", data) for data in STEP_SEEDS]
    files += _odd_files()
    files += _vtk_files()
    files += [(".bdf", deck.encode("ascii")) for deck in SEEDS]
    surface = [("triangle", np.array([[0, 1, 2], [0, 2, 3]]))]
    volumes = [("tetra", TETRA)], [("hexahedron", HEXAHEDRON)]
    with tempfile.TemporaryDirectory() as folder:
        for kinds, choices in ((SURFACE_KINDS, (surface,)), (VOLUME_KINDS, volumes)):
            for name, options in kinds:
                suffix = Path(name).suffix
                for cells in choices if suffix in suffixes else ():
                    if suffix == ".xml" and cells[0][0] == "hexahedron":
                        continue  # which DOLFIN does not know
                    path = write(Path(folder) / name, cells, POINTS, **options)
                    files.append((suffix, path.read_bytes()))
    return [bytes([suffixes.index(suffix)]) + data for suffix, data in files if suffix in suffixes]


def _documents() -> list[bytes]:
    """Return GLB files with morph targets, skins, instances and compressed geometry."""
    plain = [morphing([1, 0.5]), skinned(sets=2), instanced(TRANSLATION=[[0, 0, 1], [0, 0, 2]])]
    packed = []
    if find_spec("DracoPy"):
        plain += [draco_square(), draco_square(normalized=True)]
    if find_spec("meshopt"):
        packed.append(with_fallback(meshopt_square()))
    return [*(each.glb() for each in plain), *packed]


def _vtk_files() -> list[tuple[str, bytes]]:
    """Return VTK files of every kind of data set, as text, binary and packed."""
    files = [(".vtk", VTK_TEXT), (".vtm", b'<VTKFile type="vtkMultiBlockDataSet" version="1.0">'
              b'<vtkMultiBlockDataSet><DataSet index="0" file="a.vtu"/></vtkMultiBlockDataSet>'
              b"</VTKFile>")]  # fmt: skip
    if not find_spec("vtkmodules"):
        return files
    from mesh_files import vtk_files

    with tempfile.TemporaryDirectory() as folder:
        for make in vtk_files.DATA_SETS.values():
            for binary, version in ((False, 42), (True, 42), (False, 51), (True, 51)):
                path = vtk_files.write_legacy(Path(folder) / "a.vtk", make(), binary, version)
                files.append((".vtk", path.read_bytes()))
            for mode, packed in (("ascii", "none"), ("binary", "zlib"), ("appended raw", "none")):
                path = vtk_files.write_xml(Path(folder), make(), mode, packed)
                files.append((path.suffix, path.read_bytes()))
    return files


def _odd_files() -> list[tuple[str, bytes]]:
    """Return text files as exporters write them, and what stands in place of files."""
    points = b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    facet = b"facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    ply = b"ply\nformat ascii 1.0\nelement vertex 4\n"
    ply += b"".join(b"property float %c\n" % axis for axis in b"xyz")
    ply += b"element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    obj = points.replace(b"0 0 0", b"v 0 0 0").replace(b"\n", b"\nv ", 3)
    return [
        (".stl", b"# x\nsolid a\ncolor 1 0 0\n" + facet + b"end facet\nend solid a\n"),
        (".obj", b"4 4\n$ a cow\n" + obj + b"f 1//1 -1 \\\n2 # x\nlayer 3\nnewmtl a\nKd 1 1 1\n"),
        (
            ".off",
            b"STCN4OFF 4 2 6\n"
            + points.replace(b"\n", b" 1 0 0 1 1 0 0 1 5 5 ")
            + b"3 0 1 2\n2 0 1\n",
        ),
        (".off", b"nOFF 3 OFF4 4 6\n" + points + b"4 0 1 2 3 1 1 1\n"),
        (".off", b"OFF4 2 6\n" + points + b"3 0 1 2\n1 3\n"),
        (".ply", ply + points + b"9 0 1 2 3 -1 0 3 1 -1\n"),
        (".stl", b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n"),
        (".obj", "\ufeffv 0 0 0\nf 1 1 1\n".encode("utf-16-le")),
    ]


def _run(suffixes: tuple[str, ...], data: bytes) -> None:
    suffix = suffixes[data[0] % len(suffixes) if data else 0]
    if suffix == ".3mf" and not data[1:].startswith(b"PK"):
        # A model on its own: changes to a packed one end at its checksum.
        data = data[:1] + archive(data[1:])
    try:
        mesh = load_mesh_bytes(data[1:], suffix)
    except MeshError:
        mesh = None
    if mesh is not None:
        require(np.isfinite(mesh.vertices).all(), "coordinates are finite")
        require(len(mesh.triangles) > 0, "a mesh has triangles")
        require(
            mesh.triangles.min() >= 0 and mesh.triangles.max() < len(mesh.vertices),
            "triangles use vertices that are there",
        )
    if suffix == ".stl":
        _run_from_a_file(data[1:], None if mesh is None else mesh.vertices)
    if suffix == ".bdf":
        _run_included(data[1:])


def _run_from_a_file(data: bytes, vertices: object) -> None:
    """Compare what another reader makes of a file whose digest nobody asks for."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.stl"
        path.write_bytes(data)
        try:
            found = load_mesh(path, hashed=False).vertices
        except MeshError:
            found = None
    require(
        found is vertices is None or np.array_equal(np.asarray(found), np.asarray(vertices)),
        "both readers say the same",
    )


def _run_included(data: bytes) -> None:
    """Compare a deck with one that does nothing but include it."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "part.inc").write_bytes(data)
        (Path(folder) / "main.bdf").write_text("$ all of it\nINCLUDE 'part.inc'\n$ no more\n")
        plain = _deck(Source("part.inc", "part.inc", data))
        included = _deck(read_source(Path(folder) / "main.bdf"))
    require(plain == included, "an included deck is the deck")


def _deck(source: Source) -> tuple[object, ...] | None:
    """Return what a deck holds; None where it is refused."""
    try:
        vertices, triangles = read_nastran(source)
    except MeshError:
        return None
    return vertices.tolist(), triangles.tolist(), source.notes


TARGETS = {
    name: Target(partial(_seeds, suffixes), partial(_run, suffixes), _COSTS.get(name, 1))
    for name, suffixes in SUFFIXES.items()
}
