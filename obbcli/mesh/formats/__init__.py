"""The readers of mesh files, a format each, and the table of formats by suffix."""

from __future__ import annotations

from pathlib import PurePath
from typing import NamedTuple


class Format(NamedTuple):
    """Holds a format's name and reader.

    Args:
        name: as people call it.
        module: of this package, imported when first needed; its `read_NAME` reads a file, where
            NAME is the first word of the module.
        kind: meshio's module of the format; None where the reader is ours.
        parts: the module whose `parts_NAME` lists parts; None where the format knows none.
        is_exact: whether files hold exact surfaces, which are cut into triangles with a sag.
    """

    name: str
    module: str
    kind: str | None = None
    parts: str | None = None
    is_exact: bool = False

    @property
    def key(self) -> str:
        """NAME in the names of the functions that read the format."""
        return self.module.partition(".")[0]


_STL = Format("STL", "stl", parts="stl_parts")
_OBJ = Format("OBJ", "obj.reader", parts="obj.parts")
_PLY = Format("PLY", "ply.reader")
_OFF = Format("OFF", "off.reader")
_GLTF = Format("glTF", "gltf.reader", parts="gltf.reader")
_VTK = Format("VTK", "vtk.reader", parts="vtk.parts")
_GMSH = Format("Gmsh", "gmsh.reader")
_NASTRAN = Format("Nastran, OptiStruct", "nastran.reader", parts="nastran.reader")
_MEDIT = Format("Medit", "medit")
_THREEMF = Format("3MF", "threemf.reader", parts="threemf.reader")
_COLLADA = Format("COLLADA", "collada.reader", parts="collada.reader")
_STEP = Format("STEP", "step.reader", parts="step.reader", is_exact=True)
_TECPLOT = Format("Tecplot", "tecplot.reader", parts="tecplot.reader")

#: The one table of suffixes. Those of our own readers first, then what goes through meshio.
FORMATS = {
    ".stl": _STL,
    ".obj": _OBJ,
    ".ply": _PLY,
    ".off": _OFF,
    ".glb": _GLTF,
    ".gltf": _GLTF,
    ".3mf": _THREEMF,
    ".dae": _COLLADA,
    ".step": _STEP,
    ".stp": _STEP,
    ".stpz": _STEP,
    ".vtk": _VTK,
    ".vtu": _VTK,
    ".vtp": _VTK,
    ".vti": _VTK,
    ".vts": _VTK,
    ".vtr": _VTK,
    ".vtm": _VTK,
    ".msh": _GMSH,
    ".inp": Format("Abaqus, CalculiX, AVS UCD", "inp", parts="inp"),
    ".avs": Format("AVS UCD", "ucd"),
    ".bdf": _NASTRAN,
    ".fem": _NASTRAN,
    ".nas": _NASTRAN,
    ".mesh": _MEDIT,
    ".meshb": _MEDIT,
    ".vol": Format("Netgen", "through_meshio.reader", "netgen"),
    ".su2": Format("SU2", "su2", parts="su2"),
    ".dat": _TECPLOT,
    ".tec": _TECPLOT,
    ".plt": _TECPLOT,
    ".f3grid": Format("FLAC3D", "through_meshio.reader", "flac3d"),
    ".xml": Format("DOLFIN XML", "through_meshio.reader", "dolfin"),
}


#: What stands after the suffix of a file that gzip has packed.
PACKED_SUFFIX = ".gz"
#: What files are called whose format is packed by gzip without saying so.
PACKED_SUFFIXES = (PACKED_SUFFIX, ".stpz")


def suffix_of(name: str) -> str:
    """Return the suffix that tells a file's format, in lower case; it may stand before `.gz`."""
    path = PurePath(name.lower())
    return PurePath(path.stem).suffix if path.suffix == PACKED_SUFFIX else path.suffix


def known_suffixes() -> tuple[str, ...]:
    """Return the suffixes that can be read, sorted."""
    return tuple(sorted(FORMATS))
