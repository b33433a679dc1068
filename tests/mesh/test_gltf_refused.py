"""glTF that is out of place is refused, and named."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from mesh_files.gltf_files import DOCUMENT, INDICES, SQUARE, document, glb, load

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes


@pytest.mark.parametrize(
    ("path", "value", "fault"),
    [
        (["asset"], None, "asset: is missing"),
        (["scene"], 1, r"scenes: has no item 1 \(1 in all\)"),
        (["scenes", 0, "nodes"], [5], r"nodes: has no item 5"),
        (["scenes", 0, "nodes"], [0, 0], r"nodes\[0\]: is met twice"),
        (["nodes", 0, "children"], [0], r"nodes\[0\]: is met twice"),
        (["nodes", 0, "mesh"], -1, "meshes: has no item -1"),
        (["nodes", 0, "matrix"], [1, 2], r"nodes\[0\]\.matrix: expected 16 finite numbers"),
        (["nodes", 0, "rotation"], [0, 0, 0, 0], r"nodes\[0\]\.rotation: is zero"),
        (["nodes", 0, "translation"], [1e999, 0, 0], "is not glTF|expected 3 finite numbers"),
        (["meshes", 0, "primitives", 0, "attributes"], {}, r"primitives\[0\]: has no POSITION"),
        (["meshes", 0, "primitives", 0, "indices"], 0, r"accessors\[0\]: is not of a known type"),
        (["accessors", 0, "count"], 10**15, r"accessors\[0\]: takes \d+ bytes of bufferViews\[0\]"),
        (["accessors", 0, "count"], -4, r"accessors\[0\]\.count: is -4"),
        (["accessors", 0, "count"], 3, r"triangle 1 uses vertex 3 of 3"),
        (["accessors", 0, "byteOffset"], 4, "takes 52 bytes"),
        (["accessors", 0, "bufferView"], 9, "bufferViews: has no item 9"),
        (["accessors", 1, "componentType"], 5122, "has indices of no unsigned type"),
        (["accessors", 0, "componentType"], {}, r"accessors\[0\]: is not of a known type"),
        (["accessors", 1, "componentType"], [5123], r"accessors\[1\]: is not of a known type"),
        (["accessors", 0, "type"], ["VEC3"], r"accessors\[0\]: is not of a known type"),
        (["accessors", 1, "count"], 5, "has 5 indices, not three a triangle"),
        (["bufferViews", 0, "byteLength"], 100, r"bufferViews\[0\]: reaches to byte 100"),
        (["bufferViews", 0, "byteStride"], 4, "stride 4"),
        (["buffers", 0, "byteLength"], 100, r"buffers\[0\]: claims 100 bytes, but has 60"),
        (["extensionsUsed"], [{}, "KHR_draco_mesh_compression"], "extensionsUsed: holds something"),
    ],
)
def test_glb_refuses_what_is_out_of_place_and_names_it(path, value, fault):
    content = document()
    item = content
    for key in path[:-1]:
        item = item[key]
    item[path[-1]] = value

    with pytest.raises(MeshError, match=fault):
        load(content)


def test_glb_refuses_zeros_claimed_without_bytes():
    content = document()
    del content["accessors"][0]["bufferView"]
    content["accessors"][0]["count"] = 10**12

    with pytest.raises(MeshError, match=r"claims 1000000000000 values in 60 bytes"):
        load(content)


@pytest.mark.parametrize("component", [None, 5120, 5122, 5126, {}, [5123]])
def test_glb_refuses_replacements_whose_indices_are_of_no_unsigned_type(component):
    content = document()
    indices = {"bufferView": 1, "componentType": component}
    sparse = {"count": 1, "indices": indices, "values": {"bufferView": 0}}
    content["accessors"][0]["sparse"] = sparse

    with pytest.raises(MeshError, match=r"accessors\[0\]\.sparse: has indices of no unsigned type"):
        load(content)


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_glb_refuses_positions_that_are_not_finite(bad):
    with pytest.raises(MeshError, match=rf"vertex 0: z is {bad}"):
        load(DOCUMENT, struct.pack("<12f", 0, 0, bad, *np.ravel(SQUARE[1:])) + INDICES)


@pytest.mark.parametrize(
    ("position", "value", "fault"),
    [
        (4, 1, "byte 4: is GLB version 1"),
        (8, 2**32 - 1, "byte 8: claims 4294967295 bytes"),
        (12, 2**32 - 1, "byte 12: a chunk claims 4294967295 bytes"),
        (16, 7, "has no JSON chunk"),
    ],
)
def test_glb_refuses_headers_that_lie(position, value, fault):
    data = bytearray(glb(DOCUMENT))
    data[position : position + 4] = struct.pack("<I", value)

    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(bytes(data), ".glb")


@pytest.mark.parametrize("text", [b"{", b"[]", b"null", b"[" * 100_000, b"\xff\xfe", b'{"a": NaN}'])
def test_glb_refuses_json_that_is_no_document(text):
    with pytest.raises(MeshError, match=r"is not glTF|this is no glTF document"):
        load(text)


def test_glb_refuses_every_truncation():
    data = glb(DOCUMENT)

    for size in range(1, len(data)):
        with pytest.raises(MeshError):
            load_mesh_bytes(data[:size], ".glb")


def test_glb_takes_deep_chains_of_nodes():
    depth = 5000
    nodes = [{"children": [i + 1], "translation": [1, 0, 0]} for i in range(depth)]

    mesh = load(document(nodes=[*nodes, {"mesh": 0}]))

    assert mesh.vertices[0].tolist() == [depth, 0, 0]
