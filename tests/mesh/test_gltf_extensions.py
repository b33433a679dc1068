"""glTF's extensions: required ones are read or refused by name, instances and codecs are read."""

from __future__ import annotations

import base64
import re
import sys

import numpy as np
import pytest
from gltf_documents import TRIANGLES, draco_square, instanced, meshopt_square, with_fallback
from gltf_files import SQUARE, document, load, shifted

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats import gltf_extensions
from obbcli.mesh.formats.gltf_compressed import DRACO


@pytest.mark.parametrize("name", ["ACME_parts", "CESIUM_RTC", "KHR_materials", "EXT_voxels"])
def test_gltf_refuses_an_extension_that_it_does_not_know_but_needs(name):
    content = document(extensionsUsed=[name], extensionsRequired=[name])

    with pytest.raises(MeshError, match=rf"extensionsRequired: {name} is not read, and the shape"):
        load(content)


def test_gltf_refuses_what_places_the_shape_even_where_it_is_not_required():
    with pytest.raises(MeshError, match="extensionsUsed: CESIUM_RTC is not read"):
        load(document(extensionsUsed=["CESIUM_RTC"]))


@pytest.mark.parametrize(
    "name",
    [
        *("KHR_materials_unlit", "KHR_texture_transform", "KHR_lights_punctual", "MSFT_lod"),
        *("KHR_technique_webgl", "EXT_texture_webp", "KHR_mesh_quantization"),
    ],
)
def test_gltf_takes_required_extensions_that_are_read_or_carry_no_surface(name):
    mesh = load(document(extensionsUsed=[name], extensionsRequired=[name]))

    assert mesh.vertices.tolist() == SQUARE
    assert mesh.notes == ()


def test_gltf_says_which_extensions_that_it_does_not_know_it_passed_over():
    mesh = load(document(extensionsUsed=["A_b", "KHR_materials_unlit", "C_d", "E_f", "G_h"]))

    assert mesh.notes == ("not required and not known, passed over: A_b, C_d, E_f and 1 more",)


@pytest.mark.parametrize("name", sorted(gltf_extensions.SUPPORTED))
def test_every_extension_that_is_read_is_needed_in_the_list(name, monkeypatch):
    content = document(extensionsUsed=[name], extensionsRequired=[name])
    load(content)

    monkeypatch.setattr(gltf_extensions, "SUPPORTED", gltf_extensions.SUPPORTED - {name})

    with pytest.raises(MeshError, match=f"{name} is not read"):
        load(content)


def test_gltf_places_instances_below_their_node():
    mesh = instanced(TRANSLATION=[[1, 0, 0], [2, 0, 5]], SCALE=[[1, 1, 1], [2, -3, 1]]).load()

    first = shifted(1, 100, 0)
    second = np.array(SQUARE) * [2, -3, 1] + [2, 100, 5]
    assert mesh.vertices.tolist() == [*first.tolist(), *second.tolist()]
    # The second is mirrored, so its triangles are turned over.
    assert mesh.triangles.tolist() == [[1, 2, 0], [2, 3, 0], [4, 6, 5], [4, 7, 6]]


def test_gltf_turns_instances_by_normalised_bytes():
    mesh = instanced(dtype="<i1", ROTATION=[[0, 0, 127, 0], [0, 0, 0, 127]]).load()

    half_turn = [[0, 100, 0], [-1, 100, 0], [-1, 99, 0], [0, 99, 0]]
    np.testing.assert_allclose(mesh.vertices[:4], half_turn, atol=1e-12)
    assert mesh.vertices[4:].tolist() == shifted(0, 100, 0).tolist()


@pytest.mark.parametrize(
    ("values", "fault"),
    [
        (
            {"TRANSLATION": [[0, 0, 0]], "SCALE": [[1, 1, 1]] * 2},
            r"nodes\[0\].extensions.EXT_mesh_gpu_instancing: places no .*, or not as many",
        ),
        ({"_ID": [1, 2]}, "places no instances"),
        ({"TRANSLATION": [1, 2]}, r"accessors\[1\]: is not of a known type with 3 components"),
        ({"ROTATION": [[0, 0, 0, 0]]}, "instance 0.rotation: is zero"),
        ({}, "has no attributes"),
    ],
)
def test_gltf_refuses_instances_that_are_not_placed(values, fault):
    with pytest.raises(MeshError, match=fault):
        instanced(**values).load()


def test_gltf_refuses_instances_of_a_skin():
    builder = instanced(TRANSLATION=[[0, 0, 0]])
    builder.document["nodes"][0]["skin"] = 0

    with pytest.raises(MeshError, match="has a skin and instances"):
        builder.load()


def test_gltf_refuses_instances_that_would_fill_the_memory():
    builder = instanced(TRANSLATION=np.zeros((3, 3)))
    zeros = builder.form((2000, 3))
    attributes = builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]
    attributes["TRANSLATION"] = zeros
    builder.body += bytes(5000)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("os.sysconf", lambda _: 1000)
        with pytest.raises(MeshError, match="place more than a quarter of this machine's memory"):
            builder.load()


