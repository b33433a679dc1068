"""Progress bars: on a terminal, for long work, and only where they are wanted."""

from __future__ import annotations

import io
from contextlib import redirect_stderr
from pathlib import Path

import pytest

from obbcli.cli.progress import WORTH_A_BAR, bar, counting, measuring


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def ordinary_terminal(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")


def test_long_work_on_a_terminal_shows_a_bar():
    with redirect_stderr(Terminal()) as terminal, bar("building", WORTH_A_BAR, wanted=True) as move:
        move(0.25)
        move(0.75)

    assert "building" in terminal.getvalue()


def test_bar_shows_names_as_they_are():
    with (
        redirect_stderr(Terminal()) as terminal,
        bar("[red].stl", WORTH_A_BAR, wanted=True) as move,
    ):
        move(0.5)

    assert "[red].stl" in terminal.getvalue()


@pytest.mark.parametrize(
    ("stream", "triangles", "wanted"),
    [
        (Terminal(), WORTH_A_BAR - 1, True),
        (Terminal(), WORTH_A_BAR, False),
        (io.StringIO(), WORTH_A_BAR, True),
    ],
)
def test_no_bar_for_short_work_nor_unasked_nor_without_a_terminal(stream, triangles, wanted):
    with redirect_stderr(stream), bar("building", triangles, wanted=wanted) as move:
        assert move is None

    assert stream.getvalue() == ""


@pytest.mark.parametrize(
    ("words", "is_drawn"), [((), True), (("--quiet",), False), (("--no-progress",), False)]
)
@pytest.mark.parametrize("command", ["build", "collide"])
def test_commands_draw_a_bar_unless_told_not_to(
    here, monkeypatch, obbtree, command, words, is_drawn
):
    monkeypatch.setattr("obbcli.cli.progress.WORTH_A_BAR", 1)
    files = ("cube.stl",) if command == "build" else ("cube.stl", "apart.obj")

    with redirect_stderr(Terminal()) as terminal:
        obbtree(command, *files, *words)

    assert ("cube.stl" in terminal.getvalue()) == is_drawn


GEARS = [
    str(Path(__file__).resolve().parents[2] / f"sample_meshes/{n}.stl") for n in ("gear", "pinion")
]
TURNING = ("--omega", "0", "0", "3", "--omega-b", "0", "0", "-5.9", "--duration", "2")


@pytest.mark.parametrize(
    ("words", "is_drawn"), [((), True), (("--quiet",), False), (("--no-progress",), False)]
)
@pytest.mark.parametrize("command", ["collide", "first-contact"])
def test_long_question_shows_the_time_proven_so_far(monkeypatch, obbtree, command, words, is_drawn):
    monkeypatch.setattr("obbcli.cli.progress.PATIENCE", 0.0)
    monkeypatch.setattr("obbcli.questions.budget.POPS_A_SLICE", 1024)

    with redirect_stderr(Terminal()) as terminal:
        ended = obbtree(command, *GEARS, *TURNING, *words)

    assert ended.code == 0
    assert ("no contact before t = " in terminal.getvalue()) == is_drawn
    assert ("of 2 s" in terminal.getvalue()) == is_drawn


def test_short_question_shows_no_bar(monkeypatch, obbtree):
    monkeypatch.setattr("obbcli.cli.progress.PATIENCE", 3600.0)

    with redirect_stderr(Terminal()) as terminal:
        obbtree("first-contact", *GEARS, *TURNING)

    assert terminal.getvalue() == ""


def test_bar_changes_no_answer(monkeypatch, obbtree):
    monkeypatch.setattr("obbcli.cli.progress.PATIENCE", 0.0)
    monkeypatch.setattr("obbcli.questions.budget.POPS_A_SLICE", 1024)
    plain = obbtree("first-contact", *GEARS, *TURNING, "--json", "--max-iterations", 9_000).json

    with redirect_stderr(Terminal()):
        watched = obbtree(
            "first-contact", *GEARS, *TURNING, "--json", "--max-iterations", 9_000
        ).json

    assert plain["result"]["status"] == "unresolved"
    assert watched["result"] == plain["result"]


def test_long_list_shows_the_time_before_which_it_is_known(monkeypatch, obbtree):
    monkeypatch.setattr("obbcli.cli.progress.PATIENCE", 0.0)
    monkeypatch.setattr("obbcli.questions.budget.POPS_A_SLICE", 1024)

    with redirect_stderr(Terminal()) as terminal:
        listed = obbtree("first-contact", *GEARS, *TURNING, "--all-contacts")

    assert listed.code == 0
    assert "all contacts known before t = 0.0" in terminal.getvalue()


def test_rows_are_counted_with_their_rate_and_the_time_left(monkeypatch):
    seconds = iter([100.0, 100.0, 104.0])
    monkeypatch.setattr("obbcli.cli.progress.time.monotonic", lambda: next(seconds, 104.0))

    with redirect_stderr(Terminal()) as terminal, counting(wanted=True) as show:
        show(0.5, 0)
        show(0.7, 2000)

    assert "2,000 rows, 500 a second, 6 s left" in terminal.getvalue()


@pytest.mark.parametrize(
    ("stream", "words", "is_drawn"),
    [
        (Terminal, (), True),
        (Terminal, ("--quiet",), False),
        (Terminal, ("--no-progress",), False),
        (io.StringIO, (), False),
    ],
)
def test_sweeps_count_their_rows_on_a_terminal(here, obbtree, stream, words, is_drawn):
    (here / "q.csv").write_text("vel\n1 0 0\n")

    with redirect_stderr(stream()) as terminal:
        obbtree("sweep", "cube.stl", "apart.obj", "q.csv", "-o", "out.jsonl", *words)

    assert ("1 rows, " in terminal.getvalue()) == is_drawn


def test_study_shows_what_is_measured_and_what_time_is_left_at_most():
    with redirect_stderr(Terminal()) as terminal, measuring(60.0, wanted=True) as show:
        show(12.4, 7)

    assert "7 settings measured, at most 12 s left" in terminal.getvalue()


@pytest.mark.parametrize(("stream", "wanted"), [(Terminal, False), (io.StringIO, True)])
def test_study_draws_nothing_unasked_nor_without_a_terminal(stream, wanted):
    with redirect_stderr(stream()) as terminal, measuring(60.0, wanted=wanted) as show:
        show(1.0, 1)

    assert terminal.getvalue() == ""
