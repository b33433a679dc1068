"""`FILE#PATTERN`: the selected union, its rows, and what is said where nothing is selected."""

from __future__ import annotations

import json

import pytest
from mesh_files.gltf_files import document, glb, shifted
from mesh_files.plain_files import off

from obbcli import MeshError, load_mesh, load_parts
from obbcli.mesh.parts.load import read_parts

TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"


def written(tmp_path, name, data):
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else glb(data))
    return path


def nodes(*items, **more):
    """Return a document of these nodes; those that are no child are roots."""
    children = {child for item in items for child in item.get("children", [])}
    roots = [k for k in range(len(items)) if k not in children]
    return document(nodes=list(items), scenes=[{"nodes": roots}], **more)


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


@pytest.mark.parametrize("sign", ["xy", "x#"])
def test_pattern_may_be_longer_than_names_of_files(tmp_path, sign):
    path = written(tmp_path, "a.obj", TRIANGLE + b"o y\nf 1 2 3\no " + sign.encode() * 2500)
    path.write_bytes(path.read_bytes() + b"\nf 3 2 1\n")

    assert load_mesh(f"{path}#{sign * 2500}").triangles.tolist() == [[2, 1, 0]]
    with pytest.raises(MeshError, match="matches none of 2 parts"):
        load_mesh(f"{path}#{sign * 2499}")


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
