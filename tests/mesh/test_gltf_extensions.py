"""glTF's extensions: required ones are read or refused by name, instances and codecs are read."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.gltf_documents import instanced
from mesh_files.gltf_files import SQUARE, document, load, shifted

from obbcli.errors import MeshError
from obbcli.mesh.formats.gltf import extensions as gltf_extensions


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
