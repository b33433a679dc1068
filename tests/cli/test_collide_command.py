"""`obbtree collide`: answers, exit codes, documents, and where bodies come from."""

from __future__ import annotations

import hashlib
import io
import json
import math
import sys
from itertools import product

import pytest
from mesh_files.cube_files import all_pairs, as_input, cube, obj, stl

from obbcli import Accuracy, __version__

KEYS = ["schema", "tool_version", "inputs", "motion", "accuracy", "solid", "result", "stats"]


def pipe_in(monkeypatch: pytest.MonkeyPatch, data: bytes) -> None:
    """Let standard input hold `data`."""
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))


def test_collide_says_that_touching_cubes_touch(here, obbtree):
    ended = obbtree("collide", "cube.stl", "touching.obj")

    assert ended.code == 0
    assert "overlap_at_start" in ended.out
    assert "cube.stl (12 triangles)" in ended.out
    assert ended.err == ""


def test_collide_says_that_cubes_a_hair_apart_are_apart(here, obbtree):
    ended = obbtree("collide", "cube.stl", "apart.obj", "--json")

    assert ended.json["result"] == {
        "status": "separated",
        "collides": False,
        "witness": None,
        "approximate": False,
        "error_bound": 0.0,
        "contained": None,
    }


def test_collide_document_holds_what_was_asked_and_answered(here, obbtree):
    document = obbtree("collide", "cube.stl", "touching.obj", "--json").json

    assert list(document) == KEYS
    assert document["schema"] == "obbtree/collide/1"
    assert document["tool_version"] == __version__
    assert document["inputs"]["a"] == as_input(here / "cube.stl")
    assert document["motion"]["duration"] == 0.0
    assert document["motion"]["b"] == {
        "pose": {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "translation": [0, 0, 0]},
        "linear_velocity": [0, 0, 0],
        "angular_velocity": [0, 0, 0],
        "pivot": [1.5, 0.5, 0.5],
    }
    assert document["accuracy"] == Accuracy().as_dict()
    assert document["result"]["status"] == "overlap_at_start"
    assert document["solid"] is False
    assert document["result"]["collides"] is True
    assert document["stats"]["triangle_tests"] >= 1
    assert set(document["stats"]["seconds"]) == {"load", "query"}


def test_collide_witness_is_a_pair_that_meets(here, obbtree):
    witness = obbtree("collide", "cube.stl", "touching.obj", "--json").json["result"]["witness"]

    assert witness in all_pairs((1, 0, 0))


def test_collide_lists_every_intersecting_pair(here, obbtree):
    result = obbtree("collide", "cube.stl", "touching.obj", "--all-pairs", "--json").json["result"]

    assert result["pairs"] == all_pairs((1, 0, 0))
    assert result["pairs_complete"] is True


def test_collide_shows_pairs_in_a_table(here, obbtree):
    out = obbtree("collide", "cube.stl", "touching.obj", "--all-pairs").out

    lines = out.splitlines()
    start = next(i for i, line in enumerate(lines) if "intersecting pairs" in line)
    assert [[int(n) for n in line.split()] for line in lines[start + 3 :]] == all_pairs((1, 0, 0))


def test_collide_says_that_there_are_no_pairs(here, obbtree):
    ended = obbtree("collide", "cube.stl", "apart.obj", "--all-pairs")

    assert ended.out.endswith("\n\nno pairs of triangles intersect\n")
    assert obbtree("collide", "cube.stl", "apart.obj", "--all-pairs", "-q").out == ""


def test_collide_limit_cuts_the_list_and_says_so(here, obbtree):
    words = ("collide", "cube.stl", "touching.obj", "--all-pairs", "--limit", 3)

    ended = obbtree(*words, "--json")

    pairs = ended.json["result"]["pairs"]
    assert len(pairs) == 3
    assert pairs == sorted(pairs)
    assert all(pair in all_pairs((1, 0, 0)) for pair in pairs)
    assert ended.json["result"]["pairs_complete"] is False
    assert obbtree(*words).err == "note: 3 pairs are listed, more exist; raise --limit\n"


def test_collide_limit_that_cuts_nothing_says_nothing(here, obbtree):
    pairs = all_pairs((1, 0, 0))
    words = ("collide", "cube.stl", "touching.obj", "--all-pairs", "--limit", len(pairs), "--json")

    ended = obbtree(*words)

    assert ended.json["result"]["pairs"] == pairs
    assert ended.json["result"]["pairs_complete"] is True
    assert ended.err == ""


def test_collide_quiet_answers_in_one_word(here, obbtree):
    assert obbtree("collide", "cube.stl", "apart.obj", "-q").out == "separated\n"
    out = obbtree("collide", "cube.stl", "touching.obj", "-q", "--all-pairs", "--limit", 1).out
    assert [int(n) for n in out.split()] in all_pairs((1, 0, 0))


