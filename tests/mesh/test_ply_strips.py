"""PLY: triangle strips, as Stanford's scans come. VTK and trimesh read none of it."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes

POINTS = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]


def strips(*rows, kind="int", order="ascii", faces=()):
    """Return a file of strips, with faces before them where there are some."""
    code = {"int": "i", "uint": "I", "short": "h", "ushort": "H", "char": "b"}[kind]
    head = f"ply\nformat {order} 1.0\nelement vertex 4\n"
    head += "".join(f"property float {axis}\n" for axis in "xyz")
    if faces:
        head += f"element face {len(faces)}\nproperty list int int vertex_indices\n"
    head += f"element tristrips {len(rows)}\nproperty list int {kind} vertex_indices\nend_header\n"
    if order == "ascii":
        lists = [" ".join(map(str, row)) for row in POINTS]
        lists += [" ".join(map(str, [len(row), *row])) for row in [*faces, *rows]]
        return (head + "\n".join(lists) + "\n").encode()
    sign = "<" if "little" in order else ">"
    body = struct.pack(f"{sign}12f", *np.ravel(POINTS))
    for row in faces:
        body += struct.pack(f"{sign}{len(row) + 1}i", len(row), *row)
    for row in rows:
        body += struct.pack(f"{sign}i{len(row)}{code}", len(row), *row)
    return head.encode() + body


ORDERS = ["ascii", "binary_little_endian", "binary_big_endian"]


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(
    ("rows", "triangles"),
    [
        ([[0, 1, 2]], [[0, 1, 2]]),
        ([[0, 1, 2, 3]], [[0, 1, 2], [2, 1, 3]]),
        ([[0, 1, 2, 3, 0]], [[0, 1, 2], [2, 1, 3], [2, 3, 0]]),
        # A mark begins anew, also what is turned over.
        ([[0, 1, 2, 3, -1, 0, 3, 1, -1, 0, 2, 3]], [[0, 1, 2], [2, 1, 3], [0, 3, 1], [0, 2, 3]]),
        ([[0, 1, 2, -1, 3, 2, 1]], [[0, 1, 2], [3, 2, 1]]),
        # So does a row, also an odd one.
        ([[0, 1, 2, 3], [0, 3, 1]], [[0, 1, 2], [2, 1, 3], [0, 3, 1]]),
        ([[0, 1, 2], [3, 2, 1, 0], []], [[0, 1, 2], [3, 2, 1], [1, 2, 0]]),
        # Triangles that lead from one part to the next have rows as well.
        ([[0, 1, 2, 2, 3]], [[0, 1, 2], [2, 1, 2], [2, 2, 3]]),
        # What is too short has no triangle; marks may follow marks, begin and end.
        ([[-1, 0, 1, -1, -1, 0, 1, 2, -1]], [[0, 1, 2]]),
    ],
)
def test_ply_takes_strips_as_triangles(order, rows, triangles):
    mesh = load_mesh_bytes(strips(*rows, order=order), ".ply")

    assert mesh.triangles.tolist() == triangles
    assert mesh.vertices.tolist() == POINTS


@pytest.mark.parametrize("kind", ["uint", "ushort", "short", "char"])
def test_ply_takes_the_largest_of_unsigned_types_for_a_mark(kind):
    mark = {"uint": 2**32 - 1, "ushort": 2**16 - 1}.get(kind, -1)

    data = strips([0, 1, 2, mark, 3, 2, 1], kind=kind, order="binary_little_endian")

    assert load_mesh_bytes(data, ".ply").triangles.tolist() == [[0, 1, 2], [3, 2, 1]]


@pytest.mark.parametrize("order", ORDERS)
def test_ply_takes_faces_and_strips_in_the_files_order_and_says_so(order):
    data = strips([0, 1, 2, 3], [0, 3, 1], order=order, faces=[[3, 2, 1, 0]])

    mesh = load_mesh_bytes(data, ".ply")

    assert mesh.triangles.tolist()[2:] == [[0, 1, 2], [2, 1, 3], [0, 3, 1]]
    assert "2 strips taken as 3 triangles" in mesh.notes


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(
    ("rows", "fault"),
    [
        ([[0, 1, 4]], r"tristrips 0: uses vertex 4 of 4; indices start at 0, and -1 begins"),
        ([[0, 1, 2], [0, -2, 1]], r"tristrips 1: uses vertex -2 of 4"),
        ([[0, 1]], "has no faces"),
        ([[-1, -1, -1]], "has no faces"),
        ([], "has no faces"),
    ],
)
def test_ply_refuses_strips_of_no_vertices_or_no_triangles(order, rows, fault):
    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(strips(*rows, order=order), ".ply")


def test_ply_refuses_strips_that_are_cut_short():
    data = strips([0, 1, 2, 3, -1, 0, 3, 1], order="binary_big_endian")

    for size in range(data.index(b"end_header") + 12, len(data)):
        with pytest.raises(MeshError):
            load_mesh_bytes(data[:size], ".ply")


def by_definition(row):
    """Return a row's triangles one vertex after the other."""
    triangles, strip = [], []
    for index in row:
        strip = [] if index == -1 else [*strip, index]
        if len(strip) >= 3:
            a, b, c = strip[-3:]
            triangles.append([a, b, c] if len(strip) % 2 else [b, a, c])
    return triangles


@pytest.mark.parametrize("order", ORDERS)
def test_ply_takes_long_strips_as_their_definition_says(order):
    random = np.random.default_rng(3)
    rows = [
        [-1 if random.random() < 0.2 else int(i) for i in random.integers(0, 4, length)]
        for length in (0, 1, 200, 2, 57)
    ]

    mesh = load_mesh_bytes(strips(*rows, order=order), ".ply")

    assert mesh.triangles.tolist() == [triangle for row in rows for triangle in by_definition(row)]


@pytest.mark.parametrize("kind", ["int", "ushort"])
def test_ply_says_which_element_with_lists_it_does_not_know(kind):
    data = strips([0, 1, 2], faces=[[0, 1, 2]]).replace(b"element tristrips", b"element shards")
    known = data.replace(
        b"list int int vertex_indices\nend", b"list int %s of\nend" % kind.encode()
    )

    mesh = load_mesh_bytes(known, ".ply")

    assert mesh.triangles.tolist() == [[0, 1, 2]]
    assert mesh.notes == ("element shards is not known and was passed over",)
    with pytest.raises(MeshError, match="element shards lists vertices, and is not read"):
        load_mesh_bytes(data, ".ply")


def test_ply_says_nothing_of_elements_without_lists_of_vertices():
    data = strips([97, 98, 0], faces=[[0, 1, 2]]).replace(b"element tristrips", b"element label")
    data = data.replace(b"list int int vertex_indices\nend", b"list int uchar name\nend")

    assert load_mesh_bytes(data, ".ply").notes == ()
