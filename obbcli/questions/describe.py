"""What is to be said of a contact that the kernels found: where, with which features, how sure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli import kernels, primitives
from obbcli.answers.contact import Contact, FirstContact
from obbcli.answers.status import Status
from obbcli.answers.words import EVIDENCES, FEATURES
from obbcli.motion.body import as_body
from obbcli.questions.budget import POPS_A_SLICE
from obbcli.questions.pair_question import trees_of, with_parts

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.answers.collision import Collision
    from obbcli.answers.contact import Vector
    from obbcli.motion.body import Body, Shape
    from obbcli.questions.pair_question import Trees

_SEPARATED = Contact(status=Status.SEPARATED)


def contact_of(query: kernels.ContactQuery, found: kernels.Contact, clearance: float) -> Contact:
    """Return what a moving question found; not for triangles that meet at t = 0."""
    place = query.place(found)
    by_boxes = found.evidence is kernels.Evidence.BOXES
    # The exact test at t = 0 has found that the surfaces themselves do not touch then.
    is_at_start = found.high == 0 and (by_boxes or clearance > 0)
    return Contact(
        status=Status.OVERLAP_AT_START if is_at_start else Status.CONTACT,
        time=found.low,
        time_bounds=(found.low, None if by_boxes else found.high),
        evidence=EVIDENCES[found.evidence.value],
        point=place.point,
        point_a=place.point_a,
        point_b=place.point_b,
        normal=place.normal,
        normal_a=place.normal_a,
        normal_b=place.normal_b,
        triangle_a=None if by_boxes else found.triangle_a,
        triangle_b=None if by_boxes else found.triangle_b,
        feature=FEATURES[place.feature],
        distance=None if by_boxes else found.distance,
        approximate=by_boxes,
        error_bound=found.error_bound,
    )


def contact_at_start(
    bodies: tuple[Body, Body], trees: Trees, triangle_a: int, triangle_b: int
) -> Contact:
    """Return the contact of two triangles that meet at t = 0."""
    (a, b), (tree_a, tree_b) = bodies, trees
    # The exact test of the two triangles tells where they meet, and with which features.
    touch = primitives.first_contact(
        primitives.Triangle(a.pose.apply(tree_a.triangle(triangle_a))),
        primitives.Triangle(b.pose.apply(tree_b.triangle(triangle_b))),
    )
    assert isinstance(touch, primitives.PrimitiveContact)
    point = _vector(touch.point)
    return Contact(
        status=Status.OVERLAP_AT_START,
        time=0.0,
        time_bounds=(0.0, 0.0),
        evidence="intersecting",
        point=point,
        point_a=point,
        point_b=point,
        normal=None if touch.normal is None else _vector(touch.normal),
        normal_a=None if touch.normal_a is None else _vector(touch.normal_a),
        normal_b=None if touch.normal_b is None else _vector(touch.normal_b),
        triangle_a=triangle_a,
        triangle_b=triangle_b,
        feature=touch.feature,
        distance=0.0,
    )


def boxes_at_start(query: kernels.ContactQuery, error_bound: float, clearance: float) -> Contact:
    """Return the contact of boxes that stand for triangles and meet at t = 0.

    Args:
        query: a moving question of the same boxes, not asked yet: it may tell where some meet.
        error_bound: how far apart the surfaces can be, mesh units.
        clearance: of the question, mesh units.
    """
    # The number of pops is fixed, so that the place told does not depend on the machine's speed.
    while (left := POPS_A_SLICE - query.counts()[3]) > 0 and not query.advance(left):
        pass
    found = query.contact()
    if found is not None and found.evidence is kernels.Evidence.BOXES and found.low == 0:
        return contact_of(query, found, clearance)
    return Contact(
        status=Status.OVERLAP_AT_START,
        time=0.0,
        time_bounds=(0.0, None),
        evidence="boxes",
        feature="box",
        approximate=True,
        error_bound=error_bound,
    )


def unresolved(low: float) -> Contact:
    """Return that nothing is known beyond a proven time, s."""
    return Contact(status=Status.UNRESOLVED, time=low, time_bounds=(low, None))


def _vector(values: Iterable[float]) -> Vector:
    """Return three floats, without negative zeros."""
    x, y, z = (float(value) + 0.0 for value in values)
    return x, y, z


def answer_told(a: Body | Shape, b: Body | Shape, found: Collision) -> FirstContact:
    """Return what `Query` says of bodies that the kernels found apart, or at rest.

    Args:
        a: a body, or a tree.
        b: as `a`.
        found: what `collide` says of them.
    """
    if found.witness is None:
        is_open = found.status is Status.UNRESOLVED
        return FirstContact.of(unresolved(0.0) if is_open else _SEPARATED, found.stats)
    bodies = as_body(a), as_body(b)
    trees = trees_of(bodies)
    answer = FirstContact.of(contact_at_start(bodies, trees, *found.witness), found.stats)
    return with_parts(trees, answer, found.witness)
