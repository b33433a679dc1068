"""Meshes made to hurt: what each question about them takes, in time and in memory.

Each question has a process of its own, so that its peak is its own.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

sys.path.append(str(Path(__file__).resolve().parents[1]))

from harness import OURS, Row, Timing, markdown, time_text
from meshes.hostile import HOSTILE, HostilePair

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from obbcli import Accuracy, Mesh, ObbTree

COUNT, QUICK_COUNT = 100_000, 2_000
LARGE = {"grids": 1_000_000}
TIMEOUT = 5.0  # s, of every question that has one
MOST_PAIRS = 1_000
MOST_CONTACTS = 100
MOST_BYTES = 1 << 30  # of the list of all pairs
FITS = ("triangles", "points", "hull", "min-volume", "axis-aligned")
SPLITS = ("compact", "median", "center")


@dataclass(frozen=True)
class Outcome:
    """What one question said, and took.

    Attributes:
        status: in a word or two.
        seconds: of the question, meshes made before and trees on the way.
        processor: seconds that it took of processors, whoever else was busy.
        peak: bytes of the process, at most.
        before: bytes of it before the question, at most.
    """

    status: str
    seconds: float
    processor: float
    peak: int
    before: int


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a mesh and a question."""
    for mesh in HOSTILE:
        count = QUICK_COUNT if quick else LARGE.get(mesh, COUNT)
        for question in QUESTIONS:
            outcome = apart(mesh, question, count)
            once = Timing(outcome.seconds, outcome.seconds, outcome.seconds, 1)
            facts = {"question": question, **asdict(outcome)}
            yield Row("hostile", mesh, count, {OURS: once}, {OURS: facts})


def tables(rows: Sequence[Row]) -> str:
    """Return what was measured, in Markdown."""
    lines = [["mesh", "triangles", "question", "answer", "time", "processor", "peak", "grown"]]
    for row in rows:
        facts: Any = row.notes[OURS]
        sizes = (facts["peak"], facts["peak"] - facts["before"])
        lines.append(
            [
                row.case,
                f"{row.triangles:,}",
                facts["question"],
                facts["status"],
                time_text(facts["seconds"]),
                time_text(facts["processor"]),
                *(f"{size / 2**20:,.0f} MiB" for size in sizes),
            ]
        )
    return markdown(lines)