@pytest.mark.parametrize(
    ("other", "words", "code"),
    [
        ("touching.obj", (), 0),
        ("touching.obj", ("--exit-code",), 1),
        ("apart.obj", ("--exit-code",), 0),
        # Boxes that meet are contact; boxes that are apart are a proof, however coarse.
        ("touching.obj", ("--exit-code", "--max-depth", "0"), 1),
        ("apart.obj", ("--exit-code", "--max-depth", "0", "--translate-b", "9", "0", "0"), 0),
    ],
)
def test_collide_exit_codes(here, obbtree, other, words, code):
    assert obbtree("collide", "cube.stl", other, *words).code == code


def test_collide_at_a_limit_is_unresolved(here, obbtree):
    ended = obbtree("collide", "cube.stl", "apart.obj", "--max-iterations", 1, "--json")

    assert ended.code == 4
    assert ended.json["result"]["status"] == "unresolved"
    assert ended.json["result"]["collides"] is None


def test_collide_on_boxes_says_approximate(here, obbtree):
    result = obbtree("collide", "cube.stl", "apart.obj", "--max-depth", 0, "--json").json["result"]

    assert result["approximate"] is True
    assert result["error_bound"] >= 2**-40
    assert result["witness"] is None


@pytest.mark.parametrize(
    ("words", "status"),
    [
        (("--translate", "-1e-3", "0", "0"), "separated"),
        (("--translate", "1e-3", "-.5", "+.5"), "overlap_at_start"),
        (("--translate-b", "0", "-1.0000001", "0"), "separated"),
        (("--translate-b", "0", "-1", "-1"), "overlap_at_start"),
        # A quarter turn about z in degrees is exact: the cube comes to lie at x in [-1, 0].
        (("--rotate", "0", "0", "90", "--degrees"), "separated"),
        (("--rotate", "0", "0", "90", "--degrees", "--translate", "1", "0", "0"),
         "overlap_at_start"),
        (("--rotate-b", "0", "0", "-90", "--degrees", "--translate-b", "0", "2", "0"),
         "overlap_at_start"),
        (("--rotate", "0", "0", repr(math.pi)), "separated"),
    ],
)  # fmt: skip
def test_collide_poses_place_the_bodies(here, obbtree, words, status):
    ended = obbtree("collide", "cube.stl", "touching.obj", *words, "--json")

    assert ended.json["result"]["status"] == status


def test_collide_is_the_same_on_meshes_and_trees(here, obbtree):
    obbtree("build", "cube.stl", "touching.obj")
    words = ("--all-pairs", "--translate-b", 0, 0.25, 0, "--json")
    kinds = product(("cube.stl", "cube.obbt"), ("touching.obj", "touching.obbt"))

    documents = [obbtree("collide", a, b, *words).json for a, b in kinds]

    for document in documents:
        del document["stats"]
        del document["inputs"]
    assert all(json.dumps(one) == json.dumps(documents[0]) for one in documents)


@pytest.mark.parametrize("kind", ["stl", "obj", "obbt"])
def test_collide_reads_one_body_from_standard_input(here, obbtree, monkeypatch, kind):
    obbtree("build", "touching.obj")
    data = {
        "stl": stl(cube((1, 0, 0))),
        "obj": obj(cube((1, 0, 0))).encode(),
        "obbt": (here / "touching.obbt").read_bytes(),
    }[kind]
    pipe_in(monkeypatch, data)

    document = obbtree("collide", "cube.stl", "-", "--json").json

    assert document["result"]["status"] == "overlap_at_start"
    assert document["inputs"]["b"] == {
        "path": "-",
        "sha256": hashlib.sha256(data).hexdigest(),
        "triangle_count": 12,
        "notes": [],
    }


def test_collide_cannot_read_both_bodies_from_standard_input(here, obbtree):
    ended = obbtree("collide", "-", "-")

    assert ended.code == 2
    assert "name a file for one of them" in ended.err


def test_collide_writes_its_answer_to_a_file(here, obbtree):
    ended = obbtree("collide", "cube.stl", "apart.obj", "--json", "-o", "answer.json")

    assert (ended.code, ended.out, ended.err) == (0, "", "")
    assert json.loads((here / "answer.json").read_text())["result"]["status"] == "separated"
    assert {path.name for path in here.iterdir()} == {
        "answer.json", "apart.obj", "cube.stl", "touching.obj",
    }  # fmt: skip


def test_collide_skips_checksums_on_request(here, obbtree):
    obbtree("build", "cube.stl")
    data = bytearray((here / "cube.obbt").read_bytes())
    data[-1] ^= 1
    (here / "cube.obbt").write_bytes(data)

    refused = obbtree("collide", "cube.obbt", "apart.obj")
    answered = obbtree("collide", "cube.obbt", "apart.obj", "--no-verify")

    assert refused.code == 3
    assert "cube.obbt" in refused.err
    assert answered.code == 0
