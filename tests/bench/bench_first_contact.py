"""First contact of moving surfaces: time, tests and truth, against all who answer such questions.

Random questions by pair of surfaces, motion and outcome; ours at four accuracies. All contestants
take turns at a question; those that take seconds are asked the first few of a class. Every answer
of ours is checked, and every peer's judged.
"""

from __future__ import annotations

import gc
import random
import sys
import time
from collections import defaultdict
from itertools import product
from typing import TYPE_CHECKING, Any

import moving_truth
import numpy as np
from harness import OURS, Row, Timing, summarise
from moving_ours import our_bodies, our_calls
from moving_peers import ADVANCEMENT, PEERS, TIGHT_TRIANGLES, Models
from moving_sets import DURATION, MOTIONS, OUTCOMES, mesh_pairs, questions

import obbcli

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from meshes.surfaces import Surface
    from moving_peers import MovingPeer
    from moving_sets import Moving

QUERIES = 200
QUICK_QUERIES = 10
ROUNDS = 3
# Of the patience with slow peers.
QUICK_PATIENCE = 0.1
SLOWEST = 3


def run(quick: bool, queries: int | None = None, meshes: Path | None = None) -> Iterator[Row]:
    """Yield a row a pair of surfaces, motion and outcome."""
    count = queries or (QUICK_QUERIES if quick else QUERIES)
    patience = QUICK_PATIENCE if quick else 1.0
    models = Models()
    refusing: set[str] = set()
    for name, a, b in mesh_pairs(quick, meshes):
        is_small = max(len(a.faces), len(b.faces)) <= TIGHT_TRIANGLES
        for motion, outcome in product(MOTIONS[:1] if is_small else MOTIONS, OUTCOMES):
            start = time.perf_counter()
            tally = Tally(patience, refusing)
            for question in questions(name, (a, b), motion, outcome, count, _sorter(models)):
                tally.ask(question, models)
            row = tally.row(f"{name} / {motion} / {outcome}", (a, b))
            print(f"{row.case}: {time.perf_counter() - start:.1f} s", file=sys.stderr)
            yield row


def _sorter(models: Models) -> Callable[[Moving], bool]:
    """Return what tells hits from misses when questions are drawn."""
    return lambda question: obbcli.collide(*our_bodies(models, question), DURATION).collides


class Tally:
    """What is gathered over the questions of one class."""

    def __init__(self, patience: float, refusing: set[str]) -> None:
        """Take the share of the peers' patience, and who answers no such question at all."""
        self._patience, self._refusing = patience, refusing
        self._spent: dict[str, float] = defaultdict(float)
        self._seconds: dict[str, list[float]] = defaultdict(list)
        self._counts: dict[str, list[tuple[int, int, int]]] = defaultdict(list)
        self._verdicts: dict[str, list[str]] = defaultdict(list)
        self._errors: dict[str, list[float]] = defaultdict(list)
        self._gaps: list[float] = []
        self._hits = 0

    def ask(self, question: Moving, models: Models) -> None:
        """Ask everybody, check ours, judge the others."""
        ours = our_calls(models, question)
        calls: dict[str, Callable[[], Any]] = dict(ours)
        slow = set()
        for peer in PEERS:
            if peer.can_ask(question) and self._is_asked(peer):
                start = time.perf_counter()
                calls[peer.name] = peer.call(models, question)
                if peer.patience is not None:
                    slow.add(peer.name)
                    self._spent[peer.name] += time.perf_counter() - start
        answers, seconds = take_turns(calls, slow, question.index)
        for who in slow:
            self._spent[who] += seconds[who]
        for who, taken in seconds.items():
            self._seconds[who].append(taken)
        exact = answers[OURS]
        self._hits += exact.collides
        gap = moving_truth.check(question, answers, models)
        self._gaps += [] if gap is None else [gap]
        for who in ours:
            stats = answers[who].stats
            self._counts[who].append((stats.box_tests, stats.triangle_tests, stats.pops))
        for who in (name for name in calls if name not in ours):
            verdict, error = moving_truth.judge(exact, answers[who])
            self._verdicts[who].append(verdict)
            self._errors[who] += [] if error is None else [error]
            if verdict == "refused" and who != ADVANCEMENT:
                self._refusing.add(who)

    def _is_asked(self, peer: MovingPeer) -> bool:
        """Return whether a peer answers such questions, and has not taken too long."""
        if peer.name in self._refusing:
            return False
        return peer.patience is None or self._spent[peer.name] <= peer.patience * self._patience

    def row(self, case: str, surfaces: tuple[Surface, Surface]) -> Row:
        """Return the figures."""
        refusing = {who for who, said in self._verdicts.items() if set(said) == {"refused"}}
        timings: dict[str, Timing] = {
            who: summarise(taken) for who, taken in self._seconds.items() if who not in refusing
        }
        notes: dict[str, dict[str, object]] = {who: self._our_notes(who) for who in self._counts}
        notes[OURS] |= {"hits": self._hits, "slowest": self._slowest()}
        if self._gaps:
            notes[OURS]["smallest gap"] = min(self._gaps)
        notes |= {who: self._peer_notes(who) for who in self._verdicts}
        triangles = max(len(surface.faces) for surface in surfaces)
        return Row("first contact", case, triangles, timings, notes)

    def _our_notes(self, who: str) -> dict[str, object]:
        counts = np.array(self._counts[who])
        notes: dict[str, object] = {"asked": len(counts), "p95": self._p95(who)}
        for name, column in zip(("boxes", "triangles", "pops"), counts.T, strict=True):
            notes[name] = int(np.median(column))
            notes[f"{name} p95"] = int(np.quantile(column, 0.95))
        return notes

    def _p95(self, who: str) -> float:
        return float(np.quantile(self._seconds[who], 0.95))

    def _peer_notes(self, who: str) -> dict[str, object]:
        said, errors = self._verdicts[who], np.array(self._errors[who] or [0.0])
        return {
            "asked": len(said),
            "p95": self._p95(who),
            "misses": said.count("miss"),
            "false hits": said.count("false hit"),
            "refused": said.count("refused"),
            "compared times": len(self._errors[who]),
            "median error": float(np.median(np.abs(errors))),
            "earliest": float(errors.min()),
            "latest": float(errors.max()),
        }

    def _slowest(self) -> list[dict[str, float]]:
        """Return the questions that took ours longest: number, seconds, tests, pops."""
        taken = np.array(self._seconds[OURS])
        return [
            {"index": int(k), "seconds": float(taken[k])}
            | dict(zip(("boxes", "triangles", "pops"), self._counts[OURS][k], strict=True))
            for k in np.argsort(-taken)[:SLOWEST]
        ]


def take_turns(
    calls: dict[str, Callable[[], Any]], slow: set[str], seed: int
) -> tuple[dict[str, Any], dict[str, float]]:
    """Return answers and the least seconds of each: of some rounds, of one where it is slow.

    The order is drawn anew each round, as whoever comes after a kindred call finds caches warm.
    """
    order = list(calls)
    shuffle = random.Random(seed).shuffle
    answers: dict[str, Any] = {}
    seconds: dict[str, float] = {}
    gc.collect(0)
    gc.disable()
    try:
        for turn in range(ROUNDS):
            shuffle(order)
            for who in order:
                if turn and who in slow:
                    continue
                start = time.perf_counter()
                answers[who] = calls[who]()
                taken = time.perf_counter() - start
                seconds[who] = min(taken, seconds.get(who, taken))
    finally:
        gc.enable()
    return answers, seconds
