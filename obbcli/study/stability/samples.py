"""Moving answers against bodies at rest, posed along their motion: when do those meet?"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from obbcli.answers.status import Status
from obbcli.motion.body import Body
from obbcli.questions.collide import collide
from obbcli.questions.distance import distance
from obbcli.questions.first_contact import first_contact

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.answers.contact import Contact
    from obbcli.study.stability.world import Pair, Trees

SAMPLES = 8
# Of the time before contact: where a bracket that is slightly late is found out.
_STEPS = (1e-9, 1e-6, 1e-3)
_GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
# Of lengths and paths: what posing a body along its motion rounds.
_POSING = 2.0**-46


def fault_of_samples(pair: Pair, trees: Trees, answer: Contact) -> str:
    """Return how bodies at rest contradict an answer; empty where they do not.

    Args:
        pair: the question.
        trees: what builds trees.
        answer: to it; certified.
    """
    bodies = trees.bodies(pair)
    room = _POSING * sum(
        float(np.abs(side.vertices).max() + np.abs(side.pivot).max())
        + side.reach
        + float(np.abs(side.velocity).max()) * pair.duration
        for side in pair.sides
    )
    for time in _times(pair, answer):
        if collide(*_at(bodies, time)).status is Status.OVERLAP_AT_START:
            accuracy = replace(pair.accuracy, clearance=pair.accuracy.clearance + room)
            wider = first_contact(*bodies, pair.duration, accuracy)
            is_free = wider.status is Status.SEPARATED
            if is_free or (wider.time_bounds is not None and wider.time_bounds[0] > time):
                return f"no contact is proven at t = {time!r}, where the bodies at rest intersect"
    return _fault_at_contact(bodies, answer, room)


def _fault_at_contact(bodies: tuple[Body, Body], answer: Contact, room: float) -> str:
    """Return how far apart the bodies are at a time of proven contact; empty if they meet."""
    _, high = answer.time_bounds or (0.0, None)
    is_contact = answer.status in (Status.CONTACT, Status.OVERLAP_AT_START)
    if not is_contact or answer.approximate or high is None:
        return ""
    apart = distance(*_at(bodies, high)).bounds[0]
    if apart <= (answer.distance or 0.0) + room:
        return ""
    return f"contact is said at t = {high!r}, where the bodies at rest are {apart:.3g} apart"


def _at(bodies: tuple[Body, Body], time: float) -> tuple[Body, Body]:
    """Return bodies at rest where their motions take them."""
    a, b = (Body(body.shape, body.motion.pose_at(time, body.pose)) for body in bodies)
    return a, b


def _times(pair: Pair, answer: Contact) -> Iterator[float]:
    """Yield times that the answer proves free of contact."""
    if answer.status is Status.SEPARATED:
        low = pair.duration
        yield low
    else:
        low = 0.0 if answer.time_bounds is None else answer.time_bounds[0]
    if low > 0:
        yield float(np.nextafter(low, 0.0))
        for step in _STEPS:
            yield low * (1.0 - step)
        for number in range(1, SAMPLES):
            yield low * float(number * _GOLDEN % 1.0)
