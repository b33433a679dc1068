"""glTF: which nodes a document shows, and what of it is told in notes."""

from __future__ import annotations

import numpy as np
import pytest
from mesh_files.gltf_files import SQUARE, Builder, document, load, shifted

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh_bytes


def placed(x, **more):
    return {"mesh": 0, "translation": [x, 0, 0], **more}


def test_gltf_without_scenes_shows_all_root_nodes_and_says_so():
    content = document(nodes=[placed(1), {"children": [0], "translation": [10, 0, 0]}, placed(5)])
    del content["scenes"], content["scene"]

    mesh = load(content)

    # Node 0 is a child of node 1, so it stands at 11, after which comes node 2.
    assert mesh.vertices.tolist() == [*shifted(11).tolist(), *shifted(5).tolist()]
    assert "has no scenes: all root nodes are taken" in mesh.notes


def test_gltf_without_nodes_gives_its_meshes_unplaced_and_says_so():
    content = document()
    for key in ("scene", "scenes", "nodes"):
        del content[key]

    mesh = load(content)

    assert mesh.vertices.tolist() == SQUARE
    assert mesh.notes == ("has no nodes: its meshes are taken where they were modelled",)


@pytest.mark.parametrize(("scene", "x"), [({}, 1), ({"scene": 1}, 2)])
def test_gltf_shows_the_default_scene_and_says_which_of_several(scene, x):
    content = document(nodes=[placed(1), placed(2)], scenes=[{"nodes": [0]}, {"nodes": [1]}])
    del content["scene"]

    mesh = load(content | scene)

    assert mesh.vertices.tolist() == shifted(x).tolist()
    assert mesh.notes == (f"scene {x - 1} of 2 is taken (counted from 0)",)


def test_gltf_says_how_many_meshes_no_node_of_the_scene_places():
    content = document()
    content["meshes"] *= 3

    assert load(content).notes == ("2 of 3 meshes stand in no node of the scene",)


def test_gltf_says_nothing_of_a_plain_document():
    assert load(document()).notes == ()


def test_gltf_says_that_animations_are_not_played_and_hidden_nodes_are_taken():
    hidden = {"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": False}}}

    mesh = load(document(nodes=[hidden], animations=[{}]))

    assert mesh.vertices.tolist() == SQUARE
    assert mesh.notes == (
        "animations are not played",
        "nodes that are marked as not visible are taken as well",
    )


def test_gltf_turns_over_what_is_mirrored_by_a_matrix():
    mirror = [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]

    mesh = load(document(nodes=[{"mesh": 0, "matrix": mirror}]))

    assert mesh.triangles.tolist() == [[2, 1, 0], [3, 2, 0]]
    assert mesh.vertices[1].tolist() == [-1, 0, 0]


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"nodes": [{"children": [1, 2]}, placed(0, children=[2]), {}]}, r"nodes\[2\]: is met twi"),
        ({"nodes": [{"children": [1]}, {}], "scenes": [{"nodes": [0, 1]}]}, r"nodes\[1\]: is met"),
        ({"nodes": [{"children": [7]}]}, r"nodes: has no item 7 \(1 in all\)"),
        ({"nodes": [placed(0, matrix=[1] * 16)]}, "has both a matrix and its parts"),
        ({"nodes": [{"matrix": [1] * 16}]}, "matrix whose last row is not 0 0 0 1"),
        ({"nodes": [placed(0, rotation=[0, 0, 0, 2])]}, r"rotation: has length 2, expected a unit"),
        ({"asset": {"version": "1.0"}}, "is glTF 1.0, only 2.0 is read; convert it to glTF 2.0"),
        ({"asset": {"version": "3.1"}}, "is glTF 3.1, only 2.0 is read"),
        ({"asset": {}, "meshes": {"a": {}}, "scenes": {}}, "is glTF 1.0, only 2.0 is read"),
        ({"asset": {"version": "2.1", "minVersion": "2.1"}}, "needs a reader of glTF '2.1'"),
    ],
)
def test_gltf_refuses_documents_that_place_nodes_in_two_ways_or_are_of_another_version(
    changes, fault
):
    with pytest.raises(MeshError, match=fault):
        load(document(**changes))


def test_gltf_takes_a_quaternion_of_bytes_as_a_turn():
    # 90 / 127 is the nearest that a byte holds to the square root of a half.
    content = document(nodes=[{"mesh": 0, "rotation": [0, 0, 90 / 127, 90 / 127]}])

    expected = [[0, 0, 0], [0, 1, 0], [-1, 1, 0], [-1, 0, 0]]
    np.testing.assert_allclose(load(content).vertices, expected, atol=1e-15)


def test_gltf_takes_an_old_document_of_version_1_for_what_it_is():
    data = bytearray(Builder().glb())
    data[4] = 1

    with pytest.raises(
        MeshError, match=r"is GLB version 1 .glTF 1\.0., only 2 is read; convert it"
    ):
        load_mesh_bytes(bytes(data), ".glb")


@pytest.mark.parametrize("mode", [0, 1, 2, 3])
def test_gltf_finds_no_surface_in_points_and_lines(mode):
    content = document()
    content["meshes"][0]["primitives"][0]["mode"] = mode

    with pytest.raises(MeshError, match="has no faces; a mesh is a surface of triangles"):
        load(content)


@pytest.mark.parametrize("mode", [7, -1, "4", 2147483647, None])
def test_gltf_refuses_modes_that_it_does_not_know(mode):
    content = document()
    content["meshes"][0]["primitives"][0]["mode"] = mode

    with pytest.raises(MeshError, match=r"primitives\[0\]: has the unknown mode"):
        load(content)


def test_gltf_takes_strips_and_fans_with_the_winding_of_the_specification():
    points = np.arange(15.0).reshape(5, 3)
    expected = {
        4: [[0, 1, 2]],
        5: [[0, 1, 2], [1, 3, 2], [2, 3, 4]],
        6: [[1, 2, 0], [2, 3, 0], [3, 4, 0]],
    }

    for mode, triangles in expected.items():
        builder = Builder(nodes=[{"mesh": 0}])
        positions = builder.accessor(points[:3] if mode == 4 else points)
        primitive = {"attributes": {"POSITION": positions}, "mode": mode}
        builder.document["meshes"] = [{"primitives": [primitive]}]

        mesh = builder.load()
        assert mesh.triangles.tolist() == triangles
        told = ("triangle strips and fans are taken as triangles",)
        assert mesh.notes == (() if mode == 4 else told)
