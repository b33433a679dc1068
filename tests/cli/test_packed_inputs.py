"""Meshes packed by gzip on the command line: answers, hashes, scenes of their parts, refusals."""

from __future__ import annotations

import gzip
import hashlib
import io
import sys

import pytest

PARTS = "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nf 1 3 2\n"


@pytest.fixture
def packed(here):
    """Work in a folder where each cube is packed as well."""
    for name in ("cube.stl", "touching.obj", "apart.obj"):
        (here / f"{name}.gz").write_bytes(gzip.compress((here / name).read_bytes(), mtime=0))
    return here


def result(document):
    return {key: document[key] for key in ("motion", "accuracy", "result")}


@pytest.mark.parametrize("command", ["collide", "first-contact", "distance"])
def test_answers_about_packed_meshes_are_those_about_plain_ones(packed, obbtree, command):
    words = ("--translate-b", 0.25, 0.125, 0, "--json")

    plain = obbtree(command, "cube.stl", "touching.obj", *words).json
    ended = obbtree(command, "cube.stl.gz", "touching.obj.gz", *words)

    assert ended.code == 0
    assert result(ended.json) == result(plain)
    for name, file in (("a", "cube.stl.gz"), ("b", "touching.obj.gz")):
        digest = hashlib.sha256((packed / file).read_bytes()).hexdigest()
        expected = {"path": file, "sha256": digest, "triangle_count": 12, "notes": []}
        assert ended.json["inputs"][name] == expected


def test_tree_of_a_packed_mesh_keeps_the_hash_of_its_file(packed, obbtree):
    obbtree("build", "cube.stl.gz", "-o", "cube.obbt")

    document = obbtree("info", "cube.obbt", "--json").json
    mesh = obbtree("info", "cube.stl.gz", "--json").json

    digest = hashlib.sha256((packed / "cube.stl.gz").read_bytes()).hexdigest()
    assert digest in str(document)
    assert digest in str(mesh)
    assert obbtree("collide", "cube.obbt", "touching.obj.gz", "-q").out == "overlap_at_start\n"


def test_packed_standard_input_is_read(packed, obbtree, monkeypatch):
    stream = io.TextIOWrapper(io.BytesIO((packed / "touching.obj.gz").read_bytes()))
    monkeypatch.setattr(sys, "stdin", stream)

    assert obbtree("collide", "cube.stl", "-", "-q").out == "overlap_at_start\n"


def test_parts_of_a_packed_mesh_are_a_scene(here, obbtree):
    (here / "m.obj.gz").write_bytes(gzip.compress(PARTS.encode(), mtime=0))

    assert obbtree("scene", "m.obj.gz", "-q").out == "overlap_at_start 0.0 a b\n"
    assert obbtree("info", "m.obj.gz", "--parts", "-q").out == "a\nb\n"
    assert obbtree("collide", "m.obj.gz#a", "m.obj.gz#b", "-q").out == "overlap_at_start\n"


def test_packed_mesh_that_is_cut_off_is_one_line(packed, obbtree):
    path = packed / "cube.stl.gz"
    path.write_bytes(path.read_bytes()[:-5])

    ended = obbtree("collide", path.name, "touching.obj.gz")

    assert ended.code == 3
    assert ended.out == ""
    assert ended.err == (
        "error: cube.stl.gz: is a gzip file that ends too soon; copy or download it again\n"
    )
