"""`ScenePairs`: the bodies of a question about a scene, and the pairs of them that may meet."""

from __future__ import annotations

import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

from obbcli.questions.pair_question import check_units, time_tolerance
from obbcli.scene.candidates import Ignored, asked_pairs, find_candidates
from obbcli.scene.results import SceneContact, SceneStats
from obbcli.tree.tree import ObbTree

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from obbcli.accuracy import Accuracy
    from obbcli.answers.counts import Counts
    from obbcli.motion.body import Body
    from obbcli.scene.bodies import SceneParts
    from obbcli.scene.candidates import Candidates
    from obbcli.scene.shapes import Shapes


class ScenePairs:
    """A question about a scene, up to where pairs are looked at.

    Args:
        scene: what the scene consists of; its duration is resolved.
        shapes: its meshes and trees.
        pairs: the bodies asked about, by name; None: all pairs.
        solid: whether a body inside another at t = 0 is in contact with it.

    Attributes:
        bodies: those that pairs are of, in the order of the scene.
        shapes: the loaded shape of each body.
        duration: s.
        accuracy: of each answer.
        time_tolerance: s; the width asked of a bracket.
        candidates: the pairs that may meet.
        solid: as above.

    Raises:
        SceneError: a pair is none, or names what is not there.
        MeshError: a mesh cannot be read or is refused, as one that is not watertight if `solid`.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """

    def __init__(
        self,
        scene: SceneParts,
        shapes: Shapes,
        pairs: Iterable[tuple[str, str]] | None,
        *,
        solid: bool = False,
    ) -> None:
        assert scene.duration is not None
        self.duration = scene.duration
        self.accuracy = scene.accuracy
        self.time_tolerance = time_tolerance(scene.accuracy, scene.duration)
        self.solid = solid
        self._all = scene.bodies
        self._places_by_name = {body.name: place for place, body in enumerate(scene.bodies)}
        self._shapes = shapes
        self._placed: dict[int, Body] = {}
        self._seconds = {"load": 0.0, "bounds": 0.0, "query": 0.0}
        self._ignored = ignored = Ignored(scene.bodies, scene.ignore)
        self._wanted = wanted = None if pairs is None else asked_pairs(pairs, scene.bodies, ignored)
        places = list(range(len(scene.bodies)))
        if wanted is not None:
            places = sorted({place for pair in wanted for place in pair})
        self._places = places
        self.bodies = bodies = [scene.bodies[place] for place in places]
        with self.timed("load"):
            self.shapes = loaded = [shapes.load(body.body.shape) for body in bodies]
        check_units({body.name: shape.unit for body, shape in zip(bodies, loaded, strict=True)})
        self.candidates: Candidates = self.find(scene.accuracy)
        if solid:
            with self.timed("load"):
                self._require_watertight()

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """Count the time that the body takes."""
        start = time.perf_counter()
        try:
            yield
        finally:
            self._seconds[stage] += time.perf_counter() - start

    def find(self, accuracy: Accuracy) -> Candidates:
        """Find the pairs that may meet, or come as near as `accuracy` asks; they are kept, too."""
        with self.timed("bounds"):
            found = find_candidates(
                self.bodies, self.shapes, self._places, self._ignored, self.duration, accuracy
            )
        self.candidates = found if self._wanted is None else _only(found, self._wanted)
        return self.candidates

    def _require_watertight(self) -> None:
        """Refuse bodies that do not close, of pairs one of which may hold the other."""
        from obbcli.questions.containment import require_watertight

        pairs, times = self.candidates.pairs, self.candidates.times
        for place in sorted(set(pairs[times == 0.0].ravel().tolist())):
            tree = self.body(place).shape
            assert isinstance(tree, ObbTree)
            name = f"body {self._all[place].name!r}"
            require_watertight(tree.mesh, f"{name} ({tree.source})" if tree.source else name)

    def bodies_of(self, a: int, b: int) -> tuple[Body, Body]:
        """Return two bodies, given by their places in the scene, on their trees."""
        return self.body(a), self.body(b)

    def body(self, place: int) -> Body:
        """Return a body, given by its place in the scene, on its tree."""
        placed = self._placed.get(place)
        if placed is None:
            placed = self._placed[place] = self._shapes.body(self._all[place].body)
        return placed

    def names(self, a: int, b: int) -> tuple[str, str]:
        """Return the names of two bodies."""
        return self._all[a].name, self._all[b].name

    def pair_of(self, contact: SceneContact) -> tuple[int, int]:
        """Return the places of two bodies that touch."""
        return self._places_by_name[contact.body_a], self._places_by_name[contact.body_b]

    def stats(self, counts: Counts, *, apart: int, in_contact: int, open_: int) -> SceneStats:
        """Return what became of the pairs.

        Args:
            counts: what the search counted.
            apart: pairs that were proven apart, of the candidates.
            in_contact: pairs of which a contact is known.
            open_: pairs that a limit left open.
        """
        total, static, ignored = self.candidates[2:]
        near = len(self.candidates.times)
        return SceneStats(
            total,
            static,
            ignored,
            total - static - ignored - near,
            apart,
            in_contact,
            open_,
            near - apart - in_contact - open_,
            *counts,
            tuple(self._shapes.stats(self._all[place]) for place in self._places),
            dict(self._seconds),
        )


def _only(candidates: Candidates, wanted: list[tuple[int, int]]) -> Candidates:
    """Return the candidates among pairs that were asked for, of which none is ignored."""
    known = set(wanted)
    kept = [row for row, (a, b) in enumerate(candidates.pairs.tolist()) if (a, b) in known]
    return candidates._replace(
        pairs=candidates.pairs[kept],
        times=candidates.times[kept],
        total=len(wanted),
        static=0,
        ignored=0,
    )
