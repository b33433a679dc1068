"""Poses that are not quite rigid: what they are off counts against what is proven."""

from __future__ import annotations

import numpy as np
from movers.meshes import box, cube

import obbcli
from obbcli import Body, Mesh, Motion, Pose, Status

# Above it a floor with its top at z = 0.
FLOOR = Mesh(*box((-8.0, -9.0, -1.0), (8.0, 10.0, 0.0)))
CUBE = Mesh(*cube())


def test_poses_that_are_not_quite_rigid_cost_their_defect():
    crooked = np.eye(3) + 4e-10 * np.eye(3)[::-1]
    answers = []
    for gap in (1e-11, 1e-7):
        poses = [
            Pose(None, (0, 0, 1 + gap)),
            Pose(crooked, (1, 0, 1 + gap + 4e-10)),
            Pose(None, (2, 0, 1 + gap)),
        ]
        answers.append(
            obbcli.first_contact(Body(CUBE, motion=Motion.through([0, 1, 2], poses)), FLOOR)
        )

    assert answers[0].status is Status.CONTACT
    assert answers[0].evidence == "within_tolerance"
    assert answers[0].distance is not None
    assert 1e-11 <= answers[0].distance <= 1e-8
    assert answers[1].status is Status.SEPARATED


def test_sheet_that_only_jumps_over_a_point_is_near_it():
    # No turn makes a mesh longer: its far side is at 1 in the first pose, and 2e-10 further then.
    longer = Pose(np.diag([1 + 2e-10, 1.0, 1.0]))
    wall = Mesh([[1, -1, -1], [1, 1, -1], [1, 0, 2]], [[0, 1, 2]])
    grows = Body(wall, motion=Motion.through([0, 1], [Pose(), longer]))
    dust = Mesh([[1 + 1e-10, 0, 0]] * 3, [[0, 1, 2]])

    assert not grows.motion.is_at_rest
    answer = obbcli.first_contact(grows, dust)

    # Near all the time, it passes the point where its last pose begins.
    assert answer.status is Status.CONTACT
    assert answer.evidence == "within_tolerance"
    assert answer.time_bounds == (0.0, 1.0)
