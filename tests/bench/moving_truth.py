"""Hold what is said of moving meshes to what others find: sampled times, distances, the points.

A proof cannot be repeated by sampling, but it can be refuted: contact before the bracket, or
anywhere on a path called separated, must not be found by python-fcl nor by the question at rest.
Contact itself is confirmed by explicit points on both triangles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from harness import OURS
from moving_ours import TOLERANCES, YES_NO, our_bodies
from moving_peers import fcl_collides, fcl_distance
from moving_sets import DURATION
from oracles.distance import point_triangle_distance_squared
from oracles.still import root

import obbcli
from obbcli import Status

if TYPE_CHECKING:
    from meshes.surfaces import Surface
    from moving_peers import Models
    from moving_sets import Moving


SAMPLES = 64
COARSE = 32
# Before the bracket, as parts of the duration: what is nearer than 1e-6 is rounding's at a graze.
JUST_BEFORE = 10.0 ** -np.arange(1.0, 7.0)
BRACKET = 1e-9 * DURATION
# Of the size: what poses and points computed twice may differ by.
ROUNDING = 1e-11
# fcl.distance of triangles that nearly touch is no better than that, of the size.
FCL_ROUNDING = 1e-7
SUSPECTS = 3
ZOOMS = 14
GOLDEN = 0.5 * (5**0.5 - 1)


def check(question: Moving, answers: dict[str, Any], models: Models) -> float | None:
    """Assert our answers to a question; return the smallest gap seen where separated, of the size.

    Args:
        question: what was asked.
        answers: ours, by accuracy, and the yes or no.
        models: everybody's.
    """
    exact = answers[OURS]
    assert exact.status in {Status.CONTACT, Status.SEPARATED}, question
    assert answers[YES_NO].status is exact.status, question
    gap = None
    if exact.collides:
        check_contact(question, exact, models)
    else:
        gap = check_separated(question, models)
    for who, tolerance in TOLERANCES.items():
        if tolerance is not None:
            check_tolerated(question, exact, answers[who], tolerance, models)
    return gap


def check_contact(question: Moving, found: Any, models: Models) -> None:
    """Assert that nothing meets before the bracket, and that the points at its start do, nearly."""
    low, high = found.time_bounds
    assert 0 < low <= high <= DURATION, found
    assert high - low <= BRACKET or found.evidence == "within_tolerance", found
    assert found.distance <= BRACKET * question.size, found
    for body, surface, path in (
        ("a", question.a, question.path_a),
        ("b", question.b, question.path_b),
    ):
        corners = _corners(surface, getattr(found, f"triangle_{body}"), *path.at(low))
        off = root(point_triangle_distance_squared(getattr(found, f"point_{body}"), corners))
        assert off <= ROUNDING * question.size, (question, found, float(off))
    apart = float(np.linalg.norm(np.subtract(found.point_a, found.point_b)))
    slack = question.closing_speed * (high - low) + found.distance + ROUNDING * question.size
    assert apart <= slack, (question, found, apart)
    _assert_free(question, list(np.linspace(0, low, SAMPLES + 1)[:-1]), models)
    _assert_free(question, [low - dt for dt in JUST_BEFORE * DURATION if dt < low], models)


def _corners(surface: Surface, triangle: int, turn: Any, place: Any) -> Any:
    return surface.vertices[surface.faces[triangle]] @ turn.T + place


def _assert_free(question: Moving, times: Any, models: Models) -> None:
    """Assert that the surfaces do not meet at some times, by python-fcl and by ours at rest."""
    collides_at = fcl_collides(models, question)
    for t in times:
        assert not collides_at(float(t)), (question, float(t))
    for t in list(times)[-len(JUST_BEFORE) :]:
        assert not obbcli.collide(*_resting(question, float(t), models)).collides, (question, t)


def _resting(question: Moving, t: float, models: Models) -> Any:
    """Return our bodies as they are at a time, by `Motion.pose_at`."""
    bodies = our_bodies(models, question)
    return [obbcli.Body(one.shape, one.motion.pose_at(t, one.pose)) for one in bodies]


def check_separated(question: Moving, models: Models) -> float:
    """Assert that nothing meets on the whole path; return the smallest gap seen, of the size.

    Samples everywhere, and python-fcl's distance closing in where the surfaces could meet unseen.
    """
    _assert_free(question, np.linspace(0, DURATION, SAMPLES + 1), models)
    times = np.linspace(0, DURATION, COARSE + 1)
    gaps = np.array(
        [obbcli.distance(*_resting(question, float(t), models)).distance for t in times]
    )
    # No gap shrinks faster than the closing speed: so low can it get between two samples.
    between = 0.5 * (gaps[:-1] + gaps[1:] - question.closing_speed * DURATION / COARSE)
    smallest = float(gaps.min())
    for k in np.argsort(between)[:SUSPECTS]:
        if between[k] <= 0:
            smallest = min(smallest, _smallest_gap(question, times[k], times[k + 1], models))
    assert smallest > 0, question
    return smallest / question.size


def _smallest_gap(question: Moving, low: float, high: float, models: Models) -> float:
    """Return the smallest distance that a golden-section search sees, by python-fcl."""
    distance_at = fcl_distance(models, question)
    inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)]
    values = [distance_at(t) for t in inner]
    smallest = min(values)
    for _ in range(ZOOMS):
        if values[0] < values[1]:
            high, inner[1], values[1] = inner[1], inner[0], values[0]
            inner[0] = high - GOLDEN * (high - low)
            values[0] = distance_at(inner[0])
        else:
            low, inner[0], values[0] = inner[0], inner[1], values[1]
            inner[1] = low + GOLDEN * (high - low)
            values[1] = distance_at(inner[1])
        smallest = min(smallest, *values)
    return smallest


def check_tolerated(
    question: Moving, exact: Any, found: Any, tolerance: float, models: Models
) -> None:
    """Assert that an answer that may stop at a distance fits the exact one, and is as near."""
    if not found.collides:
        assert not exact.collides, (question, exact, found)
        return
    low, high = found.time_bounds
    assert 0 <= low <= high <= DURATION, found
    if exact.collides:
        assert low <= exact.time_bounds[1], (question, exact, found)
    if found.evidence == "intersecting":
        assert exact.collides, (question, exact, found)
        assert high >= exact.time_bounds[0], (question, exact, found)
        return
    assert found.distance <= tolerance * question.size, found
    gap = fcl_distance(models, question)(high)
    assert gap <= found.distance + FCL_ROUNDING * question.size, (question, found, gap)


def judge(exact: Any, answer: Any) -> tuple[str, float | None]:
    """Return what a peer's answer is beside ours: "right", "miss", "false hit" or "refused".

    And, where both say contact, how far off the bracket its time is; positive is late.
    """
    if answer.hit is None:
        return "refused", None
    if answer.hit != exact.collides:
        return ("miss" if exact.collides else "false hit"), None
    if not answer.hit:
        return "right", None
    low, high = exact.time_bounds
    return "right", max(answer.time - high, 0.0) + min(answer.time - low, 0.0)
