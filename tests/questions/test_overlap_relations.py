"""Relations that no depth has to decide: apart, near, contained, the same, open surfaces."""

from __future__ import annotations

import numpy as np
import pytest
from meshes.solids import joined, shifted, turned_over
from movers.meshes import box, cube, octahedron

import obbcli
from obbcli import Accuracy, Body, Mesh, MotionError, Pose, UnresolvedError
from obbcli.answers.overlap import MEETING

UNIT = box((0, 0, 0), (1, 1, 1))
TURN = Pose(rotation=[0.3, -0.2, 0.9], translation=[0.5, 2.0, -1.0])


def overlap(a, b, **asked):
    return obbcli.overlap(Mesh(*a), Mesh(*b), **asked)


def opened(mesh):
    """Return a mesh without its last triangle."""
    return mesh[0], mesh[1][:-1]


def test_boxes_apart_are_clear_and_have_no_depth_by_proof() -> None:
    found = overlap(UNIT, shifted(UNIT, (3, 0, 0)))

    assert found.relation == "clear"
    assert found.distance.bounds[0] <= 2 <= found.distance.bounds[1]
    assert found.thickness.bounds == found.protrusion_a.bounds == (0, 0)
    assert found.protrusion_b.bounds == (0, 0)
    assert found.complete
    assert not found.overlaps


@pytest.mark.parametrize(
    ("clearance", "touch", "relation"),
    [
        (0.0, None, "clear"),
        (0.2, None, "clear"),
        (0.25, None, "near"),
        (0.3, None, "near"),
        (0.3, (0.25, 0), "touching"),
        (0.0, (0.25, 0), "touching"),
        (0.0, (0.24, 0), "clear"),
        (0.25, (0.24, 0), "near"),
    ],
)
def test_gap_is_judged_by_wanted_distance_and_band(clearance, touch, relation) -> None:
    far = shifted(UNIT, (1.25, 0, 0))

    found = overlap(UNIT, far, accuracy=Accuracy(clearance=clearance), touch=touch)

    assert found.relation == relation


def test_swapped_bodies_apart_have_the_same_bits() -> None:
    a, b = Mesh(*cube(1.0)), Body(Mesh(*octahedron()), TURN)

    found, swapped = obbcli.overlap(a, b), obbcli.overlap(b, a)

    assert found.distance.bounds == swapped.distance.bounds
    assert found.distance.point_a == swapped.distance.point_b
    assert found.distance.triangle_b == swapped.distance.triangle_a


@pytest.mark.parametrize("turn", [False, True])
def test_solid_in_a_solid_is_contained(turn) -> None:
    inner = turned_over(octahedron()) if turn else octahedron()

    found = overlap(inner, cube(3.0))
    swapped = overlap(cube(3.0), inner)

    assert (found.relation, found.contained) == ("contained", "a")
    assert (swapped.relation, swapped.contained) == ("contained", "b")
    assert found.overlaps


def test_solid_in_a_hollow_is_apart() -> None:
    hollow = joined(cube(3.0), turned_over(cube(2.0)))

    found = overlap(octahedron(), hollow)

    assert found.relation == "clear"
    assert found.distance.bounds[0] <= 1 <= found.distance.bounds[1]


def test_solid_that_fills_a_hollow_and_more_is_not_contained() -> None:
    """A surrounds the hollow: its surface is all in B's matter, and it holds B's hollow."""
    hollow = joined(cube(3.0), turned_over(cube(1.0)))

    assert overlap(cube(2.0), hollow).relation == "overlapping"
    assert overlap(cube(2.0), hollow).contained is None


def test_solid_of_which_one_part_is_inside_overlaps() -> None:
    parts = joined(octahedron(), shifted(octahedron(), (9, 0, 0)))

    found = overlap(parts, cube(3.0))

    assert (found.relation, found.contained) == ("overlapping", None)


def test_same_triangles_in_any_order_are_a_duplicate() -> None:
    vertices, faces = octahedron()
    order = np.random.default_rng(5).permutation(len(faces))
    again = vertices, np.roll(faces, 1, axis=1)[order]
    a, b = Mesh(vertices, faces), Mesh(*again)

    assert obbcli.overlap(a, b).relation == "duplicate"
    assert obbcli.overlap(Body(a, TURN), Body(b, TURN)).relation == "duplicate"


def test_open_surface_has_no_depth_and_the_edge_is_named() -> None:
    found = overlap(opened(UNIT), shifted(UNIT, (0.5, 0, 0)))

    assert found.relation == "crossing"
    assert found.thickness is found.protrusion_a is found.protrusion_b is None
    assert found.reason.startswith("A is not watertight: 3 edges do not join")
    assert found.overlaps


def test_open_surface_apart_has_its_relation() -> None:
    found = overlap(shifted(UNIT, (3, 0, 0)), opened(UNIT))

    assert found.relation == "clear"
    assert found.distance.bounds[0] <= 2 <= found.distance.bounds[1]
    assert found.thickness is None
    assert found.reason.startswith("B is not watertight")


def test_solid_inside_an_open_surface_is_apart() -> None:
    assert overlap(octahedron(), opened(cube(3.0))).relation == "clear"


def test_limit_of_one_step_leaves_the_relation_open() -> None:
    far = shifted(octahedron(), (2.0, 0.5, 0.5))

    found = overlap(octahedron(), far, accuracy=Accuracy(max_iterations=1))

    assert found.relation == "unresolved"
    assert not found.complete
    with pytest.raises(UnresolvedError, match="max_iterations"):
        assert found.overlaps


def test_motion_plays_no_part() -> None:
    moving = Body(Mesh(*shifted(UNIT, (3, 0, 0))), motion=obbcli.Motion([-1, 0, 0]))

    assert obbcli.overlap(Mesh(*UNIT), moving).relation == "clear"


@pytest.mark.parametrize(
    ("asked", "where"),
    [
        ({"tolerance": 0}, "tolerance"),
        ({"tolerance": float("nan")}, "tolerance"),
        ({"tolerance": "wide"}, "tolerance"),
        ({"tolerance": True}, "tolerance"),
        ({"deeper_than": -1.0}, "deeper_than"),
        ({"deeper_than": float("inf")}, "deeper_than"),
        ({"touch": (0.1, -0.1)}, "touch"),
        ({"touch": (0.1,)}, "touch"),
        ({"touch": (float("nan"), 0)}, "touch"),
        ({"along": (0, 0, 0)}, "along"),
        ({"along": (0, float("inf"), 0)}, "along"),
        ({"along": (1, 0)}, "along"),
        ({"accuracy": Accuracy(max_depth_a=3)}, "max_depth_a"),
        ({"accuracy": Accuracy(leaves="boxes")}, "leaves"),
        ({"accuracy": Accuracy(distance_tolerance=0.1)}, "distance_tolerance"),
    ],
)
def test_bad_input_is_one_clear_error(asked, where) -> None:
    with pytest.raises(MotionError) as caught:
        overlap(UNIT, UNIT, **asked)

    assert caught.value.where.startswith(where)
    assert caught.value.fault


def test_relations_that_meet_are_relations() -> None:
    assert {"overlapping", "contained", "duplicate", "crossing"} == set(MEETING)
