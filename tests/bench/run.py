"""Run the benches: `python tests/bench/run.py [--quick] [--only NAME] [--json FILE]`.

Every answer is asserted; what is printed is the median of rounds in turns, and the quartiles.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

import bench_build
import bench_distance
import bench_primitives
import bench_static
import bench_wall
from harness import Row, machine, record, table

ROOT = Path(__file__).resolve().parents[2]
BENCHES = {
    "primitives": lambda options: bench_primitives.run(options.quick),
    "build": lambda options: bench_build.run(options.quick),
    "static": lambda options: bench_static.run(options.quick),
    "distance": lambda options: bench_distance.run(options.quick),
    "wall": lambda options: bench_wall.run(options.quick),
}


def main() -> None:
    """Run what is asked for, print tables, write the record."""
    parser = argparse.ArgumentParser(description="obbtree against its peers")
    parser.add_argument("--quick", action="store_true", help="smaller meshes, fewer rounds")
    parser.add_argument("--only", choices=BENCHES, action="append", help="one bench (repeatable)")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    options = parser.parse_args()
    about = machine(ROOT)
    for key, value in about.items():
        print(f"{key}: {value}")
    rows: list[Row] = []
    for name in options.only or BENCHES:
        measured = list(BENCHES[name](options))
        for bench in dict.fromkeys(row.bench for row in measured):
            text = table([row for row in measured if row.bench == bench])
            print(f"\n{bench}\n\n{text}")
        rows += measured
    if options.json:
        options.json.write_text(json.dumps(record(rows, about), indent=1) + "\n")


if __name__ == "__main__":
    main()
