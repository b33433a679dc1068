"""`FirstSlices`: pairs of a scene asked about at the same time, each for a slice.

Most pairs need no more than that, and are apart: no object of Python is made for these.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.counts import Counts
from obbcli.motion.body import Body
from obbcli.questions.border import limits_of, placed_of, screw_of
from obbcli.questions.pair_question import PairQuestion
from obbcli.questions.query import Query
from obbcli.questions.steady import SteadyQuery
from obbcli.tree.tree import ObbTree

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.scene.pair_queue import Item
    from obbcli.scene.pairs import ScenePairs

    _Moving = tuple[kernels.Placed, kernels.Screw]

# What `kernels.ask_pairs` says of a pair; what comes first means that nothing was found out.
_APART, _ANSWERED, _OPEN = 1, 2, 3
# Stands for the query about a pair that is to be asked about alone.
ALONE = object()


class FirstSlices:
    """The first slices of questions about pairs, by the certified method.

    Args:
        asked: bodies and pairs.
        pops: the most of a slice.
        threads: how many do them. Answers and counts do not depend on it.
    """

    def __init__(self, asked: ScenePairs, pops: int, threads: int) -> None:
        self._asked = asked
        self._pops = min(pops, asked.accuracy.max_iterations)
        self._threads = threads
        self._moving: dict[int, _Moving | None] = {}

    def ask(self, items: Sequence[Item], seconds: float | None) -> tuple[list[Item], Counts]:
        """Ask about pairs.

        Args:
            items: of which nothing was begun.
            seconds: after which no more are begun. None: no limit.

        Returns:
            the items that are not proven apart, with their queries where these were begun, and
            `ALONE` where these cannot be; and what it has cost.

        Raises:
            ObbError: a shape is refused.
        """
        suited, others, bodies = [], [], []
        for item in items:
            a, b = self._moving_of(item, item.a), self._moving_of(item, item.b)
            if a is None or b is None:
                others.append(item._replace(work=ALONE))
            else:
                suited.append(item)
                bodies.append((*a, *b))
        accuracy = replace(self._asked.accuracy, max_iterations=self._pops, timeout=seconds)
        states, queries, counts = kernels.ask_pairs(
            bodies,
            limits_of(accuracy),
            duration=self._asked.duration,
            time_tolerance=self._asked.time_tolerance,
            threads=self._threads,
        )
        begun, spent = iter(queries), Counts(*counts)
        for item, state in zip(suited, states, strict=True):
            if state in (_ANSWERED, _OPEN):
                query = self._begun(item, *next(begun), is_finished=state == _ANSWERED)
                others.append(item._replace(work=query))
                spent += query.counts
            elif state != _APART:
                others.append(item._replace(work=ALONE))
        return others, spent

    def _moving_of(self, item: Item, place: int) -> _Moving | None:
        """Return a body as the kernels see it; None where they cannot be asked in this way.

        That is where velocities change. Solids that may hold each other ask more than whether
        surfaces touch.
        """
        if self._asked.solid and item.time == 0.0:
            return None
        if place not in self._moving:
            body = self._asked.body(place)
            steady = body.motion.steady
            found = None
            if steady is not None:
                tree = body.shape
                assert isinstance(tree, ObbTree)
                if steady is not body.motion:
                    body = Body(tree, body.pose, steady)
                found = placed_of(body, tree), screw_of(body, tree)
            self._moving[place] = found
        return self._moving[place]

    def _begun(
        self,
        item: Item,
        at_start: kernels.StaticQuery,
        moving: kernels.ContactQuery | None,
        *,
        is_finished: bool,
    ) -> Query:
        """Return a query that the kernels have begun."""
        asked = self._asked
        pair = PairQuestion.of(*asked.bodies_of(item.a, item.b), asked.duration, asked.accuracy)
        search = SteadyQuery.begun(pair, at_start, moving, is_finished=is_finished)
        return Query.begun(search, pair)
