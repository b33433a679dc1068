"""AVS UCD meshes in ASCII: values by hand from the format's definition."""

from __future__ import annotations

import meshio
import numpy as np
import pytest
from mesh_files.abaqus_decks import area, volume
from mesh_files.cell_files import CUBE, write
from mesh_files.deck_files import UCD as CELLS

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

UCD = """# a square and two triangles
# more
6 4 1 0 0
10  0 0 0
11  1 0 0
12  1 1 0
13  0 1 0
20  2 0 0
21  2 1 0.5
1 1 tri 11 20 21
2 1 QUAD 10 11 12 13
3 7 line 10 11
4 7 tri 11 21 12
1 1
temperature, K
10 1.0
"""


def ucd(text, suffix=".avs"):
    return load_mesh_bytes(text.encode(), suffix)


@pytest.mark.parametrize("suffix", [".avs", ".inp"])
def test_cells_are_surface_in_the_files_order(suffix):
    mesh = ucd(UCD, suffix)

    assert mesh.triangles.tolist() == [[1, 4, 5], [0, 1, 2], [0, 2, 3], [1, 5, 2]]
    assert mesh.vertices[5].tolist() == [2, 1, 0.5]


# The apex of a pyramid comes first; prisms and bricks have one end after the other.
@pytest.mark.parametrize(
    ("kind", "corners", "held"),
    [
        ("tet", [0, 1, 3, 4], 1 / 6),
        ("pyr", [4, 0, 1, 2, 3], 1 / 3),
        ("prism", [4, 5, 7, 0, 1, 3], 1 / 2),
        ("hex", [4, 5, 6, 7, 0, 1, 2, 3], 1),
    ],
)
def test_volumes_give_their_boundary(kind, corners, held):
    nodes = "\n".join(f"{at} {x} {y} {z}" for at, (x, y, z) in enumerate(CUBE.tolist(), start=5))
    cell = " ".join(str(corner + 5) for corner in corners)

    mesh = ucd(f"8 1 0 0 0\n{nodes}\n1 1 {kind} {cell}\n")

    assert mesh.is_watertight
    assert volume(mesh) == pytest.approx(held)


@pytest.mark.parametrize(
    "cells",
    [
        [("triangle", [[0, 1, 2]]), ("quad", [[0, 1, 2, 3]])],
        [("tetra", [[0, 1, 2, 5], [0, 2, 3, 7]])],
        [("pyramid", [[4, 5, 6, 7, 8]]), ("hexahedron", [range(8)])],
        [("wedge", [[0, 1, 3, 4, 5, 7]])],
    ],
)
def test_files_that_meshio_writes_are_read_as_it_reads_them(tmp_path, cells):
    rows = [(kind, np.array([*map(list, nodes)])) for kind, nodes in cells]
    path = write(tmp_path / "a.avs", rows)
    twin = write(tmp_path / "a.vtk", rows)

    mesh, other = load_mesh(path), load_mesh(twin)

    np.testing.assert_array_equal(mesh.vertices, meshio.read(path).points)
    assert len(mesh.triangles) == len(other.triangles)
    assert mesh.is_watertight == other.is_watertight
    for measured in (area, volume):
        assert measured(mesh) == pytest.approx(measured(other))


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("6 4 1", "4000000000 4 1", ":3: has 4000000000 nodes and 4 cells, but 16 lines in all"),
        ("6 4 1", "6 9 1", ":3: has 6 nodes and 9 cells, but 16 lines in all; it was cut short"),
        ("6 4 1", "6 5 1", ":14: a cell of type 'too few words'"),
        ("6 4 1", "6 3 1", ":13: '4 7 tri 11 21 12' after the cells that the header counts"),
        ("6 4 1 0 0", "6 4 0 0 0", ":14: '1 1' after the cells that the header counts"),
        ("6 4 1", "5 4 1", ":13: '4 7 tri 11 21 12' after the cells"),
        ("6 4 1 0 0", "6 4 1", ":3: '6 4 1' where a UCD mesh has its five counts; of files with"),
        ("11  1 0 0", "11  1 0", ":5: a node is not a number and three coordinates"),
        ("11  1 0 0", "11  1 0 nan", ":5: a node is not finite; coordinates must be finite"),
        ("11  1 0 0", "11.5  1 0 0", ":5: the number of a node 11.5 is not a whole number"),
        ("11  1 0 0", "10  1 0 0", " node 10 is there twice; number each node once"),
        ("tri 11 20 21", "tri 11 20 22", ":10: a cell uses node 22, which is not there; write"),
        ("tri 11 20 21", "tri 11 20", ":10: a cell of type tri with 2 nodes; 3 are wanted"),
        ("tri 11 20 21", "tri 11 20 21 10", ":10: a cell of type tri with 4 nodes; 3 are wanted"),
        ("tri 11 20 21", "tri6 11 20 21", ":10: a cell of type 'tri6'; pt line tri quad tet pyr"),
        ("tri 11 20 21", "tri 11 x 21", ":10: 'x' is not a number"),
        (UCD, "# nothing\n", ":1: '# nothing' where a UCD mesh has its five counts"),
        (UCD, "\x07\x00\x01", " is binary UCD, which is not read; save it as ASCII UCD, or as VTK"),
        (UCD, "1\ndata\nstep1\n" + UCD, ":1: '1' where a UCD mesh has its five counts"),
    ],
)
def test_damaged_meshes_are_refused_with_line_and_remedy(old, new, fault):
    assert old in UCD

    with pytest.raises(MeshError, match=rf"^<stdin>:?{fault}"):
        ucd(UCD.replace(old, new, 1))


def test_binary_files_called_inp_are_refused_by_name():
    with pytest.raises(MeshError, match="is binary UCD, which is not read"):
        load_mesh_bytes(b"\x07" + bytes(40), ".inp")


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_mesh_cut_short_is_refused_or_has_all_cells(end):
    text = UCD.replace("\n", end)
    for size in range(1, len(text)):
        try:
            mesh = ucd(text[:size])
        except MeshError:
            continue
        assert len(mesh.triangles) == 4


@pytest.mark.needs("vtk")
def test_cells_are_those_that_vtk_reads(tmp_path):
    from vtkmodules.vtkIOGeometry import vtkAVSucdReader

    path = tmp_path / "a.avs"
    path.write_bytes(CELLS)
    reader = vtkAVSucdReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    cells = [grid.GetCell(at) for at in range(grid.GetNumberOfCells())]
    corners = [[c.GetPointId(k) for k in range(c.GetNumberOfPoints())] for c in cells]

    mesh = load_mesh(path)

    # A hexahedron with a pyramid on it, a quad on its bottom, and a triangle and a wedge elsewhere.
    expected = surface_of(corners)
    found = {frozenset(row) for row in mesh.triangles.tolist()}
    assert all(any(face <= set(row) for face in found) for row in corners if len(row) > 2)
    assert len(mesh.triangles) == expected


def surface_of(corners):
    """Return how many triangles cells have, faces of volumes that two share left out."""
    faces = {
        3: [(0, 1, 2)],
        4: [(0, 1, 2, 3)],
        5: [(0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
        6: [(0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
        8: [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
    }
    sets = [
        (len(row) > 4, frozenset(row[at] for at in face))
        for row in corners
        for face in faces.get(len(row), [])
    ]
    flat = [corners for is_volume, corners in sets if not is_volume]
    solid = [corners for is_volume, corners in sets if is_volume]
    alone = [corners for corners in solid if solid.count(corners) == 1 and corners not in flat]
    return sum(len(corners) - 2 for corners in [*flat, *alone])
