"""What gzip packs that is no whole mesh: refused by name, and before it fills memory."""

from __future__ import annotations

import gzip
import io
import tarfile
import zlib

import pytest
from mesh_files.cube_files import cube, stl
from mesh_files.packed_files import OBJ, OFF, SOLID, placed, same

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes, packed


@pytest.mark.parametrize("cut", [3, 9, 10, 11, 40, -9, -8, -4, -1])
def test_packed_mesh_that_ends_too_soon_is_refused(tmp_path, cut):
    path = placed(tmp_path, "m.stl.gz", gzip.compress(stl(cube()), mtime=0)[:cut])

    with pytest.raises(MeshError) as fault:
        load_mesh(path)

    assert str(fault.value) == (
        f"{path}: is a gzip file that ends too soon; copy or download it again"
    )


def outcome(path):
    """Return the mesh in a file, or the error that refuses it."""
    try:
        return load_mesh(path)
    except MeshError as fault:
        return fault


def test_any_damaged_byte_of_a_packed_mesh_gives_the_mesh_or_one_error(tmp_path):
    stored = gzip.compress(SOLID, mtime=0)
    plain = load_mesh_bytes(SOLID, ".stl")
    found = []
    for place in range(len(stored)):
        damaged = bytearray(stored)
        damaged[place] ^= 0x5A
        found.append(outcome(placed(tmp_path, "m.stl.gz", damaged)))
    errors = [one for one in found if isinstance(one, MeshError)]
    told = {str(error) for error in errors}

    # What gzip's header says of time and system changes nothing.
    assert len(errors) >= len(stored) - 10
    assert all(same(mesh, plain) for mesh in found if not isinstance(mesh, MeshError))
    assert {line.partition(": ")[0].partition(":")[0] for line in told} == {
        str(tmp_path / "m.stl.gz")
    }
    assert not [line for line in told if "Error" in line or "\n" in line]


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        (
            gzip.compress(OBJ, mtime=0) + b"tail",
            "is a gzip file that is damaged; copy or download it again",
        ),
        (gzip.compress(b"", mtime=0), "is empty, expected a mesh"),
        (
            gzip.compress(OFF, mtime=0),
            "holds OFF, packed by gzip; read packed are STL, OBJ, PLY and STEP",
        ),
        (gzip.compress(gzip.compress(OBJ, mtime=0), mtime=0), "is a gzip archive, not a mesh"),
        (gzip.compress(b"<!DOCTYPE html><html>", mtime=0), "is a web page"),
    ],
)
@pytest.mark.parametrize("name", ["m.stl.gz", "m.gz"])
def test_packed_files_that_are_no_meshes_are_refused(tmp_path, name, data, fault):
    path = placed(tmp_path, name, data)

    with pytest.raises(MeshError) as told:
        load_mesh(path)

    assert str(told.value).startswith(f"{path}: {fault}")


def test_archive_of_many_files_is_told_by_its_beginning(tmp_path, monkeypatch):
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w:gz") as archive:
        member = tarfile.TarInfo("part.obj")
        member.size = len(OBJ)
        archive.addfile(member, io.BytesIO(OBJ))
    path = placed(tmp_path, "parts.tar.gz", stream.getvalue())
    monkeypatch.setattr(packed, "unpacked", None)  # it is not unpacked whole

    with pytest.raises(MeshError, match="is a tar archive, not a mesh"):
        load_mesh(path)


def bomb(size):
    """Return a gzip file of `size` spaces after a line of an OBJ file."""
    packer = zlib.compressobj(9, wbits=31)
    piece = b" " * (1 << 20)
    parts = [packer.compress(b"v 0 0 0")]
    parts += [packer.compress(piece) for _ in range(size >> 20)]
    return b"".join([*parts, packer.flush()])


def test_bombs_are_refused_before_they_fill_memory(tmp_path):
    data = bomb(65 << 20)
    path = placed(tmp_path, "m.obj.gz", data)

    with pytest.raises(MeshError) as fault:
        load_mesh(path)

    assert len(data) * 200 < 64 << 20
    assert str(fault.value) == (
        f"{path}: is a gzip file that unpacks to more than 67,108,864 bytes; "
        "unpack it first where you trust it: gunzip"
    )


def test_bound_on_unpacking_is_a_part_of_memory(tmp_path, monkeypatch):
    stored = gzip.compress(OBJ, mtime=0)
    path = placed(tmp_path, "m.obj.gz", stored)

    monkeypatch.setattr(packed, "most_bytes", lambda: len(OBJ))
    assert len(load_mesh(path).triangles) == 12

    monkeypatch.setattr(packed, "most_bytes", lambda: len(OBJ) - 1)
    with pytest.raises(MeshError, match=f"unpacks to more than {len(OBJ) - 1:,} bytes"):
        load_mesh(path)
