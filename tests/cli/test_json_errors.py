"""Errors under `--json`: one object on standard error and nothing else there, whatever failed."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click
import pytest
from claims.schemas import require_valid

import obbcli
from obbcli import MeshError
from obbcli.cli.app import app
from obbcli.cli.boundary import guarded

if TYPE_CHECKING:
    from pathlib import Path

KEYS = ["schema", "tool_version", "error", "kind", "code", "where", "remedy"]
FILES = {
    "collide": ("gone.stl", "cube.stl"),
    "first-contact": ("gone.stl", "cube.stl"),
    "distance": ("gone.stl", "cube.stl"),
    "overlap": ("gone.stl", "cube.stl"),
    "clearance": ("gone.stl", "cube.stl"),
    "intervals": ("gone.stl", "cube.stl"),
    "range": ("gone.stl", "cube.stl"),
    "scene": ("gone.stl",),
    "sweep": ("gone.stl", "cube.stl", "q.csv", "-o", "out.jsonl"),
    "stability": ("gone.stl", "cube.stl"),
    "tradeoff": ("gone.stl", "cube.stl"),
    "build": ("gone.stl",),
    "info": ("gone.stl",),
    "view": ("gone.stl", "-o", "new.glb"),
    "schema": (),
    "manual": (),
}


def fail(fault: BaseException) -> None:
    raise fault


def only_error(err: str) -> dict[str, object]:
    """Return the one object that standard error must be."""
    assert err.endswith("}\n")
    assert err.count("\n") == 1
    error: dict[str, object] = json.loads(err)
    require_valid(error, "error")
    assert list(error) == KEYS
    assert error["tool_version"] == obbcli.__version__
    return error


def test_every_command_is_asked_here():
    assert set(FILES) == set(app.list_commands(click.Context(app)))


@pytest.mark.parametrize("command", [name for name in FILES if FILES[name]])
def test_missing_input_is_one_object(here: Path, obbtree, command):
    (here / "q.csv").write_text("vel\n1 0 0\n")

    ended = obbtree(command, *FILES[command], "--json")

    error = only_error(ended.err)
    assert (ended.code, error["code"]) == (3, 3)
    assert error["where"] == "gone.stl"
    assert "no such file" in str(error["error"])
    assert error["remedy"] == "check the path"


@pytest.mark.parametrize("command", FILES)
@pytest.mark.parametrize("before", [True, False])
def test_usage_error_is_one_object_wherever_the_flag_stands(here: Path, obbtree, command, before):
    words = ("--json", "--colour") if before else ("--colour", "--json")

    ended = obbtree(command, *FILES[command], *words)

    error = only_error(ended.err)
    assert (ended.code, error["code"], ended.out) == (2, 2, "")
    assert error["where"] == f"obbtree {command}"
    assert "--colour" in str(error["error"])


@pytest.mark.parametrize(
    "words",
    [
        ("--json",),
        ("colide", "a", "b", "--json"),
        ("--json", "info", "cube.stl"),
        ("info", "--json"),
        ("info", "cube.stl", "--json", "-o"),
        # An option that misses a number takes the flag for one.
        ("collide", "cube.stl", "apart.obj", "--vel", "1", "2", "--json"),
        ("info", "cube.stl", "more.stl", "--json"),
        ("build", "cube.stl", "--leaf-size", "0", "--json"),
    ],
)
def test_line_that_cannot_be_parsed_is_one_object(here: Path, obbtree, words):
    ended = obbtree(*words)

    assert (ended.code, only_error(ended.err)["code"], ended.out) == (2, 2, "")


def test_file_of_the_name_of_the_flag_is_no_flag(here: Path, obbtree):
    assert obbtree("info", "--", "--json").err == "error: --json: no such file; check the path\n"


def test_what_does_not_apply_is_null(capsys):
    code = guarded(lambda: fail(KeyboardInterrupt()), ["--json"])

    error = only_error(capsys.readouterr().err)
    assert (code, error["code"], error["error"], error["where"]) == (130, 130, "interrupted", None)

    guarded(lambda: fail(MeshError("gear.stl", "is no mesh")), ["--json"])

    assert only_error(capsys.readouterr().err)["remedy"] is None


def test_internal_error_is_one_object(here: Path, obbtree, monkeypatch):
    monkeypatch.setattr(
        "obbcli.questions.collide.collide_pair", lambda *_, **__: fail(IndexError("beyond\nall"))
    )

    ended = obbtree("collide", "cube.stl", "apart.obj", "--json")

    error = only_error(ended.err)
    assert (ended.code, error["code"], error["where"]) == (70, 70, "internal error")
    assert error["error"] == "IndexError: beyond all"


def test_debug_puts_the_traceback_into_the_object(here: Path, obbtree):
    ended = obbtree("info", "gone.stl", "--json", "--debug")

    assert ended.err.count("\n") == 1
    assert ended.error["traceback"].startswith("Traceback (most recent call last)")
    assert [*KEYS, "traceback"] == list(ended.error)
    require_valid(ended.error, "error")


def test_output_that_cannot_be_written_is_one_object(here: Path, obbtree, monkeypatch):
    ended = obbtree("info", "cube.stl", "--json", "-o", "gone/answer.json")

    error = only_error(ended.err)
    assert (ended.code, error["code"], error["where"]) == (5, 5, "gone/answer.json")

    with open("/dev/full", "w", encoding="utf-8") as full:  # noqa: PTH123  # a device
        monkeypatch.setattr("sys.stdout", full)
        ended = obbtree("collide", "cube.stl", "apart.obj", "--json")

    assert (ended.code, only_error(ended.err)["where"]) == (5, "standard output")


def test_several_inputs_are_an_object_a_line(here: Path, obbtree):
    ended = obbtree("build", "gone.stl", "cube.stl", "lost.obj", "--json")

    errors = [only_error(line) for line in ended.err.splitlines(keepends=True)]
    assert ended.code == 3
    assert [error["where"] for error in errors] == ["gone.stl", "lost.obj"]
    assert [bool(file["error"]) for file in ended.json["result"]["files"]] == [True, False, True]


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("collide", "cube.stl", "touching.obj", "--all-pairs", "--limit", 1), 0),
        (("first-contact", "cube.stl", "touching.obj", "--limit", 1), 0),
        (("first-contact", "cube.stl", "apart.obj", "--vel", 1, 0, 0, "--max-iterations", 1), 4),
        (("tradeoff", "cube.stl", "apart.obj", "--vel", 1, 0, 0, "--max-iterations", 1), 4),
        (("collide", "cube.stl", "touching.obj", "--exit-code"), 1),
    ],
)
def test_answer_is_no_error_and_has_no_notes(here: Path, obbtree, words, code):
    ended = obbtree(*words, "--json")

    assert (ended.code, ended.err) == (code, "")
    assert ended.json["schema"] == f"obbtree/{words[0]}/1"
