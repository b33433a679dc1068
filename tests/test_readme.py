"""The README is what the tool does: its commands print what it shows, its tables are the code's.

Each `console` block runs in a folder of its own that holds `sample_meshes`. Output is compared word
by word, except for what varies from run to run: times, and how many box and triangle tests an
answer took. Three dots on a line of their own stand for any lines.
"""

from __future__ import annotations

import doctest
import os
import re
import shutil
import subprocess
import sysconfig
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click
import pytest

import obbcli
from obbcli import primitives
from obbcli.cli.app import app
from obbcli.cli.boundary import ExitCode
from obbcli.mesh.load import _FORMATS
from obbcli.tree import header as treeheader

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parents[1]
TOOLS = ROOT / "tests" / "tools"
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
ANY_LINES = "..."
# A time, or the number of tests that an answer took, or of the boxes made for it.
VARYING = re.compile(
    # What something took, and not at what time of the motion (`t = 0.5 s`) it is.
    r"(?<!t = )(?<![\d.])\b\d+(\.\d+)?(e-\d+)? (us|ms|s)\b|(?<=box tests )[\d,]+"
    r"|(?<=triangle tests )[\d,]+( \(\S+ in exact)?"
    r"|(?:(?<=boxes built )|(?<=of A, ))[\d,]+(?= of)"
)


class Step(NamedTuple):
    """A command line of a console block and what it should print."""

    command: str
    expected: tuple[str, ...]


def blocks(language: str) -> Iterator[tuple[str, str]]:
    """Yield the README's fenced blocks in a language, each with the heading it stands under."""
    heading = ""
    for match in re.finditer(
        r"^#+ ([^\n]+)$|^```(\w*)\n(.*?)^```$", TEXT, re.DOTALL | re.MULTILINE
    ):
        heading = match[1] or heading
        if match[2] == language:
            yield heading, match[3]


def steps(block: str) -> Iterator[Step]:
    """Yield the commands of a console block; lines that begin with `> ` continue one."""
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        first, *rest = part.splitlines()
        more = 0
        while more < len(rest) and rest[more].startswith("> "):
            more += 1
        command = "\n".join([first, *(line[2:] for line in rest[:more])])
        yield Step(command, tuple(rest[more:]))


def normalised(line: str) -> str:
    """Return a line without what may vary: columns are as wide as the times in them."""
    return VARYING.sub("#", " ".join(re.sub("─+", "─", line).split()))


def matches(expected: list[str], found: list[str]) -> bool:
    """Return whether lines are as expected, dots standing for any lines."""
    pattern = "".join(
        "(?:.*\n)*" if line == ANY_LINES else re.escape(line) + "\n" for line in expected
    )
    return re.fullmatch(pattern, "".join(line + "\n" for line in found)) is not None


