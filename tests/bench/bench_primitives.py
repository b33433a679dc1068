"""Pairs of boxes and triangles: time a pair, and a sweep of answers against an independent check.

`python tests/bench/bench_primitives.py --sweep 1000000` asks so many pairs in each question and
counts wrong answers, which must be none, and how often exact arithmetic was needed.
"""

from __future__ import annotations

import argparse
import ctypes
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

sys.path.append(str(Path(__file__).resolve().parents[1]))

import numpy as np
import pair_truth
from harness import OURS, Row, Timing, alternate, table
from pair_sets import (
    DURATION,
    KINDS,
    Pairs,
    at_contact,
    grid_pairs,
    parallel_pairs,
    random_pairs,
)

from obbcli import kernels
from obbcli.primitives import first_contact, intersects

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

PLAIN = "plain doubles"
SOURCE = Path(__file__).with_name("plain_pairs.cpp")
# As the kernels are compiled.
FLAGS = ("-std=c++20", "-O3", "-ffp-contract=off", "-fPIC", "-shared")
AT_REST = np.zeros((1, 3))
# Relative gaps of near misses and of shapes brought together: down to less than an ulp.
GAPS = 10.0 ** -np.arange(4.0, 17.0)


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a question and kind of pairs: seconds a pair, asked as arrays."""
    count = 5_000 if quick else 50_000
    rounds = 11 if quick else 31
    with tempfile.TemporaryDirectory() as folder:
        plain = plain_library(Path(folder))
        for kind in KINDS:
            drawn = random_pairs(kind, count, 1)
            sets = {
                "random": drawn,
                "near miss": at_contact(drawn, 1e-6),
                "touching": at_contact(drawn),
                "grid": grid_pairs(kind, count, 2),
            }
            for name, pairs in sets.items():
                for still in (True, False):
                    yield _row(kind, name, pairs, still=still, plain=plain, rounds=rounds)
            yield from _single_rows(kind, drawn, rounds)


def _row(
    kind: str, name: str, pairs: Pairs, *, still: bool, plain: ctypes.CDLL | None, rounds: int
) -> Row:
    """Return the figures of one set: the verdict, ours and plain, and the whole first contact."""
    ours = _kernel_call(pairs, still=still)
    calls: dict[str, Callable[[], object]] = {OURS: ours}
    duration = 0.0 if still else pairs.duration
    calls["first contact"] = lambda: first_contact(*pairs.shapes, 0, pairs.velocity, duration)
    verdicts = ours()
    notes: dict[str, dict[str, object]] = {
        OURS: {"meet": float((verdicts & 1).mean()), "exact": float((verdicts >> 1).mean())}
    }
    if plain is not None:
        calls[PLAIN] = _plain_call(plain, pairs, still=still)
        differing = int((calls[PLAIN]() != (verdicts & 1)).sum())  # type: ignore[attr-defined]
        notes[PLAIN] = {"wrong": differing}
    timings = {who: _each(t, len(pairs.a)) for who, t in alternate(calls, rounds).items()}
    return Row(f"{kind} {'still' if still else 'moving'}", name, len(pairs.a), timings, notes)


def _each(timing: Timing, count: int) -> Timing:
    return replace(
        timing, median=timing.median / count, low=timing.low / count, high=timing.high / count
    )


def _kernel_call(pairs: Pairs, *, still: bool) -> Callable[[], Any]:
    """Return a call of the kernel that `intersects` wraps, whose bytes also say how."""
    verdicts = np.empty(len(pairs.a), dtype=np.uint8)
    velocity = AT_REST if still else pairs.velocity
    duration = np.array([0.0 if still else pairs.duration])

    def call() -> Any:
        kernels.primitive_intersects(pairs.a, pairs.b, AT_REST, velocity, duration, 1, verdicts)
        return verdicts

    return call


def _plain_call(plain: ctypes.CDLL, pairs: Pairs, *, still: bool) -> Callable[[], Any]:
    meets = np.empty(len(pairs.a), dtype=np.uint8)
    velocity = None if still else pairs.velocity
    arguments = [
        None if array is None else ctypes.c_void_p(array.ctypes.data)
        for array in (pairs.a, pairs.b, velocity)
    ]

    def call() -> Any:
        getattr(plain, pairs.kind)(
            *arguments,
            ctypes.c_double(pairs.duration),
            ctypes.c_int64(len(meets)),
            ctypes.c_void_p(meets.ctypes.data),
        )
        return meets

    return call


def plain_library(folder: Path) -> ctypes.CDLL | None:
    """Return the plain formulas compiled, or None where there is no compiler."""
    compiler = os.environ.get("CXX") or shutil.which("c++") or shutil.which("g++")
    if compiler is None:
        return None
    library = folder / "plain_pairs.so"
    subprocess.run([*compiler.split(), *FLAGS, str(SOURCE), "-o", str(library)], check=True)
    return ctypes.CDLL(str(library))


def _single_rows(kind: str, pairs: Pairs, rounds: int) -> Iterator[Row]:
    """Yield the time of one call from Python, against the peers' for the same pair."""
    one = pairs.taken([0])
    a, b = (_single(shape) for shape in one.shapes)
    velocity = one.velocity[0]
    calls: dict[str, Callable[[], object]] = {OURS: lambda: intersects(a, b)}
    calls |= _peer_calls(kind, a, b)
    yield Row(f"{kind} still", "one call", 1, alternate(calls, rounds, 0.001))
    moving: dict[str, Callable[[], object]] = {
        OURS: lambda: intersects(a, b, 0, velocity, DURATION),
        "first contact": lambda: first_contact(a, b, 0, velocity, DURATION),
    }
    yield Row(f"{kind} moving", "one call", 1, alternate(moving, rounds, 0.001))


