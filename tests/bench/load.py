"""A million questions from eight threads about shared lazy trees: no leak, no wrong answer.

`python tests/bench/load.py [--count N] [--threads N] [--seconds S]` asks at least so many, for at
least so long, compares every answer with that of a serial run, and ends with 1 where one differs or
where the memory held grows by more than `--growth` from a tenth of the way on.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

from asking.load_questions import TRIANGLES, Load, run


def told(load: Load) -> str:
    """Return a line about what was asked so far."""
    held = list(load.samples.values())[-1] / 2**20
    return f"{load.count:>9,} questions {load.seconds:8.1f} s {held:8.1f} MiB"


def main() -> int:
    """Ask, print, and return the exit code."""
    parser = argparse.ArgumentParser(description="shared trees under load")
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--threads", type=int, default=8)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--triangles", type=int, default=TRIANGLES)
    parser.add_argument("--growth", type=float, default=0.1, help="share of the memory at a tenth")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        load = run(
            Path(folder),
            options.count,
            options.threads,
            triangles=options.triangles,
            seconds=options.seconds,
            report=lambda load: print(told(load), flush=True),
        )
    first, last = load.samples.get(0.1, 0), load.samples.get(1.0, 0)
    print(f"{load.count:,} questions, {options.threads} threads, {load.seconds:.0f} s")
    print(f"memory held: {first / 2**20:.1f} MiB at a tenth, {last / 2**20:.1f} MiB at the end")
    print(f"answers that differ from a serial run: {len(load.mismatches)}")
    for line in load.mismatches[:10]:
        print(line)
    return int(bool(load.mismatches) or last > (1 + options.growth) * first)


if __name__ == "__main__":
    sys.exit(main())
