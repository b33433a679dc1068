"""Sweeps of a rotating pair: queries a second on threads and on Dask, against a Python loop."""

from __future__ import annotations

import os
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from harness import OURS, Row, alternate, time_text
from meshes.surfaces import blob

import obbcli
from obbcli.sweeps import cluster, stream
from obbcli.sweeps.query_file import opened
from obbcli.sweeps.row_questions import SweepSetting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SIZES = {100_000: (2000, 7)}
QUICK_SIZES = {10_000: (300, 3)}
WORKERS = 2
SHIFT = (3.0, 0.0, 0.0)
# B's mean velocity: half of the first ones meet A, the others hardly ever come near.
APPROACHES = {"half of them meet": (-1.5, 0.0, 0.0), "few come near": (6.0, 0.0, 0.0)}
LOOP = "a Python loop"


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a kind of sweep; all ways give the same answers, which is asserted."""
    for triangles, (count, rounds) in (QUICK_SIZES if quick else SIZES).items():
        trees = tuple(_tree(triangles, seed) for seed in (1, 2))
        with ExitStack() as stack:
            client = stack.enter_context(cluster.connected(None, WORKERS))
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
            for case, approach in APPROACHES.items():
                motions = _motions(count, np.array(approach))
                ways = _ways(trees, motions, _written(folder / "q.csv", motions), client)
                contact_count = _checked(ways)
                timings = alternate(ways, rounds)
                notes: dict[str, dict[str, object]] = {
                    who: {
                        "a second": round(count / timing.median),
                        "processor a query": time_text(_processor_seconds(ways[who]) / count),
                    }
                    for who, timing in timings.items()
                }
                notes["of"] = {"contacts": contact_count, "load": os.getloadavg()[0]}
                yield Row("sweep", f"{count:,} queries, {case}", triangles, timings, notes)


def _processor_seconds(way: Callable[[], Any]) -> float:
    """Return what this process alone computes: on a busy machine, clocks say less of threads."""
    start = time.process_time()
    way()
    return time.process_time() - start


def _tree(triangles: int, seed: int) -> obbcli.ObbTree:
    surface = blob(triangles, seed)
    return obbcli.ObbTree.build(obbcli.Mesh(surface.vertices, surface.faces), lazy=False)


def _motions(count: int, approach: Any) -> tuple[Any, Any]:
    """Return random motions of A and B, (N, 6); both rotate."""
    motions_a, motions_b = np.random.default_rng(count).normal(size=(2, count, 6))
    motions_b[:, :3] += approach
    return motions_a, motions_b


def _written(path: Path, motions: tuple[Any, Any]) -> Path:
    """Write the motions as a file of queries."""
    cells = np.concatenate(motions, axis=1).tolist()
    names = [f"{name}_{axis}" for name in ("vel", "omega", "vel_b", "omega_b") for axis in "xyz"]
    lines = (",".join(map(repr, row)) for row in cells)
    path.write_text("\n".join([",".join(names), *lines, ""]))
    return path


def _ways(
    trees: Any, motions: tuple[Any, Any], path: Path, client: Any
) -> dict[str, Callable[[], Any]]:
    """Return what answers the motions, by who: as an array, as objects, or as lines."""
    body = obbcli.Body(trees[1], obbcli.Pose(None, SHIFT))
    setting = SweepSetting({"translate_b": SHIFT}, degrees=False, accuracy=obbcli.Accuracy())

    def swept(threads: int) -> Any:
        return obbcli.sweep(trees[0], body, *motions, threads=threads)

    def looped() -> list[obbcli.FirstContact]:
        return [
            obbcli.first_contact(
                obbcli.Body(trees[0], motion=obbcli.Motion(a[:3], a[3:])),
                obbcli.Body(trees[1], body.pose, obbcli.Motion(b[:3], b[3:])),
            )
            for a, b in zip(*motions, strict=True)
        ]

    def streamed(answer: Callable[[Any], Any]) -> bytes:
        with opened(str(path)) as queries:
            return b"".join(block.lines for block in answer(queries.rows()))

    return {
        OURS: lambda: swept(1),
        f"{OURS}, 2 threads": lambda: swept(2),
        f"{OURS}, rows of a file, 2 threads": lambda: streamed(
            lambda rows: stream.answered(trees, rows, setting, 2)
        ),
        f"{OURS}, rows of a file, {WORKERS} Dask workers": lambda: streamed(
            lambda rows: cluster.answered_by(client, trees, rows, setting)
        ),
        LOOP: looped,
    }


def _checked(ways: dict[str, Callable[[], Any]]) -> int:
    """Assert that all ways say the same; return how many motions lead to contact."""
    one, two, lines, other_lines, looped = (way() for way in ways.values())
    assert one.tobytes() == two.tobytes()
    assert lines == other_lines
    times = np.array([np.nan if answer.time is None else answer.time for answer in looped])
    assert np.array_equal(one["time"], times, equal_nan=True)
    assert lines.count(b"\n") == len(one)
    return int((one["status"] == "contact").sum())
