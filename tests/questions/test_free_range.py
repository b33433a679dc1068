"""The free interval around t = 0: closed forms, reversal, contact at 0, and limits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from obbcli import Accuracy, Body, Mesh, Motion, MotionError, Pose, first_contact, free_range
from obbcli.answers.status import Status

FACES = [
    *((0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4)),
    *((2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)),
]
CORNERS = np.array([(i, j, k) for k in (-1, 1) for j in (-1, 1) for i in (-1, 1)]) / 2
CUBE = Mesh(CORNERS, FACES)
# Two stops, 1 and 2 away from a cube between them.
STOPS = Mesh(
    np.concatenate([np.add(CORNERS, [2, 0, 0]), np.subtract(CORNERS, [3, 0, 0])]),
    [*FACES, *(np.array(FACES) + 8)],
)


def test_a_sliding_cube_is_stopped_either_way() -> None:
    found = free_range(Body(CUBE, motion=Motion([0.5, 0, 0])), STOPS, 10.0)

    assert found.free == (-4.0, 2.0)
    assert found.complete
    assert (found.before.time_bounds, found.after.time_bounds) == ((4.0, 4.0), (2.0, 2.0))
    assert found.before.triangle_b is not None
    assert found.before.triangle_b >= len(FACES)


def test_a_turning_leaf_is_stopped_either_way() -> None:
    leaf = Mesh(CORNERS * (2, 0.2, 1) + [1, 0, 0], FACES)
    stop = Body(CUBE, Pose(translation=[0, 1.6, 0.01]))
    turning = Body(leaf, motion=Motion(angular_velocity=[0, 0, 1], pivot=[0, 0, 0]))

    found = free_range(turning, stop, 6.0)

    # Its sides are 0.1 off its axis, and meet the stop's lower corners, 1.2 from the pivot.
    thickness = math.asin(0.1 / math.hypot(0.5, 1.1))
    after = math.atan2(1.1, 0.5) - thickness
    before = 2 * math.pi - math.atan2(1.1, -0.5) - thickness
    assert found.free == pytest.approx((-before, after), abs=1e-8)
    for stop_at, time in ((found.before, before), (found.after, after)):
        assert stop_at.time_bounds is not None
        low, high = stop_at.time_bounds
        assert high is not None
        assert low <= time + 1e-15
        assert time <= high + 1e-15
    back = Body(leaf, motion=Motion(angular_velocity=[0, 0, -1], pivot=[0, 0, 0]))
    assert found.before.time_bounds == first_contact(back, stop, 6.0).time_bounds


def test_contact_at_zero_has_no_range() -> None:
    found = free_range(Body(CUBE, Pose(translation=[1, 0, 0]), Motion([1, 0, 0])), CUBE)

    assert found.free is None
    assert found.complete
    assert found.before.status is found.after.status is Status.OVERLAP_AT_START


def test_solids_inside_have_no_range() -> None:
    inner = Body(Mesh(CORNERS / 4, FACES), motion=Motion([1, 0, 0]))

    assert free_range(inner, CUBE, solid=True).free is None
    assert free_range(inner, CUBE).free == (-0.375, 0.375)


def test_nothing_in_the_way_is_free_for_the_whole_duration() -> None:
    found = free_range(Body(CUBE, Pose(translation=[0, 0, 3]), Motion([1, 0, 0])), CUBE, 7.0)

    assert found.free == (-7.0, 7.0)
    assert found.before.status is found.after.status is Status.SEPARATED


def test_a_path_rests_before_its_first_pose() -> None:
    path = Motion.through([0, 2], [Pose(), Pose(translation=[2, 0, 0])])

    found = free_range(Body(CUBE, Pose(), path), STOPS, 10.0)

    assert found.free is not None
    assert found.free[0] == -10
    assert found.free[1] == pytest.approx(1, abs=1e-8)


def test_a_limit_leaves_what_is_proven() -> None:
    turning = Body(CUBE, Pose(translation=[1.3, 0.2, 0]), Motion(angular_velocity=[0.3, 2, 1]))

    found = free_range(turning, CUBE, 2.0, Accuracy(max_iterations=1))

    assert not found.complete
    assert found.free is not None
    assert found.free[0] <= 0 <= found.free[1]


@pytest.mark.parametrize("field", [{"clearance": 1}, {"method": "sampled"}, {"max_depth_a": 1}])
def test_what_proves_nothing_is_refused(field: dict[str, object]) -> None:
    with pytest.raises(MotionError) as refused:
        free_range(CUBE, CUBE, accuracy=Accuracy(**field))  # type: ignore[arg-type]
    assert refused.value.where == next(iter(field))
