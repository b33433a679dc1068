"""Input that must be refused: one clear line, exit code 3, and no partial file."""

from __future__ import annotations

import io
import struct
import sys
from pathlib import Path

import pytest
from mesh_files.cube_files import cube, obj, stl

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
GOOD = stl(cube())

FILES = {
    "empty.stl": (b"", "is empty"),
    "truncated.stl": (GOOD[:-1], "truncated.stl"),
    "huge_count.stl": (GOOD[:80] + struct.pack("<I", 2**31 + 12) + GOOD[84:], "huge_count.stl"),
    "small_count.stl": (GOOD[:80] + struct.pack("<I", 1) + GOOD[84:], "small_count.stl"),
    "no_faces.stl": (bytes(84), "no faces"),
    "no_faces.obj": (TRIANGLE.encode(), "no faces"),
    "out_of_range.obj": (TRIANGLE.encode() + b"f 1 2 9\n", "out_of_range.obj:4"),
    "nan.obj": (b"v 0 nan 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "nan"),
    "infinite.obj": (b"v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n", "inf"),
    "nan.stl": (GOOD[:96] + struct.pack("<f", float("nan")) + GOOD[100:], "nan"),
    "cube.xyz": (TRIANGLE.encode(), "unknown mesh suffix '.xyz'"),
    "cube": (TRIANGLE.encode(), "no suffix"),
    "wrong.ply": (GOOD[:-1], "wrong.ply"),
    "pointer.stl": (b"version https://git-lfs.github.com/spec/v1\n", 'run "git lfs pull"'),
    "text.obbt": (b"not a tree", "is not a tree file"),
    "empty.obbt": (b"", "is not a tree file"),
}
COMMANDS = {
    "collide as A": ("collide", "{bad}", "cube.stl"),
    "collide as B": ("collide", "cube.stl", "{bad}"),
    "build": ("build", "{bad}", "-o", "out.obbt"),
    "info": ("info", "{bad}"),
}


def check_refusal(ended, place: str) -> None:
    assert ended.code == 3
    assert ended.out == ""
    assert ended.err.startswith("error: ")
    assert ended.err.count("\n") == 1
    assert place in ended.err


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("name", FILES)
def test_bad_file_is_refused_in_one_line(here, obbtree, command, name):
    data, fault = FILES[name]
    (here / name).write_bytes(data)
    before = {path.name for path in here.iterdir()}

    ended = obbtree(*(word.format(bad=name) for word in COMMANDS[command]))

    check_refusal(ended, name)
    assert command == "build" or fault in ended.err
    assert {path.name for path in here.iterdir()} == before


@pytest.mark.parametrize("name", ["gone.stl", "gone", "gone.obbt"])
@pytest.mark.parametrize("command", COMMANDS)
def test_missing_file_is_refused(here, obbtree, command, name):
    ended = obbtree(*(word.format(bad=name) for word in COMMANDS[command]))

    check_refusal(ended, name)
    assert ended.err == f"error: {name}: no such file; check the path\n"


@pytest.mark.parametrize(
    ("name", "data", "guess"),
    [
        ("cube.ply", obj(cube()).encode(), "looks like an OBJ file (.obj)"),
        ("named.stl", b"# a comment\n" + obj(cube()).encode(), "looks like an OBJ file (.obj)"),
    ],
)
def test_wrong_name_is_refused_with_a_guess(here, obbtree, name, data, guess):
    (here / name).write_bytes(data)

    ended = obbtree("info", name)

    check_refusal(ended, name)
    assert guess in ended.err


@pytest.mark.parametrize("name", ["cube.obj", "cube.xyz", "cube"])
def test_wrong_name_is_told_where_the_content_says_what_it_is(here, obbtree, name):
    (here / name).write_bytes(GOOD)

    ended = obbtree("collide", name, "cube.stl", "--exit-code")

    assert ended.code == 1
    assert "A: is a binary STL file by its content, and is read as such" in ended.out


@pytest.mark.parametrize("name", ["folder", "folder.stl", "folder.obbt"])
@pytest.mark.parametrize("command", COMMANDS)
def test_directory_is_refused(here, obbtree, command, name):
    (here / name).mkdir()

    ended = obbtree(*(word.format(bad=name) for word in COMMANDS[command]))

    check_refusal(ended, name)
    assert "is a directory" in ended.err


@pytest.mark.parametrize("name", ["cube.stl", "cube.obbt"])
def test_file_that_may_not_be_read_is_refused(here, obbtree, monkeypatch, name):
    obbtree("build", "cube.stl")
    # Whoever may read everything cannot be refused by permissions, so the system's answer is given.
    refusal = PermissionError(13, "Permission denied", name)
    real = Path.open

    def refuse(path: Path, *arguments: object, **options: object) -> object:
        if path.name == name:
            raise refusal
        return real(path, *arguments, **options)

    monkeypatch.setattr(Path, "open", refuse)

    ended = obbtree("info", name)

    check_refusal(ended, name)
    assert "ermission denied" in ended.err


def test_refusal_is_one_object_as_json(here, obbtree):
    (here / "bad.obj").write_text(TRIANGLE + "f 1 2 9\n")

    ended = obbtree("collide", "cube.stl", "bad.obj", "--json")

    assert ended.code == 3
    assert ended.out == ""
    assert ended.error["where"] == "bad.obj:4"
    assert ended.error["kind"] == "MeshError"
    assert ended.error["code"] == 3
    assert "vertex 9 of 3" in ended.error["error"]
    assert "remedy" in ended.error


@pytest.mark.parametrize("data", [b"", b"nonsense", GOOD[:-1]])
def test_bad_standard_input_is_refused(here, obbtree, monkeypatch, data):
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))

    check_refusal(obbtree("collide", "-", "cube.stl"), "<stdin>")


def test_standard_input_from_a_keyboard_is_refused(here, obbtree, monkeypatch):
    class Keyboard(io.TextIOWrapper):
        def isatty(self) -> bool:
            return True

    monkeypatch.setattr(sys, "stdin", Keyboard(io.BytesIO(obj(cube()).encode())))

    check_refusal(obbtree("info", "-"), "<stdin>: is no file or pipe")


@pytest.mark.parametrize("keep", [0, 1, 7, 8, 40, 63, 64, 200, -1])
def test_truncated_tree_is_refused(here, obbtree, keep):
    obbtree("build", "cube.stl")
    data = (here / "cube.obbt").read_bytes()
    (here / "short.obbt").write_bytes(data[:keep])

    check_refusal(obbtree("info", "short.obbt"), "short.obbt")
