"""Every pair of triangles that comes to touch, in order of time: `contacts`. Eberly 2008 §7.

The paper's callbacks in Python's form: the caller stops when it likes.
"""

from __future__ import annotations

import heapq
import math
import time
from dataclasses import fields, replace
from itertools import islice
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import Accuracy
from obbcli.contact import Query
from obbcli.errors import MotionError, UnresolvedError
from obbcli.legs import legs_of
from obbcli.mesh import Mesh
from obbcli.motion import Body, Motion, PathMotion, as_body
from obbcli.question import (
    POPS_A_SLICE,
    damaged,
    duration_of,
    moving_query,
    pivot_of,
    time_tolerance,
    trees_of,
    whole_limit,
)
from obbcli.relay import on_clock
from obbcli.results import Contact, Status
from obbcli.touching import contact_at_start, contact_of
from obbcli.tree import ObbTree

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from obbcli.motion import Shape
    from obbcli.question import Trees

_EXACT = Accuracy()


def contacts(
    a: Body | Shape,
    b: Body | Shape,
    duration: float | None = None,
    accuracy: Accuracy | None = None,
    limit: int | None = None,
) -> Iterator[Contact]:
    """Yield each triangle pair's own first contact in [0, duration], in order of time.

    Each comes with a proven bracket of its own, as `first_contact` gives it, as soon as no earlier
    one can follow; nothing later is computed before it is asked for. Pairs that meet at t = 0 come
    first. Of equal times the ids of the triangles decide. Where boxes stand for triangles, each
    pair of boxes is one contact.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, or the path of a mesh or tree file.
        b: likewise.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: what is asked of each contact. Its limits hold for the iterator as a whole.
        limit: at most so many contacts.

    Raises:
        MotionError: `limit` is no whole number of at least 1, the sampled method is asked for (it
            knows the first contact alone), the duration is negative or not finite, or positions
            leave the range of double.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        UnresolvedError: while iterating: a limit of `accuracy` was reached, or bodies turn too fast
            to be followed in doubles. All contacts before the time it names were yielded.
        OSError: a file cannot be read.
    """
    accuracy = _EXACT if accuracy is None else accuracy
    most = None if limit is None else whole_limit(limit)
    if accuracy.method == "sampled":
        raise MotionError(
            "method='sampled'", "knows the first contact alone", "use the certified method"
        )
    bodies = as_body(a), as_body(b)
    end = duration_of(duration, bodies)
    trees = trees_of(bodies)
    budget = _Budget(accuracy)
    if any(isinstance(body.motion, PathMotion) for body in bodies):
        return islice(_through_legs(bodies, trees, end, accuracy, budget), most)
    query = moving_query(bodies, trees, end, accuracy, each_pair=True)
    return islice(_of_motion(query, bodies, trees, accuracy, budget), most)


def first_patch(found: Iterable[Contact]) -> Iterator[Contact]:
    """Yield those contacts whose bracket overlaps that of the first: a patch where faces land.

    Args:
        found: in order of time.
    """
    end = math.inf
    for contact in found:
        assert contact.time_bounds is not None
        low, high = contact.time_bounds
        if low > end:
            return
        end = min(end, low if high is None else high)
        yield contact


class _Budget:
    """What is left of the pops and seconds that a caller allows."""

    def __init__(self, accuracy: Accuracy) -> None:
        self._left = accuracy.max_iterations
        self._stop = math.inf
        if accuracy.timeout is not None:
            self._stop = time.perf_counter() + accuracy.timeout

    def slice(self, proven: float) -> int:
        """Return how many pops may be done in one go.

        Raises:
            UnresolvedError: none, or no time; all is known before `proven`, s.
        """
        if self._left <= 0 or time.perf_counter() >= self._stop:
            raise unresolved_after(proven)
        return min(self._left, POPS_A_SLICE)

    def take(self, pops: int) -> None:
        """Count pops that were done."""
        self._left -= pops


def unresolved_after(proven: float) -> UnresolvedError:
    """Return the error of a question that ended before its answer was known."""
    return UnresolvedError(
        "contacts",
        f"stopped at a limit: all contacts before t = {proven!r} s are known, later ones are not",
        "raise max_iterations or timeout",
    )


