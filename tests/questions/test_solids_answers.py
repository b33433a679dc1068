"""What questions about solids answer, and how they end."""

from __future__ import annotations

import math

import numpy as np
import pytest
from meshes.solids import shifted
from meshes.surfaces import sphere, torus
from movers.meshes import cube

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, Pose, Status

INNER, OUTER = Mesh(*cube(1.0)), Mesh(*cube(2.0))


def test_answer_of_a_body_inside_has_a_point_and_no_triangles():
    found = obbcli.first_contact(INNER, OUTER, solid=True)

    assert found.time == 0.0
    assert found.time_bounds == (0.0, 0.0)
    assert found.point is not None
    assert np.abs(found.point).tolist() == [1.0, 1.0, 1.0]
    absent = ("evidence", "point_a", "point_b", "normal", "normal_a", "normal_b", "triangle_a",
              "triangle_b", "feature", "distance")  # fmt: skip
    assert {getattr(found, name) for name in absent} == {None}
    assert found.error_bound == 0.0
    assert not found.approximate


def test_moving_body_that_starts_inside_is_in_contact_at_once():
    moving = Body(INNER, motion=Motion((1, 0, 0)))

    assert obbcli.first_contact(moving, OUTER, 3.0).time == 1.0
    assert obbcli.first_contact(moving, OUTER, 3.0, solid=True).time == 0.0
    assert obbcli.collide(moving, OUTER, 0.5, solid=True).contained == "a"


@pytest.mark.parametrize("spin", [(0, 0, 0), (0.1, 0.2, 0.3)])
def test_body_that_gets_inside_later_touches_first(spin):
    moving = Body(INNER, Pose(translation=(-6, 0.25, 0.125)), Motion((4, 0, 0), spin))

    found = obbcli.first_contact(moving, OUTER, 2.0, solid=True)

    assert found.status is Status.CONTACT
    assert found.contained is None
    assert found.time == obbcli.first_contact(moving, OUTER, 2.0).time


def test_nearness_comes_after_containment():
    near = Accuracy(clearance=0.5)

    assert obbcli.first_contact(INNER, OUTER, accuracy=near, solid=True).contained == "a"
    apart = Mesh(*shifted(cube(), (2.25, 0, 0)))
    assert obbcli.first_contact(INNER, apart, accuracy=near, solid=True).contained is None
    assert obbcli.collide(INNER, apart, accuracy=near, solid=True).collides


def test_boxes_that_stand_for_triangles_answer_where_they_meet():
    found = obbcli.collide(
        INNER, OUTER, accuracy=Accuracy(max_depth_a=0, max_depth_b=0), solid=True
    )

    assert found.approximate
    assert found.contained is None


def test_boxes_that_are_apart_leave_containment_exact():
    ring, small = torus(2000, 0.3), sphere(320, 0.05)
    coarse = Accuracy(max_depth_a=0, max_depth_b=7)
    body = Body(Mesh(small.vertices, small.faces), Pose(translation=(1, 0, 0)))

    found = obbcli.first_contact(body, Mesh(ring.vertices, ring.faces), None, coarse, solid=True)

    assert not found.approximate
    assert found.contained == "a"


def test_path_is_asked_about_from_its_first_pose():
    path = Motion.through([0.5, 1], [Pose(translation=(9, 0, 0)), Pose(translation=(20, 0, 0))])
    inside = Mesh(*shifted(cube(), (9, 0, 0)))

    found = obbcli.first_contact(Body(OUTER, motion=path), inside, 1.0, solid=True)
    apart = obbcli.first_contact(Body(OUTER, motion=path), INNER, 1.0, solid=True)

    assert found.contained == "b"
    assert found.time_bounds == (0.0, 0.0)
    assert apart.status is Status.SEPARATED


def test_path_that_gets_inside_touches_first():
    path = Motion.through([0, 1], [Pose(translation=(9, 0, 0)), Pose()])

    found = obbcli.first_contact(Body(INNER, motion=path), OUTER, solid=True)

    assert found.status is Status.CONTACT
    assert found.contained is None
    assert found.time is not None
    assert math.isclose(found.time, 6 / 9)


def test_query_advanced_step_by_step_comes_to_the_same_answer():
    ring, small = torus(2000, 0.3), sphere(320, 0.1)
    ball = Body(Mesh(small.vertices, small.faces), Pose(translation=(1, 0, 0)))
    query = obbcli.Query(ball, Mesh(ring.vertices, ring.faces), solid=True)

    first = query.advance(max_iterations=1)
    while not query.is_finished:
        last = query.advance(max_iterations=1)

    assert first.status is Status.UNRESOLVED
    assert first.time_bounds == (0.0, None)
    assert last.contained == "a"
    assert last.point == query.advance().point


def test_limit_leaves_containment_unresolved():
    ring, small = torus(2000, 0.3), sphere(320, 0.1)
    ball = Body(Mesh(small.vertices, small.faces), Pose(translation=(1, 0, 0)))
    mesh = Mesh(ring.vertices, ring.faces)

    found = obbcli.collide(ball, mesh, accuracy=Accuracy(max_iterations=5), solid=True)

    assert found.status is Status.UNRESOLVED
    assert found.contained is None


def test_stats_count_the_rays():
    surfaces = obbcli.collide(INNER, OUTER).stats
    solids = obbcli.collide(INNER, OUTER, solid=True).stats

    assert solids.box_tests > surfaces.box_tests
    assert solids.triangle_tests > surfaces.triangle_tests
    assert solids.pops > surfaces.pops
