"""Parts of files: names, order, places, shared meshes, and that together they are the whole."""

from __future__ import annotations

import json
import math
import struct

import numpy as np
import pytest
from mesh_files.gltf_files import SQUARE, Builder, document, glb, shifted
from mesh_files.plain_files import FILES, off

from obbcli import MeshError, load_mesh, load_parts
from obbcli.mesh.parts.load import read_parts

TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"
FACET = b"facet normal 0 0 1\nouter loop\nvertex 0 0 %d\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
FACET += b"endfacet\n"


def written(tmp_path, name, data):
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else glb(data))
    return path


def paths_of(path):
    return [part.path for part in load_parts(path)]


def corners(mesh, vertices=None):
    return (mesh.vertices if vertices is None else vertices)[mesh.triangles]


def assert_whole(path):
    """Assert that the parts, placed, are what `load_mesh` returns, bit for bit."""
    parts = load_parts(path)
    placed = np.concatenate([corners(part.mesh, part.vertices()) for part in parts])
    for part in parts:
        points = corners(part.mesh, part.vertices()).reshape(-1, 3)
        bounds = [points.min(axis=0).tolist(), points.max(axis=0).tolist()]
        assert part.placed_bounds().tolist() == bounds

    assert placed.tobytes() == (corners(load_mesh(path)) + 0.0).tobytes()
    assert corners(load_mesh(f"{path}#**")).tobytes() == corners(load_mesh(path)).tobytes()


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
    assert_whole(path)


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
    assert_whole(path)


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
    assert_whole(path)


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
    assert_whole(path)


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


OBJ = b"""f 1 2 3
o frame
f 1 2 3
f 1 2 3 1 \\
2
g ignored
o arm#2 the second # a comment
o arm
f -3 -2 -1
o frame
usemtl x
f 1/1 2/1 3/1
"""


def test_objects_of_obj_are_parts_in_the_order_of_their_faces(tmp_path):
    path = written(tmp_path, "a.obj", TRIANGLE + OBJ)

    parts = load_parts(path).parts

    assert [(p.path, len(p.mesh.triangles)) for p in parts] == [
        *(("", 1), ("frame", 4), ("arm", 1), ("frame#2", 1)),
    ]
    assert {part.unit for part in parts} == {None}
    assert_whole(path)


def test_groups_of_obj_are_parts_where_there_is_no_object(tmp_path):
    data = TRIANGLE + b"g a b\nf 1 2 3\ng\nf 1 2 3\ng wheel#2 # left\nf 3 2 1\n"
    path = written(tmp_path, "a.obj", data)

    assert paths_of(path) == ["a b", "", "wheel#2"]
    assert_whole(path)


def test_solids_of_ascii_stl_are_parts(tmp_path):
    data = b"solid one\n" + FACET % 0 + FACET % 1 + b"endsolid one\nsolid empty\nendsolid\n"
    data += b"SOLID\n" + FACET % 2 + b"endsolid\n# solid no\nsolid facet normal\n" + FACET % 3
    path = written(tmp_path, "a.stl", data + b"end solid facet\n")

    assert [(p.path, len(p.mesh.triangles)) for p in load_parts(path)] == [
        *(("one", 2), ("", 1), ("facet normal", 1)),
    ]
    assert_whole(path)


@pytest.mark.parametrize("place", range(len(FILES)), ids=list(FILES))
def test_every_plain_file_is_the_join_of_its_parts(tmp_path, place):
    suffix, data = list(FILES.values())[place]
    path = written(tmp_path, f"a{suffix}", data)

    assert_whole(path)
    assert load_parts(path).parts[0].path in ("", "part")


def test_selection_counts_rows_of_the_union_and_lists_its_parts(tmp_path):
    items = [{"name": name, "mesh": 0, "translation": [x, 0, 0]} for x, name in enumerate("abc")]
    path = written(tmp_path, "a.glb", nodes(*items))

    mesh = load_mesh(f"{path}#[ac]")

    assert mesh.vertices.tolist() == [*shifted(0).tolist(), *shifted(2).tolist()]
    assert [tuple(rows) for rows in mesh.parts] == [("a", 0, 2), ("c", 2, 2)]
    assert (mesh.unit, mesh.source) == ("m", "a.glb")
    assert mesh.sha256 == load_mesh(path).sha256
    assert load_mesh(path).parts == ()
    assert load_mesh(f"{path}#[ac]", hashed=False).sha256 is None


def test_pattern_that_takes_nothing_lists_the_nearest_names(tmp_path):
    items = [
        {"name": "robot", "children": [1, 2]},
        {"name": "arm*", "mesh": 0},
        {"name": "gripper", "mesh": 0},
    ]
    path = written(tmp_path, "a.glb", nodes(*items))

    for pattern, told in (
        ("robot/griper", r"nearest are 'robot/gripper'"),
        ("gripper", r"'\*\*/gripper' matches 'robot/gripper'"),
        ("zzz", r"the first are 'robot/arm\\\*', 'robot/gripper'"),
        ("", r"the first are"),
    ):
        with pytest.raises(MeshError, match=rf"a\.glb#{pattern}: matches none of 2 parts; {told}"):
            load_mesh(f"{path}#{pattern}")
        with pytest.raises(MeshError, match=told):
            load_parts(path).select(pattern)


def test_pattern_at_a_file_without_names_says_so(tmp_path):
    path = written(tmp_path, "a.off", off())

    with pytest.raises(MeshError, match=r"matches no part: the parts of this file have no names"):
        load_mesh(f"{path}#arm")


def test_file_whose_own_name_holds_the_sign_wins(tmp_path):
    (tmp_path / "d#1").mkdir()
    data = TRIANGLE + b"o x\nf 1 2 3\no y\nf 3 2 1\n"
    for name in ("a.obj", "a.obj#x", "d#1/b.obj", "a#2.obj"):
        (tmp_path / name).write_bytes(data if name != "a.obj#x" else TRIANGLE + b"f 1 2 3\n" * 3)

    assert len(load_mesh(tmp_path / "a.obj#y").triangles) == 1
    assert len(load_mesh(tmp_path / "d#1/b.obj").triangles) == 2
    assert len(load_mesh(tmp_path / "d#1/b.obj#x").triangles) == 1
    assert len(load_mesh(tmp_path / "a#2.obj#x").triangles) == 1
    with pytest.raises(MeshError, match="unknown mesh suffix"):
        load_mesh(tmp_path / "a.obj#x")
    with pytest.raises(MeshError, match=r"b#2\.obj: no such file"):
        load_mesh(tmp_path / "b#2.obj")


def test_files_of_too_many_parts_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("obbcli.mesh.parts.selection.MOST_PARTS", 2)
    path = written(tmp_path, "a.obj", TRIANGLE + b"".join(b"o %d\nf 1 2 3\n" % k for k in range(3)))

    with pytest.raises(MeshError, match="has more than 2 parts; split the file"):
        load_parts(path)


def test_errors_of_parts_are_those_of_meshes(tmp_path):
    broken = written(tmp_path, "a.gltf", json.dumps({"asset": {"version": "1.0"}}).encode())
    empty = written(tmp_path, "a.obj", b"v 0 0 0\n")

    for path in (broken, empty, tmp_path / "none.glb"):
        with pytest.raises(MeshError) as whole:
            load_mesh(path)
        with pytest.raises(MeshError) as parts:
            read_parts(path)
        assert str(parts.value) == str(whole.value)
