"""SU2's meshes: values by hand from the format's description."""

from __future__ import annotations

import meshio
import numpy as np
import pytest
from mesh_files.cell_files import CUBE, write

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

FLAT = """% a square of a triangle, a quadrilateral and a triangle
NDIME= 2
NELEM= 3
5 0 1 4 0
9 1 2 3 4 1 % in the middle
5 0 4 5 2
NPOIN= 6
0 0 0
1 0 1
2 0 2
2 1 3
1 1 4
0 1 5
NMARK= 1
MARKER_TAG= low
MARKER_ELEMS= 2
3 0 1 0
3 1 2
"""
TETRA = """NDIME=3
NELEM=1
10 0 1 2 3
NPOIN=4 4
0 0 0
1 0 0
0 1 0
0 0 1
NMARK=2
MARKER_TAG=a
MARKER_ELEMS=1
5 0 1 2
MARKER_TAG=SEND_RECEIVE
MARKER_ELEMS=1
SEND_RECV=1
"""


def su2(text):
    return load_mesh_bytes(text.encode(), ".su2")


def test_flat_cells_are_surface_in_the_files_order_at_height_zero():
    mesh = su2(FLAT)

    assert mesh.triangles.tolist() == [[0, 1, 4], [1, 2, 3], [1, 3, 4], [0, 4, 5]]
    assert mesh.vertices.tolist() == [
        [x, y, 0] for x, y in ((0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1))
    ]


def test_markers_come_first_and_volumes_add_what_they_leave_out():
    mesh = su2(TETRA.replace("MARKER_TAG=SEND_RECEIVE\nMARKER_ELEMS=1\nSEND_RECV=1\n", ""))

    assert mesh.triangles[0].tolist() == [0, 1, 2]
    assert sorted(map(sorted, mesh.triangles.tolist())) == [
        [0, 1, 2],
        [0, 1, 3],
        [0, 2, 3],
        [1, 2, 3],
    ]


@pytest.mark.parametrize(
    ("kind", "corners", "count"),
    [
        (10, [0, 1, 3, 4], 4),
        (12, range(8), 12),
        (13, [0, 1, 3, 4, 5, 7], 8),
        (14, [0, 1, 2, 3, 4], 6),
    ],
)
def test_each_volume_cell_gives_its_boundary(kind, corners, count):
    points = "\n".join(" ".join(map(str, point)) for point in CUBE.tolist())
    cell = " ".join(map(str, corners))

    mesh = su2(f"NDIME= 3\nNELEM= 1\n{kind} {cell} 0\nNPOIN= 8\n{points}\nNMARK= 0\n")

    assert len(mesh.triangles) == count
    assert mesh.is_watertight


def test_every_zone_is_read_with_points_of_its_own():
    second = FLAT.replace("2 0 2", "2.5 0 2")

    mesh = su2(f"NZONE= 2\nIZONE= 1\n{FLAT}IZONE= 2\n{second}")

    assert len(mesh.triangles) == 8
    assert mesh.triangles[4:].min() == 6
    assert mesh.vertices[8].tolist() == [2.5, 0, 0]


def test_what_makes_no_part_of_the_mesh_is_passed_over():
    more = """NPERIODIC= 1
PERIODIC_INDEX= 0
PERIODIC_CENTER= 0 0 0
FFD_NBOX= 1
FFD_TAG= box
FFD_CORNER_POINTS= 2
0 0 0
9 9 9
FFD_SURFACE_POINTS= 1
low 0 0.5 0.5 0.5
AOA= 1.5
"""

    assert su2(FLAT + more).triangles.tolist() == su2(FLAT).triangles.tolist()


@pytest.mark.parametrize(
    "text",
    [FLAT.replace("\n", "\r\n"), FLAT.replace("\n", "\n\n%\n"), FLAT.replace("=", " = ").lower()],
)
def test_the_same_mesh_may_be_written_in_many_ways(text):
    assert su2(text).triangles.tolist() == su2(FLAT).triangles.tolist()


