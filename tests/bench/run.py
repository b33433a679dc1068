"""Run the benches: `python tests/bench/run.py [--quick] [--only NAME] [--json FILE]`.

Every answer is asserted; what is printed is the median of rounds in turns, and the quartiles.
First contact and fits ask `--queries` random questions a class, also of the meshes cow.obj,
spot.obj, fandisk.obj and rocker-arm.obj where `--meshes` or OBBTREE_BENCH_MESHES names their
folder. The figures go into this machine's file in `tests/bench/results/`, from which
`speed_tables.py` writes the manual's tables; those of `--quick` are not kept.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))

import bench_build
import bench_contacts
import bench_distance
import bench_first_contact
import bench_fits
import bench_formats
import bench_hostile
import bench_overlap
import bench_primitives
import bench_scene
import bench_screws
import bench_static
import bench_sweep
import bench_volume
import bench_wall
import moving_tables
from harness import Row, machine, record, table
from results_file import write

ROOT = Path(__file__).resolve().parents[2]
MESHES = "OBBTREE_BENCH_MESHES"
BENCHES = {
    "primitives": lambda options: bench_primitives.run(options.quick),
    "build": lambda options: bench_build.run(options.quick),
    "static": lambda options: bench_static.run(options.quick),
    "distance": lambda options: bench_distance.run(options.quick),
    "overlap": lambda options: bench_overlap.run(options.quick),
    "first-contact": lambda options: bench_first_contact.run(
        options.quick, options.queries, options.meshes
    ),
    "contacts": lambda options: bench_contacts.run(options.quick),
    "fits": lambda options: bench_fits.run(options.quick, options.queries, options.meshes),
    "scene": lambda options: bench_scene.run(options.quick),
    "screws": lambda options: bench_screws.run(options.quick),
    "sweep": lambda options: bench_sweep.run(options.quick),
    "volume": lambda options: bench_volume.run(options.quick),
    "hostile": lambda options: bench_hostile.run(options.quick),
    "wall": lambda options: bench_wall.run(options.quick),
    "formats": lambda options: bench_formats.run(options.quick),
}
TABLES = {
    "first contact": moving_tables.tables,
    "fits": bench_fits.tables,
    "hostile": bench_hostile.tables,
}


def main() -> None:
    """Run what is asked for, print tables, write the record."""
    parser = argparse.ArgumentParser(description="obbtree against its peers")
    parser.add_argument("--quick", action="store_true", help="smaller meshes, fewer rounds")
    parser.add_argument("--only", choices=BENCHES, action="append", help="one bench (repeatable)")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    parser.add_argument("--queries", type=int, help="random questions a class of first contact")
    parser.add_argument(
        "--meshes",
        type=Path,
        default=os.environ.get(MESHES),
        help=f"folder of real meshes for first contact (default: ${MESHES}; else none)",
    )
    options = parser.parse_args()
    load = os.getloadavg()[0]
    about = machine(ROOT)
    for key, value in about.items():
        print(f"{key}: {value}")
    rows: list[Row] = []
    for name in options.only or BENCHES:
        measured = list(BENCHES[name](options))
        for bench in dict.fromkeys(row.bench for row in measured):
            text = TABLES.get(bench, table)([row for row in measured if row.bench == bench])
            print(f"\n{bench}\n\n{text}")
        rows += measured
        if not options.quick:  # as soon as it is known: the next bench may be interrupted
            print(
                f"\nkept in {write({name: measured}, about, command_of(options, name), load).name}"
            )
    if options.json:
        options.json.write_text(json.dumps(record(rows, about), indent=1) + "\n")


def command_of(options: argparse.Namespace, name: str) -> str:
    """Return what to type for one bench again, without paths of this machine."""
    words = ["python tests/bench/run.py", "--only", name]
    if options.queries is not None:
        words += ["--queries", str(options.queries)]
    if options.meshes is not None and name in ("first-contact", "fits"):
        words += ["--meshes", "FOLDER"]
    return " ".join(words)


if __name__ == "__main__":
    main()
