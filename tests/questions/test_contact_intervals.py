"""Pieces of a motion: closed forms, exact tests inside each piece, reversal, swap, and legs."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from obbcli import (
    Accuracy,
    Body,
    ContactPiece,
    Mesh,
    MeshError,
    Motion,
    MotionError,
    ObbTree,
    Pose,
    UnresolvedError,
    contact_intervals,
    distance,
    triangle_pairs,
)
from obbcli.motion.body import pose_at

FACES = [
    *((0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4)),
    *((2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)),
]


def box(x: float, y: float, z: float) -> ObbTree:
    """Return a box of these sides about the origin."""
    corners = [(i, j, k) for k in (-1, 1) for j in (-1, 1) for i in (-1, 1)]
    return ObbTree.build(Mesh(np.array(corners) * (x / 2, y / 2, z / 2), FACES))


CUBE = box(1, 1, 1)
ROD = box(4, 0.2, 0.2)


def brackets(pieces: list[ContactPiece]) -> list[tuple[str, float, float]]:
    return [(one.kind, one.start[0], one.end[1]) for one in pieces]


def require_cover(pieces: list[ContactPiece], duration: float, width: float) -> None:
    """Require that pieces follow each other from 0 to the duration, in narrow brackets."""
    assert pieces[0].start[0] == 0
    assert pieces[-1].end[1] == duration
    for one, other in pairwise(pieces):
        if "touch" in (one.kind, other.kind):
            # The bracket of a touch holds its neighbours' ends.
            assert one.end[0] >= other.start[0] or one.end[1] >= other.start[1]
        else:
            assert one.end == other.start
    for one in pieces:
        assert 0 <= one.start[1] - one.start[0] <= width
        assert 0 <= one.end[1] - one.end[0] <= width


def placed(body: Body, time: float) -> Body:
    return Body(body.shape, pose_at(body, time, body.shape))


def require_true(pieces: list[ContactPiece], a: Body, b: Body) -> None:
    """Hold exact tests of posed bodies against pieces, also close to their ends."""
    seen = 0
    for one in pieces:
        low, high = one.start[1], one.end[0]
        if one.kind not in ("contact", "free") or high - low < 1e-6:
            continue
        for share in (1e-6, 1e-3, 0.1, 0.37, 0.5, 0.83, 0.999, 1 - 1e-6):
            time = low + share * (high - low)
            met = len(triangle_pairs(placed(a, time), placed(b, time), limit=1)) > 0
            assert met == (one.kind == "contact"), (one, time)
            seen += 1
    assert seen > 0


def test_falling_box_meets_and_leaves_a_rod_exactly() -> None:
    falling = Body(CUBE, Pose(translation=[0, 0, 2]), Motion([0, 0, -1]))

    pieces = list(contact_intervals(falling, ROD, 4.0))

    assert [one.kind for one in pieces] == ["free", "contact", "free"]
    # The surfaces are the cube's shell and the rod's: the rod is longer than the cube.
    assert pieces[0].end[0] <= 1.4 <= pieces[0].end[1]
    assert pieces[1].end[0] <= 2.6 <= pieces[1].end[1]
    require_cover(pieces, 4.0, 1e-15)
    require_true(pieces, falling, Body(ROD))


def test_flush_faces_slide_in_contact_exactly() -> None:
    sliding = Body(CUBE, Pose(translation=[0, 0, 1]), Motion([1.25, 0, 0]))

    pieces = list(contact_intervals(sliding, CUBE, 2.0))

    assert [one.kind for one in pieces] == ["contact", "free"]
    assert pieces[0].start == (0, 0)
    assert pieces[0].end[0] <= 0.8 <= pieces[0].end[1]


def test_edges_that_pass_touch_at_one_instant() -> None:
    passing = Body(CUBE, Pose(translation=[-1, 3, 0.25]), Motion([1, -1, 0]))

    pieces = list(contact_intervals(passing, CUBE, 4.0))

    assert [one.kind for one in pieces] == ["free", "touch", "free"]
    assert pieces[1].start == pieces[1].end
    assert pieces[1].start[0] <= 2 <= pieces[1].start[1] <= 2 + 1e-15
    require_cover(pieces, 4.0, 1e-15)


def hinge() -> tuple[Body, Body]:
    """Return a rod that turns about its middle, and a cube in its way.

    The rod's side meets the cube's edge, or its corner the cube's side: both in closed form.
    """
    turning = Body(ROD, motion=Motion(angular_velocity=[0, 0, 1], pivot=[0, 0, 0]))
    return turning, Body(CUBE, Pose(translation=[1.0, 1.5, 0.05]))


def test_turning_rod_enters_and_leaves_where_geometry_says() -> None:
    rod, cube = hinge()

    pieces = list(contact_intervals(rod, cube, 3.0))

    assert [one.kind for one in pieces] == ["free", "contact", "free"]
    # The upper side of the rod is 0.1 off its axis and comes to the corner (1.5, 1); the lower side
    # leaves the corner (0.5, 2), unless the rod's end is short of it, as it is not: |.| = 2.06 > 2.
    enters = math.atan2(1, 1.5) - math.asin(0.1 / math.hypot(1, 1.5))
    assert pieces[0].end[0] <= enters <= pieces[0].end[1]
    # The end of the rod leaves the left side, x = 0.5: its trailing corner is at (2, -0.1).
    leaves = math.acos(0.5 / math.hypot(2, 0.1)) + math.atan2(0.1, 2)
    assert pieces[1].end[0] <= leaves <= pieces[1].end[1]
    require_cover(pieces, 3.0, 3e-9)
    require_true(pieces, rod, cube)


def test_swapped_bodies_have_the_same_pieces() -> None:
    rod, cube = hinge()

    there = brackets(list(contact_intervals(rod, cube, 3.0)))
    back = brackets(list(contact_intervals(cube, rod, 3.0)))

    assert [one[0] for one in there] == [one[0] for one in back]
    assert np.allclose([one[1:] for one in there], [one[1:] for one in back], rtol=0, atol=6e-9)


def test_reversed_motion_has_the_pieces_reversed() -> None:
    rod, cube = hinge()
    end = placed(rod, 3.0)
    back = Body(ROD, end.pose, Motion(angular_velocity=[0, 0, -1], pivot=[0, 0, 0]))

    there = brackets(list(contact_intervals(rod, cube, 3.0)))
    reverse = [
        (kind, 3 - high, 3 - low)
        for kind, low, high in brackets(list(contact_intervals(back, cube, 3.0)))
    ]

    assert [one[0] for one in there] == [one[0] for one in reverse[::-1]]
    assert np.allclose([one[1:] for one in there], [one[1:] for one in reverse[::-1]], atol=1e-8)


def test_legs_cut_in_two_have_the_same_pieces() -> None:
    rod, cube = hinge()
    times = [0, 0.4, 1.0, 1.1, 2.0, 3.0]
    poses = [pose_at(rod, time, ROD) for time in times]
    path = Body(ROD, poses[0], Motion.through(times, poses))

    whole = brackets(list(contact_intervals(rod, cube, 3.0)))
    cut = brackets(list(contact_intervals(path, cube, 3.0)))

    assert [one[0] for one in whole] == [one[0] for one in cut]
    assert np.allclose([one[1:] for one in whole], [one[1:] for one in cut], rtol=0, atol=1e-8)


@pytest.mark.parametrize("seed", range(6))
def test_random_motions_agree_with_exact_tests_at_many_times(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a = Body(
        CUBE,
        Pose(rng.normal(size=3), [-2, 0, 0]),
        Motion([2, 0, 0], rng.normal(size=3), [-2, 0, 0]),
    )
    b = Body(ROD, Pose(rng.normal(size=3)), Motion(None, 2 * rng.normal(size=3), [0, 0, 0]))

    pieces = list(contact_intervals(a, b, 2.0))

    require_cover([one for one in pieces if one.kind != "undecided"][:1], pieces[0].end[1], 2.0)
    assert sum(one.end[1] - one.start[0] for one in pieces if one.kind == "undecided") < 1e-6
    require_true(pieces, a, b)


def test_within_a_distance_flush_faces_that_turn_are_decided() -> None:
    sliding = Body(CUBE, Pose(translation=[0, 0, 1]), Motion([1.25, 0, 0], [0, 0, 1]))

    bare = list(contact_intervals(sliding, CUBE, 2.0))
    near = list(contact_intervals(sliding, CUBE, 2.0, within=0.05))

    assert {one.kind for one in bare} >= {"undecided", "free"}
    assert [one.kind for one in near] == ["contact", "free"]
    for share in (0.1, 0.5, 0.999):
        time = share * near[0].end[0]
        assert distance(placed(sliding, time), CUBE).bounds[0] <= 0.05
        later = near[1].start[1] + share * (2 - near[1].start[1])
        assert distance(placed(sliding, later), CUBE).bounds[1] > 0.05


@pytest.mark.parametrize("spin", [None, [0.3, 0.2, 0.1]])
def test_solids_inside_each_other_are_in_contact(spin: list[float] | None) -> None:
    small = Body(box(0.2, 0.2, 0.2), Pose(translation=[-2, 0.01, 0.02]), Motion([1, 0, 0], spin))

    surfaces = [one.kind for one in contact_intervals(small, CUBE, 4.0)]
    solids = list(contact_intervals(small, CUBE, 4.0, solid=True))

    assert surfaces == ["free", "contact", "free", "contact", "free"]
    assert solids[0].kind == solids[-1].kind == "free"
    assert {one.kind for one in solids[1:-1]} <= {"contact", "undecided"}
    assert sum(o.end[1] - o.start[0] for o in solids if o.kind == "undecided") <= 2 * 4e-9


def test_bodies_at_rest_have_one_piece() -> None:
    apart = Body(CUBE, Pose(translation=[0, 0, 3]))

    assert brackets(list(contact_intervals(apart, CUBE, 1.0))) == [("free", 0, 1)]
    assert brackets(list(contact_intervals(CUBE, CUBE, 1.0))) == [("contact", 0, 1)]
    assert brackets(list(contact_intervals(CUBE, CUBE))) == [("touch", 0, 0)]


def test_a_limit_yields_what_is_known_and_says_so() -> None:
    rod, cube = hinge()
    found = contact_intervals(rod, cube, 3.0, Accuracy(max_iterations=1))

    with pytest.raises(UnresolvedError, match="limit"):
        list(found)
    assert len(list(contact_intervals(rod, cube, 3.0, limit=2))) == 2


@pytest.mark.parametrize(
    ("accuracy", "where"),
    [
        (Accuracy(clearance=1), "clearance"),
        (Accuracy(method="sampled"), "method"),
        (Accuracy(leaves="boxes"), "leaves"),
        (Accuracy(max_depth_b=2), "max_depth_b"),
    ],
)
def test_what_proves_nothing_is_refused(accuracy: Accuracy, where: str) -> None:
    with pytest.raises(MotionError) as refused:
        contact_intervals(*hinge(), 1.0, accuracy)
    assert refused.value.where == where


def test_open_meshes_are_no_solids_and_lengths_are_lengths() -> None:
    sheet = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(MeshError, match="watertight"):
        contact_intervals(sheet, CUBE, solid=True)
    for within in (-1, math.nan, math.inf, "1"):
        with pytest.raises(MotionError, match="within"):
            contact_intervals(CUBE, CUBE, within=within)  # type: ignore[arg-type]


def test_time_tolerance_of_nothing_ends() -> None:
    rod, cube = hinge()

    pieces = list(contact_intervals(rod, cube, 3.0, Accuracy(time_tolerance=0)))

    assert [one.kind for one in pieces if one.kind != "undecided"] == ["free", "contact", "free"]


@pytest.mark.parametrize("power", [-500, 0, 500])
def test_bodies_of_any_size_have_the_same_pieces(power: int) -> None:
    size = 2.0**power
    cube = Mesh(CUBE.mesh.vertices * size, FACES)
    coming = Body(cube, Pose(translation=[2 * size, 0, 0]), Motion([-size, 0, 0], [0.1, 0.2, 0.3]))
    same = Body(CUBE, Pose(translation=[2, 0, 0]), Motion([-1, 0, 0], [0.1, 0.2, 0.3]))

    pieces = brackets(list(contact_intervals(coming, cube, 3.0)))

    assert pieces == brackets(list(contact_intervals(same, CUBE, 3.0)))
