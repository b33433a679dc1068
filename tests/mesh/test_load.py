"""`load_mesh` as a whole: suffixes, files that are none, digests, and what stays unimported."""

from __future__ import annotations

import hashlib
import io
import os
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from obbcli.errors import MeshError
from obbcli.mesh import known_suffixes, load_mesh, load_mesh_bytes, read_stream

OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def test_load_mesh_takes_str_and_path_and_suffixes_in_any_case(tmp_path):
    path = tmp_path / "part.OBJ"
    path.write_bytes(OBJ)

    for form in (path, str(path)):
        assert load_mesh(form).triangles.tolist() == [[0, 1, 2]]


def test_load_mesh_names_the_file_and_hashes_the_bytes_it_read(tmp_path):
    path = tmp_path / "part.obj"
    path.write_bytes(OBJ)

    mesh = load_mesh(path)

    assert mesh.source == "part.obj"
    assert mesh.sha256 == hashlib.sha256(OBJ).hexdigest()


def test_stream_that_does_not_end_is_refused(monkeypatch):
    room = 3 << 20
    monkeypatch.setattr("os.sysconf", {"SC_PHYS_PAGES": room, "SC_PAGE_SIZE": 4}.get)

    assert len(read_stream(io.BytesIO(bytes(room)), "<stdin>")) == room
    with (
        open("/dev/zero", "rb") as endless,  # noqa: PTH123  # a device
        pytest.raises(MeshError, match="<stdin>: goes on after a quarter of this machine's memory"),
    ):
        read_stream(endless, "<stdin>")


def test_load_mesh_hashes_where_no_thread_is_to_be_had(tmp_path, monkeypatch):
    data = b"\0" * 80 + struct.pack("<I", 30000) + bytes(50 * 30000)
    (tmp_path / "flat.stl").write_bytes(data)

    def refuse(_thread):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr("threading.Thread.start", refuse)

    assert load_mesh(tmp_path / "flat.stl").sha256 == hashlib.sha256(data).hexdigest()


def test_load_mesh_hashes_large_files_right(tmp_path):
    data = b"\0" * 80 + struct.pack("<I", 30000) + bytes(50 * 30000)
    path = tmp_path / "zeros.stl"
    path.write_bytes(data)

    assert load_mesh(path).sha256 == hashlib.sha256(data).hexdigest()
    assert load_mesh(path, hashed=False).sha256 is None


def test_load_mesh_bytes_reads_what_a_file_would_hold():
    mesh = load_mesh_bytes(OBJ, ".obj")

    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert mesh.source == "<stdin>"
    assert mesh.sha256 == hashlib.sha256(OBJ).hexdigest()


def test_load_mesh_bytes_gives_libraries_a_file_of_their_own():
    data = b"""# vtk DataFile Version 4.2
made by hand
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 3 double
0 0 0 1 0 0 0 1 0
CELLS 1 4
3 0 1 2
CELL_TYPES 1
5
"""

    assert load_mesh_bytes(data, ".vtk").triangles.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize(
    "data",
    [
        b"solid".ljust(80) + struct.pack("<I", 1) + bytes(50),
        b"OFF\n3 1 0\n0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n",
        b"SOLID x\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 0 0 0 vertex 0 0 0\n"
        b"endloop endfacet\nendsolid x\n",
    ],
)
def test_load_mesh_bytes_without_a_suffix_goes_by_the_beginning(data):
    assert load_mesh_bytes(data).triangles.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        (b"1 2 3\n", "<stdin>: does not begin as any known format does; put it into a file"),
        (b"PK\x03\x04", "<stdin>: is a zip archive, not a mesh; unpack it"),
        (b"", "<stdin>: is empty"),
    ],
)
def test_load_mesh_bytes_without_a_suffix_refuses_what_does_not_say(data, fault):
    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(data)


@pytest.mark.parametrize("name", ["none.stl", "none", "none.xyz"])
def test_load_mesh_refuses_a_missing_file(tmp_path, name):
    with pytest.raises(MeshError, match=f"{name}: no such file") as caught:
        load_mesh(tmp_path / name)

    assert isinstance(caught.value.__cause__, FileNotFoundError)


@pytest.mark.parametrize("name", ["folder.stl", "folder"])
def test_load_mesh_refuses_a_directory(tmp_path, name):
    (tmp_path / name).mkdir()

    with pytest.raises(MeshError, match=f"{name}: is a directory"):
        load_mesh(tmp_path / name)


def test_load_mesh_refuses_a_device(tmp_path):
    path = tmp_path / "endless.stl"
    path.symlink_to("/dev/zero")

    with pytest.raises(MeshError, match="is a device or socket"):
        load_mesh(path)


def test_load_mesh_reads_a_named_pipe(tmp_path):
    path = tmp_path / "pipe.obj"
    os.mkfifo(path)
    writer = subprocess.Popen(
        [sys.executable, "-c", f"open({str(path)!r}, 'wb').write({OBJ!r})"],
    )

    mesh = load_mesh(path)

    assert writer.wait() == 0
    assert mesh.triangles.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("suffix", known_suffixes())
def test_load_mesh_refuses_an_empty_file(tmp_path, suffix):
    path = tmp_path / f"empty{suffix}"
    path.write_bytes(b"")

    with pytest.raises(MeshError, match="is empty"):
        load_mesh(path)


