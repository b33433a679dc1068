"""`info --parts`, and mesh files in place of scenes: parts at rest, decoded where asked about."""

from __future__ import annotations

import gzip
import io
import os
import struct
import sys
import threading

import numpy as np
import pytest
from mesh_files.cube_files import CUBE_FACES, cube
from mesh_files.gltf_files import Builder, glb

import obbcli
from obbcli import MeshError, Pose, Scene, SceneError, load_parts


def cubes(*nodes):
    """Return a GLB file whose mesh 0 is the unit cube, and mesh 1 its first triangle, damaged."""
    made = Builder(scenes=[{"nodes": list(range(len(nodes)))}], nodes=list(nodes))
    corners = made.view(struct.pack("<24f", *np.ravel(cube())))
    faces = made.view(struct.pack("<36H", *np.ravel(CUBE_FACES)))
    made.document["accessors"] = [
        {"bufferView": corners, "componentType": 5126, "count": 8, "type": "VEC3"},
        {"bufferView": faces, "componentType": 5123, "count": 36, "type": "SCALAR"},
    ]
    primitive = {"attributes": {"POSITION": 0}, "indices": 1}
    made.document["meshes"] = [{"primitives": [primitive]}, {"primitives": [{"indices": 1}]}]
    made.document["buffers"] = [{"byteLength": len(made.body)}]
    return glb(made.document, made.body)


def at(name, *shift, **more):
    return {"name": name, "mesh": 0, "translation": list(shift), **more}


SCALED = at("lid", 0, 0, 9, scale=[2, 1, 1])


@pytest.fixture
def files(here):
    (here / "a.glb").write_bytes(cubes(at("frame", 0, 0, 0), at("arm", 0.5, 0, 0), SCALED))
    (here / "bad.glb").write_bytes(
        cubes(at("x", 0, 0, 0), at("y", 1, 0, 0), at("z", 0, 0, 0, mesh=1))
    )
    return here


def test_info_lists_parts_as_they_are_placed(files, obbtree):
    document = obbtree("info", "a.glb", "--parts", "--json").json

    assert document["inputs"]["file"]["triangle_count"] == 36
    assert document["result"] == {
        "kind": "assembly",
        "part_count": 3,
        "mesh_count": 2,
        "triangle_count": 36,
        "bounds": [[0, 0, 0], [2, 1, 10]],
        "size": pytest.approx(105**0.5),
        "parts": [
            {
                "path": path,
                "triangle_count": 12,
                "bounds": bounds,
                "unit": "m",
                "is_watertight": True,
            }
            for path, bounds in (
                ("frame", [[0, 0, 0], [1, 1, 1]]),
                ("arm", [[0.5, 0, 0], [1.5, 1, 1]]),
                ("lid", [[0, 0, 9], [2, 1, 10]]),
            )
        ],
    }


def test_info_of_parts_shows_a_table_and_paths(files, obbtree):
    table = obbtree("info", "a.glb", "--parts").out

    assert "arm            12   0.5 0 0   1.5 1 1      m          yes" in table
    assert "2, which copies share" in table
    assert obbtree("info", "a.glb#[af]*", "--parts", "--quiet").out == "frame\narm\n"
    assert "(no name)          12    0 0 0" in obbtree("info", "cube.stl", "--parts").out


def test_info_of_parts_is_refused_where_it_has_no_meaning(files, obbtree):
    obbtree("build", "cube.stl")

    for words, code, told in (
        (("a.glb", "--check"), 2, "--check proves a tree"),
        (("cube.obbt",), 3, "is a tree file, which has no parts"),
        (("bad.glb",), 3, "has no POSITION"),
        (("a.glb#gone",), 3, "matches none of 3 parts"),
    ):
        ended = obbtree("info", *words, "--parts")
        assert (ended.code, told in ended.err) == (code, True), ended.err


@pytest.mark.parametrize("is_packed", [False, True])
def test_parts_of_standard_input_and_of_pipes_are_listed(files, obbtree, monkeypatch, is_packed):
    data = (files / "a.glb").read_bytes()
    if is_packed:
        data = gzip.compress(b"o first\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", mtime=0)
    (files / "b.obj.gz").write_bytes(data)
    os.mkfifo(files / "p.obj.gz")
    writer = threading.Thread(target=(files / "p.obj.gz").write_bytes, args=(data,))
    writer.start()
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))

    of_file = obbtree("info", "b.obj.gz", "--parts", "--json").json
    of_stream = obbtree("info", "-", "--parts", "--json").json
    of_pipe = obbtree("info", "p.obj.gz", "--parts", "--json").json
    writer.join()

    assert of_stream["result"] == of_pipe["result"] == of_file["result"]
    assert of_stream["inputs"]["file"]["sha256"] == of_file["inputs"]["file"]["sha256"]
    assert of_stream["inputs"]["file"]["path"] == "-"


