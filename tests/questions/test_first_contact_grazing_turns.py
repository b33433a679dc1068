"""Grazes of turning bodies: brackets hold the first time within the clearance, in closed form."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from claims.brackets import assert_holds
from movers.meshes import box, cube

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, Pose

X, Y, Z = np.eye(3)
BLOCK = Mesh(*box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)))
# The quarters of a plate whose top is z = 0, cut through its middle.
PLATE = Mesh(
    [[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0], [0, 0, 0]],
    [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
)
# A crank about z whose corner goes round at a distance of exactly 5, past a wall.
CRANK = Mesh(*box((-3.0, -4.0, -1.0), (3.0, 4.0, 1.0)))
TURNS = 0.5


def wall_at(x: float) -> Mesh:
    return Mesh(*box((x, -9.0, -4.0), (x + 1.0, 10.0, 5.0)))


@pytest.mark.parametrize("clearance", [0.0, 0.25, 2.0])
@pytest.mark.parametrize("tolerance", [1e-3, None, 1e-14])
def test_edge_that_turns_past_a_wall_grazes_it_in_the_bracket(
    clearance: float, tolerance: float | None
) -> None:
    turning = Body(CRANK, motion=Motion(None, TURNS * Z, [0, 0, 0]))
    accuracy = Accuracy(clearance=clearance, time_tolerance=tolerance)

    answer = obbcli.first_contact(turning, wall_at(5.0 + clearance), 3.0, accuracy)

    # Edges at (3, -4) and (3, 4) come to the angle 0, the first after atan(4 / 3).
    low, high = assert_holds(answer, mpmath.atan(mpmath.mpf(4) / 3) / TURNS)
    assert high - low <= max(1e-5, 1.01 * (tolerance or 0))


@pytest.mark.parametrize("clearance", [0.0, 0.25])
def test_vertex_that_spins_past_a_vertex_grazes_it_in_the_bracket(clearance: float) -> None:
    tip = Mesh([[3.0, 4.0, 0.0], [0, 0, 1], [0, 0, -1]], [[0, 1, 2]])
    needle = Mesh([[5.0 + clearance, 0.0, 0.0], [9, 0, 1], [9, 0, -1]], [[0, 1, 2]])
    spinning = Body(tip, motion=Motion(None, -TURNS * Z, [0, 0, 0]))

    answer = obbcli.first_contact(spinning, needle, 3.0, Accuracy(clearance=clearance))

    low, high = assert_holds(answer, mpmath.atan(mpmath.mpf(4) / 3) / TURNS)
    assert high - low <= 1e-5


@pytest.mark.parametrize("clearance", [0.25, 1.0])
def test_face_that_spins_in_its_plane_is_near_from_a_time_in_the_bracket_on(
    clearance: float,
) -> None:
    # About its vertical axis the block has corners at sqrt(2), one of them at the angle of the way.
    block = Mesh(*cube())
    spin = 0.125
    sliding = Body(block, Pose(None, [-8.0, 0.0, 1.0 + clearance]), Motion(X, spin * Z))

    answer = obbcli.first_contact(sliding, PLATE, 16.0, Accuracy(clearance=clearance))

    def ahead(time: mpmath.mpf) -> mpmath.mpf:
        angles = (spin * time + mpmath.pi * (2 * k + 1) / 4 for k in range(4))
        return -4 + time + mpmath.sqrt(2) * max(map(mpmath.cos, angles))

    with mpmath.workdps(40):
        truth = mpmath.findroot(ahead, (2.5, 3.0), solver="illinois")
    assert_holds(answer, truth)
    assert answer.evidence == "within_tolerance"


@pytest.mark.parametrize("tolerance", [0.5, 1e-3, 1e-9])
@pytest.mark.parametrize("spin", [0.0, 0.5])
def test_search_that_may_stop_near_holds_the_time_of_contact(spin: float, tolerance: float) -> None:
    falling = Body(BLOCK, Pose(None, [0.25, 0.5, 4.0]), Motion(-Z, spin * Z))

    answer = obbcli.first_contact(falling, BLOCK, 8.0, Accuracy(distance_tolerance=tolerance))

    assert_holds(answer, mpmath.mpf(3))
    assert answer.distance is not None
    assert answer.distance <= tolerance