@pytest.mark.parametrize(
    "cells", [[("tetra", [[0, 1, 2, 5], [0, 2, 3, 7]])], [("hexahedron", [range(8)])]]
)
def test_files_that_meshio_writes_are_read_as_it_reads_them(tmp_path, cells):
    path = write(tmp_path / "a.su2", [(kind, np.array([*map(list, rows)])) for kind, rows in cells])

    mesh, other = load_mesh(path), meshio.read(path)

    np.testing.assert_array_equal(mesh.vertices, other.points)
    assert len(mesh.triangles) == {"tetra": 8, "hexahedron": 12}[cells[0][0]]


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("NELEM= 3", "NELEM= 4", ":3: NELEM= 4, but 3 lines follow; it was cut short"),
        ("NELEM= 3", "NELEM= x", ":3: NELEM= 'x' is not a whole number"),
        ("NPOIN= 6", "NPOIN= 4000000000", ":7: NPOIN= 4000000000, but 6 lines follow"),
        ("NPOIN= 6", "NPOIN= " + "1" * 5000, ":7: NPOIN= '1.*' is not a whole number"),
        ("NDIME= 2", "NDIME= 4", ":2: NDIME= 4; 2 or 3 dimensions are read"),
        ("NDIME= 2", "NDIME= 2\n7", ":3: '7' after NDIME, which has no lines"),
        ("NDIME= 2\n", "", ":2: NELEM before NDIME; write NDIME first"),
        ("NPOIN= 6", "NPOINTS= 6", ":7: the keyword NPOINTS is not known; remove it"),
        ("5 0 1 4 0", "5 0 1 6 0", ":4: an element uses point 6 of 6; points are counted from 0"),
        ("5 0 1 4 0", "5 0 1 -1 0", ":4: an element uses point -1 of 6"),
        ("5 0 1 4 0", "5 0 1.5 4 0", ":4: a number of an element 1.5 is not a whole number"),
        ("5 0 1 4 0", "5 0 1", ":4: an element of type 5 with 2 numbers, 3 points wanted"),
        ("5 0 1 4 0", "22 0 1 4 2 3 5", ":4: an element of type 22 is not known; lines, tri"),
        ("1 0 1\n", "1 0 7\n", ":9: point 1 is numbered 7; number points from 0 in order"),
        ("1 0 1\n", "1 0 1 7\n", ":9: a point of 4 numbers, 2 wanted"),
        ("1 0 1\n", "1 nan 1\n", ":9: point 1 is not finite"),
        ("1 0 1\n", "1 zero 1\n", ":9: 'zero' is not a number"),
        ("3 1 2", "3 1 9", ":18: an element uses point 9 of 6"),
        ("% a", "a ", ":1: 'a' before the first keyword; an SU2 mesh begins with NDIME= or NZONE="),
        (FLAT, "% nothing\n", " has no NDIME, which begins an SU2 mesh"),
        (FLAT, "NZONE= 2\nIZONE= 1\n" + FLAT, ":1: NZONE= 2, but 1 zones follow"),
        (FLAT, "NDIME= 2\n", " zone '' has no NPOIN"),
        (
            FLAT,
            FLAT + FLAT,
            ":25: NPOIN before NDIME, or a second time; begin each zone with IZONE=",
        ),
        (
            FLAT,
            TETRA.replace("SEND_RECV", "5 0\nSEND_RECV"),
            ":15: an element of type 5 with 1 num",
        ),
    ],
)
def test_damaged_meshes_are_refused_with_line_and_remedy(old, new, fault):
    assert old in FLAT

    with pytest.raises(MeshError, match=rf"^<stdin>:?{fault}"):
        su2(FLAT.replace(old, new, 1))


def test_a_mesh_cut_short_is_refused():
    for size in range(
        len(FLAT) - len("NMARK= 1\nMARKER_TAG= low\nMARKER_ELEMS= 2\n3 0 1 0\n3 1 2\n")
    ):
        try:
            mesh = su2(FLAT[:size])
        except MeshError:
            continue
        # Only the number of the last point may be missing.
        assert len(mesh.triangles) == 4
