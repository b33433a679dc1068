"""OFF as Geomview defines it: a stream of words, its variants, and ModelNet's opening word."""

from __future__ import annotations

import pytest

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes

POINTS = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
ROWS = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
VERTICES = b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
FACES = b"3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"


def with_extra(extra):
    return VERTICES.replace(b"\n", b" " + extra + b"\n")


@pytest.mark.parametrize(
    "data",
    [
        b"OFF4 4 6\n" + VERTICES + FACES,  # ModelNet
        b"\t  OFF4 4 6 # or nah\n" + VERTICES + FACES,
        b"OFF\n4\n4\n6\n" + VERTICES + FACES,
        b"OFF 4 4 6 " + VERTICES.replace(b"\n", b" ") + FACES,
        b"OFF 4 4 6\n0\n0 0 1\n0 0 0 1 0 0\n# between\n0\n1\n" + FACES,
        b"OFF 4 4 6\n" + VERTICES + FACES.replace(b"3 0 2", b"3 0\n# half way\n2"),
        b"OFF 4 4 6\n" + VERTICES.replace(b"0 1 0\n", b"0 1\n0 ") + FACES,
        b"OFF\n4 4 6\n" + VERTICES + FACES.replace(b"\n", b" 0.5 0.5 0.5 1\n"),
        b"OFF 4 4 6 " + VERTICES.replace(b"\n", b" ") + FACES.replace(b"\n", b" 7\n"),
        b"4 4 6\n" + VERTICES + FACES,  # the word may be left out
        b"off\n4 4 6\n" + VERTICES + FACES,
        b"NOFF\n4 4 6\n" + with_extra(b"0 0 1") + FACES,
        b"noff\n4 4 6\n" + with_extra(b"0 0 1") + FACES,
        b"NOFF 4 4 6 " + with_extra(b"0 0 1").replace(b"\n", b" ") + FACES,
        b"COFF 4 4 6 " + with_extra(b"1 0 0 1").replace(b"\n", b" ") + FACES,
        b"COFF\n4 4 6\n" + with_extra(b"255 0 0") + FACES,
        b"STOFF 4 4 6 " + with_extra(b"0.5 0.5").replace(b"\n", b" ") + FACES,
        b"STCNOFF 4 4 6 " + with_extra(b"0 0 1 1 0 0 1 0.5 0.5").replace(b"\n", b" ") + FACES,
        b"nOFF\n3\n4 4 6\n" + VERTICES + FACES,
        b"nOFF 3 4 4 6\n" + VERTICES + FACES,
        b"STCNnOFF 3\n4 4 6\n" + with_extra(b"0 0 1 1 0 0 1 0.5 0.5") + FACES,
    ],
)
def test_off_reads_what_geomview_reads(data):
    mesh = load_mesh_bytes(data, ".off")

    assert mesh.vertices.tolist() == POINTS
    assert mesh.triangles.tolist() == ROWS
    assert mesh.notes == ()


def test_off_divides_by_homogeneous_coordinates_and_says_so():
    vertices = b"0 0 0 1\n2 0 0 2\n0 0.25 0 0.25\n0 0 -3 -3\n"

    mesh = load_mesh_bytes(b"4OFF\n4 4 6\n" + vertices + FACES, ".off")

    assert mesh.vertices.tolist() == POINTS
    assert mesh.notes == ("vertices are divided by their homogeneous coordinate",)


def test_off_lays_flat_vertices_at_zero_and_says_so():
    mesh = load_mesh_bytes(b"nOFF 2\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2\n", ".off")

    assert mesh.vertices.tolist() == POINTS[:3]
    assert mesh.notes == ("vertices of two coordinates lie at z = 0",)


def test_off_finds_no_surface_in_faces_of_one_or_two_corners_and_says_so():
    faces = FACES.replace(b"3 0 1 3\n", b"3 0 1 3\n1 0\n2 0 1 0.5 0.5 0.5\n")

    mesh = load_mesh_bytes(b"OFF\n4 6 6\n" + VERTICES + faces, ".off")

    assert mesh.triangles.tolist() == ROWS
    assert mesh.notes == ("2 faces of one or two corners, which have no surface, passed over",)


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        (b"4OFF\n4 4 6\n" + with_extra(b"0") + FACES, "vertex 0 is at infinity: its last coord"),
        (b"nOFF 4\n4 4 6\n" + with_extra(b"0") + FACES, ":1: has vertices of 4 numbers, which is"),
        (b"4nOFF 3\n4 4 6\n" + with_extra(b"1") + FACES, ":1: has vertices of 4 numbers, which"),
        (b"nOFF x\n4 4 6\n" + VERTICES + FACES, ":1: dimension 'x' is not a whole number"),
        (b"OFFSET 4 4\n" + VERTICES + FACES, ":1: begins with 'OFFSET', expected 'OFF'"),
        (b"OFF BINARY\n\0\0\0\4", ":1: is binary OFF, which is not read; export it as ASCII"),
        (b"OFF 4 4 6 " + VERTICES.replace(b"\n", b" ") + FACES[:-4], "ends inside face 3"),
        (b"OFF 4 4 6 " + VERTICES.replace(b"\n", b" ") + FACES[:-8], "but ends at face 3"),
        (b"OFF 4 9 6\n" + VERTICES + FACES, "claims 4 vertices and 9 faces, but ends at face 4"),
        (b"OFF 4 4 6\n0 0\n0 1 0 0 0 x 0\n0 0 1\n" + FACES, ":3: 'x' is not a number"),
        (b"OFF 4 4 6\n0 0\n0 1 0 0 0 1 0\n0 0 1\n3 0 2 4\n" + FACES[8:], ":5: face uses vertex 4"),
        (b"OFF", "has no counts of vertices and faces; it was cut short"),
        (b"OFF 4 4", "claims 4 vertices and 4 faces, but 0 lines follow"),
    ],
)
def test_off_refuses_streams_that_are_not_what_they_claim(data, fault):
    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(data, ".off")