def apart(mesh: str, question: str, count: int) -> Outcome:
    """Ask in a process of its own; one that dies is an answer, too."""
    command = [sys.executable, __file__, mesh, question, str(count)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        words = (done.stderr.strip().splitlines() or [""])[-1]
        return Outcome(f"died with {done.returncode}: {words}", 0.0, 0.0, 0, 0)
    return Outcome(**json.loads(done.stdout))


def peak_bytes() -> int:
    """Return what this process held at most: not before it was itself, as the system's sum does."""
    status = Path("/proc/self/status")
    if status.exists():
        lines = dict(line.split(":", 1) for line in status.read_text().splitlines())
        return int(lines["VmHWM"].split()[0]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def ask(mesh: str, question: str, count: int) -> Outcome:
    """Ask here."""
    pair = HOSTILE[mesh](count)
    call = QUESTIONS[question](pair)
    before = peak_bytes()
    start, used = time.perf_counter(), time.process_time()
    status = call()
    taken = time.perf_counter() - start, time.process_time() - used
    return Outcome(status, *taken, peak_bytes(), before)


def accuracy(**given: Any) -> Accuracy:
    """Return what is asked of the answers: an end within some seconds."""
    from obbcli import Accuracy

    return Accuracy(timeout=TIMEOUT, **given)


def trees(pair: HostilePair) -> tuple[ObbTree, ObbTree]:
    """Return trees that have not begun."""
    from obbcli import ObbTree

    one = ObbTree.build(mesh_of(pair.a))
    return one, one if pair.b is pair.a else ObbTree.build(mesh_of(pair.b))


def mesh_of(surface: Any) -> Mesh:
    """Return a surface as the package knows it."""
    from obbcli import Mesh

    return Mesh(surface.vertices, surface.faces)


def bodies(pair: HostilePair, place: str, *, moves: bool, turns: bool = False) -> tuple[Any, Any]:
    """Return a at rest, and b where it is to be, moving or not."""
    from obbcli import Body, Motion, Pose

    a, b = trees(pair)
    motion = Motion(pair.velocity, pair.spin if turns else (0, 0, 0)) if moves else Motion()
    return Body(a), Body(b, Pose(translation=getattr(pair, place)), motion)


def _build(fit: Any, split: Any) -> Callable[[HostilePair], Callable[[], str]]:
    def prepare(pair: HostilePair) -> Callable[[], str]:
        from obbcli import ObbTree

        mesh = mesh_of(pair.a)

        def call() -> str:
            tree = ObbTree.build(mesh, fit=fit, split=split, lazy=False)
            tree.check()
            return f"{tree.node_count:,} boxes"

        return call

    return prepare


def _collide(place: str) -> Callable[[HostilePair], Callable[[], str]]:
    def prepare(pair: HostilePair) -> Callable[[], str]:
        from obbcli import collide

        a, b = bodies(pair, place, moves=False)
        return lambda: str(collide(a, b, accuracy=accuracy()).status.value)

    return prepare


def _pairs(limit: int | None) -> Callable[[HostilePair], Callable[[], str]]:
    def prepare(pair: HostilePair) -> Callable[[], str]:
        from obbcli import ObbError, triangle_pairs

        a, b = bodies(pair, "close", moves=False)

        def call() -> str:
            try:
                found = triangle_pairs(a, b, limit, max_memory=MOST_BYTES)
            except ObbError as refused:
                return "refused: " + refused.fault
            return f"{len(found):,} pairs"

        return call

    return prepare


def _blocks(pair: HostilePair) -> Callable[[], str]:
    from obbcli import triangle_pair_blocks

    a, b = bodies(pair, "close", moves=False)

    def call() -> str:
        stop = time.perf_counter() + TIMEOUT
        count = 0
        for block in triangle_pair_blocks(a, b):
            count += len(block)
            if time.perf_counter() > stop:
                return f"the first {count:,} pairs"
        return f"{count:,} pairs"

    return call


def _distance(pair: HostilePair) -> Callable[[], str]:
    from obbcli import distance

    a, b = bodies(pair, "apart", moves=False)

    def call() -> str:
        found = distance(a, b, accuracy())
        low, high = found.bounds
        return f"{high:.4g} - {high - low:.1g}"

    return call


def _first(place: str = "apart", *, turns: bool, **given: Any) -> Any:
    def prepare(pair: HostilePair) -> Callable[[], str]:
        from obbcli import first_contact

        a, b = bodies(pair, place, moves=True, turns=turns)

        def call() -> str:
            found = first_contact(a, b, accuracy=accuracy(**given))
            time_text = "" if found.time is None else f" {found.time:.4g} s"
            return found.status.value + time_text

        return call

    return prepare


def _contacts(*, turns: bool) -> Callable[[HostilePair], Callable[[], str]]:
    def prepare(pair: HostilePair) -> Callable[[], str]:
        from obbcli import UnresolvedError, contacts

        a, b = bodies(pair, "apart", moves=True, turns=turns)

        def call() -> str:
            count = 0
            try:
                for _ in contacts(a, b, accuracy=accuracy(), limit=MOST_CONTACTS):
                    count += 1
            except UnresolvedError:
                return f"{count} contacts, unresolved"
            return f"{count} contacts"

        return call

    return prepare


def _scene(pair: HostilePair) -> Callable[[], str]:
    from obbcli import Body, Motion, Pose, Scene

    a, b = bodies(pair, "apart", moves=True, turns=True)
    back = Body(b.shape, Pose(translation=tuple(-x for x in pair.apart)), Motion())
    scene = Scene({"a": a, "b": b, "c": back}, accuracy=accuracy())
    return lambda: f"{len(list(scene.first_contacts()))} contacts"


QUESTIONS: dict[str, Callable[[HostilePair], Callable[[], str]]] = {
    **{f"build, {split}": _build("triangles", split) for split in SPLITS},
    **{f"build, {fit}": _build(fit, "compact") for fit in FITS[1:]},
    "collide, apart": _collide("apart"),
    "collide, close": _collide("close"),
    f"{MOST_PAIRS:,} pairs": _pairs(MOST_PAIRS),
    "all pairs": _pairs(None),
    "all pairs, in blocks": _blocks,
    "distance": _distance,
    "first contact": _first(turns=False),
    "first contact, turning": _first(turns=True),
    "first contact, sampled": _first(turns=True, method="sampled", steps=100),
    "contacts": _contacts(turns=False),
    "contacts, turning": _contacts(turns=True),
    "scene": _scene,
}


if __name__ == "__main__":
    print(json.dumps(asdict(ask(sys.argv[1], sys.argv[2], int(sys.argv[3])))))
