"""The readers of mesh files, a format each, and the table of formats by suffix."""

from __future__ import annotations

from typing import NamedTuple


class Format(NamedTuple):
    """Holds a format's name and reader.

    Args:
        name: as people call it.
        module: of this package, imported when first needed, or `cells` for meshio's formats.
        kind: meshio's module of the format; None where the reader is ours.
        parts: the module whose `parts_NAME`, NAME being `module`, lists parts; None where the
            format knows none.
    """

    name: str
    module: str
    kind: str | None = None
    parts: str | None = None


_STL = Format("STL", "stl", parts="stl_parts")
_OBJ = Format("OBJ", "obj", parts="obj_parts")
_PLY = Format("PLY", "ply")
_OFF = Format("OFF", "off")
_GLTF = Format("glTF", "gltf", parts="gltf")
_VTK = Format("VTK", "vtk", parts="vtk_parts")
_GMSH = Format("Gmsh", "gmsh")
_NASTRAN = Format("Nastran, OptiStruct", "nastran")
_MEDIT = Format("Medit", "medit")
_TECPLOT = Format("Tecplot", "tecplot")

#: The one table of suffixes. Those of our own readers first, then what goes through meshio.
FORMATS = {
    ".stl": _STL,
    ".obj": _OBJ,
    ".ply": _PLY,
    ".off": _OFF,
    ".glb": _GLTF,
    ".gltf": _GLTF,
    ".vtk": _VTK,
    ".vtu": _VTK,
    ".vtp": _VTK,
    ".vti": _VTK,
    ".vts": _VTK,
    ".vtr": _VTK,
    ".vtm": _VTK,
    ".msh": _GMSH,
    ".inp": Format("Abaqus, CalculiX, AVS UCD", "inp"),
    ".avs": Format("AVS UCD", "ucd"),
    ".bdf": _NASTRAN,
    ".fem": _NASTRAN,
    ".nas": _NASTRAN,
    ".mesh": _MEDIT,
    ".meshb": _MEDIT,
    ".vol": Format("Netgen", "cells", "netgen"),
    ".su2": Format("SU2", "su2"),
    ".dat": _TECPLOT,
    ".tec": _TECPLOT,
    ".plt": _TECPLOT,
    ".f3grid": Format("FLAC3D", "cells", "flac3d"),
    ".xml": Format("DOLFIN XML", "cells", "dolfin"),
}


def known_suffixes() -> tuple[str, ...]:
    """Return the suffixes that can be read, sorted."""
    return tuple(sorted(FORMATS))
