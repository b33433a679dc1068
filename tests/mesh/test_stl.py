"""STL, binary and ASCII: odd but valid files load, and every lie of a header is named in bytes."""

from __future__ import annotations

import os
import struct
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes
from obbcli.mesh.formats import stl as stl_module

FIRST = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]
SECOND = [[0.0, 0, 1], [1, 0, 1], [0, 2, 1]]
ASCII = b"""solid part
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid part
"""


def binary_stl(*facets, header=b"", count=None, tail=b""):
    records = b"".join(struct.pack("<12fH", 0, 0, 0, *np.ravel(facet), 0xFFFF) for facet in facets)
    claimed = len(facets) if count is None else count
    return header.ljust(80, b"\0") + struct.pack("<I", claimed) + records + tail


@pytest.mark.parametrize("header", [b"", b"solid part", b"solid facet normal", b" SOLID\n"])
def test_binary_stl_loads_whatever_its_header_says(header):
    mesh = load_mesh_bytes(binary_stl(FIRST, SECOND, header=header), ".stl")

    assert mesh.vertices.tolist() == FIRST + SECOND
    assert mesh.triangles.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_binary_stl_keeps_the_float32_values_exactly():
    value = float(np.float32(0.1))

    mesh = load_mesh_bytes(binary_stl([[value, 0, 0], [1e38, 0, 0], [0, 1e-45, 0]]), ".stl")

    assert mesh.vertices[0, 0] == value
    assert mesh.vertices[1, 0] == float(np.float32(1e38))
    assert mesh.vertices[2, 1] == float(np.float32(1e-45))


@pytest.mark.parametrize("count", [1, 2, 3, 6, 7])
def test_binary_stl_file_reads_the_same_piece_by_piece_and_whole(tmp_path, monkeypatch, count):
    monkeypatch.setattr(stl_module, "_RECORDS_A_PIECE", 3)
    facets = np.random.default_rng(count).normal(size=(count, 3, 3)).astype(np.float32)
    path = tmp_path / "part.stl"
    path.write_bytes(binary_stl(*facets))

    pieces, whole = load_mesh(path, hashed=False), load_mesh(path)

    assert pieces.vertices.tolist() == whole.vertices.tolist() == facets.reshape(-1, 3).tolist()
    assert pieces.triangles.tolist() == whole.triangles.tolist()
    assert (pieces.source, pieces.sha256) == ("part.stl", None)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"solid",
        bytes(84),
        ASCII,
        binary_stl(FIRST, count=2),
        binary_stl(FIRST, tail=b"\n"),
        binary_stl(FIRST, [[0.0, 0, float("nan")], *SECOND[1:]]),
        bytes(80) + struct.pack("<I12IH", 1, *[0x7FA00000] * 12, 0),
    ],
)
def test_stl_files_say_the_same_hashed_or_not(tmp_path, data):
    path = tmp_path / "part.stl"
    path.write_bytes(data)

    def said(**options):
        try:
            return load_mesh(path, **options).vertices.tolist()
        except MeshError as fault:
            return str(fault)

    assert said(hashed=False) == said(hashed=True)


def test_binary_stl_file_that_shrinks_while_it_is_read_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "part.stl"
    path.write_bytes(binary_stl(FIRST, SECOND, count=3))
    whole = os.stat_result((0o100644, 0, 0, 1, 0, 0, 84 + 3 * 50, 0, 0, 0))
    monkeypatch.setattr(stl_module, "os", SimpleNamespace(fstat=lambda _: whole))

    with pytest.raises(MeshError, match="the file has 184"):
        load_mesh(path, hashed=False)


def test_binary_stl_ignores_normals_that_are_not_finite():
    record = struct.pack("<12fH", *[float("nan")] * 3, *np.ravel(FIRST), 0)

    mesh = load_mesh_bytes(bytes(80) + struct.pack("<I", 1) + record, ".stl")

    assert mesh.vertices.tolist() == FIRST


@pytest.mark.parametrize(
    ("count", "size"),
    [(3, 234), (1, 134), (0, 84), (2 + 2**31, 107374182584), (2**32 - 1, 214748364834)],
)
def test_binary_stl_refuses_a_count_that_lies(count, size):
    data = binary_stl(FIRST, SECOND, count=count)

    with pytest.raises(MeshError, match=rf"byte 80: .*{count} triangles.*{size} bytes.*has 184"):
        load_mesh_bytes(data, ".stl")


@pytest.mark.parametrize("size", range(1, 184))
def test_binary_stl_refuses_every_truncation(size):
    data = binary_stl(FIRST, SECOND, header=b"solid x")[:size]

    # 84 bytes and a header are a mesh of no triangles only if they say so: these claim two.
    with pytest.raises(MeshError):
        load_mesh_bytes(data, ".stl")


@pytest.mark.parametrize("tail", [b"\0", b"\n", bytes(49), bytes(51), bytes(50)])
def test_binary_stl_refuses_trailing_bytes(tail):
    with pytest.raises(MeshError, match=r"takes 184 bytes, but the file has \d+ .*bytes after"):
        load_mesh_bytes(binary_stl(FIRST, SECOND, tail=tail), ".stl")


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf")])
def test_binary_stl_refuses_coordinates_that_are_not_finite(tmp_path, bad):
    path = tmp_path / "bad.stl"
    path.write_bytes(binary_stl(FIRST, [[0, 0, 0], [0, bad, 0], [0, 0, 1]]))

    with pytest.raises(MeshError, match=rf"{path}: vertex 4: y is {bad}; .*must be finite"):
        load_mesh(path)


