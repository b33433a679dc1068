"""`obbtree manual`: topics listed and printed, laid out on a terminal, refused where unknown."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING, Any

import click
import pytest
from click.shell_completion import ShellComplete

from obbcli.cli.app import app
from obbcli.manual import TOPICS, page, summary
from obbcli.report.prose import draw_page

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from typing import TypeAlias

    Run: TypeAlias = Callable[..., Any]

CONTROL = re.compile(r"\x1b\[[\d;]*m|\x1b\]8;[^\x1b]*\x1b\\")


class Terminal(io.StringIO):
    """Text that counts as a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def laid_out(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], str]:
    """Return what lays a text out on a terminal of 80 columns, and gives it without styles."""
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("TERM", "xterm-256color")

    def draw(text: str) -> str:
        terminal = Terminal()
        draw_page(text, terminal)
        return CONTROL.sub("", terminal.getvalue())

    return draw


def test_without_a_topic_all_are_listed(obbtree: Run) -> None:
    ended = obbtree("manual")

    lines = ended.out.splitlines()
    assert [line.split()[0] for line in lines[: len(TOPICS)]] == list(TOPICS)
    assert all(summary(topic) in line for topic, line in zip(TOPICS, lines, strict=False))
    assert all(len(line) <= 80 for line in lines)
    assert lines[-1] == "obbtree manual TOPIC prints one."
    assert ended.code == 0


def test_quiet_lists_bare_names(obbtree: Run) -> None:
    assert obbtree("manual", "--quiet").out.split("\n") == [*TOPICS, ""]


@pytest.mark.parametrize("words", [("scenes",), ("scenes.md",), ("Scenes",), ("scenes", "-q")])
def test_a_pipe_gets_the_text(obbtree: Run, words: tuple[str, ...]) -> None:
    ended = obbtree("manual", *words)

    assert (ended.code, ended.out, ended.err) == (0, page("scenes"), "")


def test_a_file_gets_the_text(here: Path, obbtree: Run) -> None:
    ended = obbtree("manual", "scenes", "-o", "scenes.md")

    assert (ended.code, ended.out) == (0, "")
    assert (here / "scenes.md").read_text(encoding="utf-8") == page("scenes")


@pytest.mark.parametrize(
    ("word", "remedy"),
    [("scnes", "did you mean 'scenes'?"), ("nonsense", "known are tour, ci, commands")],
)
def test_unknown_topic_is_one_error(obbtree: Run, word: str, remedy: str) -> None:
    ended = obbtree("manual", word)

    assert (ended.code, ended.out, ended.err.count("\n")) == (2, "", 1)
    assert f"there is no topic '{word}': {remedy}" in ended.err


@pytest.mark.parametrize("words", [(), ("tour",)])
def test_json_is_refused(obbtree: Run, words: tuple[str, ...]) -> None:
    ended = obbtree("manual", *words, "--json")

    assert (ended.code, ended.out, ended.error["code"]) == (2, "", 2)
    assert "has no JSON document" in ended.error["error"]
    assert "obbtree schema" in ended.error["remedy"]


def test_topics_complete() -> None:
    complete = ShellComplete(app, {}, "obbtree", "_OBBTREE_COMPLETE")

    found = complete.get_completions(["manual"], "python")

    assert [(one.value, one.help) for one in found] == [
        (topic, summary(topic)) for topic in ("python", "python-tour")
    ]
    assert [one.value for one in complete.get_completions([], "man")] == ["manual"]


@pytest.mark.parametrize("topic", TOPICS)
def test_a_terminal_gets_every_topic_laid_out(topic: str, laid_out: Callable[[str], str]) -> None:
    shown = laid_out(page(topic))

    lines = shown.splitlines()
    assert all(len(line) <= 80 for line in lines)
    # Neither tables, links nor code are left as Markdown.
    assert not [line for line in lines if re.search(r"\|---|```|\w\]\(", line)]
    title = page(topic).splitlines()[0].removeprefix("# ")
    assert title.split()[0] in shown


def test_words_of_links_and_pictures_stay(laid_out: Callable[[str], str]) -> None:
    text = "# T\n\nSee [scenes](scenes.md#x), [jq](https://jqlang.org).\n\n![An arm](a/arm.png)\n"

    shown = laid_out(text)

    assert "See scenes, jq" in shown
    assert "picture: An arm" in shown
    assert "scenes.md" not in shown


def test_colours_can_be_forced_and_forbidden(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    forced = io.StringIO()
    draw_page("# T\n\n- one\n", forced)
    assert "\x1b[" in forced.getvalue()

    monkeypatch.delenv("FORCE_COLOR")
    plain = io.StringIO()
    draw_page("# T\n\n- one\n", plain)
    assert plain.getvalue() == "# T\n\n- one\n"


def test_help_and_welcome_name_it(obbtree: Run) -> None:
    assert "obbtree manual" in obbtree().out
    assert "\n  manual " in obbtree("--help").out
    assert isinstance(app.get_command(click.Context(app), "manual"), click.Command)
