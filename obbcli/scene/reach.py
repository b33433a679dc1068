"""`WideningPairs`: the pairs of a scene, nearest first by where their bodies go."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from obbcli.accuracy import Accuracy
from obbcli.scene.pairs import ScenePairs

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.scene.bodies import SceneParts
    from obbcli.scene.candidates import Pair
    from obbcli.scene.shapes import Shapes

# The first reach above 0, in diagonals of a usual body.
_FIRST = 1 / 8


class WideningPairs:
    """Pairs whose boxes come within a reach that is widened as far as answers need.

    Pairs that are not found within a reach are proven further apart at all times: that is their
    first lower bound, and no look at their trees is needed for it.

    Args:
        scene: its parts; the duration is resolved.
        shapes: its meshes and trees.
        pairs: the bodies asked about, by name; None: all pairs.
        solid: whether a body inside another at t = 0 touches it.
        most: mesh units; pairs that are proven further apart are not asked for. None: all are.

    Attributes:
        asked: the bodies, and the pairs found so far.
        held: pairs whose boxes meet at t = 0, so that one may hold the other.

    Raises:
        ObbError: as `ScenePairs`.
    """

    def __init__(
        self,
        scene: SceneParts,
        shapes: Shapes,
        pairs: Iterable[tuple[str, str]] | None,
        *,
        solid: bool,
        most: float | None,
    ) -> None:
        bare = Accuracy(max_iterations=scene.accuracy.max_iterations)
        self.asked = ScenePairs(scene._replace(accuracy=bare), shapes, pairs, solid=solid)
        self._most = most
        self._factor = 2.0
        # Pairs not found so far are further apart than this, mesh units.
        self._reach = 0.0
        first = self.asked.candidates
        self._known = {(a, b) for a, b in first.pairs.tolist()}
        self.held: set[Pair] = {
            (a, b)
            for (a, b), time in zip(first.pairs.tolist(), first.times.tolist(), strict=True)
            if time == 0.0
        }

    @property
    def reach(self) -> float:
        """Pairs not found so far are never nearer, mesh units; infinite where none are left."""
        return math.inf if self.is_exhausted else self._reach

    @property
    def is_exhausted(self) -> bool:
        """Whether all pairs that are asked for are found."""
        found = self.asked.candidates
        wanted = found.total - found.static - found.ignored
        limit = sys.float_info.max if self._most is None else self._most
        return len(found.times) == wanted or self._reach >= limit

    def widen(self) -> list[Pair]:
        """Widen the reach, and return the pairs that are found by that."""
        self._reach = self._next()
        near = replace(Accuracy(), clearance=self._reach)
        found = self.asked.find(near)
        new = [(a, b) for a, b in found.pairs.tolist() if (a, b) not in self._known]
        self._known.update(new)
        # Wide gaps between bodies take few rounds.
        self._factor = 2.0 if new else min(self._factor**2, 1e100)
        return sorted(new)

    def _next(self) -> float:
        limit = sys.float_info.max if self._most is None else self._most
        if self._reach > 0:
            return min(self._reach * self._factor, limit)
        spans = [float(np.ptp(shape.bounds, axis=0).max()) for shape in self.asked.shapes]
        usual = _FIRST * float(np.median(spans))
        return min(usual if 0 < usual < math.inf else 1.0, limit)
