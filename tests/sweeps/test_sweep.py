"""`sweep`: row by row what `first_contact` says, bit for bit, whatever the threads."""

from __future__ import annotations

import math
from dataclasses import fields

import numpy as np
import pytest
from meshes.surfaces import blob, sheet

from obbcli import (
    Accuracy,
    Body,
    Contact,
    Mesh,
    Motion,
    MotionError,
    ObbError,
    ObbTree,
    Pose,
    first_contact,
    sweep,
)

APART = Pose((0.3, -0.2, 0.5), (3.0, 0.1, -0.2))
COUNTERS = ("box_tests", "triangle_tests", "exact_triangle_tests", "pops", "image_tests")


@pytest.fixture(scope="module")
def pair() -> tuple[ObbTree, ObbTree]:
    return tuple(
        ObbTree.build(Mesh(surface.vertices, surface.faces), leaf_size=leaf_size)
        for surface, leaf_size in ((blob(500, 1), 1), (blob(700, 2), 4))
    )


def moving(count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Return random motions of two bodies of which some meet."""
    rng = np.random.default_rng(seed)
    motions_a, motions_b = rng.normal(size=(2, count, 9))
    motions_b[:, 0] -= 3.0
    motions_a[::3, 3:6] = 0.0
    motions_b[::5, 3:6] = 0.0
    motions_a[::4, :3] = 0.0
    return motions_a, motions_b


def motion_of(row: np.ndarray) -> Motion:
    return Motion(row[:3], row[3:6], row[6:] if len(row) == 9 else None)


def assert_is(row: np.void, answer) -> None:
    """Assert that a row says what an answer says, to the last bit."""
    low, high = answer.time_bounds or (None, None)
    expected = {"time": answer.time, "time_lo": low, "time_hi": high}
    for field in fields(Contact):
        if field.name != "time_bounds":
            expected[field.name] = getattr(answer, field.name)
    expected["status"] = answer.status.value
    for name in COUNTERS:
        expected[name] = getattr(answer.stats, name)
    assert set(expected) == set(row.dtype.names)
    for name, value in expected.items():
        none = {"U": "", "i": -1, "f": math.nan}.get(row.dtype[name].base.kind)
        wanted = none if value is None else value
        found = row[name]
        same = np.array_equal(found, wanted, equal_nan=row.dtype[name].base.kind == "f")
        if value is None and row.dtype[name].shape:
            same = bool(np.isnan(found).all())
        assert same, (name, found, value)
        if row.dtype[name].base.kind == "f":
            assert not np.signbit(found[np.asarray(found) == 0]).any()


ACCURACIES = {
    "exact": Accuracy(),
    "near": Accuracy(distance_tolerance=0.05),
    "clear": Accuracy(clearance=0.3),
    "wide": Accuracy(time_tolerance=0.01),
    "shallow": Accuracy(max_depth_a=3, max_depth_b=2),
    "roots": Accuracy(max_depth_a=0, max_depth_b=0),
    "coarse": Accuracy(leaves="boxes"),
    "brief": Accuracy(max_iterations=40),
    "one pop": Accuracy(max_iterations=1),
    "sampled": Accuracy(method="sampled", steps=5),
}


@pytest.mark.parametrize("accuracy", ACCURACIES.values(), ids=ACCURACIES.keys())
def test_rows_are_those_of_first_contact(pair, accuracy):
    motions_a, motions_b = moving(24)
    durations = np.linspace(0.0, 1.5, 24)
    body = Body(pair[1], APART)

    rows = sweep(pair[0], body, motions_a, motions_b, durations, accuracy, threads=2)

    for row, a, b, duration in zip(rows, motions_a, motions_b, durations, strict=True):
        bodies = Body(pair[0], motion=motion_of(a)), Body(pair[1], APART, motion_of(b))
        assert_is(row, first_contact(*bodies, float(duration), accuracy))


def test_random_rows_have_many_answers(pair):
    rows = sweep(pair[0], Body(pair[1], APART), *moving(24))

    assert {"contact", "separated"} <= set(rows["status"])
    assert len(set(rows["feature"])) > 2


@pytest.mark.parametrize("accuracy", ["exact", "clear", "shallow", "roots", "coarse", "one pop"])
def test_bodies_that_touch_at_the_start_say_where(pair, accuracy):
    body = Body(pair[1], Pose(None, (1.2, 0, 0)))

    rows = sweep(pair[0], body, np.zeros((3, 6)), None, [0.0, 1.0, 2.0], ACCURACIES[accuracy])

    for row, duration in zip(rows, (0.0, 1.0, 2.0), strict=True):
        assert_is(row, first_contact(pair[0], body, duration, ACCURACIES[accuracy]))


@pytest.fixture(scope="module")
def sheets() -> tuple[ObbTree, Body]:
    """Return a wavy sheet and itself a little above: thousands of pops to tell apart."""
    surface = sheet(8000, 0.2)
    tree = ObbTree.build(Mesh(surface.vertices, surface.faces))
    return tree, Body(tree, Pose(None, (0, 0, 0.003)))


@pytest.mark.parametrize("limit", [16_383, 16_385, 16_578, 16_579, 20_000, 30_000, 33_000, 40_000])
def test_limits_in_the_middle_of_slices_end_at_the_same_pop(sheets, limit):
    plain, above = sheets
    motions = np.array([[0, 0, 1e-3, 0, 0, 0], [0, 0, 1e-3, 0, 0, 0.03]])
    accuracy = Accuracy(max_iterations=limit)

    rows = sweep(plain, above, None, motions, None, accuracy)

    for row, motion in zip(rows, motions, strict=True):
        body = Body(above.shape, above.pose, motion_of(motion))
        answer = first_contact(plain, body, accuracy=accuracy)
        # The one that goes straight takes fewer pops than the largest limits.
        assert answer.status == "unresolved" or (not motion[3:].any() and limit > 30_000)
        assert_is(row, answer)


def test_bodies_nearer_than_the_clearance_are_in_contact_at_the_start(sheets):
    plain, above = sheets
    accuracy = Accuracy(clearance=0.01)

    rows = sweep(plain, above, None, [[0, 0, 1, 0, 0, 0], [0, 0, 1, 1, 0, 0]], 1.0, accuracy)

    assert set(rows["status"]) == {"overlap_at_start"}
    for row, spin in zip(rows, (0, 1), strict=True):
        body = Body(above.shape, above.pose, Motion((0, 0, 1), (spin, 0, 0)))
        assert_is(row, first_contact(plain, body, 1.0, accuracy))


@pytest.mark.parametrize("pivots_alike", [True, False])
def test_bodies_that_move_alike_are_asked_at_the_start_alone(pair, pivots_alike):
    motions = moving(3)[0] + 1
    others = motions if pivots_alike else motions + np.repeat([0, 1], [6, 3])
    body = Body(pair[1], APART)

    rows = sweep(pair[0], body, motions, others)

    at_rest = first_contact(pair[0], body).stats.pops
    assert set(rows["pops"] > at_rest) == {not pivots_alike}
    for row, a, b in zip(rows, motions, others, strict=True):
        bodies = Body(pair[0], motion=motion_of(a)), Body(pair[1], APART, motion_of(b))
        assert_is(row, first_contact(*bodies))


def test_motions_come_as_objects_as_arrays_or_as_one_for_all(pair):
    motions_a, motions_b = moving(6)
    body = Body(pair[1], APART)
    expected = sweep(pair[0], body, motions_a, motions_b[:1])

    objects = sweep(pair[0], body, [motion_of(m) for m in motions_a], motion_of(motions_b[0]))
    one = sweep(pair[0], body, motions_a.tolist(), motions_b[0], durations=1.0)
    own = sweep(pair[0], Body(pair[1], APART, motion_of(motions_b[0])), motions_a)

    for rows in (objects, one, own):
        assert rows.tobytes() == expected.tobytes()


def test_pivots_left_out_are_the_centroids(pair):
    motions_a, motions_b = moving(6)
    body = Body(pair[1], APART)

    rows = sweep(pair[0], body, motions_a[:, :6], motions_b[:, :6])

    for row, a, b in zip(rows, motions_a[:, :6], motions_b[:, :6], strict=True):
        bodies = Body(pair[0], motion=motion_of(a)), Body(pair[1], APART, motion_of(b))
        assert_is(row, first_contact(*bodies))


def test_paths_are_asked_among_the_others(pair):
    path = Motion.through([0, 1], [APART, Pose((0.3, 0.8, 0.5), (0.5, 0.1, -0.2))])
    other = motion_of(moving(1)[1][0])

    rows = sweep(pair[0], pair[1], moving(3)[0], [other, path, other], 0.8)

    for row, a, b in zip(rows, moving(3)[0], [other, path, other], strict=True):
        bodies = Body(pair[0], motion=motion_of(a)), Body(pair[1], motion=b)
        assert_is(row, first_contact(*bodies, 0.8))


def test_threads_and_laziness_change_no_bit(pair):
    surfaces = blob(500, 1), blob(700, 2)
    lazy, whole = (
        [ObbTree.build(Mesh(s.vertices, s.faces), lazy=is_lazy) for s in surfaces]
        for is_lazy in (True, False)
    )
    motions = moving(40)

    one, many, other = (
        sweep(a, Body(b, APART), *motions, threads=threads).tobytes()
        for (a, b), threads in ((whole, 1), (whole, 8), (lazy, 8))
    )

    assert one == many == other


def test_no_rows_are_no_answers(pair):
    rows = sweep(*pair, np.empty((0, 6)))

    assert len(rows) == 0
    assert "status" in rows.dtype.names


def test_rest_is_asked_about_an_instant(pair):
    rows = sweep(pair[0], Body(pair[1], APART), np.zeros((2, 6)), None)

    assert set(rows["status"]) == {"separated"}
    assert rows["pops"].tolist() == [first_contact(pair[0], Body(pair[1], APART)).stats.pops] * 2


REFUSED = {
    "ragged": (([[1, 2], [3]],), {}, "motions_a"),
    "words": ((["ab"],), {}, "motions_a"),
    "narrow": ((np.zeros((2, 5)),), {}, r"motions_a: has shape \(2, 5\); give \(N, 6\)"),
    "infinite": ((np.full((2, 6), np.inf),), {}, r"motions_a\[0, 0\]: is inf"),
    "another kind": (([Motion(), 3],), {}, r"motions_a\[1\]: is of type int"),
    "two lengths": (
        (np.zeros((2, 6)), np.zeros((3, 6))),
        {},
        "motions: 2 motions_a, 3 motions_b do not go together",
    ),
    "lengths of time": ((np.zeros((2, 6)),), {"durations": [1, 1, 1]}, "2 motions_a, 1 motions_b"),
    "back in time": ((np.zeros((2, 6)),), {"durations": [1, -1]}, r"durations\[1\]: is -1.0"),
    "one back in time": ((np.zeros((2, 6)),), {"durations": -1}, "duration: is -1"),
    "beyond doubles": ((np.full((2, 6), 1e308),), {}, "row 0: motion"),
}


@pytest.mark.parametrize(("motions", "options", "told"), REFUSED.values(), ids=REFUSED.keys())
def test_faulty_arrays_are_refused_by_name(pair, motions, options, told):
    with pytest.raises(MotionError, match=told):
        sweep(pair[0], Body(pair[1], APART), *motions, **options)


def test_body_that_moves_by_itself_takes_no_other_motion(pair):
    with pytest.raises(MotionError, match="motions_a: are given beside a body that moves"):
        sweep(Body(pair[0], motion=Motion((1, 0, 0))), pair[1], np.zeros((2, 6)))


def test_no_threads_are_refused(pair):
    with pytest.raises(ObbError, match="threads: is 0"):
        sweep(*pair, np.zeros((2, 6)), threads=0)


@pytest.mark.parametrize("accuracy", [Accuracy(), Accuracy(method="sampled")])
def test_pose_beyond_doubles_is_refused(pair, accuracy):
    far = Body(pair[1], Pose(None, (1e308, 0, 0)))

    with pytest.raises(MotionError, match="pose"):
        sweep(pair[0], far, np.ones((2, 6)), None, 1.0, accuracy)
