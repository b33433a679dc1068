"""Tables: aligned lines in files, folded and never cut on terminals however narrow."""

from __future__ import annotations

import io
import re

import pytest

from obbcli.report.table import Table, draw

BUILT = Table(
    [
        ("some/long/folder/gear.stl", "trees/gear.obbt", "11,520", "1,036.7 KiB", "152.0"),
        ("b.stl", "b.obbt", "12", "1.2 KiB", "99.1"),
    ],
    ("mesh", "tree", "triangles", "file", "B/triangle"),
    name_count=2,
)
WIDE = Table([("齿轮.stl", "1"), ("gear.stl", "22"), ("e\u0301.stl", "3")], ("mesh", "count"))


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def drawn(monkeypatch: pytest.MonkeyPatch, width: int, *tables: Table) -> str:
    """Return what a terminal of a width shows, without styles."""
    monkeypatch.setenv("COLUMNS", str(width))
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("NO_COLOR", "1")
    terminal = Terminal()
    draw(tables, terminal)
    return re.sub(r"\x1b\[[0-9;]*m", "", terminal.getvalue())


@pytest.mark.parametrize("width", [24, 30, 40, 50, 60, 80, 100, 200])
def test_table_on_a_terminal_cuts_nothing(monkeypatch, width):
    text = drawn(monkeypatch, width, BUILT)

    letters = re.sub(r"\s", "", text)
    assert all(len(line) <= width for line in text.splitlines())
    assert "…" not in text
    for row in BUILT.rows:
        for number in row[2:]:
            assert number in text
    if width < 60:
        # One list a row, whose names are whole once the folds are taken out.
        assert "some/long/folder/gear.stl" in letters
        assert all(text.count(heading) >= 2 for heading in ("mesh", "triangles", "B/triangle"))


def test_table_on_a_wide_terminal_is_one_row_a_row(monkeypatch):
    text = drawn(monkeypatch, 120, BUILT)

    assert text.count("B/triangle") == 1
    assert any("gear.stl" in line and "11,520" in line for line in text.splitlines())


def test_lines_align_wide_and_combining_letters():
    file = io.StringIO()

    draw([WIDE], file)

    assert file.getvalue().splitlines() == [
        "mesh       count",
        "─" * 16,
        "齿轮.stl       1",
        "gear.stl      22",
        "e\u0301.stl          3",
    ]


@pytest.mark.parametrize("stream", [io.StringIO, Terminal])
def test_table_without_rows_is_its_title(monkeypatch, stream):
    monkeypatch.setenv("TERM", "dumb")
    file = stream()

    draw([Table([], title="no pairs")], file)

    assert file.getvalue() == "no pairs\n"