def run(command: str, folder: Path) -> list[str]:
    """Return what a command line prints to a terminal's two streams."""
    # The last has a jq for machines without one.
    path = os.pathsep.join((sysconfig.get_path("scripts"), os.environ["PATH"], str(TOOLS)))
    ended = subprocess.run(
        ["sh", "-c", command],
        cwd=folder,
        env=os.environ | {"PATH": path, "LC_ALL": "C.UTF-8"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        encoding="utf-8",
        check=False,
    )
    return ended.stdout.rstrip("\n").splitlines()


def section(heading: str) -> str:
    """Return what stands under a heading, up to the next one of its rank or above."""
    match = re.search(rf"^(#+) {re.escape(heading)}$", TEXT, re.MULTILINE)
    assert match is not None
    return re.split(rf"^#{{1,{len(match[1])}}} ", TEXT[match.end() :], flags=re.MULTILINE)[0]


def table_rows(heading: str) -> list[list[str]]:
    """Return the cells of all tables under a heading, but not those of their first rows."""
    lines = [line for line in section(heading).splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    rules = [number for number, row in enumerate(cells) if set("".join(row)) == {"-"}]
    skipped = {number for rule in rules for number in (rule - 1, rule)}
    return [row for number, row in enumerate(cells) if number not in skipped]


def is_explained(word: str, heading: str) -> bool:
    """Return whether a word or option stands in code under a heading, outside of examples."""
    prose = re.sub(r"^```(console|python).*?^```$", "", section(heading), flags=re.DOTALL | re.M)
    code = re.findall(r"^```.*?^```$|`[^`\n]+`", prose, re.DOTALL | re.MULTILINE)
    whole = re.compile(rf"(?<![\w-]){re.escape(word)}(?![\w-])")
    return any(whole.search(span) for span in code)


def command_line() -> Iterator[str]:
    """Yield every command, every option and every choice of an option."""
    context = click.Context(app)
    names = app.list_commands(context)
    yield from names
    for command in (app, *(app.get_command(context, name) for name in names)):
        assert command is not None
        for param in command.get_params(context):
            if isinstance(param, click.Option):
                yield from param.opts
            if isinstance(param.type, click.Choice):
                yield from param.type.choices


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder that holds the sample meshes, as the root of the project does."""
    shutil.copytree(ROOT / "sample_meshes", tmp_path / "sample_meshes")
    return tmp_path


@pytest.mark.parametrize(
    "block", [pytest.param(block, id=heading) for heading, block in blocks("console")]
)
def test_console_block_prints_what_it_shows(block: str, folder: Path) -> None:
    for step in steps(block):
        found = [normalised(line) for line in run(step.command, folder)]
        expected = [normalised(line) for line in step.expected]

        # Compared as lists, so that a difference is shown line by line.
        assert matches(expected, found) or found == expected, step.command


def test_python_blocks_answer_what_they_show(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    text = "".join(block for _, block in blocks("python"))
    lesson = doctest.DocTestParser().get_doctest(text, {}, "README", "README.md", 0)
    report: list[str] = []

    results = doctest.DocTestRunner().run(lesson, out=report.append)

    assert results.attempted > 0
    assert not report, "".join(report)


def test_console_comparison_sees_a_changed_word() -> None:
    shown = ["status separated", "...", "time load 1.2 ms, query 3 us"]

    assert matches(*([normalised(x) for x in lines] for lines in (shown, shown)))
    assert not matches(shown, ["status overlap_at_start", *shown[1:]])


@pytest.mark.parametrize("word", sorted(set(command_line())))
def test_command_line_word_is_explained(word: str) -> None:
    assert is_explained(word, "Command line")


@pytest.mark.parametrize("name", [*obbcli.__all__, *primitives.__all__])
def test_public_name_is_explained(name: str) -> None:
    assert is_explained(name, "Python")


def test_format_table_is_the_loader_s() -> None:
    shown = {
        suffix: (name, reader)
        for name, suffixes, reader in table_rows("Mesh formats")
        for suffix in re.findall(r"`(\.\w+)`", suffixes)
    }

    assert shown == {
        suffix: (form.name, "meshio" if form.kind else "obbtree")
        for suffix, form in _FORMATS.items()
    }


def test_exit_codes_are_those_of_the_command_line() -> None:
    shown = [int(row[0]) for row in table_rows("Command line") if row[0].isdigit()]

    assert shown == [code.value for code in ExitCode]


def test_statuses_are_those_of_the_package() -> None:
    shown = [row[0].strip("`") for row in table_rows("Command line")]

    assert {status.value for status in obbcli.Status} <= set(shown)


def test_tree_file_header_is_the_one_written() -> None:
    fields = [row for row in table_rows("Tree files") if row[0].isdigit() and row[1]]
    types = [row[1].strip("`") for row in fields]
    magic = re.search(r"magic: `([0-9A-F ]+)`", TEXT)

    assert "<" + "".join(types) == treeheader.FIXED.format
    assert [int(row[0]) for row in fields][-1] + 4 == treeheader.FIXED.size
    assert magic is not None
    assert bytes.fromhex(magic[1]) == treeheader.MAGIC
