"""Files of named cubes in every format that knows parts, placed as each format places things."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias
from xml.sax.saxutils import quoteattr

import numpy as np
from mesh_files import collada_files, threemf_files
from mesh_files.cube_files import CUBE_FACES, cube
from mesh_files.gltf_files import Builder, glb

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    #: Where the cube at the origin goes: by so much.
    Shift: TypeAlias = tuple[float, float, float]
    #: Names and places; a cube that is placed nowhere is damaged.
    Cubes: TypeAlias = Sequence[tuple[str, Shift | None]]

_WORDS = [" ".join(map(repr, corner)) for corner in cube()]
_FACES = [" ".join(map(str, face)) for face in CUBE_FACES]
_FROM_ONE = [" ".join(str(corner + 1) for corner in face) for face in CUBE_FACES]


def gltf(folder: Path, cubes: Cubes) -> Path:
    """Write nodes that share a mesh; a damaged one has a mesh that names an accessor too many."""
    nodes = [
        {"name": name, "mesh": 1}
        if shift is None
        else {"name": name, "mesh": 0, "translation": list(shift)}
        for name, shift in cubes
    ]
    made = Builder(scenes=[{"nodes": list(range(len(nodes)))}], nodes=nodes)
    attributes = {"POSITION": made.accessor(cube())}
    indices = made.accessor(np.ravel(CUBE_FACES), "<u2")
    made.document["meshes"] = [
        {"primitives": [{"attributes": attributes, "indices": indices}]},
        {"primitives": [{"attributes": attributes, "indices": 99}]},
    ]
    made.document["buffers"] = [{"byteLength": len(made.body)}]
    return _put(folder / "a.glb", glb(made.document, made.body))


def threemf(folder: Path, cubes: Cubes) -> Path:
    """Write an object of each name, placed by an item; a damaged one lacks a corner."""
    objects, items = [], []
    for key, (name, shift) in enumerate(cubes, start=1):
        vertices = "".join(
            "<vertex "
            + " ".join(f'{axis}="{x!r}"' for axis, x in zip("xyz", row, strict=True))
            + "/>"
            for row in cube()[: 8 if shift else 7]
        )
        triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in CUBE_FACES)
        content = f"<vertices>{vertices}</vertices><triangles>{triangles}</triangles>"
        objects.append(
            threemf_files.mesh(key, f"name={quoteattr(name)}", f"<mesh>{content}</mesh>")
        )
        items.append(f'<item objectid="{key}" {threemf_files.shift(*(shift or (0, 0, 0)))}/>')
    model = threemf_files.model("".join(objects), "".join(items))
    return _put(folder / "a.3mf", threemf_files.archive(model))


def collada(folder: Path, cubes: Cubes) -> Path:
    """Write nodes that share a geometry; a damaged one shows another, with a corner too many."""
    points, rows = " ".join(_WORDS), " ".join(_FACES)
    accessor = 'count="8" stride="3"'
    shapes = "".join(
        collada_files.geometry(collada_files.triangles(numbers), key, accessor, points)
        for key, numbers in (("g", rows), ("h", rows.replace("7", "8")))
    )
    nodes = []
    for name, shift in cubes:
        place = " ".join(map(repr, shift or (0.0, 0.0, 0.0)))
        shown = f'<instance_geometry url="#{"h" if shift is None else "g"}"/>'
        nodes.append(f"<node name={quoteattr(name)}><translate>{place}</translate>{shown}</node>")
    return _put(folder / "a.dae", collada_files.document("".join(nodes), shapes))


def obj(folder: Path, cubes: Cubes) -> Path:
    """Write objects; a damaged one has a face with a corner too many."""
    lines = []
    for count, (name, shift) in enumerate(cubes):
        lines += [f"o {name}", *("v " + _row(corner) for corner in cube(shift or (0, 0, 0)))]
        first = 1 + 8 * (count if shift else 999)
        lines += ["f " + " ".join(str(first + corner) for corner in face) for face in CUBE_FACES]
    return _put(folder / "a.obj", "\n".join([*lines, ""]))


def stl(folder: Path, cubes: Cubes) -> Path:
    """Write solids; a damaged one has a word where a coordinate is wanted."""
    lines = []
    for name, shift in cubes:
        corners = [_row(corner) if shift else "0 0 x" for corner in cube(shift or (0, 0, 0))]
        lines.append(f"solid {name}")
        for face in CUBE_FACES:
            rows = "".join(f"vertex {corners[corner]}\n" for corner in face)
            lines.append(f"facet normal 0 0 0\nouter loop\n{rows}endloop\nendfacet")
        lines.append(f"endsolid {name}")
    return _put(folder / "a.stl", "\n".join([*lines, ""]))


def vtm(folder: Path, cubes: Cubes) -> Path:
    """Write an index of blocks, a grid of triangles each; the file of a damaged one is missing."""
    blocks = []
    for number, (name, shift) in enumerate(cubes):
        blocks.append(f'<DataSet index="{number}" name={quoteattr(name)} file="{number}.vtu"/>')
        if shift is not None:
            _put(folder / f"{number}.vtu", _vtu(shift))
    content = f"<vtkMultiBlockDataSet>{''.join(blocks)}</vtkMultiBlockDataSet>"
    return _put(folder / "a.vtm", f'<VTKFile type="vtkMultiBlockDataSet">{content}</VTKFile>')


def _vtu(shift: Shift) -> str:
    points = " ".join(_row(corner) for corner in cube(shift))
    arrays = [f'<DataArray type="Int64" Name="connectivity" format="ascii">{" ".join(_FACES)}']
    for name, kind, values in (("offsets", "Int64", range(3, 37, 3)), ("types", "UInt8", [5] * 12)):
        numbers = " ".join(map(str, values))
        arrays.append(f'<DataArray type="{kind}" Name="{name}" format="ascii">{numbers}')
    return (
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">'
        '<UnstructuredGrid><Piece NumberOfPoints="8" NumberOfCells="12"><Points><DataArray '
        f'type="Float64" NumberOfComponents="3" format="ascii">{points}</DataArray></Points>'
        f"<Cells>{'</DataArray>'.join([*arrays, ''])}</Cells></Piece></UnstructuredGrid></VTKFile>"
    )


def abaqus(folder: Path, cubes: Cubes) -> Path:
    """Write instances of one part; a damaged one is of another, with a node that is not defined."""
    nodes = [f"{number}, {_row(corner, ', ')}" for number, corner in enumerate(cube(), start=1)]
    faces = [f"{number}, {row.replace(' ', ', ')}" for number, row in enumerate(_FROM_ONE, start=1)]
    lines = []
    for part, count in (("cube", 8), ("damaged", 7)):
        lines += [f"*PART, NAME={part}", "*NODE", *nodes[:count], "*ELEMENT, TYPE=S3", *faces]
        lines.append("*END PART")
    lines.append("*ASSEMBLY, NAME=all")
    for name, shift in cubes:
        part = "damaged" if shift is None else "cube"
        lines.append(f'*INSTANCE, NAME="{name}", PART={part}')
        lines += [_row(shift or (0, 0, 0), ", "), "*END INSTANCE"]
    return _put(folder / "a.inp", "\n".join([*lines, "*END ASSEMBLY", ""]))


def tecplot(folder: Path, cubes: Cubes) -> Path:
    """Write zones; a damaged one has a coordinate too few."""
    lines = ["VARIABLES = X, Y, Z"]
    for name, shift in cubes:
        lines.append(f'ZONE T="{name}", N=8, E=12, F=FEPOINT, ET=TRIANGLE')
        lines += [_row(corner) for corner in cube(shift or (0, 0, 0))[: 8 if shift else 7]]
        lines += _FROM_ONE
    return _put(folder / "a.dat", "\n".join([*lines, ""]))


def su2(folder: Path, cubes: Cubes) -> Path:
    """Write zones; a damaged one lacks a point."""
    lines = [f"NZONE= {len(cubes)}"]
    for name, shift in cubes:
        corners = cube(shift or (0, 0, 0))[: 8 if shift else 7]
        lines += [f"IZONE= {name}", "NDIME= 3", "NELEM= 12", *(f"5 {row}" for row in _FACES)]
        lines += [f"NPOIN= {len(corners)}", *map(_row, corners)]
    return _put(folder / "a.su2", "\n".join([*lines, ""]))


def _row(numbers: Sequence[float], between: str = " ") -> str:
    return between.join(map(repr, map(float, numbers)))


def _put(path: Path, data: str | bytes) -> Path:
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    return path


WRITERS: dict[str, Callable[[Path, Cubes], Path]] = {
    "glTF": gltf,
    "3MF": threemf,
    "COLLADA": collada,
    "OBJ": obj,
    "STL": stl,
    "VTK": vtm,
    "Abaqus": abaqus,
    "Tecplot": tecplot,
    "SU2": su2,
}
#: Whose parts share a mesh, with a pose each; the others hold every part's own coordinates.
PLACING = ("glTF", "COLLADA", "Abaqus")
#: Whose parts are decoded alone: a damaged one beside them does not matter.
DECODED_ALONE = ("glTF", "COLLADA", "VTK", "Abaqus", "Tecplot", "SU2")
