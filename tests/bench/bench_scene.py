"""Scenes of 10 to 10,000 bodies: how time and work grow, what `first` saves, what memory it takes.

Bodies are instances of a few blobs, scattered at the same density, that move by about two of their
sizes while they turn. Every answer is compared with asking pair by pair, as far as that ends.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from harness import OURS, Row, Timing, alternate
from meshes.surfaces import blob

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli import Mesh, Scene

COUNTS = {10: 9, 100: 5, 1_000: 3, 10_000: 1}
QUICK_COUNTS = {10: 5, 100: 3, 1_000: 1}
TRIANGLES = 2_000
MESHES = 4
DENSITY = 0.004  # bodies of radius 1 in a unit of space
MOST_ONE_BY_ONE = 1_000  # more would take hours
# What the system says of a child counts what its parent held when it was made.
WATCHED = """
import re, sys
from obbcli.cli import main
code = main(sys.argv[1:])
print(re.search(r"VmHWM:\\s+(\\d+) kB", open("/proc/self/status").read())[1], file=sys.stderr)
sys.exit(code)
"""
INSTANCES, LARGE, QUICK_LARGE = 1_000, 100_000, 10_000


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a number of bodies, how they grow, and one about memory."""
    from obbcli import Mesh

    surfaces = [blob(TRIANGLES, seed=seed) for seed in range(MESHES)]
    meshes = [Mesh(surface.vertices, surface.faces) for surface in surfaces]
    rows = []
    for count, rounds in (QUICK_COUNTS if quick else COUNTS).items():
        rows.append(scattered_row(meshes, count, rounds))
        yield rows[-1]
    yield growth(rows)
    with tempfile.TemporaryDirectory() as folder:
        yield from instances(Path(folder), QUICK_LARGE if quick else LARGE)


def scattered(meshes: list[Mesh], count: int) -> Scene:
    """Return a scene; its trees have not begun."""
    from obbcli import Body, Motion, Pose, Scene

    rng = np.random.default_rng(0)
    width = 0.5 * (count / DENSITY) ** (1 / 3)
    bodies = {}
    for k in range(count):
        pose = Pose(rng.uniform(-3, 3, 3), rng.uniform(-width, width, 3))
        motion = Motion(4 * rng.normal(size=3), rng.uniform(-3, 3, 3))
        bodies[str(k)] = Body(meshes[k % len(meshes)], pose, motion)
    return Scene(bodies)


def scattered_row(meshes: list[Mesh], count: int, rounds: int) -> Row:
    """Return what a scene takes: all contacts, the first alone, and pair by pair."""
    every = scattered(meshes, count).first_contacts()
    contacts = list(every)
    first = scattered(meshes, count).first_contacts(first=True)
    assert list(first) == contacts[:1]
    calls: dict[str, Any] = {
        OURS: lambda: list(scattered(meshes, count).first_contacts()),
        f"{OURS} first": lambda: list(scattered(meshes, count).first_contacts(first=True)),
    }
    if count <= MOST_ONE_BY_ONE:
        found = one_by_one(meshes, count)
        assert found == sorted((one.time, one.body_a, one.body_b) for one in contacts)
        calls["pair by pair"] = partial(one_by_one, meshes, count)
    stats = every.stats
    facts = {
        "pairs": f"{stats.pairs:,}",
        "near": f"{stats.pairs - stats.apart_by_bounds:,}",
        "contacts": stats.in_contact,
        "boxes built": sum(body.nodes_built for body in stats.bodies[:MESHES]),
        "pops": stats.pops,
        "bounds": stats.seconds["bounds"],
    }
    notes = {OURS: facts, f"{OURS} first": {"pops": first.stats.pops}}
    return Row("scene", f"{count:,} bodies", TRIANGLES, alternate(calls, rounds), notes)


def one_by_one(meshes: list[Mesh], count: int) -> list[tuple[float, str, str]]:
    """Return the contacts of all pairs, each asked about alone, on trees that all share."""
    from obbcli import Body, ObbTree, first_contact

    trees = {id(mesh): ObbTree.build(mesh) for mesh in meshes}
    scene = scattered(meshes, count)
    bodies = [
        (one.name, Body(trees[id(one.body.shape)], one.body.pose, one.body.motion))
        for one in scene.bodies
    ]
    found = []
    for (name_a, a), (name_b, b) in combinations(bodies, 2):
        answer = first_contact(a, b, scene.duration)
        if answer.time is not None:
            found.append((answer.time, name_a, name_b))
    return sorted(found)