def _single(shape: Any) -> Any:
    arrays = [
        getattr(shape, name)[0]
        for name in ("center", "axes", "half_extents", "vertices")
        if hasattr(shape, name)
    ]
    return type(shape)(*arrays)


def _peer_calls(kind: str, a: Any, b: Any) -> dict[str, Callable[[], object]]:
    """Return python-fcl's and coal's calls for two shapes at rest, objects made beforehand."""
    import coal
    import fcl

    def place(shape: Any) -> tuple[Any, Any]:
        is_box = hasattr(shape, "center")
        return (shape.axes.T, shape.center) if is_box else (np.eye(3), np.zeros(3))

    def in_fcl(shape: Any) -> Any:
        geometry = (
            fcl.Box(*(2 * shape.half_extents))
            if hasattr(shape, "center")
            else fcl.TriangleP(*shape.vertices)
        )
        return fcl.CollisionObject(geometry, fcl.Transform(*place(shape)))

    def in_coal(shape: Any) -> tuple[Any, Any]:
        geometry = (
            coal.Box(*(2 * shape.half_extents))
            if hasattr(shape, "center")
            else coal.TriangleP(*shape.vertices)
        )
        return geometry, coal.Transform3s(*place(shape))

    fcl_a, fcl_b = in_fcl(a), in_fcl(b)
    asked, found = fcl.CollisionRequest(), fcl.CollisionResult()
    coal_pair = (*in_coal(a), *in_coal(b))
    coal_asked, coal_found = coal.CollisionRequest(), coal.CollisionResult()

    def ask_coal() -> object:
        coal_found.clear()
        return coal.collide(*coal_pair, coal_asked, coal_found)

    return {"python-fcl": lambda: fcl.collide(fcl_a, fcl_b, asked, found), "coal": ask_coal}


def sweep(count: int) -> bool:
    """Print wrong answers and exact decisions of each question; return whether all were right."""
    right = True
    for kind in KINDS:
        # Where oracles have to decide, pairs cost a thousand times more.
        sets = {
            "random": (random_pairs(kind, count * 6 // 10, 3), pair_truth.truth),
            "grid": (grid_pairs(kind, count * 3 // 10, 4), pair_truth.exact_truth),
            "small grid": (grid_pairs(kind, count // 10, 5, size=1), pair_truth.exact_truth),
        }
        near = random_pairs(kind, count // 50, 6)
        sets["nearly parallel"] = (parallel_pairs(kind, count // 50, 7), pair_truth.truth)
        sets["nearly there"] = (at_contact(near, GAPS), pair_truth.truth)
        sets["just inside"] = (at_contact(near, -GAPS), pair_truth.truth)
        for name, (pairs, truth_of) in sets.items():
            for still in (True, False):
                right &= _sweep_set(name, pairs, truth_of, still=still)
    return right


def _sweep_set(name: str, pairs: Pairs, truth_of: Any, *, still: bool) -> bool:
    tally = dict.fromkeys(("pairs", "meet", "by oracle", "exact", "wrong", "wrong times"), 0)
    for start in range(0, len(pairs.a), 50_000):
        part = pairs.taken(slice(start, start + 50_000))
        truth = truth_of(part, still=still)
        verdicts = _kernel_call(part, still=still)()
        meets = (verdicts & 1).astype(bool)
        tally["pairs"] += len(meets)
        tally["meet"] += int(meets.sum())
        tally["by oracle"] += truth.by_oracle
        tally["exact"] += int((verdicts >> 1).sum())
        tally["wrong"] += int((meets != truth.meets).sum())
        tally["wrong times"] += _wrong_times(part, truth, exact=truth_of is pair_truth.exact_truth)
    question = f"{pairs.kind} {'still' if still else 'moving'} {name}"
    print(f"{question:36}", *(f"{key} {value:,}".ljust(20) for key, value in tally.items()))
    return tally["wrong"] == tally["wrong times"] == 0


def _wrong_times(pairs: Pairs, truth: pair_truth.Truth, *, exact: bool) -> int:
    """Return how many first and last times are not the truth: bit for bit on a grid."""
    duration = 0.0 if not truth.last.any() else pairs.duration
    contacts: Any = first_contact(*pairs.shapes, 0, pairs.velocity, duration)
    rows = contacts.rows
    if not np.array_equal(rows, np.flatnonzero(truth.meets)):
        return len(pairs.a)
    wrong = 0
    for found, wanted in ((contacts.time, truth.first), (contacts.last_time, truth.last)):
        error = np.abs(found - wanted[rows])
        # Doubles lose what a steep or grazing contact multiplies.
        suspects = rows[error > (0.0 if exact else 1e-12)]
        for k in suspects if not exact else ():
            times = pair_truth.oracle(pairs, int(k), still=duration == 0)
            place = int(np.searchsorted(rows, k))
            wrong += float(times[0]) != contacts.time[place]
            wrong += float(times[1]) != contacts.last_time[place]
        wrong += len(suspects) if exact else 0
    return wrong


def main() -> None:
    """Measure, or sweep."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="fewer pairs and rounds")
    parser.add_argument("--sweep", type=int, metavar="N", help="check N pairs in each question")
    options = parser.parse_args()
    if options.sweep:
        sys.exit(0 if sweep(options.sweep) else 1)
    rows = list(run(options.quick))
    for bench in dict.fromkeys(row.bench for row in rows):
        print(f"\n{bench}\n{table([row for row in rows if row.bench == bench])}")


if __name__ == "__main__":
    main()
