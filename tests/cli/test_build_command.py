"""`obbtree build`: where trees go, what is never overwritten, and what one bad mesh costs."""

from __future__ import annotations

import io
import json
import sys

import pytest
from mesh_files.cube_files import as_input, cube, stl

from obbcli import ObbTree


def test_build_puts_the_tree_beside_its_mesh(here, obbtree):
    (here / "parts").mkdir()
    (here / "parts" / "gear.v2.stl").write_bytes(stl(cube()))

    ended = obbtree("build", "parts/gear.v2.stl")

    assert ended.code == 0
    assert "parts/gear.v2.obbt" in ended.out
    tree = ObbTree.open(here / "parts" / "gear.v2.obbt")
    tree.check()
    assert tree.triangle_count == 12
    assert tree.source == "gear.v2.stl"


def test_build_document_tells_what_was_written(here, obbtree):
    document = obbtree("build", "cube.stl", "touching.obj", "--json").json

    size = (here / "cube.obbt").stat().st_size
    assert list(document) == ["schema", "tool_version", "inputs", "options", "result", "stats"]
    assert document["schema"] == "obbtree/build/1"
    assert document["inputs"][0] == as_input(here / "cube.stl")
    assert document["options"] == {
        "fit": "triangles", "split": "compact", "leaf_size": 1, "max_depth": None,
    }  # fmt: skip
    assert document["result"]["files"][0] == {
        "output": "cube.obbt",
        "error": None,
        "triangle_count": 12,
        "vertex_count": 36,
        "node_count": 11,
        "level_count": 7,
        "file_bytes": size,
        "bytes_per_triangle": size / 12,
    }
    outputs = [file["output"] for file in document["result"]["files"]]
    assert outputs == ["cube.obbt", "touching.obbt"]
    assert set(document["stats"]["seconds"][0]) == {"load", "build", "save"}


def test_build_passes_its_options_on(here, obbtree):
    words = ("--fit", "axis-aligned", "--split", "center", "--leaf-size", 3, "--max-depth", 4)

    assert obbtree("build", "cube.stl", *words).code == 0

    tree = ObbTree.open(here / "cube.obbt")
    assert (tree.fit, tree.split, tree.leaf_size, tree.max_depth) == (
        "axis-aligned",
        "center",
        3,
        4,
    )


def test_build_into_a_directory(here, obbtree):
    (here / "trees").mkdir()

    assert obbtree("build", "cube.stl", "touching.obj", "-o", "trees").code == 0

    assert {path.name for path in (here / "trees").iterdir()} == {"cube.obbt", "touching.obbt"}


def test_build_to_a_named_file(here, obbtree):
    assert obbtree("build", "cube.stl", "-o", "any name").code == 0

    ObbTree.open(here / "any name").check()


def test_build_reads_standard_input(here, obbtree, monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(stl(cube()))))

    assert obbtree("build", "-", "-o", "piped.obbt").code == 0

    assert ObbTree.open(here / "piped.obbt").triangle_count == 12


def test_build_does_not_replace_a_file_unasked(here, obbtree):
    (here / "cube.obbt").write_bytes(b"precious")

    ended = obbtree("build", "cube.stl")

    assert ended.code == 5
    assert ended.err == "error: cube.obbt: exists already; add --force to replace it\n"
    assert (here / "cube.obbt").read_bytes() == b"precious"


def test_build_replaces_a_file_on_request(here, obbtree):
    (here / "cube.obbt").write_bytes(b"old")

    assert obbtree("build", "cube.stl", "--force").code == 0

    ObbTree.open(here / "cube.obbt").check()


def test_build_never_replaces_what_is_no_file(here, obbtree):
    ended = obbtree("build", "cube.stl", "--force", "-o", "/dev/null")

    assert ended.code == 5
    assert "is not a file" in ended.err


def test_build_into_a_missing_folder_is_an_output_fault(here, obbtree):
    ended = obbtree("build", "cube.stl", "-o", "gone/cube.obbt")

    assert ended.code == 5
    assert "create its folder first" in ended.err


def test_build_continues_past_a_bad_mesh(here, obbtree):
    (here / "bad.stl").write_bytes(b"")

    ended = obbtree("build", "cube.stl", "bad.stl", "gone.obj", "touching.obj")

    assert ended.code == 3
    assert (here / "cube.obbt").exists()
    assert (here / "touching.obbt").exists()
    lines = ended.err.splitlines()
    assert [line.split(":")[1].strip() for line in lines[:2]] == ["bad.stl", "gone.obj"]
    assert lines[2] == "note: 2 of 4 trees were not built"


def test_build_as_json_tells_bad_meshes_apart(here, obbtree):
    ended = obbtree("build", "cube.stl", "gone.obj", "--json", "-q")

    assert ended.error["where"] == "gone.obj"
    assert [source["triangle_count"] for source in ended.json["inputs"]] == [12, None]
    good, bad = ended.json["result"]["files"]
    assert good["error"] is None
    assert bad == {"output": None, "error": "gone.obj: no such file; check the path"}


