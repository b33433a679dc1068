"""Questions that many threads ask about the same trees, and how their answers are compared.

Shared by the test of a few thousand and by `bench/load.py`, which asks a million.
"""

from __future__ import annotations

import gc
import os
import random
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from meshes.surfaces import blob, torus

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Pose, Query

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

TRIANGLES = 500
PLACES = 16  # of a pair of bodies
KINDS = ("collide", "first_contact", "distance", "triangle_pairs", "advance", "moving", "opened")
WEIGHTS = (30, 8, 12, 12, 8, 15, 15)
PIECE = 40  # pops that a question asked in pieces goes on by
REFUSED = 0.02  # of the questions are followed by one that is refused
FRESH = 2_000  # questions of a thread until it replaces the trees that all share


class Trees:
    """Lazy trees that all threads ask about, replaced now and then by fresh ones."""

    def __init__(self, folder: Path, triangles: int = TRIANGLES) -> None:
        surfaces = blob(triangles, seed=1), blob(triangles, seed=2), torus(triangles, 0.25)
        self._meshes = [Mesh(surface.vertices, surface.faces) for surface in surfaces]
        self.paths = [folder / f"{k}.obbt" for k in range(len(surfaces))]
        for mesh, path in zip(self._meshes, self.paths, strict=True):
            ObbTree.build(mesh).save(path)
        self.shared: list[ObbTree] = []
        self.renew()

    def renew(self) -> None:
        """Replace the trees by some that have not begun; who uses the old ones goes on."""
        self.shared = [ObbTree.build(mesh) for mesh in self._meshes]


def bodies(trees: list[Any], number: int) -> tuple[Body, Body]:
    """Return the bodies of one of the places: apart, touching or deep in one another; moving."""
    random_numbers = np.random.default_rng(number)
    shapes = random_numbers.integers(len(trees), size=2)
    way = random_numbers.normal(size=3)
    far = random_numbers.uniform(0.5, 3.0) * way / np.linalg.norm(way)
    pose = Pose(random_numbers.uniform(-3, 3, 3), far)
    motion = Motion(-1.5 * far, random_numbers.uniform(-1, 1, 3))
    return Body(trees[shapes[0]]), Body(trees[shapes[1]], pose, motion)


def ask(kind: str, number: int, trees: Trees) -> object:
    """Return an answer without what it cost: equal answers are equal objects."""
    a, b = bodies(trees.paths if kind == "opened" else trees.shared, number)
    still = Body(b.shape, b.pose)
    if kind in ("collide", "opened"):
        found = obbcli.collide(a, still)
        return found.status, found.witness
    if kind == "moving":
        return obbcli.collide(a, b).status
    if kind == "distance":
        apart = obbcli.distance(a, b, Accuracy(distance_tolerance=1e-3))
        return apart.bounds, apart.triangle_a, apart.triangle_b
    if kind == "triangle_pairs":
        pairs = obbcli.triangle_pairs(a, b, 200, threads=1)
        return pairs.tobytes()
    accuracy = Accuracy(time_tolerance=1e-4)
    if kind == "first_contact":
        return _told(obbcli.first_contact(a, b, accuracy=accuracy))
    query = Query(a, b, accuracy=accuracy)
    while not query.is_finished:
        contact = query.advance(PIECE)
    return _told(contact)


def _told(found: obbcli.FirstContact) -> object:
    return found.status, found.time_bounds, found.triangle_a, found.triangle_b, found.point


def refuse(number: int, trees: Trees, folder: Path) -> None:
    """Ask what is refused: errors must leave nothing behind either."""
    a, b = bodies(trees.shared, number)
    calls: list[Callable[[], object]] = [
        lambda: obbcli.collide(folder / "none.obbt", b),
        lambda: obbcli.collide(a, Body(b.shape, Pose(translation=(1e308, 1e308, 1e308)))),
        lambda: obbcli.triangle_pairs(a, a, max_memory=64),
        lambda: ObbTree.build(Mesh([[0, 0, 0]], [[0, 0, 0]]), fit="none"),  # type: ignore[arg-type]
        lambda: list(obbcli.contacts(a, b, accuracy=Accuracy(max_iterations=3))),
    ]
    try:
        calls[number % len(calls)]()
    except (obbcli.ObbError, OSError):
        return
    raise AssertionError(f"what is to be refused was answered: {number % len(calls)}")


