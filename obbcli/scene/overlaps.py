"""`Overlaps`: how the bodies of a scene lie to each other at t = 0, pair by pair."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from obbcli.answers.counts import Counts
from obbcli.answers.overlap import MEETING, Overlap
from obbcli.questions.budget import Budget
from obbcli.questions.overlap.band import most_gap
from obbcli.questions.overlap.overlap import overlap_of
from obbcli.questions.pair_question import PairQuestion
from obbcli.scene.pairs import ScenePairs

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.questions.overlap.asked import Asked
    from obbcli.scene.bodies import SceneParts
    from obbcli.scene.results import SceneStats
    from obbcli.scene.shapes import Shapes


@dataclass(frozen=True)
class SceneOverlap:
    """How two bodies of a scene lie to each other.

    Attributes:
        body_a: the name of A, of the two bodies the one that comes first in the scene.
        body_b: the name of B.
        overlap: what `overlap` says of the two.
    """

    body_a: str
    body_b: str
    overlap: Overlap


class Overlaps(Iterator[SceneOverlap]):
    """All pairs of a scene that are not clear, in the order of its bodies.

    Made by `Scene.overlaps`. Pairs whose bounds are apart cost no look at their trees. Depths of
    bodies that touch are as the question about touching left them.

    Args:
        scene: its parts; the accuracy says how near bodies are wanted apart (`clearance`), how
            many steps a pair may take, and how long all may take together.
        shapes: its meshes and trees.
        pairs: the bodies asked about, by name; None: all pairs.
        asked: what is asked of each pair.

    Attributes:
        asked: the bodies and pairs of the question.

    Raises:
        ObbError: as `Scene.overlaps`.
    """

    def __init__(
        self,
        scene: SceneParts,
        shapes: Shapes,
        pairs: Iterable[tuple[str, str]] | None,
        asked: Asked,
    ) -> None:
        self.wanted = asked
        self.accuracy = scene.accuracy
        named = None if pairs is None else list(pairs)
        loaded = [
            (body.body, shapes.load(body.body.shape))
            for body in scene.bodies
            if named is None or any(body.name in pair for pair in named)
        ]
        reach = max(scene.accuracy.clearance, most_gap(loaded, asked.touch))
        near = replace(scene.accuracy, clearance=reach, distance_tolerance=None)
        self.asked = ScenePairs(scene._replace(duration=0.0, accuracy=near), shapes, named)
        self._left = iter(sorted(self.asked.candidates.pairs.tolist()))
        self._budget = Budget(seconds=scene.accuracy.timeout)
        self._counts = Counts()
        self._ends = {"apart": 0, "in_contact": 0, "open_": 0}

    @property
    def stats(self) -> SceneStats:
        """What became of the pairs so far, and what it took."""
        return self.asked.stats(self._counts, **self._ends)

    def __next__(self) -> SceneOverlap:
        """Return the next pair that is not clear.

        Raises:
            ObbError: as `overlap`.
        """
        for a, b in self._left:
            with self.asked.timed("query"):
                found = self._ask(a, b)
            if found.relation != "clear":
                return SceneOverlap(*self.asked.names(a, b), found)
        raise StopIteration

    def _ask(self, a: int, b: int) -> Overlap:
        """Return how two bodies, given by their places in the scene, lie to each other."""
        accuracy = replace(self.accuracy, timeout=self._budget.seconds_left)
        pair = PairQuestion.of(*self.asked.bodies_of(a, b), 0.0, accuracy)
        found = overlap_of(pair, self.wanted)
        self._counts += found.stats.counts
        end = "in_contact" if found.relation in (*MEETING, "touching") else "apart"
        self._ends["open_" if found.relation == "unresolved" else end] += 1
        return found
