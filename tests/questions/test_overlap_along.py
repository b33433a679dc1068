"""How far A has to go in a direction to be free for good, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from meshes.solids import joined, shifted
from movers.meshes import box, octahedron

import obbcli
from obbcli import Accuracy, Body, Mesh, Pose

SLAB = box((0, 0, 0), (100, 100, 10))


def along(a, b, direction, **asked):
    return obbcli.overlap(a, b, along=direction, **asked).separation_along


def assert_is(found, truth: float) -> None:
    low, high = found.bounds
    assert low - found.error_bound <= truth <= high + found.error_bound
    assert high - low <= 1e-9 * max(truth, 1.0)
    assert found.error_bound <= 1e-10


@pytest.mark.parametrize("turn", [None, [0.3, -0.2, 0.9]])
@pytest.mark.parametrize(
    ("direction", "truth"),
    [((0, 0, 1), 0.1), ((0, 0, -1), 19.9), ((5, 0, 0), 100.0), ((0, -3, 4), 0.125)],
)
def test_slab_sunk_by_a_tenth_in_another(direction, truth, turn) -> None:
    a = Mesh(*shifted(SLAB, (0, 0, 9.9)))
    pose = Pose(rotation=turn)

    found = along(Body(a, pose), Body(Mesh(*SLAB), pose), pose.rotation @ direction)

    assert_is(found, truth)


def test_body_that_leaves_a_frame_is_stopped_by_its_far_side() -> None:
    """A lies between two walls: it is free now, and meets the second wall on its way."""
    frame = Mesh(*joined(box((-2, -2, -2), (-1, 2, 2)), box((3, -2, -2), (4, 2, 2))))

    found = along(Mesh(*octahedron()), frame, (1, 0, 0))

    assert_is(found, 5.0)


def test_body_that_is_past_the_other_needs_no_way() -> None:
    a, b = Mesh(*shifted(octahedron(), (5, 0, 0))), Mesh(*octahedron())

    assert along(a, b, (1, 0, 0)).bounds == (0, 0)
    assert_is(along(a, b, (-1, 0, 0)), 7.0)


def test_body_that_passes_by_needs_no_way() -> None:
    a = Mesh(*shifted(octahedron(), (0, 9, 0)))

    assert along(a, Mesh(*octahedron()), (1, 0, 0)).bounds == (0, 0)


def test_open_surfaces_have_a_way_out_too() -> None:
    vertices, faces = box((0, 0, 0), (1, 1, 1))
    a, b = Mesh(vertices, faces[:-1]), Mesh(*shifted((vertices, faces), (0.25, 0, 0)))

    assert_is(along(a, b, (1, 0, 0)), 1.25)


def test_limit_leaves_the_way_open() -> None:
    ball = octahedron()

    found = obbcli.overlap(
        Mesh(*ball),
        Mesh(*shifted(ball, (0.5, 0.1, 0))),
        Accuracy(max_iterations=1),
        along=(1, 0, 0),
    )

    assert found.separation_along.bounds == (0, None)
    assert not found.complete


def test_direction_of_any_length_is_made_unit() -> None:
    a, b = Mesh(*octahedron()), Mesh(*shifted(octahedron(), (0.5, 0, 0)))

    small, large = (along(a, b, np.array([3, 0, 4]) * s) for s in (2.0**-1000, 2.0**1000))

    assert small == large
    assert small.direction == (0.6, 0.0, 0.8)
