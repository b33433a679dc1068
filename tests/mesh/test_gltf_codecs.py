"""glTF's compressed geometry: unpacked by the codecs' libraries, or refused with the remedy."""

from __future__ import annotations

import base64
import re
import sys

import numpy as np
import pytest
from mesh_files.gltf_documents import TRIANGLES, draco_square, meshopt_square, with_fallback
from mesh_files.gltf_files import SQUARE

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats.gltf.compressed import DRACO


@pytest.mark.needs("meshopt")
def test_gltf_unpacks_meshopt():
    mesh = load_mesh_bytes(with_fallback(meshopt_square()), ".glb")

    assert mesh.vertices.tolist() == SQUARE
    # The codec may begin a triangle at any of its corners.
    assert [sorted(row) for row in mesh.triangles.tolist()] == TRIANGLES
    assert mesh.notes == ()


@pytest.mark.needs("meshopt")
@pytest.mark.parametrize(
    "options",
    [{"name": "KHR_meshopt_compression"}, {"codes": "INDICES"}, {"filter": "EXPONENTIAL"}],
)
def test_gltf_unpacks_every_kind_of_meshopt(options):
    mesh = load_mesh_bytes(with_fallback(meshopt_square(**options)), ".glb")

    assert mesh.vertices.tolist() == SQUARE
    assert [sorted(row) for row in mesh.triangles.tolist()] == TRIANGLES


@pytest.mark.needs("meshopt")
def test_gltf_takes_the_plain_buffer_where_nothing_requires_the_packed_one():
    moved = (np.asarray(SQUARE, "<f4") + np.float32(5)).tobytes()
    body = moved + np.asarray(TRIANGLES, "<u2").tobytes()
    uri = "data:;base64," + base64.b64encode(body).decode()
    builder = meshopt_square(required=False)
    builder.document["bufferViews"][1]["byteOffset"] = 48

    mesh = load_mesh_bytes(with_fallback(builder, uri), ".glb")

    assert mesh.vertices.tolist() == (np.array(SQUARE) + 5).tolist()


@pytest.mark.needs("meshopt")
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


@pytest.mark.needs("DracoPy")
def test_gltf_unpacks_draco():
    mesh = draco_square().load()

    np.testing.assert_allclose(mesh.vertices, SQUARE, atol=1e-4)
    assert [sorted(row) for row in mesh.triangles.tolist()] == TRIANGLES
    assert mesh.notes == ()


@pytest.mark.needs("DracoPy")
def test_gltf_scales_what_draco_packs_as_the_accessor_says():
    mesh = draco_square(normalized=True).load()

    np.testing.assert_allclose(mesh.vertices, SQUARE, atol=1e-4)
    assert "as their accessor says (normalized)" in mesh.notes[0]


@pytest.mark.needs("DracoPy")
def test_gltf_takes_plain_accessors_where_nothing_requires_draco():
    builder = draco_square(required=False)
    moved = np.asarray(SQUARE) + 5
    attributes = builder.document["meshes"][0]["primitives"][0]["attributes"]
    attributes["POSITION"] = builder.accessor(moved)
    indices = builder.accessor(np.ravel(TRIANGLES), "<u2")
    builder.document["meshes"][0]["primitives"][0]["indices"] = indices

    assert builder.load().vertices.tolist() == moved.tolist()


@pytest.mark.needs("DracoPy")
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


@pytest.mark.needs("DracoPy")
def test_gltf_refuses_damaged_draco_without_the_librarys_words():
    builder = draco_square()
    builder.body = bytes(len(builder.body))

    with pytest.raises(MeshError, match="holds compressed bytes that are damaged; export") as told:
        builder.load()
    assert not re.search(r"Exception|Error|DracoPy", str(told.value))


@pytest.mark.parametrize(
    ("package", "codec", "made"),
    [
        pytest.param("DracoPy", "Draco", draco_square, marks=pytest.mark.needs("DracoPy")),
        pytest.param("meshopt", "meshopt", meshopt_square, marks=pytest.mark.needs("meshopt")),
    ],
)
def test_gltf_names_the_package_that_unpacks_where_it_is_missing(package, codec, made, monkeypatch):
    data = with_fallback(made())
    monkeypatch.setitem(sys.modules, package, None)

    with pytest.raises(MeshError, match=f"is compressed by {codec}, .*; pip install {package}$"):
        load_mesh_bytes(data, ".glb")