def test_pipe_that_is_packed_is_read_as_its_name_says(files, obbtree):
    os.mkfifo(files / "p.obj.gz")
    # Nothing at its beginning tells an OBJ file.
    data = gzip.compress(b"mtllib\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", mtime=0)
    writer = threading.Thread(target=(files / "p.obj.gz").write_bytes, args=(data,))
    writer.start()

    ended = obbtree("info", "p.obj.gz", "--json")
    writer.join()

    assert ended.json["result"]["triangle_count"] == 1


def test_tree_on_standard_input_has_no_parts(files, obbtree, monkeypatch):
    obbtree("build", "cube.stl")
    data = (files / "cube.obbt").read_bytes()
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))

    ended = obbtree("info", "-", "--parts")

    assert (ended.code, ended.out) == (3, "")
    assert ended.err.startswith("error: -: is a tree file, which has no parts; ask about the mesh")


def test_turned_part_has_the_bounds_of_what_stands_there(files):
    half = 0.5**0.5
    (files / "t.glb").write_bytes(cubes(at("t", 5, 0, 0, rotation=[0, 0, half, half])))

    (part,) = load_parts("t.glb")

    np.testing.assert_allclose(part.placed_bounds(), [[4, 0, 0], [5, 1, 1]], atol=1e-15)


def test_mesh_file_is_a_scene_of_its_parts(files, obbtree):
    answer = obbtree("scene", "a.glb", "--json").json

    assert [body["name"] for body in answer["bodies"]] == ["frame", "arm", "lid"]
    assert [body["mesh"] for body in answer["bodies"]] == [0, 0, 0]
    assert [mesh["path"] for mesh in answer["inputs"]["meshes"]] == ["a.glb"]
    assert answer["inputs"]["scene"]["triangle_count"] is None
    assert answer["inputs"]["meshes"][0]["triangle_count"] == 36
    assert [(c["body_a"], c["body_b"], c["time"]) for c in answer["result"]["contacts"]] == [
        ("frame", "arm", 0.0)
    ]
    assert obbtree("scene", "a.glb", "--exit-code").code == 1
    assert obbtree("scene", "a.glb#[fl]*", "--exit-code", "--quiet").code == 0


def test_scene_of_parts_decodes_what_is_asked_about(files, obbtree):
    ended = obbtree("scene", "bad.glb", "--pairs", "x,y", "--explain")

    assert ended.code == 0
    assert "meshes decoded: 1 of 2" in ended.out
    assert (
        obbtree("scene", "bad.glb", "--pairs", "x,y", "--json").json["stats"]["meshes_decoded"] == 1
    )
    assert obbtree("scene", "bad.glb").code == 3


def test_scene_file_is_never_replaced_by_its_answer(files, obbtree):
    assert obbtree("scene", "a.glb", "-o", "a.glb").code == 2


def test_copies_answer_as_meshes_that_are_copies_bit_for_bit(files):
    turn = [0.1, 0.2, 0.3, (1 - 0.14) ** 0.5]
    nodes = [at("a", 0.3, 0, 0), at("b", 1.1, 0.4, 0.2, rotation=turn), at("c", -0.6, 0, 0)]
    (files / "t.glb").write_bytes(cubes(*nodes))
    parts = load_parts("t.glb").parts

    shared = list(Scene(load_parts("t.glb")).first_contacts())
    copied = {
        part.path: obbcli.Body(
            obbcli.Mesh(part.mesh.vertices, part.mesh.triangles),
            Pose(part.pose.rotation, part.pose.translation),
        )
        for part in parts
    }

    assert shared == list(Scene(copied).first_contacts())
    assert len(shared) == 2
    a, b, _ = parts
    one, two = obbcli.distance(a, parts[2]), obbcli.distance(copied["a"], copied["c"])
    assert (one.bounds, one.point_a, one.triangle_b) == (two.bounds, two.point_a, two.triangle_b)
    assert obbcli.collide(a, b).witness == obbcli.collide(copied["a"], copied["b"]).witness


def test_parts_without_names_are_called_as_their_file(files):
    (files / "n.glb").write_bytes(cubes({"mesh": 0}, {"mesh": 0}, at("n", 0, 0, 0)))

    assert [body.name for body in Scene.load("n.glb").bodies] == ["n", "#2", "n#2"]
    assert [body.name for body in Scene.load("cube.stl").bodies] == ["cube"]


def test_scene_of_parts_refuses_what_a_scene_refuses(files):
    with pytest.raises(SceneError):
        list(Scene.load("a.glb").first_contacts(pairs=[("frame", "gone")]))
    with pytest.raises(MeshError, match="matches none"):
        Scene.load("a.glb#gone")
    with pytest.raises(MeshError, match="no such file"):
        Scene.load("gone.glb")