@dataclass
class Load:
    """What was asked, and whether all was well.

    Attributes:
        count: questions.
        mismatches: those whose answer was not that of a serial run.
        samples: bytes held by the process, by share of the questions asked.
        seconds: of wall time.
    """

    count: int = 0
    mismatches: list[str] = field(default_factory=list)
    samples: dict[float, int] = field(default_factory=dict)
    seconds: float = 0.0


def serial_answers(trees: Trees) -> dict[tuple[str, int], object]:
    """Return what a single thread is told, of fresh trees."""
    trees.renew()
    return {(kind, number): ask(kind, number, trees) for kind in KINDS for number in range(PLACES)}


def run(
    folder: Path,
    count: int,
    threads: int,
    *,
    triangles: int = TRIANGLES,
    seconds: float = 0.0,
    fresh: int = FRESH,
    report: Callable[[Load], object] | None = None,
) -> Load:
    """Ask at least so many questions, for at least so long, in so many threads at once."""
    shift = Shift(folder, Trees(folder, triangles), count, seconds, fresh, report)
    workers = [threading.Thread(target=shift.work, args=(seed,)) for seed in range(threads)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    shift.load.seconds = time.perf_counter() - shift.start
    return shift.load


class Shift:
    """What the threads of a run share."""

    def __init__(
        self,
        folder: Path,
        trees: Trees,
        count: int,
        seconds: float,
        fresh: int,
        report: Callable[[Load], object] | None,
    ) -> None:
        self._folder, self._trees = folder, trees
        self._count, self._seconds, self._fresh, self._report = count, seconds, fresh, report
        self._wanted = serial_answers(trees)
        trees.renew()
        self._lock = threading.Lock()
        self._shares = _shares()
        self._next = next(self._shares)
        self.load = Load()
        self.start = time.perf_counter()

    def work(self, seed: int) -> None:
        """Ask until all is asked, or an answer is wrong."""
        chance = random.Random(seed)
        while True:
            fault = self._fault(chance)
            with self._lock:
                self.load.count += 1
                if fault:
                    self.load.mismatches.append(fault)
                if self.load.count % self._fresh == 0:
                    self._trees.renew()
                if self._note() >= 1 or self.load.mismatches:
                    return

    def _fault(self, chance: random.Random) -> str:
        """Ask once, and now and then what is refused; return what was wrong about it."""
        kind = chance.choices(KINDS, WEIGHTS)[0]
        number = chance.randrange(PLACES)
        try:
            answer = ask(kind, number, self._trees)
            if chance.random() < REFUSED:
                refuse(number, self._trees, self._folder)
        except Exception as wrong:  # noqa: BLE001  # told by the run
            return f"{kind} {number}: {wrong!r}"
        return "" if answer == self._wanted[kind, number] else f"{kind} {number}: {answer!r}"

    def _note(self) -> float:
        """Sample the memory at every tenth; return the share that is done."""
        taken = time.perf_counter() - self.start
        done = self.load.count / self._count
        if self._seconds > 0:
            done = min(done, taken / self._seconds)
        while self._next <= done:
            self.load.samples[self._next] = _held()
            self.load.seconds = taken
            if self._report is not None:
                self._report(self.load)
            self._next = next(self._shares, 2.0)
        return done


def _shares() -> Iterator[float]:
    for tenth in range(1, 11):
        yield tenth / 10


def _held() -> int:
    gc.collect()
    statm = Path("/proc/self/statm")
    if not statm.exists():
        return 0
    return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
