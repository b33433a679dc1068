"""Parts of glTF: nodes by their names, what shares a mesh, what has one of its own."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest
from claims.parts import require_whole
from mesh_files.gltf_files import SQUARE, Builder, document, glb

from obbcli import MeshError, load_mesh, load_parts


def written(tmp_path, name, data):
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else glb(data))
    return path


def paths_of(path):
    return [part.path for part in load_parts(path)]


def nodes(*items, **more):
    """Return a document of these nodes; those that are no child are roots."""
    children = {child for item in items for child in item.get("children", [])}
    roots = [k for k in range(len(items)) if k not in children]
    return document(nodes=list(items), scenes=[{"nodes": roots}], **more)


def test_gltf_nodes_are_parts_with_the_names_from_the_root_down(tmp_path):
    items = [
        {"name": "robot", "children": [1, 2], "translation": [10, 0, 0]},
        {"name": "base", "mesh": 0},
        {"name": "arm", "mesh": 0, "children": [3], "translation": [0, 5, 0]},
        {"name": "hand", "mesh": 0, "translation": [0, 0, 2]},
    ]
    path = written(tmp_path, "robot.glb", nodes(*items))

    parts = load_parts(path).parts

    assert [part.path for part in parts] == ["robot/base", "robot/arm", "robot/arm/hand"]
    assert [part.pose.translation.tolist() for part in parts] == [
        [10, 0, 0],
        [10, 5, 0],
        [10, 5, 2],
    ]
    assert {part.unit for part in parts} == {"m"}
    assert parts[0].mesh is parts[1].mesh is parts[2].mesh
    assert parts[0].mesh.vertices.tolist() == SQUARE
    require_whole(path)


def test_gltf_names_that_are_equal_empty_or_odd(tmp_path):
    items = [
        {"name": "arm", "mesh": 0},
        {"name": "arm", "mesh": 0},
        {"name": "a/b", "mesh": 0},
        {"name": "x#*[", "mesh": 0},
        {"mesh": 0},
        {"mesh": 0},
        {"name": "group", "children": [7, 8]},
        {"mesh": 0},
        {"children": [9]},
        {"name": "deep", "mesh": 0},
        {"name": 5, "mesh": 0},
    ]
    path = written(tmp_path, "odd.glb", nodes(*items))

    found = paths_of(path)

    assert found == [
        *("arm", "arm#2", "a/b", "x#*[", "", "#2"),
        *("group/", "group/deep", "#3"),
    ]
    assert paths_of(f"{path}#arm") == ["arm"]
    assert paths_of(f"{path}#arm*") == ["arm", "arm#2"]
    assert paths_of(f"{path}#a/b") == paths_of(f"{path}#a") == ["a/b"]
    assert paths_of(rf"{path}#x#\*\[") == ["x#*["]
    assert paths_of(f"{path}#group") == ["group/", "group/deep"]
    assert paths_of(f"{path}##2") == ["#2"]
    require_whole(path)


def test_gltf_node_without_a_name_takes_its_mesh_s(tmp_path):
    content = nodes({"mesh": 0}, {"mesh": 0, "name": "own"})
    content["meshes"][0]["name"] = "plate"

    assert paths_of(written(tmp_path, "a.glb", content)) == ["plate", "own"]


def test_second_group_of_a_name_is_another_path(tmp_path):
    items = [
        {"name": "wheel", "children": [2]},
        {"name": "wheel", "children": [3]},
        {"name": "tire", "mesh": 0},
        {"name": "tire", "mesh": 0},
    ]
    path = written(tmp_path, "a.glb", nodes(*items))

    assert paths_of(path) == ["wheel/tire", "wheel#2/tire"]
    assert paths_of(f"{path}#wheel") == ["wheel/tire"]


def test_turned_nodes_share_a_mesh_and_scaled_or_mirrored_ones_have_their_own(tmp_path):
    half = math.sqrt(0.5)
    items = [
        {"name": "plain", "mesh": 0},
        {"name": "turned", "mesh": 0, "rotation": [0, 0, half, half], "translation": [0.1, 0, 7]},
        {"name": "large", "mesh": 0, "scale": [1.7, 1.7, 1.7], "translation": [0.3, 0, 0]},
        {"name": "large too", "mesh": 0, "scale": [1.7, 1.7, 1.7], "translation": [0.7, 0, 0]},
        {"name": "uneven", "mesh": 0, "scale": [1, 3, 0.1]},
        {"name": "mirrored", "mesh": 0, "scale": [-1, 1, 1], "translation": [0.3, 0, 0]},
        {"name": "flat", "mesh": 0, "scale": [1, 0, 1]},
    ]
    path = written(tmp_path, "a.glb", nodes(*items))

    plain, turned, large, too, uneven, mirrored, flat = load_parts(path)

    assert turned.mesh is plain.mesh
    assert large.mesh is too.mesh
    assert len({id(p.mesh) for p in (plain, large, uneven, mirrored, flat)}) == 5
    assert mirrored.mesh.triangles.tolist() == [row[::-1] for row in plain.mesh.triangles.tolist()]
    assert mirrored.mesh.vertices.tolist() == (np.array(SQUARE) * [-1, 1, 1]).tolist()
    assert large.pose.translation.tolist() == [0.3, 0, 0]
    require_whole(path)


def test_instances_are_parts_with_numbers(tmp_path):
    made = Builder(nodes=[{"mesh": 0, "name": "bolt"}], extensionsUsed=["EXT_mesh_gpu_instancing"])
    made.document["meshes"] = [{"primitives": [{"attributes": {"POSITION": 0}}]}]
    place = made.view(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
    shifts = made.view(struct.pack("<6f", 0, 0, 1, 0, 0, 2.5))
    made.document["accessors"] = [
        {"bufferView": place, "componentType": 5126, "count": 3, "type": "VEC3"},
        {"bufferView": shifts, "componentType": 5126, "count": 2, "type": "VEC3"},
    ]
    made.document["nodes"][0]["extensions"] = {
        "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}
    }
    made.document["buffers"] = [{"byteLength": len(made.body)}]
    path = written(tmp_path, "a.glb", glb(made.document, made.body))

    first, second = load_parts(path)

    assert (first.path, second.path) == ("bolt", "bolt#2")
    assert first.mesh is second.mesh
    assert [p.pose.translation.tolist() for p in (first, second)] == [[0, 0, 1], [0, 0, 2.5]]
    require_whole(path)


def test_parts_are_decoded_when_they_are_asked_for(tmp_path):
    content = nodes({"name": "good", "mesh": 0}, {"name": "bad", "mesh": 1})
    content["meshes"].append({"primitives": [{"attributes": {"POSITION": 99}}]})
    path = written(tmp_path, "a.glb", content)

    good, bad = load_parts(path)

    assert (good.is_decoded, bad.is_decoded) == (False, False)
    assert good.mesh.vertices.tolist() == SQUARE
    assert (good.is_decoded, bad.is_decoded) == (True, False)
    assert load_mesh(f"{path}#good").vertices.tolist() == SQUARE
    with pytest.raises(MeshError, match=r"a\.glb: accessors: has no item 99"):
        _ = bad.mesh
    with pytest.raises(MeshError, match=r"a\.glb: accessors: has no item 99"):
        load_mesh(path)


def test_nodes_of_points_and_lines_are_no_parts(tmp_path):
    content = nodes({"name": "line", "mesh": 1}, {"name": "plate", "mesh": 0})
    content["meshes"].append({"primitives": [{"attributes": {"POSITION": 0}, "mode": 1}]})

    assert paths_of(written(tmp_path, "a.glb", content)) == ["plate"]


def test_notes_of_a_part_are_the_file_s_and_its_own_in_any_order(tmp_path):
    content = nodes({"name": "a", "mesh": 0}, {"name": "b", "mesh": 1})
    primitive = content["meshes"][0]["primitives"][0]
    content["meshes"].append({"primitives": [primitive | {"mode": 5}]})
    content["animations"] = [{}]
    path = written(tmp_path, "a.glb", content)

    for order in (0, 1), (1, 0):
        parts = load_parts(path).parts
        notes = {k: parts[k].mesh.notes for k in order}
        assert notes[0] == ("animations are not played",)
        assert notes[1] == (*notes[0], "triangle strips and fans are taken as triangles")
