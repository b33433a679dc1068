"""Files whose faces differ in corners: taken at once they are what they are taken one by one."""

from __future__ import annotations

import struct

import pytest

from obbcli import MeshError
from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats.obj import reader as obj_reader
from obbcli.mesh.formats.off import reader as off_reader
from obbcli.mesh.formats.ply import body as ply_body

POINTS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 2, 0), (-1, 0.5, 0)]
FACES = [(0, 1, 2, 3), (2, 3, 4), (0, 1, 2, 4, 3), (0, 3, 5), (3, 2, 1, 0)]
LINES = "\n".join(" ".join(map(str, point)) for point in POINTS)
OBJ = "".join(f"v {line}\n" for line in LINES.split("\n")) + "".join(
    f"f {' '.join(f'{corner + 1}/1' for corner in face)}\n" for face in FACES
)
ROWS = "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in FACES)
OFF = f"OFF\n6 5 0\n{LINES}\n{ROWS}"
HEAD = (
    "ply\nformat {} 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
    "property double z\nelement face 5\nproperty list {} {} vertex_indices\nend_header\n"
)
PLY = HEAD.format("ascii", "uchar", "int") + LINES + "\n" + ROWS
FANS = [(face[0], face[k], face[k + 1]) for face in FACES for k in range(1, len(face) - 1)]
TEXTS = {".obj": OBJ, ".off": OFF, ".ply": PLY}
#: What words may become, in the last face and in others.
WORDS = ["9", "-1", "-9", "0", "1_0", "+1", "1.0", "x", "1 2", "", "1/2/3", "/", "2 # 3", "\u0661"]


def binary(count_code="B", index_code="i", order="<", faces=FACES):
    names = {"B": "uchar", "b": "char", "i": "int", "H": "ushort", "h": "short", "q": "int64"}
    encoding = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = HEAD.format(encoding, names[count_code], names[index_code]).encode()
    points = b"".join(struct.pack(f"{order}3d", *point) for point in POINTS)
    rows = [struct.pack(f"{order}{count_code}", len(face)) for face in faces]
    rows = [
        n + struct.pack(f"{order}{len(f)}{index_code}", *f)
        for n, f in zip(rows, faces, strict=True)
    ]
    return head + points + b"".join(rows)


def outcome(data, suffix):
    try:
        found = load_mesh_bytes(data, suffix)
    except MeshError as fault:
        return str(fault)
    return found.vertices.tobytes(), found.triangles.tolist(), found.notes


@pytest.fixture
def one_by_one(monkeypatch):
    """Return a function that lets readers take faces one by one from now on."""

    def let():
        monkeypatch.setattr(obj_reader, "_read_regular", lambda _: None)
        monkeypatch.setattr(off_reader, "counted_rows", lambda _: None)
        monkeypatch.setattr(ply_body, "counted_rows", lambda _: None)
        monkeypatch.setattr(ply_body, "short_lists", lambda *_: None)

    return let


@pytest.mark.parametrize("suffix", TEXTS)
def test_faces_of_all_kinds_are_cut_in_their_order(suffix):
    found = load_mesh_bytes(TEXTS[suffix].encode(), suffix)

    assert found.vertices.tolist() == [list(map(float, point)) for point in POINTS]
    assert found.triangles.tolist() == [list(row) for row in FANS]


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("count_code", ["B", "b", "i"])
@pytest.mark.parametrize("index_code", ["B", "i", "H"])
def test_faces_of_a_binary_file_are_cut_in_their_order(order, count_code, index_code):
    found = load_mesh_bytes(binary(count_code, index_code, order), ".ply")

    assert found.triangles.tolist() == [list(row) for row in FANS]


@pytest.mark.parametrize("word", WORDS)
@pytest.mark.parametrize("suffix", TEXTS)
def test_odd_words_in_faces_mean_what_they_mean_one_by_one(one_by_one, suffix, word):
    lines = TEXTS[suffix].splitlines()
    texts = []
    for row in range(len(lines) - len(FACES), len(lines)):
        for column in range(len(lines[row].split())):
            words = lines[row].split()
            words[column] = word
            texts.append("\n".join([*lines[:row], " ".join(words), *lines[row + 1 :]]).encode())

    found = [outcome(text, suffix) for text in texts]
    one_by_one()

    assert found == [outcome(text, suffix) for text in texts]


@pytest.mark.parametrize("count_code", ["B", "b"])
def test_damaged_binary_faces_are_what_they_are_one_by_one(one_by_one, count_code):
    whole = binary(count_code, "H")
    start = len(whole) - sum(1 + 2 * len(face) for face in FACES)
    cases = [whole[:end] for end in range(start, len(whole))] + [whole + b"\1"]
    for place in range(start, len(whole)):
        for value in (0, 1, 3, 127, 128, 255):
            changed = bytearray(whole)
            changed[place] = value
            cases.append(bytes(changed))

    found = [outcome(data, ".ply") for data in cases]
    one_by_one()

    assert found == [outcome(data, ".ply") for data in cases]
