"""Broken files of every kind of breakage end in a MeshError or a sound mesh, never otherwise."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesh_files.plain_files import FACES, FILES, POINTS

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes

every_file = pytest.mark.parametrize(("suffix", "data"), FILES.values(), ids=FILES)


def load_or_refuse(data, suffix):
    """Return the mesh, or None where it is refused; any other exception fails the test."""
    try:
        mesh = load_mesh_bytes(data, suffix)
    except MeshError:
        return None
    assert np.isfinite(mesh.vertices).all()
    assert mesh.triangles.min() >= 0
    assert mesh.triangles.max() < len(mesh.vertices)
    return mesh


@every_file
def test_the_whole_file_loads(suffix, data):
    mesh = load_or_refuse(data, suffix)

    assert mesh.vertices[mesh.triangles].tolist() == [[POINTS[i] for i in face] for face in FACES]


@every_file
def test_a_truncated_file_is_refused_or_a_prefix_of_the_mesh(suffix, data):
    for size in range(len(data)):
        mesh = load_or_refuse(data[:size], suffix)

        if mesh is not None:
            assert suffix in (".obj", ".off") or size == len(data) - 1 or data[:5] == b"solid"
            corners = mesh.vertices[mesh.triangles]
            whole = [[POINTS[i] for i in face] for face in FACES]
            assert corners.tolist() == whole[: len(corners)]


@every_file
@given(draw=st.data())
def test_a_file_with_bytes_changed_never_fails_otherwise(suffix, data, draw):
    changed = bytearray(data)
    for _ in range(draw.draw(st.integers(1, 4))):
        position = draw.draw(st.integers(0, len(changed) - 1))
        changed[position] = draw.draw(st.integers(0, 255))

    load_or_refuse(bytes(changed), suffix)


@every_file
@given(draw=st.data())
def test_a_file_with_a_piece_cut_out_or_repeated_never_fails_otherwise(suffix, data, draw):
    start = draw.draw(st.integers(0, len(data) - 1))
    end = draw.draw(st.integers(start, len(data)))
    times = draw.draw(st.sampled_from([0, 2]))

    load_or_refuse(data[:start] + data[start:end] * times + data[end:], suffix)


@every_file
@given(
    number=st.sampled_from([b"-1", b"4294967296", b"99999999999999999999", b"nan", b"1e999", b""])
)
def test_a_text_with_a_number_replaced_never_fails_otherwise(suffix, data, number):
    words = data.split(b" ")
    for place in range(0, len(words), max(1, len(words) // 25)):
        changed = b" ".join([*words[:place], number, *words[place + 1 :]])

        load_or_refuse(changed, suffix)


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".off", ".ply", ".glb", ".gltf"])
@given(data=st.binary(max_size=300))
def test_noise_is_refused(suffix, data):
    assert load_or_refuse(data, suffix) is None


@pytest.mark.parametrize(
    ("suffix", "data"),
    [
        (".obj", b"v 0 0 " + b"x" * 100_000),
        (".obj", b"v 0 0 0\nf " + b"1" * 100_000 + b" 1 1\n"),
        (".off", b"OFF\n" + b"1" * 100_000 + b" 1 1\n"),
        (".ply", b"ply\nformat ascii 1.0\nelement vertex " + b"1" * 100_000 + b"\nend_header\n"),
        (".ply", b"ply\nformat ascii 1.0\nelement " + b"x" * 100_000 + b" 1\nend_header\n"),
        (".stl", b"solid a\n" + b"x" * 100_000),
        (".stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 " + b"x" * 100_000),
        (".gltf", b'{"asset": {}, "' + b"x" * 100_000 + b'": '),
    ],
)
def test_error_shows_of_a_long_word_its_beginning(suffix, data):
    with pytest.raises(MeshError) as refused:
        load_mesh_bytes(data, suffix)

    assert len(str(refused.value)) < 400
