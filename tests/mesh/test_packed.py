"""Meshes packed by gzip: read as their content, hashed as they lie there, and bounded."""

from __future__ import annotations

import gzip
import hashlib
import itertools
import os
import threading

import pytest
from mesh_files.cube_files import cube, stl
from mesh_files.packed_files import OBJ, SOLID, placed, same

from obbcli import load_parts
from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

PLY = (
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    b"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
)
NAMED_PARTS = b"o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nf 1 3 2\n"
CONTENTS = {"a.stl": stl(cube()), "b.stl": SOLID, "c.ply": PLY, "d.obj": OBJ}


@pytest.mark.parametrize("hashed", [True, False])
@pytest.mark.parametrize("name", CONTENTS)
def test_packed_mesh_is_the_plain_one(tmp_path, name, hashed):
    data = CONTENTS[name]
    plain = load_mesh(placed(tmp_path, name, data))
    stored = gzip.compress(data, mtime=0)

    mesh = load_mesh(placed(tmp_path, f"{name}.gz", stored), hashed=hashed)

    assert same(mesh, plain)
    assert mesh.source == f"{name}.gz"
    assert mesh.sha256 == (hashlib.sha256(stored).hexdigest() if hashed else None)
    assert mesh.notes == ()


@pytest.mark.parametrize("name", ["m.STL.GZ", "m.gz", "m.obj.gz"])
def test_content_counts_before_the_name(tmp_path, name):
    mesh = load_mesh(placed(tmp_path, name, gzip.compress(stl(cube()), mtime=0)))

    assert len(mesh.triangles) == 12
    assert mesh.notes == (
        ("is a binary STL file by its content, and is read as such",) * (name != "m.STL.GZ")
    )


def test_packed_file_that_is_not_called_so_is_told_in_a_note(tmp_path):
    mesh = load_mesh(placed(tmp_path, "m.stl", gzip.compress(stl(cube()), mtime=0)), hashed=False)

    assert len(mesh.triangles) == 12
    assert mesh.notes == ("is packed by gzip by its content, and is read as such",)


def test_plain_file_that_is_called_packed_is_read(tmp_path):
    # So do browsers leave files that a server had packed for the way.
    assert len(load_mesh(placed(tmp_path, "m.obj.gz", OBJ)).triangles) == 12


def test_binary_stl_whose_title_begins_as_gzip_does_is_an_stl(tmp_path):
    data = b"\x1f\x8b\x08" + stl(cube())[3:]

    assert len(load_mesh(placed(tmp_path, "m.stl", data)).triangles) == 12


def test_members_of_a_packed_file_are_one_content(tmp_path):
    data = gzip.compress(OBJ[:100], mtime=0) + gzip.compress(OBJ[100:], mtime=0)

    assert len(load_mesh(placed(tmp_path, "m.obj.gz", data)).triangles) == 12


def flagged(flag, more):
    """Return a packed mesh whose header has a flag, and what the flag announces."""
    stored = bytearray(gzip.compress(OBJ, mtime=0))
    stored[3] |= flag
    return bytes(stored[:10]) + more + bytes(stored[10:])


EXTRA, NAME, COMMENT, HEADER_CHECK, RESERVED = 4, 8, 16, 2, 0x20
MEMBER, NOTHING = gzip.compress(OBJ, mtime=0), gzip.compress(b"", mtime=0)


@pytest.mark.parametrize(
    "data",
    [
        MEMBER + bytes(1000),
        MEMBER + bytes(7) + NOTHING + bytes(5 << 20),
        NOTHING * 5_000 + MEMBER + NOTHING,
        flagged(NAME, b"n" * (1 << 20) + b"\0"),
        flagged(COMMENT, b"a comment\0"),
        flagged(EXTRA, (60_000).to_bytes(2, "little") + bytes(60_000)),
        flagged(NAME | COMMENT, b"m.obj\0\xff\0"),
        gzip.compress(OBJ, 0, mtime=0),
    ],
    ids=["filled", "fillings", "empty members", "long name", "comment", "extra", "two", "stored"],
)
def test_whatever_gzip_allows_is_unpacked_as_gzip_does(data):
    assert same(load_mesh_bytes(data, ".obj"), load_mesh_bytes(OBJ, ".obj"))
    assert gzip.decompress(data) == OBJ


@pytest.mark.parametrize("size", [(1 << 20) - 1, 1 << 20, (1 << 20) + 1, 3 << 20])
def test_member_may_follow_one_that_unpacks_to_far_more(size):
    data = gzip.compress(b"#" * size + b"\n", mtime=0) + MEMBER

    assert same(load_mesh_bytes(data, ".obj"), load_mesh_bytes(OBJ, ".obj"))


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        (MEMBER + MEMBER[:-9], "ends too soon"),
        (MEMBER + b"\x1f\x8b", "ends too soon"),
        (flagged(NAME, b"")[:60], "ends too soon"),
        (MEMBER + b"\0xyz", "is damaged"),
        (flagged(HEADER_CHECK, b"zz"), "is damaged"),
        (flagged(RESERVED, b""), "is damaged"),
        (MEMBER[:2] + b"\x07" + MEMBER[3:], "is damaged"),
        (MEMBER[:-4] + b"\0\0\0\0", "is damaged"),
    ],
)
def test_members_that_are_not_whole_and_what_is_no_member_are_refused(data, fault):
    with pytest.raises(MeshError, match=f"is a gzip file that {fault}"):
        load_mesh_bytes(data, ".obj")


def test_members_of_any_size_are_put_together():
    """The bounds of pieces lie anywhere in the packed and in the unpacked text."""
    numbers = "".join(f"v {k} {k * k % 97} {k % 89}\n" for k in range(150_000)).encode()
    text = numbers + b"f 1 2 3\n"
    assert len(text) > 1 << 21
    cuts = [0, 1, 700, 1 << 16, 1 << 20, (1 << 20) + 1, len(text)]
    members = [gzip.compress(text[a:b], mtime=0) for a, b in itertools.pairwise(cuts)]

    mesh = load_mesh_bytes(b"".join(members), ".obj")

    assert len(mesh.vertices) == 150_000
    assert mesh.vertices[-1].tolist() == [149_999, 149_999**2 % 97, 149_999 % 89]


def test_packed_bytes_of_a_stream_are_read():
    stored = gzip.compress(OBJ, mtime=0)

    mesh = load_mesh_bytes(stored)

    assert len(mesh.triangles) == 12
    assert mesh.sha256 == hashlib.sha256(stored).hexdigest()


def test_pipe_with_a_packed_mesh_is_read(tmp_path):
    path = tmp_path / "m.obj.gz"
    os.mkfifo(path)
    writer = threading.Thread(target=path.write_bytes, args=(gzip.compress(OBJ, mtime=0),))
    writer.start()

    mesh = load_mesh(path)
    writer.join()

    assert len(mesh.triangles) == 12


def test_parts_of_a_packed_mesh_are_its_parts(tmp_path):
    stored = gzip.compress(NAMED_PARTS, mtime=0)
    path = placed(tmp_path, "m.obj.gz", stored)

    assembly = load_parts(path)

    assert [part.path for part in assembly.parts] == ["a", "b"]
    assert assembly.sha256 == hashlib.sha256(stored).hexdigest()
    assert load_mesh(f"{path}#b").triangles.tolist() == [[0, 2, 1]]
