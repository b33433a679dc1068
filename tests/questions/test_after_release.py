"""First contact after release: closed forms, never released, open, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from obbcli import Accuracy, Body, Mesh, Motion, MotionError, Pose, first_contact

FACES = [
    *((0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4)),
    *((2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)),
]
CORNERS = np.array([(i, j, k) for k in (-1, 1) for j in (-1, 1) for i in (-1, 1)]) / 2
CUBE = Mesh(CORNERS, FACES)
# A cube that stands where another slides on, and the next one, 4 further and half a side higher.
ROW = Mesh(
    np.concatenate([CORNERS, np.add(CORNERS, [4, 0, 0.5])]), [*FACES, *(np.array(FACES) + 8)]
)
SLIDING = Body(CUBE, Pose(translation=[0, 0, 1]), Motion([1.25, 0, 0]))


def test_a_cube_that_slides_off_meets_the_next_one() -> None:
    found = first_contact(SLIDING, ROW, 4.0, after_release=True)

    assert found.status.value == "contact"
    assert found.released is not None
    assert found.released[0] <= 0.8 <= found.released[1] <= 0.8 + 1e-15
    assert found.time_bounds is not None
    low, high = found.time_bounds
    assert high is not None
    assert low <= 2.4 <= high + 1e-15
    assert found.triangle_b is not None
    assert found.triangle_b >= len(FACES)
    assert first_contact(SLIDING, ROW, 4.0).status.value == "overlap_at_start"


def test_released_by_a_distance_is_later() -> None:
    found = first_contact(SLIDING, CUBE, 4.0, after_release=True, released_by=0.1)

    assert found.status.value == "separated"
    assert found.released is not None
    assert found.released[0] <= 0.88 + 1e-12
    assert found.released[1] >= 0.88 - 1e-12
    assert found.released[1] - found.released[0] <= 4e-9


def test_lifted_bodies_are_released_at_once() -> None:
    lifted = Body(CUBE, Pose(translation=[0, 0, 1]), Motion([0, 0, 1]))
    back = Motion.through([0, 1, 2], [Pose(translation=[0, 0, z]) for z in (1, 2, 0.5)])

    found = first_contact(lifted, CUBE, 1.0, after_release=True)
    again = first_contact(Body(CUBE, Pose(translation=[0, 0, 1]), back), CUBE, after_release=True)

    assert (found.status.value, found.released) == ("separated", (0.0, 0.0))
    assert again.status.value == "contact"
    assert again.time == pytest.approx(1 + 2 / 3, abs=1e-8)
    assert again.released is not None
    assert 0 <= again.released[0] <= again.released[1] <= 1e-8


def test_turning_bodies_are_released_and_meet_again() -> None:
    rod = Mesh(CORNERS * (4, 0.2, 0.2), FACES)
    stop = Body(CUBE, Pose(translation=[1.5, 0.3, 0.01]))
    turning = Body(rod, motion=Motion(angular_velocity=[0, 0, 1], pivot=[0, 0, 0]))

    found = first_contact(turning, stop, 6.0, after_release=True)

    # Each end of the rod comes by: what leaves at t is as what leaves half a turn later.
    assert found.status.value == "contact"
    assert found.released is not None
    assert found.time is not None
    assert 0 < found.released[0] < found.released[1] < found.time
    later = Body(rod, Pose([0, 0, np.pi]), Motion(angular_velocity=[0, 0, 1], pivot=[0, 0, 0]))
    other = first_contact(later, stop, 6.0, after_release=True)
    assert other.released == pytest.approx(found.released, abs=1e-8)
    assert other.time == pytest.approx(found.time, abs=1e-8)


def test_bodies_apart_at_the_start_are_released_at_zero() -> None:
    coming = Body(CUBE, Pose(translation=[3, 0, 0]), Motion([-1, 0, 0]))

    found = first_contact(coming, CUBE, 5.0, after_release=True)

    assert found.released == (0.0, 0.0)
    assert found.time_bounds == first_contact(coming, CUBE, 5.0).time_bounds == (2.0, 2.0)


@pytest.mark.parametrize("duration", [0.0, 0.5])
def test_never_released_is_overlap_at_start(duration: float) -> None:
    found = first_contact(SLIDING, CUBE, duration, after_release=True)

    assert found.status.value == "overlap_at_start"
    assert found.released is None


def test_near_bodies_that_are_never_released_are_so_too() -> None:
    near = Body(CUBE, Pose(translation=[0, 0, 1.01]), Motion([0.1, 0, 0]))

    found = first_contact(near, CUBE, 1.0, after_release=True, released_by=0.5)

    assert (found.status.value, found.released) == ("overlap_at_start", None)


def test_what_is_not_known_is_unresolved() -> None:
    flush = Body(CUBE, Pose(translation=[0, 0, 1]), Motion([1.25, 0, 0], [0, 0, 1]))

    found = first_contact(flush, CUBE, 2.0, after_release=True)
    limited = first_contact(SLIDING, ROW, 4.0, Accuracy(max_iterations=1), after_release=True)

    assert (found.status.value, found.released) == ("unresolved", None)
    assert (limited.status.value, limited.released) == ("unresolved", None)


def test_solids_are_released_when_they_are_outside() -> None:
    inner = Body(Mesh(CORNERS / 4, FACES), motion=Motion([1, 0, 0]))

    assert first_contact(inner, CUBE, 1.0, after_release=True).released == (0.0, 0.0)
    found = first_contact(inner, CUBE, 1.0, solid=True, after_release=True)
    assert found.status.value == "separated"
    assert found.released is not None
    assert found.released[0] <= 0.625 <= found.released[1]


def test_what_does_not_go_together_is_refused() -> None:
    with pytest.raises(MotionError, match="after_release"):
        first_contact(CUBE, CUBE, released_by=1.0)
    with pytest.raises(MotionError, match="released_by"):
        first_contact(CUBE, CUBE, after_release=True, released_by=-1.0)
    with pytest.raises(MotionError, match="clearance"):
        first_contact(CUBE, CUBE, accuracy=Accuracy(clearance=1), after_release=True)
