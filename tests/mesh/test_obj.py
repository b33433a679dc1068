"""OBJ: every form of face, faces in the file's order, and errors that name the line."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes
from obbcli.mesh.formats.obj import reader as obj_module

SQUARE = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def triangles(data):
    return load_mesh_bytes(data, ".obj").triangles.tolist()


@pytest.mark.parametrize(
    "face",
    [
        b"f 1 2 3",
        b"f 1/1 2/2 3/3",
        b"f 1//1 2//1 3//1",
        b"f 1/1/1 2/2/1 3/3/1",
        b"f -4 -3 -2",
        b"f -4/-1/-1 2 -2//-1",
        b"f 1 2 \\\n3",
        b"f 1 2\\\n 3",
        b"f 1 2 3 # the first",
        b"\tf\t1  2   3 ",
        b"fo 1 2 3",
    ],
)
def test_obj_reads_every_form_of_face(face):
    assert triangles(SQUARE + face + b"\n") == [[0, 1, 2]]


def test_obj_cuts_convex_polygons_into_fans_in_place():
    faces = b"f 1 2 3\nf 1 2 3 4\nf 2 3 4\nf 4 3 2 1 1\nf 3 2 1\n"

    assert triangles(SQUARE + faces) == [
        [0, 1, 2],
        [0, 1, 2],
        [0, 2, 3],
        [1, 2, 3],
        [3, 2, 1],
        [3, 1, 0],
        [3, 0, 0],
        [2, 1, 0],
    ]


def test_obj_keeps_the_order_of_faces_across_objects_groups_and_materials():
    data = SQUARE + (
        b"mtllib none.mtl\no first\nusemtl red\nf 1 2 3\nusemtl blue\nf 2 3 4\n"
        b"o second\ng left right\nusemtl red\ns off\nf 3 4 1\nusemtl blue\nf 4 1 2\n"
    )

    assert triangles(data) == [[0, 1, 2], [1, 2, 3], [2, 3, 0], [3, 0, 1]]


def test_obj_counts_negative_indices_from_the_vertices_so_far():
    data = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -3 -2 -1\n"

    assert triangles(data) == [[0, 1, 2], [1, 2, 3]]


def test_obj_takes_faces_before_their_vertices():
    assert triangles(b"f 1 2 3\n" + SQUARE) == [[0, 1, 2]]


@pytest.mark.parametrize("end", [b"\r\n", b"\r", b"\n\n"])
def test_obj_takes_any_line_ends_marks_and_comments(end):
    data = b"\xef\xbb\xbf# a comment\n" + SQUARE + b"#f 9 9 9\nf 1 2 3 4"

    assert triangles(data.replace(b"\n", end)) == [[0, 1, 2], [0, 2, 3]]


def test_obj_passes_over_attributes_points_and_lines():
    data = (
        b"v 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 0\nvn 0 0 1\nvp 1 1\np 1\nl 1 2\ns 1\n"
        b"g a\nusemtl m\nf 1 2 3\n"
    )
    mesh = load_mesh_bytes(data, ".obj")

    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_obj_keeps_isolated_vertices_and_repeated_and_degenerate_faces():
    mesh = load_mesh_bytes(SQUARE + b"f 1 2 3\nf 1 2 3\nf 1 1 2\n", ".obj")

    assert len(mesh.vertices) == 4
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 1, 2], [0, 0, 1]]


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        (b"f 1 2 9", r":5: face uses vertex 9 of 4; indices start at 1"),
        (b"f 1 2 5/1/1", r":5: face uses vertex 5 of 4; indices start at 1"),
        (b"f 0 1 2", r":5: face uses vertex 0 of 4; indices start at 1"),
        (b"f 1 2 -5", r":5: face uses vertex -5 of 4; negative indices count back"),
        (b"f 1 2", r":5: face has 2 vertices, at least 3"),
        (b"f", r":5: face has 0 vertices"),
        (b"f 1 2 x", r":5: 'x' is not a vertex of a face"),
        (b"f 1 2 1.5", r":5: '1.5' is not a vertex"),
        (b"f 1 2 /3", r":5: '/3' is not a vertex"),
        (b"f 1 2 3_0", r":5: '3_0' is not a vertex"),
        (b"f 1 2 99999999999999999999999", r":5: face uses vertex 99999999999999999999999 of 4"),
        (b"v 0 nan 0", r":5: coordinate is nan"),
        (b"v 0 0 1e999", r":5: coordinate is 1e999"),
        (b"v -inf 0 0", r":5: coordinate is -inf"),
        (b"v 0 0", r":5: vertex has 2 coordinates"),
        (b"v 0 0 z", r":5: 'z' is not a number"),
        (b"v 0 0 1_0", r":5: '1_0' is not a number"),
        (b"ff 1 2 3", r":5: 'ff' is no OBJ statement"),
        (b"surf 0 1 0 1 1 2 3", r":5: 'surf' is a free-form surface"),
        (b"call other.obj", r":5: 'call' is a call of another file"),
    ],
)
def test_obj_refuses_what_is_wrong_and_names_the_line(tmp_path, line, fault):
    path = tmp_path / "gear.obj"
    path.write_bytes(SQUARE + line + b"\nf 1 2 3\n")

    with pytest.raises(MeshError, match=r"gear\.obj" + fault):
        load_mesh(path)


def test_obj_names_the_line_of_a_continued_face():
    with pytest.raises(MeshError, match=r"<stdin>:6: face uses vertex 7 of 4"):
        load_mesh_bytes(SQUARE + b"f 1 2 3\nf 1 \\\n2 \\\n7\n", ".obj")


def test_obj_takes_coordinates_at_the_ends_of_the_double_range():
    mesh = load_mesh_bytes(b"v 1e308 1e308 1e308\nv 5e-324 0 0\nv 0 1 0\nf 1 2 3\n", ".obj")

    assert mesh.vertices[0].tolist() == [1e308] * 3
    assert mesh.vertices[1, 0] == 5e-324


@pytest.mark.parametrize(
    "data",
    [
        SQUARE + b"f 1 2 3\nf 4 3 2\n",
        SQUARE + b"f 1/1 2/2 3/3\nf 4/1 3/2 2/3\n",
        SQUARE + b"# end\n\no a_b\n  s off\nf 1 2 3 4\nf 4 3 2 1\n",
        SQUARE.replace(b"0\n", b"0 0.5 0.5 0.5\n") + b"f 4 3 2\n",
        SQUARE + b"f 1 2 -1\n",
        SQUARE + b"f 1 2 3\nf 1 2 3 4\n",
        SQUARE + b" f 1 2 3\nf 3 4 1\n",
        SQUARE + b"f\t1 2 3\nf 3 4 1\n",
        SQUARE + b"f 1 2 3 #4\nf 3 4 1 #5\n",
    ],
)
def test_obj_reads_the_same_by_columns_and_by_statements(data, monkeypatch):
    by_columns = load_mesh_bytes(data, ".obj")

    monkeypatch.setattr(obj_module, "_read_regular", lambda _: None)
    by_statements = load_mesh_bytes(data, ".obj")

    assert by_columns.vertices.tolist() == by_statements.vertices.tolist()
    assert by_columns.triangles.tolist() == by_statements.triangles.tolist()


def test_obj_agrees_with_trimesh_on_a_file_it_wrote(tmp_path):
    path = tmp_path / "sphere.obj"
    sphere = trimesh.creation.icosphere(subdivisions=2)
    sphere.export(path, digits=17)

    mesh = load_mesh(path)

    np.testing.assert_array_equal(mesh.vertices, sphere.vertices)
    np.testing.assert_array_equal(mesh.triangles, sphere.faces)
