"""How near the bodies of a scene come to each other, the nearest pair first."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from movers.meshes import box

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, MotionError, Pose, Scene, SceneBody, SceneError

UNIT = Mesh(*box((0, 0, 0), (1, 1, 1)))
LARGE = Mesh(*box((-9, -9, -9), (10, 10, 10)))


def at(x, y=0.0, shape=UNIT, motion=None):
    return Body(shape, Pose(translation=[x, y, 0]), motion or Motion())


# Gaps along x at t = 0: 2, 5, 94; the first body comes nearer by 1.5.
ROW = {"comes": at(0, motion=Motion([1.5, 0, 0])), "near": at(3), "mid": at(9), "far": at(104)}
GAPS = {
    ("comes", "near"): 0.5,
    ("near", "mid"): 5.0,
    ("comes", "mid"): 6.5,
    ("mid", "far"): 94.0,
    ("near", "far"): 100.0,
    ("comes", "far"): 101.5,
}


def names(found):
    return [(one.body_a, one.body_b) for one in found]


def crowd(seed, count=7):
    """Return bodies that move and turn at random."""
    rng = np.random.default_rng(seed)
    return {
        f"body {k}": Body(
            UNIT,
            Pose(translation=rng.uniform(-5, 5, 3)),
            Motion(rng.uniform(-3, 3, 3), angular_velocity=rng.uniform(-1, 1, 3)),
        )
        for k in range(count)
    }


def test_pairs_come_in_the_order_of_their_least_distances() -> None:
    found = list(Scene(ROW).clearances())

    assert names(found) == list(GAPS)
    for one in found:
        low, high = one.clearance.minimum.bounds
        assert low <= GAPS[one.body_a, one.body_b] <= high
        assert high - low <= 1e-5 * high
        assert one.clearance.complete


@pytest.mark.parametrize("seed", range(4))
def test_pairs_are_answered_as_by_themselves(seed) -> None:
    bodies = crowd(seed)
    clearances = Scene(bodies, duration=2.0).clearances()

    found = list(clearances)

    assert sorted(names(found)) == sorted(itertools.combinations(bodies, 2))
    lows = [one.clearance.minimum.bounds[0] for one in found]
    assert lows == sorted(lows)
    for one in found:
        alone = obbcli.clearance(bodies[one.body_a], bodies[one.body_b], duration=2.0)
        here = one.clearance.minimum
        assert here.bounds[0] >= alone.minimum.bounds[0]
        assert here.bounds[1] == alone.minimum.bounds[1]
        assert (here.time, here.point_a, here.when) == (
            alone.minimum.time,
            alone.minimum.point_a,
            alone.minimum.when,
        )
        assert one.clearance.first_contact == alone.first_contact
    assert clearances.low == math.inf
    assert clearances.stats.in_contact + clearances.stats.apart_by_trees == len(found)


@pytest.mark.parametrize("seed", range(4))
def test_what_is_still_to_come_is_bounded_at_every_moment(seed) -> None:
    bodies = crowd(seed)
    truth = {
        (a, b): obbcli.clearance(bodies[a], bodies[b], duration=2.0).minimum.bounds[1]
        for a, b in itertools.combinations(bodies, 2)
    }
    clearances = Scene(bodies, duration=2.0).clearances()

    while not clearances.is_finished:
        one = clearances.advance()
        if one is not None:
            highest = truth.pop((one.body_a, one.body_b))
            assert one.clearance.minimum.bounds[0] <= highest
        assert all(clearances.low <= high for high in truth.values())
    assert truth == {}


def test_nearest_pair_alone_opens_no_tree_of_far_bodies() -> None:
    clearances = Scene(ROW).clearances()

    assert names([next(clearances)]) == [("comes", "near")]
    assert clearances.stats.later == 5
    assert clearances.stats.apart_by_bounds == 0
    nodes = {body.name: body.nodes_built for body in clearances.stats.bodies}
    apart = Scene({"a": at(0), "b": at(1.5), "c": at(900, shape=LARGE)}).clearances()
    next(apart)
    built = {body.name: body.nodes_built for body in apart.stats.bodies}
    assert nodes["comes"] > 0
    assert built["a"] > 0
    assert built["c"] == 0 < LARGE.triangles.shape[0]


@pytest.mark.parametrize(("within", "kept"), [(0.1, 0), (0.5, 1), (4.9, 1), (6, 2), (1e6, 6)])
def test_pairs_beyond_a_reach_are_counted(within, kept) -> None:
    clearances = Scene(ROW).clearances(within=within)

    assert names(clearances) == list(GAPS)[:kept]
    stats = clearances.stats
    assert stats.pairs == 6
    assert stats.apart_by_bounds + stats.apart_by_trees == 6
    assert stats.later == 0


@pytest.mark.parametrize("seed", range(4))
def test_reach_leaves_out_what_is_further(seed) -> None:
    scene = Scene(crowd(seed), duration=2.0)
    every = {name: one.clearance for name, one in by_name(scene.clearances()).items()}

    kept = by_name(scene.clearances(within=2.0))

    inside = {k for k, one in every.items() if one.minimum.bounds[1] <= 2.0}
    outside = {k for k, one in every.items() if one.minimum.bounds[0] > 2.0}
    assert inside
    assert outside
    assert inside <= set(kept)
    assert not outside & set(kept)


def by_name(found):
    return {(one.body_a, one.body_b): one for one in found}


@pytest.mark.parametrize("seed", range(4))
def test_verdicts_are_those_of_pairs_by_themselves(seed) -> None:
    bodies = crowd(seed)
    clearances = Scene(bodies, duration=2.0).clearances(at_least=2.0)

    found = by_name(clearances)

    for a, b in itertools.combinations(bodies, 2):
        alone = obbcli.clearance(bodies[a], bodies[b], duration=2.0, at_least=2.0).at_least
        if (a, b) in found:
            assert found[a, b].clearance.at_least.verdict == alone.verdict
        else:
            assert alone.verdict == "holds"
    verdicts = [one.clearance.at_least.verdict for one in found.values()]
    stats = clearances.stats
    assert stats.in_contact == verdicts.count("violated") > 0
    assert stats.apart_by_bounds == stats.pairs - len(found)
    assert stats.unresolved == 0


def test_named_static_and_ignored_pairs() -> None:
    bodies = [SceneBody(name, at(3.0 * k), static=name != "c") for k, name in enumerate("abc")]
    scene = Scene(bodies, ignore=[{"bodies": ["a", "c"]}])

    clearances = scene.clearances()

    assert names(clearances) == [("b", "c")]
    assert clearances.stats[:3] == (3, 1, 1)
    assert names(Scene(ROW).clearances(pairs=[("far", "mid")])) == [("mid", "far")]
    with pytest.raises(SceneError, match="no body"):
        Scene(ROW).clearances(pairs=[("far", "mud")])
    with pytest.raises(SceneError, match="ignored"):
        scene.clearances(pairs=[("a", "c")])


def test_groups_that_are_ignored_are_not_asked() -> None:
    bodies = [SceneBody(name, at(3.0 * k), group="g") for k, name in enumerate("ab")]
    scene = Scene([*bodies, SceneBody("c", at(9))], ignore=[{"groups": ["g"]}])

    assert names(scene.clearances()) == [("b", "c"), ("a", "c")]


def test_body_inside_another_touches_a_solid() -> None:
    scene = Scene({"large": at(0, shape=LARGE), "small": at(0), "out": at(30)})

    solid = list(scene.clearances(solid=True))
    hollow = list(scene.clearances())

    assert names(solid)[0] == ("large", "small")
    assert solid[0].clearance.minimum.bounds == (0, 0)
    assert solid[0].clearance.first_contact.contained == "b"
    low, high = hollow[0].clearance.minimum.bounds
    assert low <= 9 <= high
    assert names(solid)[1:] == names(hollow)[1:] == [("large", "out"), ("small", "out")]


def test_limit_of_a_pair_leaves_its_bracket_wide_and_proven() -> None:
    clearances = Scene(crowd(0), accuracy=Accuracy(max_iterations=1), duration=2.0).clearances()
    truth = by_name(Scene(crowd(0), duration=2.0).clearances())

    found = by_name(clearances)

    assert set(found) == set(truth)
    assert not all(one.clearance.complete for one in found.values())
    for name, one in found.items():
        low, high = one.clearance.minimum.bounds
        true_low, true_high = truth[name].clearance.minimum.bounds
        assert low <= true_high
        assert high is None or high >= true_low
    assert clearances.stats.unresolved == sum(not one.clearance.complete for one in found.values())


def test_time_that_has_run_out_leaves_pairs_for_later() -> None:
    clearances = Scene(ROW, accuracy=Accuracy(timeout=0.0)).clearances()

    assert list(clearances) == []
    assert clearances.stats.later == 6
    assert clearances.low == 0


def test_search_that_is_stopped_tells_what_was_begun() -> None:
    clearances = Scene(crowd(1), duration=2.0).clearances()
    while clearances.stats.box_tests == 0:
        assert clearances.advance() is None
    clearances.stop()

    found = list(clearances)

    assert len(found) == 1
    stats = clearances.stats
    assert stats.apart_by_trees + stats.in_contact + stats.unresolved == 1
    assert stats.later == stats.pairs - 1


def test_bodies_very_far_apart_are_ordered_too() -> None:
    scene = Scene({"a": at(0), "b": at(1e9), "c": at(1e30)})

    assert names(scene.clearances()) == [("a", "b"), ("a", "c"), ("b", "c")]


@pytest.mark.parametrize(
    ("asked", "fault"),
    [
        ({"within": -1}, "within"),
        ({"within": math.nan}, "within"),
        ({"at_least": "1"}, "at_least"),
        ({"tolerance": 0}, "tolerance"),
    ],
)
def test_bad_number_is_one_clear_error(asked, fault) -> None:
    with pytest.raises(MotionError, match=fault):
        Scene(ROW).clearances(**asked)


@pytest.mark.parametrize("name", ["clearance", "time_tolerance", "max_depth_a"])
def test_accuracy_that_says_nothing_here_is_refused(name) -> None:
    with pytest.raises(MotionError, match=name):
        Scene(ROW, accuracy=Accuracy(**{name: 1})).clearances()
