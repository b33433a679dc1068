"""Every pair of triangles that comes to touch, in order of time: `contacts`. Eberly 2008 §7.

The paper's callbacks in Python's form: the caller stops when it likes.
"""

from __future__ import annotations

import heapq
import math
from dataclasses import fields, replace
from functools import partial
from itertools import count, islice, takewhile
from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.accuracy import Accuracy
from obbcli.answers.contact import Contact
from obbcli.answers.status import Status
from obbcli.errors import MotionError, UnresolvedError
from obbcli.mesh import Mesh
from obbcli.motion.body import Body, with_pivot
from obbcli.questions.border import moving_query, whole_limit
from obbcli.questions.describe import contact_at_start, contact_of
from obbcli.questions.legs.leg import on_clock
from obbcli.questions.legs.through_poses import legs_of
from obbcli.questions.pair_question import PairQuestion
from obbcli.questions.query import Query
from obbcli.questions.search import Search
from obbcli.tree.tree import ObbTree

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from obbcli.motion.body import Shape

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
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
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
            to be followed in doubles. All contacts before its `time` were yielded.
        OSError: a file cannot be read.

    Example:
        >>> from obbcli import Body, Motion
        >>> finger = Body("sample_meshes/finger_left.off", motion=Motion([0, -10, 0]))
        >>> [one.time for one in contacts(finger, "sample_meshes/workpiece.obj", limit=2)]
        [0.5, 0.5]
    """
    most = None if limit is None else whole_limit(limit)
    asked = _EXACT if accuracy is None else accuracy
    _refuse_sampled(asked)
    pair = PairQuestion.of(a, b, duration, asked)
    search = Search(asked.max_iterations, asked.timeout)
    return islice(search_contacts(pair, search), most)


def _refuse_sampled(accuracy: Accuracy) -> None:
    if accuracy.method == "sampled":
        raise MotionError(
            "method='sampled'", "knows the first contact alone", "use the certified method"
        )


def search_contacts(pair: PairQuestion, search: Search) -> Iterator[Contact]:
    """Yield what `contacts` yields, as far as a search goes, whose limits stand for `accuracy`'s.

    Raises:
        ObbError: as `contacts` does.
    """
    _refuse_sampled(pair.accuracy)
    found = (_of_motion if pair.is_steady else _of_path)(pair, search)
    named = (pair.with_parts(one, (one.triangle_a, one.triangle_b)) for one in found)
    return takewhile(lambda contact: _low(contact) <= search.end, named)


def _low(contact: Contact) -> float:
    assert contact.time is not None
    return contact.time


def _of_motion(pair: PairQuestion, search: Search) -> Iterator[Contact]:
    """Return the contacts of bodies of constant velocities."""
    query = moving_query(pair, each_pair=True)

    def contact(found: kernels.Contact) -> Contact:
        if found.high == 0 and found.evidence is kernels.Evidence.INTERSECTING:
            return contact_at_start(pair.bodies, pair.trees, found.triangle_a, found.triangle_b)
        return contact_of(query, found, pair.accuracy.clearance)

    return map(contact, search.found(query, pair.trees))


def _of_path(pair: PairQuestion, search: Search) -> Iterator[Contact]:
    """Yield the contacts of bodies of which one follows a path."""
    waiting: list[tuple[float, int, int, int, Contact]] = []
    number = count()
    try:
        for low, ask in _near_pairs(pair, search):
            yield from _taken_before(low, waiting)
            contact = ask()
            if contact is not None:
                a, b = contact.triangle_a, contact.triangle_b
                order = (-1, -1) if a is None or b is None else (a, b)
                heapq.heappush(waiting, (_low(contact), *order, next(number), contact))
    except UnresolvedError as limit:
        yield from _taken_before(limit.time or 0.0, waiting)
        raise
    yield from _taken_before(math.inf, waiting)


def _taken_before(
    time: float, waiting: list[tuple[float, int, int, int, Contact]]
) -> Iterator[Contact]:
    while waiting and waiting[0][0] < time:
        yield heapq.heappop(waiting)[-1]


def _near_pairs(
    pair: PairQuestion, search: Search
) -> Iterator[tuple[float, Callable[[], Contact | None]]]:
    """Yield each pair that comes near on a leg, from when on, and what says whether it touches.

    A leg shows which pairs come near, with its slack to spare; each such pair is then asked about
    alone, over the whole path.
    """
    known = set()
    clearance = pair.accuracy.clearance
    for leg in legs_of(pair):
        if leg.start > search.end:
            return
        wide = leg.question(
            pair, clearance=clearance + leg.slack, time_tolerance=pair.time_tolerance
        )
        query = moving_query(wide, each_pair=True)
        for found in search.found(query, pair.trees, leg.start):
            by_boxes = found.evidence is kernels.Evidence.BOXES
            # Of boxes their places in the trees; of triangles their rows, however they were met.
            which = found.ranges if by_boxes else (found.triangle_a, found.triangle_b)
            if which in known:
                continue
            known.add(which)
            low = on_clock(leg.start, found.low, pair.duration, up=False)
            if by_boxes:
                contact = contact_of(query, found, clearance)
                yield low, partial(_boxes, contact, low)
            else:
                ids = found.triangle_a, found.triangle_b
                yield low, partial(_alone, pair, ids, low, search)


def _boxes(contact: Contact, low: float) -> Contact:
    """Return a leg's contact of boxes on the whole question's clock."""
    status = Status.CONTACT if low > 0 else contact.status
    return replace(contact, status=status, time=low, time_bounds=(low, None))


def _alone(pair: PairQuestion, ids: tuple[int, int], low: float, search: Search) -> Contact | None:
    """Return the first contact of one pair that is apart before `low`, s; None where it has none.

    Raises:
        UnresolvedError: a limit was reached.
    """
    a, b = map(_triangle, pair.bodies, pair.trees, ids)
    found = search.answer(Query(a, b, pair.duration, pair.accuracy), low)
    if found.status is Status.SEPARATED:
        return None
    assert found.time_bounds is not None
    # Both lower ends are proven. The later one keeps the contacts in order of time.
    lo = max(low, found.time_bounds[0])
    parts = {field.name: getattr(found, field.name) for field in fields(Contact)}
    own = {"triangle_a": ids[0], "triangle_b": ids[1], "time": lo}
    return Contact(**{**parts, **own, "time_bounds": (lo, found.time_bounds[1])})


def _triangle(body: Body, tree: ObbTree, row: int) -> Body:
    """Return a body of one triangle of another, with the same motion."""
    mesh = Mesh(tree.triangle(row), [[0, 1, 2]])
    return Body(ObbTree.build(mesh), pose=body.pose, motion=with_pivot(body, tree))
