"""Small meshes of finite elements, written by meshio."""

from __future__ import annotations

import contextlib
import io

import meshio
import numpy as np

#: A unit cube of 8 corners, then its apex for a pyramid on top.
CUBE = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    dtype=float,
)
POINTS = np.vstack([CUBE, [[0.5, 0.5, 2.0]]])
TETRA = np.array([[0, 1, 2, 5], [0, 2, 3, 7]])
HEXAHEDRON = np.arange(8).reshape(1, 8)

#: Names of files with the options to write them: of those that hold surfaces, and of all.
SURFACE_KINDS = [
    ("a.vtk", {}),
    ("a.vtk", {"binary": False}),
    ("a.vtk", {"file_format": "vtk42"}),
    ("a.vtu", {}),
    ("a.vtu", {"binary": False}),
    ("a.msh", {"file_format": "gmsh"}),
    ("a.msh", {"file_format": "gmsh", "binary": False}),
    ("a.msh", {"file_format": "gmsh22"}),
    ("a.inp", {}),
    ("a.avs", {}),
    ("a.mesh", {}),
    ("a.meshb", {}),
    ("a.vol", {}),
    ("a.dat", {}),
    ("a.tec", {}),
    ("a.xml", {}),
]
VOLUME_KINDS = [*SURFACE_KINDS, *((f"a.{s}", {}) for s in ("bdf", "fem", "nas", "su2", "f3grid"))]


def write(path, cells, points=POINTS, **options):
    with contextlib.redirect_stderr(io.StringIO()):
        meshio.Mesh(points, cells).write(path, **options)
    return path
