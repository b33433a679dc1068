"""Write the tables of the manual's `speed` topic: `python tests/bench/speed_tables.py`.

Between the lines `<!-- figures: NAME -->` and `<!-- end of figures -->` stands what this writes of
the bench of that name: machine, date, load and command, and its tables. `--check` writes nothing
and ends with 1 where the page differs.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

sys.path.append(str(Path(__file__).resolve().parents[1]))
sys.path.append(str(Path(__file__).resolve().parent))

import bench_fits
import bench_hostile
import moving_tables
from harness import OURS, markdown, time_text
from results_file import FOLDER, read, rows_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from harness import Row

PAGE = Path(__file__).resolve().parents[2] / "obbcli" / "manual" / "speed.md"
# A page has room for so many rows a table: longer ones show the largest meshes alone.
_MOST_ROWS = 20
FIGURES = re.compile(
    r"(?P<begin><!-- figures: (?P<name>[\w-]+) -->\n).*?(?P<end><!-- end of figures -->)", re.DOTALL
)


def boxes_of_fits(rows: Sequence[Row]) -> str:
    """Return the columns of the table of fits that count boxes, with volume and time of builds."""
    lines = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in bench_fits.tables(rows).splitlines()
    ]
    kept = [
        column
        for column, name in enumerate(lines[0])
        if column == 0 or name.endswith("boxes") or name in ("volume", "build")
    ]
    return markdown([[line[column] for column in kept] for line in (lines[0], *lines[2:])])


# What a page has no room for is printed by the bench alone.
LEFT_OUT = {"root boxes"}
TABLES = {
    "first contact": moving_tables.short,
    "fits": boxes_of_fits,
    "hostile": bench_hostile.tables,
}


def main() -> int:
    """Write the page, or compare it; return the exit code."""
    parser = argparse.ArgumentParser(description="the tables of the manual's speed topic")
    parser.add_argument("--check", action="store_true", help="compare, and write nothing")
    options = parser.parse_args()
    text = PAGE.read_text(encoding="utf-8")
    fresh = page(text)
    if fresh == text:
        return 0
    if options.check:
        print(f"{PAGE.name} differs from the figures: run {Path(__file__).name}", file=sys.stderr)
        return 1
    PAGE.write_text(fresh, encoding="utf-8")
    return 0


def page(text: str) -> str:
    """Return the page with the tables of the figures at hand.

    Raises:
        LookupError: the page wants a bench that no machine's file holds.
    """
    found = {}
    for path in sorted(FOLDER.glob("*.json")):
        whole = read(path)
        for name, bench in whole["benches"].items():
            found[name] = whole["machine"], bench

    def section(match: re.Match[str]) -> str:
        if match["name"] not in found:
            raise LookupError(f"no file of figures holds the bench {match['name']!r}")
        return f"{match['begin']}\n{told(*found[match['name']])}\n\n{match['end']}"

    return FIGURES.sub(section, text)


def told(machine: Mapping[str, Any], bench: Mapping[str, Any]) -> str:
    """Return machine, date, load and command of a bench, and its tables."""
    place = f"{machine['cores']} cores of {machine['processor']}"
    when = f"Measured {bench['measured']} on {place} at a load of {bench['load']:g}"
    rows = rows_of(bench)
    tables = []
    for name in dict.fromkeys(row.bench for row in rows if row.bench not in LEFT_OUT):
        some = [row for row in rows if row.bench == name]
        tables.append(f"**{name}**\n\n{TABLES.get(name, medians)(some)}")
    return f"{when}: `{bench['command']}`.\n\n" + "\n\n".join(tables)


def medians(rows: Sequence[Row]) -> str:
    """Return rows of one bench: medians, and ours against the best other."""
    if len(rows) > _MOST_ROWS:
        rows = [row for row in rows if row.triangles * 2 > max(r.triangles for r in rows)]
    who = list(dict.fromkeys(name for row in rows for name in row.timings))
    lines = [["case", "triangles", *who, f"best other / {OURS}"]]
    for row in rows:
        times = [time_text(row.timings[w].median) if w in row.timings else "-" for w in who]
        others = [timing.median for w, timing in row.timings.items() if not w.startswith(OURS)]
        ratio = "-"
        if others and OURS in row.timings:
            ratio = f"{min(others) / row.timings[OURS].median:.2f}x"
        lines.append([row.case, f"{row.triangles:,}", *times, ratio])
    return markdown(lines)


if __name__ == "__main__":
    sys.exit(main())
