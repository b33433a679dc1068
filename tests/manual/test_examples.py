"""Examples of README and manual do what they show, in consoles and in Python.

Each `console` block runs in a folder of its own that holds `sample_meshes`. Output is compared word
by word, except for what varies from run to run: times, and how many box and triangle tests an
answer took. Three dots on a line of their own stand for any lines. Pictures that a block makes are
compared with those that are shown.
"""

from __future__ import annotations

import doctest
import shutil
from typing import TYPE_CHECKING

import numpy as np
import pytest
from claims.png_files import pixels_of
from manual.consoles import matches, normalised, run, steps
from manual.pages import ROOT, Block, blocks

if TYPE_CHECKING:
    from pathlib import Path

PICTURES = ROOT / "sample_meshes" / "pictures"
CONSOLES = blocks("console")
LESSONS = sorted({block.page for block in blocks("python")})


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder that holds the sample meshes, as the root of the project does."""
    shutil.copytree(ROOT / "sample_meshes", tmp_path / "sample_meshes")
    return tmp_path


@pytest.mark.parametrize("block", [pytest.param(one, id=one.name) for one in CONSOLES])
def test_console_block_prints_and_draws_what_it_shows(block: Block, folder: Path) -> None:
    for step in steps(block.text):
        found = [normalised(line) for line in run(step.command, folder)]
        expected = [normalised(line) for line in step.expected]

        # Compared as lists, so that a difference is shown line by line.
        assert matches(expected, found) or found == expected, step.command
    for made in folder.glob("*.png"):
        assert_looks_like(made, PICTURES / made.name)


def assert_looks_like(made: Path, shown: Path) -> None:
    """Compare two pictures; the last bits of a processor may move an edge by a pixel."""
    one, other = (pixels_of(path.read_bytes()) for path in (made, shown))
    assert one.shape == other.shape
    assert np.abs(one - other).mean() < 0.5


def test_no_console_block_stands_twice() -> None:
    texts = [block.text for block in CONSOLES]

    assert [block.name for block in CONSOLES if texts.count(block.text) > 1] == []


@pytest.mark.parametrize("page", LESSONS)
def test_python_blocks_answer_what_they_show(
    page: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    text = "".join(block.text for block in blocks("python") if block.page == page)
    lesson = doctest.DocTestParser().get_doctest(text, {}, page, page, 0)
    report: list[str] = []

    results = doctest.DocTestRunner().run(lesson, out=report.append)

    assert results.attempted > 0
    assert not report, "".join(report)


def test_console_comparison_sees_a_changed_word() -> None:
    shown = ["status separated", "...", "time load 1.2 ms, query 3 us"]

    assert matches(*([normalised(x) for x in lines] for lines in (shown, shown)))
    assert not matches(shown, ["status overlap_at_start", *shown[1:]])
