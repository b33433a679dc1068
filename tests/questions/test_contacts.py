"""`obbcli.contacts`: each pair's own first contact, in order of time, against pairs asked alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from movers.answers import as_body
from movers.flyby import flyby
from movers.meshes import cube

import obbcli
from obbcli import Accuracy, Body, Contact, Mesh, Motion, Status, UnresolvedError


def alone(body: Body, row: int) -> Body:
    """Return one triangle of a body in the same motion."""
    mesh: Any = body.shape
    return Body(Mesh(mesh.vertices[mesh.triangles[row]], [[0, 1, 2]]), body.pose, body.motion)


@pytest.mark.parametrize("turning", [False, True], ids=["going", "turning"])
@pytest.mark.parametrize("seed", range(12))
def test_every_pair_has_the_contact_it_has_alone(seed: int, turning: bool) -> None:
    a, b = (as_body(mover) for mover in flyby(seed, turning=turning))
    found = {(c.triangle_a, c.triangle_b): c for c in obbcli.contacts(a, b)}
    for i in range(len(a.shape.triangles)):
        for j in range(len(b.shape.triangles)):
            answer = obbcli.first_contact(alone(a, i), alone(b, j), 1.0)
            assert ((i, j) in found) == (answer.status is not Status.SEPARATED)
            if (i, j) in found:
                low, high = found[i, j].time_bounds
                assert low <= answer.time_bounds[1]
                assert answer.time_bounds[0] <= high
                assert high - low <= 1.0000001e-9


@pytest.mark.parametrize("turning", [False, True], ids=["going", "turning"])
def test_contacts_come_in_order_of_time_and_the_first_is_first_contact(turning: bool) -> None:
    a, b = (as_body(mover) for mover in flyby(1, turning=turning))
    times = [c.time for c in obbcli.contacts(a, b)]
    assert times == sorted(times)
    first = obbcli.first_contact(a, b)
    assert first.time_bounds[0] <= next(obbcli.contacts(a, b)).time_bounds[1]
    assert times[0] <= first.time_bounds[1]
    assert [c.time for c in obbcli.contacts(a, b, limit=3)] == times[:3]


def test_pairs_at_start_are_triangle_pairs() -> None:
    a, b = Mesh(*cube()), Body(Mesh(*cube()), obbcli.Pose(translation=(0.5, 0.25, 0.125)))
    found = list(obbcli.contacts(a, b))
    assert [(c.triangle_a, c.triangle_b) for c in found] == [
        tuple(pair) for pair in obbcli.triangle_pairs(a, b).tolist()
    ]
    assert all(c.status is Status.OVERLAP_AT_START and c.time == 0 for c in found)


def test_a_limit_names_what_is_known() -> None:
    a, b = (as_body(mover) for mover in flyby(1, turning=True))
    known: list[Contact] = []
    with pytest.raises(UnresolvedError, match="all contacts before t = "):
        known.extend(obbcli.contacts(a, b, accuracy=Accuracy(max_iterations=20)))


@pytest.mark.parametrize("limit", [0, -1, 1.5, True, "2"])
def test_senseless_limits_are_refused_at_once(limit: Any) -> None:
    with pytest.raises(obbcli.MotionError, match="limit"):
        obbcli.contacts(Mesh(*cube()), Mesh(*cube()), limit=limit)


@pytest.mark.parametrize("seed", range(4))
def test_paths_have_the_contacts_of_the_motion_they_follow(seed: int) -> None:
    a, b = (as_body(mover) for mover in flyby(seed, turning=True))
    times = [0.0, 0.3, 0.55, 1.0]
    pivot = a.pose.apply(np.mean(a.shape.vertices, axis=0)[None])[0]
    motion = Motion(a.motion.linear_velocity, a.motion.angular_velocity, pivot)
    path = Motion.through(times, [motion.pose_at(t, a.pose, pivot) for t in times])
    along = {
        (c.triangle_a, c.triangle_b): c.time
        for c in obbcli.contacts(Body(a.shape, a.pose, path), b)
    }
    straight = {
        (c.triangle_a, c.triangle_b): c.time
        for c in obbcli.contacts(Body(a.shape, a.pose, motion), b)
    }
    assert along.keys() == straight.keys()
    for pair, time in along.items():
        assert time == pytest.approx(straight[pair], abs=2e-9)


def split(body: Body, pieces: int) -> Body:
    """Return a body that turns about its own origin as the path through poses on its way."""
    start = body.pose.translation
    times = np.linspace(0, 1, pieces + 1)
    motion = Motion(body.motion.linear_velocity, body.motion.angular_velocity, start)
    path = Motion.through(times, [motion.pose_at(t, body.pose, start) for t in times])
    return Body(body.shape, body.pose, path)


@pytest.mark.parametrize("follows", [False, True], ids=["constant", "path"])
def test_nothing_before_the_time_of_a_limit_is_lost(follows: bool) -> None:
    a, b = (as_body(mover) for mover in flyby(2, turning=True))
    a = split(a, 5) if follows else a
    every = list(obbcli.contacts(a, b))
    assert len(every) > 20
    told = set()
    for pops in range(15, 1890 if follows else 640, 25):
        known: list[Contact] = []
        with pytest.raises(UnresolvedError) as limit:
            known.extend(obbcli.contacts(a, b, accuracy=Accuracy(max_iterations=pops)))
        before = [c for c in every if c.time < limit.value.time]
        assert known[: len(before)] == before
        assert known == every[: len(known)]
        told.add(len(known))
    assert len(told) > 5
