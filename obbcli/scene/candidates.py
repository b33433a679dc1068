"""The pairs of a scene that may meet, and not before when: all others are proven apart."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli import kernels
from obbcli.errors import SceneError
from obbcli.questions.pair_question import time_tolerance
from obbcli.scene.swept_boxes import MARGIN, swept_boxes
from obbcli.spelling import nearest

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from obbcli.accuracy import Accuracy
    from obbcli.motion.body import Surface
    from obbcli.scene.bodies import Ignore, SceneBody

Pair = tuple[int, int]


class Candidates(NamedTuple):
    """Pairs that may meet, by time.

    Attributes:
        pairs: int64 (K, 2), places of bodies in the scene, the smaller first.
        times: float64 (K,), s; no question about the pair names an earlier contact.
        total: how many pairs there are.
        static: how many of them are of two static bodies.
        ignored: how many of the others are to be ignored.
    """

    pairs: NDArray[np.int64]
    times: NDArray[np.float64]
    total: int
    static: int
    ignored: int


class Ignored:
    """What is not asked about: two static bodies, and what a scene says to ignore.

    Args:
        bodies: of the scene.
        ignore: as checked.
    """

    def __init__(self, bodies: Sequence[SceneBody], ignore: Sequence[Ignore]) -> None:
        places = {body.name: place for place, body in enumerate(bodies)}
        numbers: dict[str | None, int] = {None: 0}
        for body in bodies:
            numbers.setdefault(body.group, len(numbers))
        self.groups = np.array([numbers[body.group] for body in bodies], np.uint32)
        self.static = np.array([body.static for body in bodies])
        self.matrix = np.zeros((len(numbers), len(numbers)), dtype=bool)
        self.pairs: set[Pair] = set()
        for entry in ignore:
            if "bodies" in entry:
                a, b = sorted(places[name] for name in entry["bodies"])
                self.pairs.add((a, b))
            else:
                found = [numbers[group] for group in entry["groups"]]
                self.matrix[found[0], found[-1]] = self.matrix[found[-1], found[0]] = True

    def is_static(self, pair: Pair) -> bool:
        """Return whether both bodies are static."""
        return bool(self.static[pair[0]] and self.static[pair[1]])

    def __contains__(self, pair: Pair) -> bool:
        return pair in self.pairs or bool(self.matrix[self.groups[pair[0]], self.groups[pair[1]]])

    def counts(self) -> tuple[int, int]:
        """Return how many pairs are of two static bodies, and how many others are ignored."""
        of_static = int(self.static.sum())
        static = of_static * (of_static - 1) // 2
        size = len(self.matrix)
        all_of = np.bincount(self.groups, minlength=size).tolist()
        still_of = np.bincount(self.groups[self.static], minlength=size).tolist()
        ignored = 0
        for g, h in zip(*np.nonzero(np.triu(self.matrix)), strict=True):
            if g == h:
                n, s = all_of[g], still_of[g]
                ignored += (n * (n - 1) - s * (s - 1)) // 2
            else:
                ignored += all_of[g] * all_of[h] - still_of[g] * still_of[h]
        for a, b in self.pairs:
            by_group = self.matrix[self.groups[a], self.groups[b]]
            ignored += not (by_group or self.is_static((a, b)))
        return static, ignored


def asked_pairs(
    pairs: Iterable[tuple[str, str]], bodies: Sequence[SceneBody], ignored: Ignored
) -> list[Pair]:
    """Return the pairs that were asked for by name, sorted, each once.

    Raises:
        SceneError: a name is not known, both are the same, or the scene says not to ask about them.
    """
    places = {body.name: place for place, body in enumerate(bodies)}
    found = set()
    for pair in pairs:
        names = (pair,) if isinstance(pair, str) else tuple(pair)
        where = "pairs: " + ",".join(map(str, names))
        if len(names) != 2 or names[0] == names[1]:
            raise SceneError(where, "is no pair", "name two bodies")
        for name in names:
            if name not in places:
                fault = f"no body of the scene is called {name!r}"
                raise SceneError(where, fault, nearest(str(name), list(places)))
        a, b = sorted(places[name] for name in names)
        if ignored.is_static((a, b)):
            raise SceneError(where, "both are static", "make one of them not static")
        if (a, b) in ignored:
            raise SceneError(where, "is ignored by the scene", "take it out of ignore")
        found.add((a, b))
    if not found:
        raise SceneError("pairs", "are none", "name some, or leave it out to ask about all")
    return sorted(found)


def find_candidates(
    bodies: Sequence[SceneBody],
    shapes: Sequence[Surface],
    places: Sequence[int],
    ignored: Ignored,
    duration: float,
    accuracy: Accuracy,
) -> Candidates:
    """Return the pairs of a scene that may meet.

    Args:
        bodies: those asked about.
        shapes: the loaded shape of each body.
        places: the place of each body in the scene, increasing.
        ignored: what is not asked about.
        duration: s.
        accuracy: of the questions to come.
    """
    swept = swept_boxes([body.body for body in bodies], shapes, duration, accuracy)
    near = accuracy.clearance + (accuracy.distance_tolerance or 0.0)
    reach = min((1 + MARGIN) * near, sys.float_info.max)
    numbers = np.array(places)
    rows, times = kernels.swept_pairs(
        swept.bodies,
        swept.times,
        swept.boxes,
        ignored.groups[numbers],
        ignored.static[numbers].astype(np.uint8),
        ignored.matrix.astype(np.uint8).ravel(),
        len(ignored.matrix),
        reach,
    )
    pairs = numbers[rows]
    if ignored.pairs:
        kept = np.array([(a, b) not in ignored.pairs for a, b in pairs.tolist()], dtype=bool)
        pairs, times = pairs[kept], times[kept]
    count = len(ignored.groups)
    total = count * (count - 1) // 2
    tolerance = time_tolerance(accuracy, duration)
    early = np.maximum((1 - MARGIN) * times - (1 + MARGIN) * tolerance, 0.0)
    return Candidates(pairs, early, total, *ignored.counts())


def earliest(time: float, tolerance: float) -> float:
    """Return what no bracket of a contact that is not before `time` begins before, s."""
    return max((1 - MARGIN) * time - (1 + MARGIN) * tolerance, 0.0)