def test_build_with_several_faults_exits_with_the_highest(here, obbtree):
    (here / "touching.obbt").write_bytes(b"")

    assert obbtree("build", "gone.obj", "cube.stl", "touching.obj").code == 5


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (("cube.stl", "touching.obj", "-o", "one.obbt"), "is not a directory"),
        (("cube.stl", "./cube.stl"), "would hold 2 trees"),
        (("-",), "add -o FILE"),
        ((), "Missing argument"),
        (("cube.stl", "--leaf-size", "0"), "'0' is not a whole number of at least 1"),
        (("cube.stl", "--max-depth", "-1"), "'-1' is not a whole number of at least 0"),
        (("cube.stl", "--max-depth", "1.5"), "'1.5' is not a whole number of at least 0"),
        (("cube.stl", "--max-depth", "1_0"), "'1_0' is not a whole number of at least 0"),
        (("cube.stl", "-o", ""), "an empty word names no file"),
        (("cube.stl", "-o", "-"), "not to standard output"),
        (("",), "an empty word names no file"),
        (("cube.stl", "--fit", "tight"), "'tight' is not one of"),
        (("cube.stl", "--max-memory", "lots"), "'lots' is no number of bytes"),
        (("cube.stl", "--max-memory", "-5"), "'-5' is no number of bytes"),
        (("cube.stl", "--max-memory", ""), "'' is no number of bytes"),
    ],
)
def test_build_refuses_usage_that_means_nothing(here, obbtree, words, fault):
    ended = obbtree("build", *words)

    assert ended.code == 2
    assert ended.err.count("\n") == 1
    assert fault in ended.err
    assert not list(here.glob("*.obbt"))


def test_build_refuses_a_tree_as_mesh(here, obbtree):
    obbtree("build", "cube.stl")

    ended = obbtree("build", "cube.obbt", "-o", "again.obbt")

    assert ended.code == 3
    assert "is a tree file already" in ended.err


@pytest.mark.parametrize(("limit", "code"), [("100", 3), ("1k", 3), ("1M", 0), ("1g", 0)])
def test_build_keeps_to_its_memory(here, obbtree, limit, code):
    ended = obbtree("build", "cube.stl", "--max-memory", limit)

    assert ended.code == code
    assert (here / "cube.obbt").exists() == (code == 0)


def test_build_over_its_memory_names_the_mesh_as_it_was_written(here, obbtree):
    ended = obbtree("build", here / "cube.stl", "--max-memory", 1)

    assert ended.err.startswith(f"error: {here / 'cube.stl'}: a build over 12 triangles needs")


@pytest.mark.parametrize(
    "output", ["cube.stl", "./cube.stl", "link.stl", "hard.stl", "touching.obj"]
)
def test_build_never_replaces_a_mesh_by_its_tree(here, obbtree, output):
    (here / "link.stl").symlink_to("cube.stl")
    (here / "hard.stl").hardlink_to(here / "cube.stl")
    before = {path.name: path.read_bytes() for path in here.iterdir()}
    meshes = ("cube.stl", "touching.obj") if output == "touching.obj" else ("cube.stl",)

    ended = obbtree("build", *meshes, "-o", output, "--force")

    assert ended.code == 2
    assert len(meshes) == 2 or "would be lost; write to another file" in ended.err
    assert {path.name: path.read_bytes() for path in here.iterdir()} == before


def test_build_into_a_folder_keeps_an_input_of_that_name(here, obbtree):
    (here / "cube.obbt").write_bytes((here / "touching.obj").read_bytes())
    before = (here / "cube.obbt").read_bytes()

    ended = obbtree("build", "cube.stl", "cube.obbt", "--force")

    assert ended.code == 2
    assert (here / "cube.obbt").read_bytes() == before


def test_build_where_every_mesh_fails_is_one_document_all_the_same(here, obbtree):
    ended = obbtree("build", "gone.stl", "lost.obj", "--json")

    assert ended.code == 3
    assert [file["output"] for file in ended.json["result"]["files"]] == [None, None]
    assert ended.json["result"]["errors"] == [
        {"path": name, "error": "no such file", "where": name, "remedy": "check the path"}
        for name in ("gone.stl", "lost.obj")
    ]
    assert [json.loads(line)["where"] for line in ended.err.splitlines()] == [
        "gone.stl",
        "lost.obj",
    ]


@pytest.mark.parametrize(
    ("bad", "note"),
    [
        (("gone.stl",), "note: 1 of 2 trees was not built"),
        (("gone.stl", "lost.obj"), "note: 2 of 3 trees were not built"),
    ],
)
def test_build_counts_what_was_not_built(here, obbtree, bad, note):
    assert obbtree("build", "cube.stl", *bad).err.splitlines()[-1] == note


def test_build_quiet_says_nothing(here, obbtree):
    ended = obbtree("build", "cube.stl", "--quiet")

    assert (ended.code, ended.out, ended.err) == (0, "", "")


def test_build_interrupted_leaves_no_file(here, obbtree, monkeypatch):
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = {path.name for path in here.iterdir()}
    monkeypatch.setattr("os.fsync", interrupt)

    ended = obbtree("build", "cube.stl", "touching.obj")

    assert ended.code == 130
    assert ended.err.startswith("error: interrupted")
    assert ended.err.count("\n") == 1
    assert {path.name for path in here.iterdir()} == before
