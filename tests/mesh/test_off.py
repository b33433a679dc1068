"""OFF: variants, faces in the file's order, and counts that do not fit."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

SQUARE = b"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n"


def test_off_cuts_convex_polygons_into_fans_in_place():
    data = SQUARE.replace(b"4 2 0", b"4 4 0") + b"3 3 2 1\n5 3 2 1 0 0\n"

    mesh = load_mesh_bytes(data, ".off")

    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert mesh.triangles.tolist() == [
        [0, 1, 2],
        [0, 1, 2],
        [0, 2, 3],
        [3, 2, 1],
        [3, 2, 1],
        [3, 1, 0],
        [3, 0, 0],
    ]


@pytest.mark.parametrize(
    "data",
    [
        SQUARE.replace(b"\n", b"\r\n"),
        SQUARE.replace(b"OFF\n", b"OFF "),
        SQUARE.replace(b"OFF", b"off"),
        SQUARE.replace(b"4 2 0", b"4 2"),
        SQUARE.replace(b"OFF\n", b"# first\nOFF # the header\n\n# then\n"),
        SQUARE.replace(b"OFF", b"COFF").replace(b" 0\n", b" 0 255 0 0 255\n", 5).replace(
            b"4 2 0 255 0 0 255", b"4 2 0"
        ),
        SQUARE.replace(b"OFF", b"NOFF").replace(b"1 1 0", b"1 1 0 0 0 1"),
        SQUARE.replace(b"3 0 1 2", b"3 0 1 2 255 0 0"),
        SQUARE.rstrip(),
    ],
)  # fmt: skip
def test_off_reads_every_variant(data):
    mesh = load_mesh_bytes(data, ".off")

    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (b"OFF", b"OOF", r":1: begins with 'OOF', expected 'OFF'"),
        (b"OFF", b"5OFF", r":1: begins with '5OFF'"),
        (b"OFF", b"{", r":1: begins with '{', expected 'OFF'"),
        (b"OFF", b"OFF BINARY", r":1: is binary OFF"),
        (b"4 2 0", b"4000000000 2 0", r"claims 4000000000 vertices and 2 faces, but 6 lines"),
        (b"4 2 0", b"4 4000000000 0", r"claims 4 vertices and 4000000000 faces, but 6 lines"),
        (b"4 2 0", b"4 1 0", r":8: claims 4 vertices and 1 faces, and more lines follow"),
        (b"4 2 0", b"-4 2 0", r":2: count -4 is negative"),
        (b"4 2 0", b"4", r":7: claims 4 vertices and 0 faces, and more lines follow"),
        (b"4 2 0", b"4 two 0", r":2: count 'two' is not a whole number"),
        (b"1 1 0", b"1 1", r":5: vertex has 2 coordinates"),
        (b"1 1 0", b"1 nan 0", r":5: coordinate is nan"),
        (b"1 1 0", b"1 1 1e999", r":5: coordinate is 1e999"),
        (b"1 1 0", b"1 1 z", r":5: 'z' is not a number"),
        (b"3 0 1 2", b"3 0 1 4", r":7: face uses vertex 4 of 4; indices start at 0"),
        (b"3 0 1 2", b"3 0 1 -1", r":7: face uses vertex -1 of 4"),
        (b"3 0 1 2", b"0 0 1 2", r":7: face has 0 vertices"),
        (b"3 0 1 2", b"3 0 1 2 4 0 1 2 3", r":7: 5 words follow a face's vertices, a colour has"),
        (b"3 0 1 2", b"3 0 1", r":7: face has 2 of its 3 vertices"),
        (b"3 0 1 2", b"-3 0 1", r":7: face has -3 vertices"),
        (b"3 0 1 2", b"3 0 1 x", r":7: vertex 'x' is not a whole number"),
    ],
)
def test_off_refuses_what_is_wrong_and_names_the_line(old, new, fault):
    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(SQUARE.replace(old, new, 1), ".off")


def test_off_refuses_a_bad_index_among_triangles_alone():
    data = b"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 3\n"

    with pytest.raises(MeshError, match=r":7: face uses vertex 3 of 3"):
        load_mesh_bytes(data, ".off")


@pytest.mark.parametrize("size", range(1, len(SQUARE) - 1))
def test_off_refuses_every_truncation_but_that_of_the_last_line_end(size):
    with pytest.raises(MeshError):
        load_mesh_bytes(SQUARE[:size], ".off")


def test_off_agrees_with_trimesh_on_a_file_it_wrote(tmp_path):
    path = tmp_path / "sphere.off"
    sphere = trimesh.creation.icosphere(subdivisions=2)
    sphere.export(path, digits=17)

    mesh = load_mesh(path)

    np.testing.assert_array_equal(mesh.vertices, sphere.vertices)
    np.testing.assert_array_equal(mesh.triangles, sphere.faces)
