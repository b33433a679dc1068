"""glTF and GLB: document order, placed nodes, every triangle mode, and lengths that lie."""

from __future__ import annotations

import base64
import json
import struct

import numpy as np
import pytest
import trimesh
from mesh_files.gltf_files import DOCUMENT, INDICES, POSITIONS, SQUARE, document, load

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes


def test_glb_loads():
    mesh = load(DOCUMENT)

    assert mesh.vertices.tolist() == SQUARE
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_gltf_loads_with_data_in_the_document():
    uri = "data:application/octet-stream;base64," + base64.b64encode(POSITIONS + INDICES).decode()
    content = document(buffers=[{"byteLength": 60, "uri": uri}])

    mesh = load_mesh_bytes(json.dumps(content).encode(), ".gltf")

    assert mesh.vertices.tolist() == SQUARE


def test_gltf_loads_with_a_file_beside_it(tmp_path):
    (tmp_path / "all data.bin").write_bytes(POSITIONS + INDICES)
    content = document(buffers=[{"byteLength": 60, "uri": "all%20data.bin"}])
    path = tmp_path / "square.gltf"
    path.write_text(json.dumps(content))

    assert load_mesh(path).triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize("uri", ["../secret.bin", "/etc/hostname", "file:///etc/hostname"])
def test_gltf_reads_no_file_elsewhere(tmp_path, uri):
    path = tmp_path / "square.gltf"
    path.write_text(json.dumps(document(buffers=[{"byteLength": 1, "uri": uri}])))

    with pytest.raises(MeshError, match="is not a path beside the file"):
        load_mesh(path)


def test_gltf_refuses_a_missing_file_beside_it_and_any_beside_a_stream(tmp_path):
    content = json.dumps(document(buffers=[{"byteLength": 1, "uri": "gone.bin"}])).encode()
    path = tmp_path / "square.gltf"
    path.write_bytes(content)

    fault = r"buffers\[0\]: lies in the file 'gone\.bin', which cannot be read"
    with pytest.raises(MeshError, match=fault):
        load_mesh(path)
    with pytest.raises(MeshError, match="name the file instead of a stream"):
        load_mesh_bytes(content, ".gltf")


@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        (4, [[0, 1, 2], [0, 2, 3]]),
        (5, [[0, 1, 2], [1, 0, 2], [2, 0, 2], [0, 3, 2]]),
        (6, [[1, 2, 0], [2, 0, 0], [0, 2, 0], [2, 3, 0]]),
    ],
)
def test_glb_reads_lists_strips_and_fans(mode, expected):
    content = document()
    content["meshes"][0]["primitives"][0]["mode"] = mode

    assert load(content).triangles.tolist() == expected


def test_glb_reads_triangles_without_indices():
    content = document()
    del content["meshes"][0]["primitives"][0]["indices"]
    content["accessors"][0]["count"] = 3

    assert load(content).triangles.tolist() == [[0, 1, 2]]


def test_glb_leaves_out_points_and_lines():
    content = document()
    content["meshes"][0]["primitives"].insert(0, {"attributes": {"POSITION": 0}, "mode": 1})

    assert len(load(content).triangles) == 2


def test_glb_takes_nodes_depth_first_in_the_documents_order():
    nodes = [
        {"mesh": 0, "translation": [10, 0, 0], "children": [2, 3]},
        {"mesh": 0, "translation": [20, 0, 0]},
        {"mesh": 0, "translation": [1, 0, 0]},
        {"mesh": 0, "translation": [2, 0, 0]},
    ]

    mesh = load(document(nodes=nodes, scenes=[{"nodes": [0, 1]}]))

    firsts = mesh.vertices[mesh.triangles[::2, 0]]
    assert firsts.tolist() == [[10, 0, 0], [11, 0, 0], [12, 0, 0], [20, 0, 0]]


def test_glb_applies_scale_then_rotation_then_translation():
    half = 0.5**0.5
    node = {
        "mesh": 0,
        "scale": [2, 3, 4],
        "rotation": [0, 0, half, half],  # a quarter turn about z
        "translation": [100, 0, 0],
    }

    mesh = load(document(nodes=[node]))

    expected = [[100, 0, 0], [100, 2, 0], [97, 2, 0], [97, 0, 0]]
    np.testing.assert_allclose(mesh.vertices, expected, atol=1e-12)


def test_glb_reads_matrices_by_columns():
    matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]

    mesh = load(document(nodes=[{"mesh": 0, "matrix": matrix}]))

    assert mesh.vertices[0].tolist() == [5, 6, 7]


def test_glb_turns_mirrored_triangles_over():
    mesh = load(document(nodes=[{"mesh": 0, "scale": [-1, 1, 1]}]))

    corners = mesh.vertices[mesh.triangles[0]]
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    assert normal[2] > 0


def test_glb_without_scenes_gives_its_meshes_unplaced():
    content = document()
    for key in ("scene", "scenes", "nodes"):
        del content[key]

    assert load(content).vertices.tolist() == SQUARE


def test_glb_reads_interleaved_positions():
    rows = b"".join(struct.pack("<3f2f", *row, 9, 9) for row in SQUARE)
    content = document(buffers=[{"byteLength": 92}])
    content["bufferViews"] = [
        {"buffer": 0, "byteLength": 80, "byteStride": 20},
        {"buffer": 0, "byteOffset": 80, "byteLength": 12},
    ]

    assert load(content, rows + INDICES).vertices.tolist() == SQUARE


def test_glb_applies_sparse_replacements():
    content = document(buffers=[{"byteLength": 76}])
    content["bufferViews"] += [
        {"buffer": 0, "byteOffset": 60, "byteLength": 4},
        {"buffer": 0, "byteOffset": 64, "byteLength": 12},
    ]
    content["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": 2, "componentType": 5123},
        "values": {"bufferView": 3},
    }
    body = POSITIONS + INDICES + struct.pack("<2H", 2, 0) + struct.pack("<3f", 7, 8, 9)

    assert load(content, body).vertices.tolist() == [*SQUARE[:2], [7, 8, 9], SQUARE[3]]


def test_glb_scales_normalised_positions():
    content = document(buffers=[{"byteLength": 24}])
    content["accessors"][0] |= {"componentType": 5121, "normalized": True}
    content["bufferViews"][0] |= {"byteLength": 12}
    content["bufferViews"][1] |= {"byteOffset": 12}
    body = bytes(value * 255 for row in SQUARE for value in map(int, row)) + INDICES

    assert load(content, body).vertices.tolist() == SQUARE


def test_glb_agrees_with_trimesh_on_a_file_it_wrote(tmp_path):
    path = tmp_path / "spheres.glb"
    sphere = trimesh.creation.icosphere(subdivisions=1)
    scene = trimesh.Scene()
    places = [
        trimesh.transformations.random_rotation_matrix(np.array([k, 0.3, 0.7])) for k in (0.1, 0.9)
    ]
    for place in places:
        place[:3, 3] = [3, 4, 5]
        scene.add_geometry(sphere, transform=place)
    scene.export(path)

    mesh = load_mesh(path)

    corners = mesh.vertices[mesh.triangles].reshape(2, *sphere.triangles.shape)
    for ours, place in zip(corners, places, strict=True):
        theirs = sphere.triangles @ place[:3, :3].T + place[:3, 3]
        np.testing.assert_allclose(ours, theirs, atol=1e-6)
