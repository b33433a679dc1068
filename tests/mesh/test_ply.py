"""PLY: ASCII and both binary orders, any properties, and headers that claim too much."""

from __future__ import annotations

import struct

import meshio
import numpy as np
import pytest
import trimesh

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

POINTS = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
HEADER = """ply
format {format} 1.0
comment made by hand
obj_info nothing
element vertex 4
property float x
property float y
property float z
element face {count}
property list uchar int vertex_indices
end_header
"""


def ascii_ply(*faces, header=HEADER, count=None):
    lines = [" ".join(map(str, row)) for row in POINTS]
    lines += [" ".join(map(str, [len(face), *face])) for face in faces]
    head = header.format(format="ascii", count=len(faces) if count is None else count)
    return (head + "\n".join(lines) + "\n").encode()


def binary_ply(*faces, order="<", header=HEADER, count=None, tail=b""):
    name = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = header.format(format=name, count=len(faces) if count is None else count).encode()
    body = b"".join(struct.pack(order + "3f", *row) for row in POINTS)
    body += b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)
    return head + body + tail


WRITERS = {
    "ascii": ascii_ply,
    "little": binary_ply,
    "big": lambda *faces, **rest: binary_ply(*faces, order=">", **rest),
}
every_kind = pytest.mark.parametrize("write", WRITERS.values(), ids=WRITERS)


@every_kind
def test_ply_loads_triangles(write):
    mesh = load_mesh_bytes(write((0, 1, 2), (2, 3, 0)), ".ply")

    assert mesh.vertices.tolist() == POINTS
    assert mesh.triangles.tolist() == [[0, 1, 2], [2, 3, 0]]


@every_kind
def test_ply_cuts_convex_polygons_into_fans_in_place(write):
    mesh = load_mesh_bytes(write((0, 1, 2), (0, 1, 2, 3), (3, 2, 1), (3, 2, 1, 0, 0)), ".ply")

    assert mesh.triangles.tolist() == [
        [0, 1, 2],
        [0, 1, 2],
        [0, 2, 3],
        [3, 2, 1],
        [3, 2, 1],
        [3, 1, 0],
        [3, 0, 0],
    ]


@every_kind
def test_ply_cuts_equal_quads_into_fans_in_place(write):
    mesh = load_mesh_bytes(write((0, 1, 2, 3), (3, 2, 1, 0)), ".ply")

    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3], [3, 2, 1], [3, 1, 0]]


def test_ply_passes_over_other_elements_and_properties():
    data = b"""ply
format ascii 1.0
element tag 2
property list uchar float values
element vertex 3
property uchar red
property double z
property double y
property double x
element face 1
property uchar flag
property list uchar uint vertex_index
property list uchar float texcoord
element edge 1
property int vertex1
property int vertex2
end_header
2 0.5 0.5
0
255 3 2 1
255 6 5 4
255 9 8 8

7 3 0 1 2 2 0.25 0.75
0 1
"""
    mesh = load_mesh_bytes(data, ".ply")

    assert mesh.vertices.tolist() == [[1, 2, 3], [4, 5, 6], [8, 8, 9]]
    assert mesh.triangles.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("order", ["<", ">"])
def test_ply_reads_binary_elements_with_several_lists(order):
    name = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = f"""ply\r
format {name} 1.0\r
element face 2\r
property list ushort short vertex_indices\r
property double weight\r
property list uchar char other\r
element vertex 4\r
property double x\r
property double y\r
property double z\r
property int id\r
end_header\r
""".encode()
    body = struct.pack(order + "H3hdB", 3, 0, 1, 2, 1.0, 0)
    body += struct.pack(order + "H4hdB2b", 4, 0, 1, 2, 3, 1.0, 2, 5, 6)
    body += b"".join(struct.pack(order + "3di", *row, 9) for row in POINTS)

    mesh = load_mesh_bytes(head + body, ".ply")

    assert mesh.vertices.tolist() == POINTS
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3]]


def test_ply_rounds_ascii_to_the_type_declared_as_binary_would_be():
    data = ascii_ply((0, 1, 2)).replace(b"\n1 0 0\n", b"\n0.1 0 0\n")

    mesh = load_mesh_bytes(data, ".ply")

    assert mesh.vertices[1, 0] == float(np.float32(0.1))


@pytest.mark.parametrize("end", [b"\r\n", b"\r"])
def test_ply_takes_any_line_ends(end):
    data = ascii_ply((0, 1, 2)).replace(b"\n", end)

    assert load_mesh_bytes(data, ".ply").triangles.tolist() == [[0, 1, 2]]


@every_kind
@pytest.mark.parametrize("bad", [4, -1, 2**31 - 1])
def test_ply_refuses_indices_out_of_range(write, bad):
    data = write((0, 1, 2), (0, 1, 2, 3), (2, bad, 0))

    with pytest.raises(MeshError, match=rf"face 2: uses vertex {bad} of 4; indices start at 0"):
        load_mesh_bytes(data, ".ply")


@every_kind
def test_ply_refuses_faces_of_two_vertices(write):
    with pytest.raises(MeshError, match="face 1: has 2 vertices, at least 3"):
        load_mesh_bytes(write((0, 1, 2), (0, 1)), ".ply")


@every_kind
@pytest.mark.parametrize("count", [3, 4_000_000_000, 10**30])
def test_ply_refuses_counts_that_do_not_fit_the_file(write, count):
    data = write((0, 1, 2), (0, 1, 2), count=count)

    with pytest.raises(MeshError, match=r"ends inside face|take at least|claims \d+ rows, but"):
        load_mesh_bytes(data, ".ply")