def test_gltf_unpacks_meshopt():
    mesh = load_mesh_bytes(with_fallback(meshopt_square()), ".glb")

    assert mesh.vertices.tolist() == SQUARE
    # The codec may begin a triangle at any of its corners.
    assert [sorted(row) for row in mesh.triangles.tolist()] == TRIANGLES
    assert mesh.notes == ()


def test_gltf_takes_the_plain_buffer_where_nothing_requires_the_packed_one():
    moved = (np.asarray(SQUARE, "<f4") + np.float32(5)).tobytes()
    body = moved + np.asarray(TRIANGLES, "<u2").tobytes()
    uri = "data:;base64," + base64.b64encode(body).decode()
    builder = meshopt_square(required=False)
    builder.document["bufferViews"][1]["byteOffset"] = 48

    mesh = load_mesh_bytes(with_fallback(builder, uri), ".glb")

    assert mesh.vertices.tolist() == (np.array(SQUARE) + 5).tolist()


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"mode": "LINES"}, "in no known mode"),
        ({"mode": {}}, "in no known mode"),
        ({"byteStride": 3}, "in no known mode and row size"),
        ({"filter": "ACME"}, "with no known filter"),
        ({"filter": "OCTAHEDRAL"}, "with no known filter"),
        ({"count": 10**9}, "claims 12000000000 bytes packed into"),
        ({"count": 6}, r"bufferViews\[0\]: claims 48 bytes, but has 72"),
        ({"byteLength": 9}, "holds compressed bytes that are damaged"),
        ({"count": 3}, r"bufferViews\[0\]: claims 48 bytes, but has 36"),
        ({"byteLength": 10**6}, r"reaches to byte \d+ of a buffer"),
    ],
)
def test_gltf_refuses_packed_views_that_are_not_what_they_say(changes, fault):
    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(with_fallback(meshopt_square(**changes)), ".glb")


def test_gltf_unpacks_draco():
    mesh = draco_square().load()

    np.testing.assert_allclose(mesh.vertices, SQUARE, atol=1e-4)
    assert [sorted(row) for row in mesh.triangles.tolist()] == TRIANGLES
    assert mesh.notes == ()


def test_gltf_scales_what_draco_packs_as_the_accessor_says():
    mesh = draco_square(normalized=True).load()

    np.testing.assert_allclose(mesh.vertices, SQUARE, atol=1e-4)
    assert "as their accessor says (normalized)" in mesh.notes[0]


def test_gltf_takes_plain_accessors_where_nothing_requires_draco():
    builder = draco_square(required=False)
    moved = np.asarray(SQUARE) + 5
    attributes = builder.document["meshes"][0]["primitives"][0]["attributes"]
    attributes["POSITION"] = builder.accessor(moved)
    indices = builder.accessor(np.ravel(TRIANGLES), "<u2")
    builder.document["meshes"][0]["primitives"][0]["indices"] = indices

    assert builder.load().vertices.tolist() == moved.tolist()


@pytest.mark.parametrize(
    ("path", "value", "fault"),
    [
        (["accessors", 0, "count"], 5, "holds compressed POSITION that is not what"),
        (["accessors", 1, "count"], 9, "holds 2 triangles, but its accessor has 9 indices"),
        (["attributes", "POSITION"], 77, "holds compressed POSITION that is not what"),
        (["attributes"], {}, f"extensions.{DRACO}: has no POSITION"),
        (["bufferView"], 4, "bufferViews: has no item 4"),
    ],
)
def test_gltf_refuses_draco_that_is_not_what_its_accessors_say(path, value, fault):
    builder = draco_square()
    extension = builder.document["meshes"][0]["primitives"][0]["extensions"][DRACO]
    item = builder.document if path[0] == "accessors" else extension
    for key in path[:-1]:
        item = item[key]
    item[path[-1]] = value

    with pytest.raises(MeshError, match=fault):
        builder.load()


def test_gltf_refuses_damaged_draco_without_the_librarys_words():
    builder = draco_square()
    builder.body = bytes(len(builder.body))

    with pytest.raises(MeshError, match="holds compressed bytes that are damaged; export") as told:
        builder.load()
    assert not re.search(r"Exception|Error|DracoPy", str(told.value))


@pytest.mark.parametrize(
    ("package", "codec", "made"),
    [("DracoPy", "Draco", draco_square), ("meshopt", "meshopt", meshopt_square)],
)
def test_gltf_names_the_package_that_unpacks_where_it_is_missing(package, codec, made, monkeypatch):
    data = with_fallback(made())
    monkeypatch.setitem(sys.modules, package, None)

    with pytest.raises(MeshError, match=f"is compressed by {codec}, .*; pip install {package}$"):
        load_mesh_bytes(data, ".glb")
