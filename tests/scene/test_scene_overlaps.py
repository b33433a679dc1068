"""How the bodies of a scene lie to each other at t = 0."""

from __future__ import annotations

import numpy as np
import pytest
from movers.meshes import box

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, MotionError, Pose, Scene, SceneBody, SceneError

UNIT = Mesh(*box((0, 0, 0), (1, 1, 1)))
OPEN = Mesh(UNIT.vertices, UNIT.triangles[:-1])


def at(x, shape=UNIT, motion=None):
    return Body(shape, Pose(translation=[x, 0, 0]), motion or Motion())


def told(scene, *, accuracy=None, **asked):
    """Return the relations of a scene's pairs that are not clear."""
    made = Scene(scene, accuracy=accuracy)
    return [(one.body_a, one.body_b, one.overlap.relation) for one in made.overlaps(**asked)]


ROW = {"left": at(0), "flush": at(1), "sunk": at(1.75), "near": at(3.0), "far": at(9)}


def test_pairs_that_are_not_clear_come_in_the_order_of_the_bodies() -> None:
    assert told(ROW) == [("left", "flush", "touching"), ("flush", "sunk", "overlapping")]


def test_wanted_distance_makes_pairs_near() -> None:
    assert told(ROW, accuracy=Accuracy(clearance=0.5)) == [
        ("left", "flush", "touching"),
        ("flush", "sunk", "overlapping"),
        ("sunk", "near", "near"),
    ]


def test_band_that_is_asked_for_holds_for_all_pairs() -> None:
    assert told(ROW, touch=(0.3, 0.3)) == [
        ("left", "flush", "touching"),
        ("flush", "sunk", "touching"),
        ("sunk", "near", "touching"),
    ]


def test_bodies_far_from_the_origin_touch_within_the_rounding_of_their_places() -> None:
    far = 1e12
    gap = 4 * float(np.spacing(far))
    pair = {"left": at(far), "right": at(far + 1 + gap)}

    assert obbcli.overlap(*pair.values()).relation == "touching"
    assert told(pair) == [("left", "right", "touching")]


def test_pairs_are_asked_as_by_themselves() -> None:
    found = {(one.body_a, one.body_b): one.overlap for one in Scene(ROW).overlaps()}

    alone = obbcli.overlap(ROW["flush"], ROW["sunk"])
    one = found["flush", "sunk"]
    assert one.thickness == alone.thickness
    assert (one.protrusion_a, one.protrusion_b) == (alone.protrusion_a, alone.protrusion_b)
    assert (one.volume, one.band) == (alone.volume, alone.band)


def test_named_pairs_alone_are_asked() -> None:
    assert told(ROW, pairs=[("sunk", "flush")]) == [("flush", "sunk", "overlapping")]
    with pytest.raises(SceneError, match="no body"):
        told(ROW, pairs=[("sunk", "sink")])


def test_bodies_are_where_they_are_at_the_start() -> None:
    scene = {"still": at(0), "comes": at(3, motion=Motion([-10, 0, 0]))}

    assert told(scene) == []


def test_ignored_and_static_pairs_are_not_asked() -> None:
    bodies = [SceneBody(name, at(0), static=name != "c") for name in "abc"]
    scene = Scene(bodies, ignore=[{"bodies": ["a", "c"]}])

    overlaps = scene.overlaps()

    assert [(one.body_a, one.body_b) for one in overlaps] == [("b", "c")]
    assert (overlaps.stats.static, overlaps.stats.ignored, overlaps.stats.in_contact) == (1, 1, 1)


def test_open_surfaces_are_told_beside_solids() -> None:
    scene = {"open": at(0, OPEN), "solid": at(0.5)}

    (found,) = Scene(scene).overlaps()

    assert found.overlap.relation == "crossing"
    assert found.overlap.reason.startswith("A is not watertight")


def test_pairs_apart_by_bounds_build_no_boxes() -> None:
    overlaps = Scene({"a": at(0), "b": at(9)}).overlaps()

    assert list(overlaps) == []
    assert overlaps.stats.apart_by_bounds == 1
    assert overlaps.stats.box_tests == 0


def test_limit_leaves_a_pair_open() -> None:
    scene = {"a": at(0), "b": Body(UNIT, Pose([0.3, 0.4, 0.5], [0.5, 0, 0]))}

    assert told(scene, accuracy=Accuracy(max_iterations=1)) == [("a", "b", "unresolved")]


def test_bad_band_is_one_clear_error() -> None:
    with pytest.raises(MotionError, match="touch"):
        Scene(ROW).overlaps(touch=(-1, 0))
    with pytest.raises(MotionError, match="tolerance"):
        Scene(ROW).overlaps(tolerance=0)
