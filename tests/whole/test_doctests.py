"""Examples in docstrings do what they show, every question has one, and so does the program."""

from __future__ import annotations

import doctest
import inspect
import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import obbcli
from obbcli import primitives

ROOT = Path(__file__).resolve().parents[2]
MODULES = sorted(
    ".".join(path.relative_to(ROOT).with_suffix("").parts)
    for path in (ROOT / "obbcli").rglob("*.py")
    if ">>> " in path.read_text(encoding="utf-8")
)
PROGRAM = "tests/examples/latest_start.py"
GRIPPER = ("sample_meshes/finger_left.off", "sample_meshes/workpiece.obj")


@pytest.mark.parametrize("name", MODULES)
def test_examples_print_what_they_show(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    report: list[str] = []
    runner = doctest.DocTestRunner()
    lessons = doctest.DocTestFinder().find(import_module(name), name)
    for lesson in lessons:
        runner.run(lesson, out=report.append)

    assert any(lesson.examples for lesson in lessons)
    assert not report, "".join(report)


@pytest.mark.parametrize("package", [obbcli, primitives])
def test_every_question_has_an_example(package: object) -> None:
    names: list[str] = package.__all__  # type: ignore[attr-defined]
    functions = [getattr(package, name) for name in names if name != "__version__"]
    missing = [
        function.__name__
        for function in functions
        if inspect.isfunction(function) and ">>> " not in (function.__doc__ or "")
    ]
    assert not missing


def program(*words: str) -> subprocess.CompletedProcess[str]:
    """Run the example."""
    return subprocess.run(
        [sys.executable, PROGRAM, *words],
        cwd=ROOT,
        env=os.environ,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize(
    ("words", "said", "code"),
    [
        ((), "the finger may start 0.5 s later: contact by t = 0.5 s\n", 0),
        (("--speed", "20"), "the finger may start 0.75 s later: contact by t = 0.25 s\n", 0),
        (("--deadline", "0.4"), "the finger is late: no contact before t = 0.5 s\n", 1),
        (("--speed", "4"), "the finger never meets the workpiece: proven\n", 1),
    ],
)
def test_the_program_answers(words: tuple[str, ...], said: str, code: int) -> None:
    ended = program(*GRIPPER, *words)
    assert (ended.stdout, ended.returncode) == (said, code), ended.stderr


def test_the_program_tells_what_it_cannot_read() -> None:
    ended = program("lost.off", GRIPPER[1])
    assert (ended.stdout, ended.returncode) == ("", 2)
    assert ended.stderr == "lost.off: no such file; check the path\n"