@every_kind
def test_ply_refuses_more_contents_than_claimed(write):
    data = write((0, 1, 2), (0, 1, 2), count=1)

    with pytest.raises(MeshError, match=r"13 bytes follow|<stdin>:17: .*more follow"):
        load_mesh_bytes(data, ".ply")


@pytest.mark.parametrize("count", [-3, -1])
def test_ply_refuses_negative_counts(count):
    for element in ("face", "vertex"):
        data = ascii_ply((0, 1, 2)).replace(
            f"element {element} {1 if element == 'face' else 4}".encode(),
            f"element {element} {count}".encode(),
        )
        with pytest.raises(MeshError, match=rf"element {element} has the negative count {count}"):
            load_mesh_bytes(data, ".ply")


def test_ply_refuses_a_negative_list_length():
    data = ascii_ply((0, 1, 2)).replace(b"3 0 1 2", b"-3 0 1 2")
    signed = HEADER.replace("list uchar", "list char")
    binary = binary_ply((0, 1, 2), header=signed)

    with pytest.raises(MeshError, match=r"<stdin>:16: list length -3 is negative"):
        load_mesh_bytes(data, ".ply")
    with pytest.raises(MeshError, match=r"face 0: list length -1 is negative"):
        load_mesh_bytes(binary[:-13] + b"\xff" + binary[-12:], ".ply")


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (b"0.0 0 0", b"nan 0 0", r":12: coordinate is nan"),
        (b"1 1 0", b"1 1e999 0", r":14: coordinate is 1e999"),
        (b"1 1 0", b"1 1 a", r":14: 'a' is not a number"),
        (b"1 1 0", b"1 1", r":14: 2 words are not what a row of element vertex holds"),
        (b"1 1 0", b"1 1 0 0", r":14: 4 words are not what a row of element vertex holds"),
        (b"3 0 1 2", b"3 0 1", r":16: 3 words are not what a row of element face holds"),
        (b"3 0 1 2", b"3 0 1 1.5", r":16: vertex_indices '1.5' is not a whole number"),
        (b"3 0 1 2", b"3 0 1 99999999999999999999", r"does not fit its type"),
        (b"ply\n", b"plyx\n", r":1: does not begin with a line 'ply'"),
        (b"format ascii 1.0\n", b"", r":2: expected a line 'format' first|:4: expected"),
        (b"format ascii", b"format morse", r":2: unknown format"),
        (b"property float z", b"property quad z", r":8: expected 'property"),
        (b"property float z", b"property float y", r":8: property y is declared twice"),
        (b"property float z\n", b"", r"words are not what a row|has no element vertex"),
        (b"element face", b"element vertex", r":9: element vertex is declared twice"),
        (b"element face 1", b"element face", r":9: expected 'element NAME COUNT'"),
        (b"element face 1", b"element face many", r":9: count 'many' is not a whole number"),
        (b"comment", b"commend", r":3: 'commend' is out of place"),
        (b"list uchar int", b"list float int", r":10: a list's length must be of a whole type"),
        (b"list uchar int", b"list uchar float", r"are not of a whole type"),
        (b"vertex_indices", b"corners", r"has no faces: element face has no list vertex_indices"),
        (b"element face", b"element range_grid", r"element range_grid lists vertices, and is not"),
        (b"end_header\n", b"", r"is out of place|does not end"),
    ],
)
def test_ply_refuses_what_is_wrong_and_names_the_line(old, new, fault):
    data = ascii_ply((0, 1, 2))
    assert old in data

    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(data.replace(old, new, 1), ".ply")


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_ply_refuses_binary_coordinates_that_are_not_finite(bad):
    data = bytearray(binary_ply((0, 1, 2)))
    start = data.index(b"end_header\n") + len(b"end_header\n")
    data[start + 16 : start + 20] = struct.pack("<f", bad)

    with pytest.raises(MeshError, match=rf"vertex 1: y is {bad}"):
        load_mesh_bytes(bytes(data), ".ply")


def test_ply_refuses_a_float_too_large_for_its_type():
    with pytest.raises(MeshError, match="vertex 0: x is inf"):
        load_mesh_bytes(ascii_ply((0, 1, 2)).replace(b"0.0 0 0", b"1e39 0 0"), ".ply")


@every_kind
def test_ply_refuses_every_truncation_but_that_of_the_last_line_end(write):
    data = write((0, 1, 2), (0, 1, 2, 3))

    for size in range(1, len(data) - 1):
        with pytest.raises(MeshError):
            load_mesh_bytes(data[:size], ".ply")


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_ply_agrees_with_trimesh_on_a_file_it_wrote(tmp_path, encoding):
    path = tmp_path / "sphere.ply"
    sphere = trimesh.creation.icosphere(subdivisions=2)
    sphere.vertex_normals = sphere.vertices  # to find them, trimesh would need SciPy
    sphere.export(path, encoding=encoding, vertex_normal=True)

    mesh = load_mesh(path)

    np.testing.assert_array_equal(mesh.vertices, trimesh.load(path, process=False).vertices)
    np.testing.assert_array_equal(mesh.triangles, sphere.faces)


@pytest.mark.parametrize("binary", [True, False])
def test_ply_agrees_with_meshio_on_a_file_it_wrote(tmp_path, binary):
    path = tmp_path / "sphere.ply"
    sphere = trimesh.creation.icosphere(subdivisions=1)
    cells = [("triangle", np.array(sphere.faces, dtype=np.int32))]
    meshio.Mesh(sphere.vertices, cells).write(path, binary=binary)

    mesh = load_mesh(path)

    np.testing.assert_array_equal(mesh.vertices, sphere.vertices)
    np.testing.assert_array_equal(mesh.triangles, sphere.faces)