def growth(rows: list[Row]) -> Row:
    """Return how time and work grow with the number of bodies, as exponents from 100 bodies on."""
    counts = [int(row.case.split()[0].replace(",", "")) for row in rows]

    def exponent(values: list[Any]) -> float:
        first = counts.index(100)
        return float(np.polyfit(np.log(counts[first:]), np.log(values[first:]), 1)[0])

    facts: dict[str, object] = {
        "time": exponent([row.timings[OURS].median for row in rows]),
        "bounds": exponent([row.notes[OURS]["bounds"] for row in rows]),
        "pops": exponent([row.notes[OURS]["pops"] for row in rows]),
        "boxes built": exponent([row.notes[OURS]["boxes built"] for row in rows]),
        "time of first": exponent([row.timings[f"{OURS} first"].median for row in rows]),
    }
    return Row("scene", "exponent in the number of bodies", TRIANGLES, {}, {OURS: facts})


def instances(folder: Path, triangles: int) -> Iterator[Row]:
    """Yield what the command takes for many bodies of one large mesh, as STL and as tree file."""
    from obbcli import Mesh, ObbTree

    surface = blob(triangles)
    mesh = Mesh(surface.vertices, surface.faces)
    write_stl(folder / "blob.stl", mesh)
    ObbTree.build(folder / "blob.stl").save(folder / "blob.obbt")
    answers = []
    for name in ("blob.stl", "blob.obbt"):
        scene = folder / f"{name}.json"
        scene.write_text(json.dumps(scene_file(name)))
        for options in ((), ("--first",)):
            words = ["scene", str(scene), "--json", *options]
            seconds, peak, document = measured(words)
            facts = {
                "peak MiB": peak / 2**20,
                "contacts": len(document["result"]["contacts"]),
                "boxes built": document["stats"]["bodies"][0]["nodes_built"],
                "triangles loaded": document["stats"]["bodies"][0]["triangles_loaded"],
            }
            timing = Timing(seconds, seconds, seconds, 1)
            case = f"{INSTANCES:,} bodies of {name} {' '.join(options)}".strip()
            yield Row("scene", case, len(surface.faces), {OURS: timing}, {OURS: facts})
            answers.append(document["result"]["contacts"])
    assert answers[0] == answers[2]
    assert answers[1] == answers[3] == answers[0][:1]


def scene_file(mesh: str) -> dict[str, Any]:
    """Return what the file of a scene of one mesh says."""
    rng = np.random.default_rng(1)
    width = 0.5 * (INSTANCES / DENSITY) ** (1 / 3)

    def body(k: int) -> dict[str, Any]:
        turn, place = rng.uniform(-3, 3, 3).tolist(), rng.uniform(-width, width, 3).tolist()
        velocity, spin = (4 * rng.normal(size=3)).tolist(), rng.uniform(-3, 3, 3).tolist()
        motion = {"linear_velocity": velocity, "angular_velocity": spin}
        pose = {"rotation": turn, "translation": place}
        return {"name": f"body {k}", "mesh": mesh, "pose": pose, "motion": motion}

    return {"duration": 1.0, "body": [body(k) for k in range(INSTANCES)]}


def write_stl(path: Path, mesh: Mesh) -> None:
    """Write a binary STL file."""
    facet = [("normal", "<f4", 3), ("at", "<f4", (3, 3)), ("rest", "<u2")]
    facets = np.zeros(len(mesh.triangles), facet)
    facets["at"] = mesh.vertices[mesh.triangles]
    path.write_bytes(bytes(80) + len(facets).to_bytes(4, "little") + facets.tobytes())


def measured(words: list[str]) -> tuple[float, int, dict[str, Any]]:
    """Return seconds, peak bytes and the document of a command line."""
    start = time.perf_counter()
    ended = subprocess.run(
        [sys.executable, "-c", WATCHED, *words], capture_output=True, text=True, check=True
    )
    seconds = time.perf_counter() - start
    return seconds, 1024 * int(ended.stderr), json.loads(ended.stdout)
