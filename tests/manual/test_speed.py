"""The tables of the manual's `speed` topic are those of the figures that are kept as data."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "tests" / "bench" / "speed_tables.py"
sys.path.append(str(SCRIPT.parent))

from speed_tables import FIGURES, PAGE, page  # noqa: E402


def test_tables_are_written_from_the_figures() -> None:
    ended = subprocess.run(
        [sys.executable, SCRIPT, "--check"], capture_output=True, text=True, check=False
    )

    assert ended.stderr == ""
    assert ended.returncode == 0


def test_a_changed_figure_is_seen() -> None:
    text = PAGE.read_text(encoding="utf-8")
    first = FIGURES.search(text)
    assert first is not None
    table = first[0].index("| ", first[0].index("| ---"))

    changed = text.replace(first[0], first[0][:table] + "| 1" + first[0][table:], 1)

    assert changed != text
    assert page(changed) == text


def test_a_bench_without_figures_is_refused() -> None:
    with pytest.raises(LookupError, match="no file of figures holds the bench 'nonsense'"):
        page("<!-- figures: nonsense -->\n<!-- end of figures -->")
