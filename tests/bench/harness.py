"""Measure alternatives fairly: in one process, in turns, medians with their spread.

A machine's speed drifts; alternatives that take turns drift together, so that their ratio stands.
"""

from __future__ import annotations

import gc
import math
import os
import platform
import statistics
import subprocess
import sys
import time
from dataclasses import asdict, dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

OURS = "obbtree"
PACKAGES = (
    "obbtree",
    "numpy",
    "python-fcl",
    "coal",
    "ipctk",
    "manifold3d",
    "vtk",
    "pyvista",
    "trimesh",
    "meshio",
    "manifold3d",
)


@dataclass(frozen=True)
class Timing:
    """Seconds a call: the median over rounds, the quartiles around it, and the number of rounds."""

    median: float
    low: float
    high: float
    rounds: int


@dataclass(frozen=True)
class Row:
    """One measured line.

    Attributes:
        bench: what was measured.
        case: on what.
        triangles: of each mesh.
        timings: by who was measured.
        notes: counts and sizes, by who and what.
    """

    bench: str
    case: str
    triangles: int
    timings: Mapping[str, Timing]
    notes: Mapping[str, Mapping[str, object]] = field(default_factory=dict)


def alternate(
    candidates: Mapping[str, Callable[[], object]], rounds: int, sample_seconds: float = 0.0
) -> dict[str, Timing]:
    """Return the time of a call of each candidate.

    Args:
        candidates: by who; each is called once before the clock runs.
        rounds: in each, every candidate has its turn; who is first changes.
        sample_seconds: calls too short for the clock are repeated for about so long a turn. A call
            that is not timed goes before each such turn: it warms what others have left cold.
    """
    samples: dict[str, list[float]] = {who: [] for who in candidates}
    order = list(candidates)
    gc.collect()
    gc.disable()
    try:
        loops = {who: _loops(call, sample_seconds) for who, call in candidates.items()}
        for _ in range(rounds):
            for who in order:
                if sample_seconds > 0:
                    candidates[who]()
                samples[who].append(_seconds(candidates[who], loops[who]))
            order = order[1:] + order[:1]
    finally:
        gc.enable()
    return {who: summarise(times) for who, times in samples.items()}


def summarise(times: Sequence[float]) -> Timing:
    """Return median and quartiles of some times."""
    ordered = sorted(times)
    quarter = (len(ordered) - 1) // 4
    return Timing(statistics.median(ordered), ordered[quarter], ordered[-1 - quarter], len(ordered))


def _loops(call: Callable[[], object], sample_seconds: float) -> int:
    call()
    loops = 1
    # One call of less than a microsecond takes as long as looking at the clock does.
    while (seconds := loops * _seconds(call, loops)) < sample_seconds:
        loops = min(8 * loops, math.ceil(1.1 * loops * sample_seconds / max(seconds, 1e-7)))
    return loops


def _seconds(call: Callable[[], object], loops: int) -> float:
    start = time.perf_counter()
    for _ in range(loops):
        call()
    return (time.perf_counter() - start) / loops


def resident_bytes() -> int | None:
    """Return the memory this process holds, or None where the system does not say."""
    statm = Path("/proc/self/statm")
    if not statm.exists():
        return None
    return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def machine(root: Path) -> dict[str, object]:
    """Return what the figures depend on: processor, system, compiler, flags, versions."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(),
        "python": sys.version.split()[0],
        **_compiler(root),
        "versions": {name: _version(name) for name in PACKAGES},
    }


def _processor() -> str:
    cpuinfo = Path("/proc/cpuinfo")
    lines = cpuinfo.read_text().splitlines() if cpuinfo.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _compiler(root: Path) -> dict[str, object]:
    """Return the compiler's own words and the kernels' flags, from the newest build folder."""
    caches = sorted(root.glob(".build/*/CMakeCache.txt"), key=lambda path: path.stat().st_mtime)
    if not caches:
        return {"compiler": None, "flags": None}
    entries = [line.split("=", 1) for line in caches[-1].read_text().splitlines() if "=" in line]
    path = dict(entries)["CMAKE_CXX_COMPILER:FILEPATH"]
    words = subprocess.run([path, "--version"], capture_output=True, text=True, check=True).stdout
    kernels = (caches[-1].parent / "build.ninja").read_text().partition("obb_kernels.dir")[2]
    flags = kernels.partition("FLAGS = ")[2].partition("\n")[0]
    return {"compiler": words.splitlines()[0], "flags": flags}


def table(rows: Sequence[Row]) -> str:
    """Return rows of one bench as Markdown: medians, spread, ours against the best other."""
    who = list(dict.fromkeys(name for row in rows for name in row.timings))
    lines = [["case", "triangles", *who, f"best other / {OURS}", "notes"]]
    lines += [_line(row, who) for row in rows]
    return markdown(lines)


def markdown(lines: Sequence[Sequence[str]]) -> str:
    """Return lines of cells, the first being headings, as a table in Markdown."""
    widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
    rule = ["-" * width for width in widths]
    return "\n".join(
        "| " + " | ".join(map(str.ljust, line, widths)) + " |"
        for line in (lines[0], rule, *lines[1:])
    )


def _line(row: Row, who: Sequence[str]) -> list[str]:
    cells = [seconds_text(row.timings[name]) if name in row.timings else "-" for name in who]
    others = [timing.median for name, timing in row.timings.items() if not name.startswith(OURS)]
    ratio = "-"
    if OURS in row.timings and others:
        ratio = f"{min(others) / row.timings[OURS].median:.2f}x"
    notes = "; ".join(
        f"{name}: " + ", ".join(f"{key} {_short(value)}" for key, value in facts.items())
        for name, facts in row.notes.items()
    )
    return [row.case, f"{row.triangles:,}", *cells, ratio, notes]


def _short(value: object) -> str:
    return f"{value:,.4g}" if isinstance(value, float) else f"{value}"


def time_text(seconds: float) -> str:
    """Return `12.3 us`."""
    unit, scale = _unit(seconds)
    return f"{_three(seconds * scale)} {unit}"


def _unit(seconds: float) -> tuple[str, float]:
    """Return the unit that a time is told in, and how many make a second."""
    return next((pair for pair in (("s", 1.0), ("ms", 1e3)) if seconds * pair[1] >= 1), ("us", 1e6))


def seconds_text(timing: Timing) -> str:
    """Return `12.3 us (12.1 .. 12.9)`."""
    unit, scale = _unit(timing.median)
    low, middle, high = (_three(x * scale) for x in (timing.low, timing.median, timing.high))
    return f"{middle} {unit} ({low} .. {high})"


def _three(number: float) -> str:
    """Return three digits, or all of them before the point."""
    return f"{number:.0f}" if number >= 100 else f"{number:.3g}"


def record(rows: Sequence[Row], about: Mapping[str, object]) -> dict[str, object]:
    """Return what the JSON file holds."""
    return {"schema": "obbtree/bench/1", "machine": about, "rows": [asdict(row) for row in rows]}
