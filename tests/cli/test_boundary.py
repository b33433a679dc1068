"""The error boundary and the command itself: exit codes, one line a fault, help."""

from __future__ import annotations

import click
import pytest

import obbcli.cli
from obbcli import MeshError, MotionError, ObbError, SceneError, TreeFileError, UnresolvedError
from obbcli.cli import main
from obbcli.cli.app import app
from obbcli.cli.boundary import ExitCode, OutputError, UsageError, guarded

COMMANDS = ("collide", "first-contact", "build", "info")


def fail(fault: BaseException) -> None:
    raise fault


@pytest.mark.parametrize(
    ("fault", "code"),
    [
        (ObbError("place", "fault"), 3),
        (MeshError("place", "fault"), 3),
        (TreeFileError("place", "fault"), 3),
        (SceneError("place", "fault"), 3),
        (MotionError("place", "fault"), 3),
        (UnresolvedError("place", "fault"), 4),
        (OutputError("place", "fault"), 5),
        (UsageError("place", "fault"), 2),
        (click.UsageError("place: fault"), 2),
        (click.Abort(), 130),
        (KeyboardInterrupt(), 130),
        (FileNotFoundError(2, "No such file", "place"), 3),
        (MemoryError(), 3),
        (ZeroDivisionError("two\nlines"), 70),
        (RecursionError("deep"), 70),
    ],
)
def test_every_fault_is_one_line_and_a_code(capsys, fault, code):
    assert guarded(lambda: fail(fault), []) == code

    streams = capsys.readouterr()
    assert streams.out == ""
    assert streams.err.startswith("error: ")
    assert streams.err.count("\n") == 1
    assert "Traceback" not in streams.err


def test_line_names_place_fault_and_remedy(capsys):
    guarded(lambda: fail(MeshError("gear.obj:12", "uses vertex 9 of 8", "count from 1")), [])

    assert capsys.readouterr().err == "error: gear.obj:12: uses vertex 9 of 8; count from 1\n"


def test_names_that_would_break_the_line_are_escaped(capsys):
    guarded(lambda: fail(MeshError("two\nlines\x1b[2J.stl", "is no mesh: é")), [])

    assert capsys.readouterr().err == "error: two\\nlines\\x1b[2J.stl: is no mesh: é\n"


def test_debug_adds_the_traceback(capsys):
    code = guarded(lambda: fail(ZeroDivisionError("oh")), ["--debug"])

    err = capsys.readouterr().err
    assert code == ExitCode.INTERNAL
    assert "Traceback (most recent call last)" in err
    assert err.splitlines()[-1].startswith("error: internal error: ZeroDivisionError: oh")


def test_internal_error_of_a_command_is_one_line(here, obbtree, monkeypatch):
    monkeypatch.setattr(
        "obbcli.questions.collide.collide_pair", lambda *_, **__: fail(IndexError("beyond"))
    )

    ended = obbtree("collide", "cube.stl", "apart.obj")

    assert ended.code == 70
    assert ended.err.count("\n") == 1
    assert "IndexError: beyond" in ended.err
    assert "--debug" in ended.err


def test_full_disk_under_standard_output_is_an_output_fault(here, obbtree, monkeypatch):
    with open("/dev/full", "w", encoding="utf-8") as full:  # noqa: PTH123  # a device
        monkeypatch.setattr("sys.stdout", full)

        ended = obbtree("collide", "cube.stl", "apart.obj")

    assert ended.code == 5
    assert ended.err == "error: standard output: cannot be written: No space left on device\n"


def test_closed_standard_output_is_an_output_fault(here, obbtree, monkeypatch):
    monkeypatch.setattr("sys.stdout", None)

    ended = obbtree("collide", "cube.stl", "apart.obj")
    saved = obbtree("collide", "cube.stl", "apart.obj", "-q", "-o", "answer.txt")

    assert (ended.code, saved.code) == (5, 0)
    assert "use -o FILE" in ended.err
    assert (here / "answer.txt").read_text() == "separated\n"


def test_help_to_nowhere_is_an_output_fault(obbtree, monkeypatch):
    monkeypatch.setattr("sys.stdout", None)

    for words in ((), ("--help",), ("--version",), ("info", "--help")):
        assert (ended := obbtree(*words)).code == 5
        assert ended.err == "error: standard output: is closed; use -o FILE\n"


def test_error_that_nobody_can_read_keeps_its_exit_code(here, obbtree, monkeypatch):
    with open("/dev/full", "w", encoding="utf-8") as full:  # noqa: PTH123  # a device
        monkeypatch.setattr("sys.stderr", full)

        assert obbtree("info", "gone.stl").code == 3


def test_answer_to_a_place_that_cannot_be_written_is_an_output_fault(here, obbtree):
    ended = obbtree("collide", "cube.stl", "apart.obj", "-o", "gone/answer.txt")

    assert ended.code == 5
    assert "gone" in ended.err


def test_answer_goes_to_a_device_without_replacing_it(here, obbtree):
    assert obbtree("collide", "cube.stl", "apart.obj", "-o", "/dev/null").code == 0
    assert obbtree("collide", "cube.stl", "apart.obj", "-q", "-o", "-").out == "separated\n"


def test_help_lists_the_commands(obbtree):
    ended = obbtree("--help")

    assert ended.code == 0
    for name in COMMANDS:
        assert f"  {name} " in ended.out


@pytest.mark.parametrize("name", COMMANDS)
def test_help_of_a_command_has_an_example_and_names_every_option(obbtree, name):
    ended = obbtree(name, "--help")

    command = app.get_command(click.Context(app), name)
    options = [option for param in command.params for option in param.opts if option[0] == "-"]
    assert ended.code == 0
    assert f"  obbtree {name} " in ended.out.partition("Examples:")[2]
    assert "\nCommon:\n" in ended.out
    assert all(option in ended.out for option in options)


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (("colide", "a", "b"), "No such command 'colide', did you mean 'collide'?"),
        (("frist-contact",), "did you mean 'first-contact'?"),
        (("xyzzy",), "No such command 'xyzzy'; see"),
        (("--json", "collide", "a", "b"), "belongs after the command: obbtree collide --json"),
        (("-q",), "belongs after the command: obbtree COMMAND -q"),
        (("info", ""), "an empty word names no file"),
        (("--nonsense",), "No such option"),
        (("info",), "Missing argument 'FILE'"),
        (("collide", "a.stl"), "Missing argument 'B'"),
    ],
)
def test_usage_errors_point_to_the_help(obbtree, words, fault):
    ended = obbtree(*words)

    assert ended.code == 2
    assert ended.err.count("\n") == 1
    assert fault in ended.err
    assert "--help'" in ended.err


def test_main_takes_the_words_of_the_process(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["obbtree", "--version"])

    assert main() == 0

    assert capsys.readouterr().out == f"obbtree {obbcli.__version__}\n"


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shell_completion_is_offered(monkeypatch, capsys, shell):
    monkeypatch.setenv("_OBBTREE_COMPLETE", f"{shell}_source")

    with pytest.raises(SystemExit) as end:
        main([])

    assert end.value.code == 0
    assert "_OBBTREE_COMPLETE" in capsys.readouterr().out


@pytest.mark.parametrize("words", ["collide sam", "build a.stl sam", "info -o sam"])
def test_shell_completes_files(monkeypatch, capsys, words):
    monkeypatch.setenv("_OBBTREE_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", f"obbtree {words}")
    monkeypatch.setenv("COMP_CWORD", str(len(words.split())))

    with pytest.raises(SystemExit) as end:
        main([])

    assert end.value.code == 0
    assert capsys.readouterr().out == "file,sam\n"