@pytest.mark.parametrize(
    "name", ["model.iges", "model", "model.stl.zip", "model.x3d", "model.obbt"]
)
def test_load_mesh_refuses_an_unknown_suffix_and_lists_the_known_ones(tmp_path, name):
    (tmp_path / name).write_bytes(OBJ)

    with pytest.raises(MeshError, match=r"suffix.*known are .*\.glb.*\.obj.*\.stl.*\.vtk"):
        load_mesh(tmp_path / name)


def test_load_mesh_refuses_a_file_it_may_not_read(tmp_path, monkeypatch):
    path = tmp_path / "secret.stl"
    path.write_bytes(b"x")

    def denied(self):
        raise PermissionError(13, "Permission denied", str(self))

    # The tests may run as root, who may read everything.
    monkeypatch.setattr(Path, "read_bytes", denied)
    with pytest.raises(MeshError, match=r"permission denied.*chmod \+r") as caught:
        load_mesh(path)

    assert isinstance(caught.value.__cause__, PermissionError)


def test_load_mesh_reports_a_failing_disk(tmp_path, monkeypatch):
    path = tmp_path / "bad.stl"
    path.write_bytes(b"x")

    def failing(self):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(Path, "read_bytes", failing)
    with pytest.raises(MeshError, match="cannot be read: Input/output error"):
        load_mesh(path)


@pytest.mark.parametrize("path", ["a\0b.stl", "x" * 5000 + ".stl"])
def test_load_mesh_refuses_impossible_paths(path):
    with pytest.raises(MeshError, match="cannot be read"):
        load_mesh(path)


@pytest.mark.parametrize(
    ("suffix", "data", "guess"),
    [
        (".stl", b"ply\nformat ascii 1.0\nend_header\n", r"a PLY file \(\.ply\)"),
        (
            ".stl",
            OBJ,
            "no STL: found 'v', expected 'solid'; the file looks like an OBJ",
        ),
        (".ply", b"solid x\nendsolid x\n", r"an ASCII STL file \(\.stl\)"),
        (".obj", b"OFF\n3 1 0\n", r"an OFF file \(\.off\)"),
        (".off", b"glTF\2\0\0\0", r"a GLB file \(\.glb\)"),
        (".glb", b"# vtk DataFile Version 4.2\n", r"a VTK file \(\.vtk\)"),
        (".vtk", b"$MeshFormat\n4.1 0 8\n", r"a Gmsh file \(\.msh\)"),
        (".msh", b"<VTKFile type=", r"a VTK XML file \(\.vtu\)"),
        (".stl", b"PK\x03\x04" + bytes(200), "is a zip archive, not a mesh; unpack it"),
        (".vtu", b"\x1f\x8b\x08" + bytes(200), "is a gzip file that is damaged"),
        (".inp", b"ISO-10303-21;\n", "a STEP file"),
    ],
)
def test_load_mesh_says_what_a_file_with_the_wrong_suffix_looks_like(suffix, data, guess):
    with pytest.raises(MeshError, match=guess):
        load_mesh_bytes(data, suffix)


@pytest.mark.parametrize("suffix", known_suffixes())
@pytest.mark.parametrize("data", [b"\n", b"\0" * 100, b"hello world\n", bytes(range(256))])
def test_load_mesh_refuses_contents_of_no_format(suffix, data):
    with pytest.raises(MeshError):
        load_mesh_bytes(data, suffix)


@pytest.mark.parametrize(
    ("suffix", "data"),
    [
        (".stl", b"solid empty\nendsolid empty\n"),
        (".stl", bytes(84)),
        (".obj", b"v 0 0 0\nv 1 0 0\nl 1 2\n"),
        (".off", b"OFF\n1 0 0\n0 0 0\n"),
        (".ply", b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
         b"property float z\nend_header\n0 0 0\n"),
        (".gltf", b'{"asset": {"version": "2.0"}}'),
        (".vtk", b"# vtk DataFile Version 4.2\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
         b"POINTS 2 float\n0 0 0 1 0 0\nCELLS 1 3\n2 0 1\nCELL_TYPES 1\n3\n"),
    ],
)  # fmt: skip
def test_load_mesh_refuses_a_file_without_faces(suffix, data):
    with pytest.raises(MeshError, match="has no faces"):
        load_mesh_bytes(data, suffix)


def test_load_mesh_of_own_formats_imports_no_library(tmp_path):
    (tmp_path / "a.stl").write_bytes(bytes(80) + struct.pack("<I", 1) + bytes(50))
    (tmp_path / "a.obj").write_bytes(OBJ)
    code = (
        "import sys; from obbcli.mesh import load_mesh; "
        f"load_mesh({str(tmp_path / 'a.stl')!r}); load_mesh({str(tmp_path / 'a.obj')!r}); "
        "print([m for m in ('trimesh', 'meshio', 'scipy', 'rich') if m in sys.modules])"
    )

    root = Path(__file__).parents[2]
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=root, check=True
    )

    assert result.stdout.strip() == "[]"


def test_load_mesh_gives_read_only_arrays_of_the_promised_types():
    mesh = load_mesh_bytes(OBJ, ".obj")

    assert mesh.vertices.dtype == np.float64
    assert mesh.triangles.dtype == np.int32
    assert mesh.vertices.flags.c_contiguous
    assert mesh.triangles.flags.c_contiguous
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0, 0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        mesh.triangles[0, 0] = 1