def test_binary_stl_refuses_signalling_nans_without_a_warning():
    data = bytearray(binary_stl(FIRST))
    data[96:100] = struct.pack("<I", 0x7F800001)

    with pytest.raises(MeshError, match="vertex 0: x is nan"):
        load_mesh_bytes(bytes(data), ".stl")


def test_binary_stl_agrees_with_trimesh_on_a_file_it_wrote(tmp_path):
    path = tmp_path / "sphere.stl"
    sphere = trimesh.creation.icosphere(subdivisions=2)
    sphere.export(path)

    mesh = load_mesh(path)

    theirs = trimesh.load(path, process=False)
    np.testing.assert_array_equal(mesh.vertices[mesh.triangles], theirs.triangles)
    np.testing.assert_allclose(mesh.vertices[mesh.triangles], sphere.triangles, atol=1e-7)


def test_ascii_stl_loads():
    mesh = load_mesh_bytes(ASCII, ".stl")

    assert mesh.vertices.tolist() == FIRST
    assert mesh.triangles.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize(
    "data",
    [
        ASCII.upper(),
        ASCII.title(),
        ASCII.replace(b"\n", b"\r\n"),
        ASCII.replace(b"\n", b"\r"),
        ASCII.replace(b"\n", b"\n\n \t"),
        ASCII.replace(b" ", b"\t  "),
        b"\n  " + ASCII,
        b"\xef\xbb\xbf" + ASCII,
        ASCII.replace(b" part", b""),
        ASCII.replace(b"solid part", b"solid facet normal 1 2 3 vertex"),
        ASCII.replace(b"part", "pièce".encode("latin-1")),
        ASCII.replace(b"0 0 1", b"nan nan nan"),
        ASCII.replace(b"0 0 1", b"- - -"),
        ASCII.replace(b"vertex 1 0 0", b"vertex +1.0e0 -0 .0E+5"),
        ASCII.replace(b"\nvertex", b" vertex").replace(b"\nouter", b" outer"),
        ASCII.replace(b"vertex 0 1 0", b"vertex\n0\n1\n0"),
        ASCII.rstrip(),
    ],
)
def test_ascii_stl_loads_in_odd_case_and_spacing(data):
    mesh = load_mesh_bytes(data, ".stl")

    assert mesh.vertices.tolist() == FIRST


def test_ascii_stl_joins_several_solids_in_order():
    second = ASCII.replace(b"part", b"lid").replace(b"vertex 0 1 0", b"vertex 0 7 0")

    mesh = load_mesh_bytes(ASCII + b"\n" + second, ".stl")

    assert mesh.triangles.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert mesh.vertices[5].tolist() == [0, 7, 0]


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (b"vertex 1 0 0", b"vertex 1 nan 0", r"<stdin>:5: coordinate is nan"),
        (b"vertex 1 0 0", b"vertex 1 1e999 0", r"<stdin>:5: coordinate is 1e999"),
        (b"vertex 1 0 0", b"vertex 1 -inf 0", r"<stdin>:5: coordinate is -inf"),
        (b"vertex 1 0 0", b"vertex 1 zero 0", r"<stdin>:5: 'zero' is not a number"),
        (b"vertex 1 0 0", b"vertex 1_0 0 0", r"<stdin>:5: '1_0' is not a number"),
        (b"vertex 1 0 0", b"vertex 1,5 0 0", r"<stdin>:5: '1,5' is not a number"),
        (b"vertex 1 0 0\n", b"", r"<stdin>:6: found 'endloop', expected 'vertex'"),
        (b"vertex 1 0 0", b"vertex 1 0", r"<stdin>:6: 'vertex' is not a number"),
        (b"vertex 1 0 0", b"vertex 1 0 0 0", r"<stdin>:5: found '0', expected 'vertex'"),
        (b"endloop", b"vertex 1 1 0\nendloop", r"<stdin>:7: found 'vertex', expected 'endloop'"),
        (b"facet normal", b"facette normal", r"<stdin>:2: found 'facette', expected 'facet'"),
        (b"endsolid part\n", b"", r"<stdin>:8: the file ends inside a solid"),
        (b"endfacet\nendsolid part\n", b"", r"<stdin>:7: the file ends inside a solid"),
        (b"endsolid", b"ende", r"<stdin>:9: found 'ende', expected 'facet'"),
    ],
)  # fmt: skip
def test_ascii_stl_refuses_what_is_out_of_place_and_names_the_line(old, new, fault):
    assert old in ASCII

    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(ASCII.replace(old, new, 1), ".stl")


@pytest.mark.parametrize("size", range(1, len(ASCII) - len("endsolid part\n")))
def test_ascii_stl_refuses_truncation_before_its_last_line(size):
    with pytest.raises(MeshError):
        load_mesh_bytes(ASCII[:size], ".stl")


def test_ascii_stl_agrees_with_trimesh_on_a_file_it_wrote(tmp_path):
    path = tmp_path / "sphere.stl"
    sphere = trimesh.creation.icosphere(subdivisions=2)
    sphere.export(path, file_type="stl_ascii")

    mesh = load_mesh(path)

    np.testing.assert_array_equal(mesh.vertices[mesh.triangles], sphere.triangles)


def test_ascii_stl_reads_the_same_by_columns_and_word_by_word(tmp_path, monkeypatch):
    path = tmp_path / "sphere.stl"
    trimesh.creation.icosphere(subdivisions=1).export(path, file_type="stl_ascii")
    by_columns = load_mesh(path)

    monkeypatch.setattr(stl_module, "_read_regular", lambda _: None)
    word_by_word = load_mesh(path)

    np.testing.assert_array_equal(by_columns.vertices, word_by_word.vertices)