def _of_motion(
    query: kernels.ContactQuery,
    bodies: tuple[Body, Body],
    trees: Trees,
    accuracy: Accuracy,
    budget: _Budget,
) -> Iterator[Contact]:
    """Yield the contacts of bodies of constant velocities."""
    for found in _taken(query, trees, budget):
        is_exact = found.evidence is kernels.Evidence.INTERSECTING
        if found.high == 0 and is_exact:
            yield contact_at_start(bodies, trees, found.triangle_a, found.triangle_b)
        else:
            yield contact_of(query, found, accuracy.clearance)


def _taken(
    query: kernels.ContactQuery, trees: Trees, budget: _Budget, start: float = 0.0
) -> Iterator[kernels.Contact]:
    """Yield what the kernels find, earliest first; `start` is where their clock begins, s."""
    is_finished = False
    while True:
        found = query.take()
        if found is not None:
            yield found
            continue
        if is_finished:
            break
        pops = query.counts()[3]
        try:
            is_finished = query.advance(budget.slice(start + query.lower_bound))
        except kernels.TreeError as fault:
            raise damaged(trees, fault) from fault
        budget.take(query.counts()[3] - pops)
    if query.has_given_up:
        raise unresolved_after(start + query.lower_bound)


def _through_legs(
    bodies: tuple[Body, Body],
    trees: Trees,
    duration: float,
    accuracy: Accuracy,
    budget: _Budget,
) -> Iterator[Contact]:
    """Yield the contacts of bodies of which one follows a path, leg by leg.

    A leg shows which pairs come near, with its slack to spare; each such pair is then asked about
    alone, over the whole path.
    """
    known = set()
    waiting: list[tuple[float, int, int, int, Contact]] = []
    for leg in legs_of(bodies, trees, duration):
        wide = replace(
            accuracy,
            clearance=accuracy.clearance + leg.slack,
            time_tolerance=time_tolerance(accuracy, duration),
        )
        query = moving_query(leg.bodies, trees, leg.duration, wide, each_pair=True)
        for found in _taken(query, trees, budget, leg.start):
            low = on_clock(leg.start, found.low, duration, up=False)
            while waiting and waiting[0][0] < low:
                yield heapq.heappop(waiting)[-1]
            if found.ranges in known:
                continue
            known.add(found.ranges)
            contact: Contact | None
            if found.evidence is kernels.Evidence.BOXES:
                contact = contact_of(query, found, accuracy.clearance)
                status = Status.CONTACT if low > 0 else contact.status
                contact = replace(contact, status=status, time=low, time_bounds=(low, None))
            else:
                ids = found.triangle_a, found.triangle_b
                contact = _alone(bodies, trees, ids, duration, accuracy, low)
            if contact is not None:
                assert contact.time is not None
                order = contact.time, found.triangle_a, found.triangle_b, len(known)
                heapq.heappush(waiting, (*order, contact))
    while waiting:
        yield heapq.heappop(waiting)[-1]


def _alone(
    bodies: tuple[Body, Body],
    trees: Trees,
    ids: tuple[int, int],
    duration: float,
    accuracy: Accuracy,
    low: float,
) -> Contact | None:
    """Return the first contact of one pair that is apart before `low`, s; None where it has none.

    Raises:
        UnresolvedError: a limit was reached.
    """
    a, b = (_triangle(*of) for of in zip(bodies, trees, ids, strict=True))
    found = Query(a, b, duration, accuracy).advance(accuracy.max_iterations, accuracy.timeout)
    if found.status is Status.SEPARATED:
        return None
    assert found.time_bounds is not None
    if found.status is Status.UNRESOLVED:
        raise unresolved_after(low)
    # Both lower ends are proven; with the later one the order in time is kept.
    lo = max(low, found.time_bounds[0])
    parts = {field.name: getattr(found, field.name) for field in fields(Contact)}
    own = {"triangle_a": ids[0], "triangle_b": ids[1], "time": lo}
    return Contact(**{**parts, **own, "time_bounds": (lo, found.time_bounds[1])})


def _triangle(body: Body, tree: ObbTree, row: int) -> Body:
    """Return a body of one triangle of another, with the same motion."""
    mesh = Mesh(tree.vertices[tree.mesh.triangles[row]], [[0, 1, 2]])
    motion = body.motion
    if not isinstance(motion, PathMotion) and motion.angular_velocity.any():
        pivot = pivot_of(body, tree)
        motion = Motion(motion.linear_velocity, motion.angular_velocity, pivot)
    return Body(ObbTree.build(mesh), pose=body.pose, motion=motion)
