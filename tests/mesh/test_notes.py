"""Notes: what of a file was taken with a change is told by meshes, trees, tables and documents."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest
from mesh_files.cell_files import HEXAHEDRON, write

from obbcli import Mesh, ObbTree, Scene, TreeFileError, load_mesh
from obbcli.cli import main

if TYPE_CHECKING:
    from pathlib import Path

NOTE = "1 volume cell taken as its boundary"
SCENE = """duration = 1.0
[[body]]
name = "cell"
mesh = "{}"
[[body]]
name = "again"
mesh = "a.vtk"
"""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the working folder, which holds a.vtk: one hexahedron; and a.obbt, its tree."""
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "a.vtk", [("hexahedron", HEXAHEDRON)])
    ObbTree.build(tmp_path / "a.vtk").save(tmp_path / "a.obbt")
    return tmp_path


def printed(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    capsys.readouterr()
    assert main(list(words)) == 0
    return capsys.readouterr().out


def documented(capsys: pytest.CaptureFixture[str], *words: str) -> Any:
    return json.loads(printed(capsys, *words, "--json"))


def test_mesh_made_in_code_has_no_notes() -> None:
    assert Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).notes == ()


def test_mesh_of_a_file_says_what_was_changed(here: Path) -> None:
    assert load_mesh(here / "a.vtk").notes == (NOTE,)


def test_trees_and_their_files_keep_notes(here: Path) -> None:
    built = ObbTree.build(here / "a.vtk")

    for tree in (built, ObbTree.open(here / "a.obbt"), ObbTree.from_bytes(built.to_bytes())):
        assert tree.notes == tree.mesh.notes == (NOTE,)


def test_tree_files_without_notes_have_no_key_for_them() -> None:
    # Readers of version 1 refuse keys that they do not know.
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2], [1, 2, 3]])

    assert b"notes" not in ObbTree.build(mesh).to_bytes()


def test_tree_files_refuse_notes_that_a_terminal_would_obey() -> None:
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], notes=["plain"])
    data = ObbTree.build(mesh).to_bytes()
    from obbcli.tree import header

    description = header.checked_header(memoryview(data), len(data), "x").description
    text = json.dumps({"notes": ["\x1b[2J"]})
    assert description.notes == ("plain",)
    with pytest.raises(TreeFileError, match="notes"):
        header._description(_with(data, text), "x", 1)


def _with(data: bytes, more: str) -> bytes:
    """Return the description of a tree file with other keys put in."""
    start = data.index(b"{")
    fields, _ = json.JSONDecoder().raw_decode(data[start:].decode("latin-1"))
    return json.dumps(fields | json.loads(more)).encode()


def test_notes_hold_nothing_that_a_terminal_would_obey() -> None:
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], notes=["name \x1b[2J\n"])

    assert mesh.notes == ("name ?[2J?",)
    assert ObbTree.from_bytes(ObbTree.build(mesh).to_bytes()).notes == mesh.notes


@pytest.mark.parametrize("file", ["a.vtk", "a.obbt"])
def test_info_tells_notes(file: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert documented(capsys, "info", file)["inputs"]["file"]["notes"] == [NOTE]
    assert f"note        {NOTE}\n" in printed(capsys, "info", file)


@pytest.mark.parametrize("command", ["collide", "distance", "first-contact", "view"])
@pytest.mark.parametrize("file", ["a.vtk", "a.obbt"])
def test_questions_tell_notes(
    command: str, file: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = ("-o", "x.glb", "--force") if command == "view" else ()
    words = (command, file, "a.vtk", *output)

    inputs = documented(capsys, *words)["inputs"]

    assert inputs["a"]["notes"] == inputs["b"]["notes"] == [NOTE]
    shown = printed(capsys, *words).splitlines()
    assert [" ".join(line.split()) for line in shown[2:4]] == [f"note A: {NOTE}", f"note B: {NOTE}"]


@pytest.mark.parametrize("command", ["stability", "tradeoff"])
def test_studies_tell_notes(command: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = (command, "a.vtk", "a.obbt", *(("--budget", "0.1") if command == "tradeoff" else ()))

    assert documented(capsys, *words)["inputs"]["b"]["notes"] == [NOTE]


def test_builds_tell_notes(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert documented(capsys, "build", "a.vtk", "--force")["inputs"][0]["notes"] == [NOTE]
    assert f"note  a.vtk: {NOTE}\n" in printed(capsys, "build", "a.vtk", "--force")


@pytest.mark.parametrize("file", ["a.vtk", "a.obbt"])
def test_scenes_tell_notes_of_each_file_once(
    file: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (here / "s.toml").write_text(SCENE.format(file))

    meshes = documented(capsys, "scene", "s.toml")["inputs"]["meshes"]

    files = list(dict.fromkeys([file, "a.vtk"]))
    assert [(mesh["path"], mesh["notes"]) for mesh in meshes] == [(name, [NOTE]) for name in files]
    assert printed(capsys, "scene", "s.toml").count(NOTE) == len(files)
    assert Scene.load("s.toml")


def test_sweeps_tell_notes_and_go_on(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "q.csv").write_text("vel\n0 0 1\n")
    words = ("sweep", "a.vtk", "a.obbt", "q.csv", "-o", "r.jsonl")

    assert documented(capsys, *words)["inputs"]["a"]["notes"] == [NOTE]
    header = json.loads((here / "r.jsonl").read_text().splitlines()[0])
    assert header["inputs"]["b"]["notes"] == [NOTE]
    assert documented(capsys, *words, "--resume")["result"]["resumed_from"] == 1
