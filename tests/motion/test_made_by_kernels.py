"""`Pose` and `Body`, made in C++ where their arguments allow it: alike however they are made."""

from __future__ import annotations

import copy
import dataclasses
import gc
import inspect
import pickle
import weakref
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from obbcli import Body, Mesh, Motion, MotionError, ObbTree, Pose, collide

TURN = Pose(rotation=[0.1, -0.7, 0.3]).rotation
SHIFT = np.array([1.0, -0.0, 3e-300])
TREE = ObbTree.build(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2], [0, 1, 3]]))
COPIED = [
    copy.copy,
    copy.deepcopy,
    *(lambda x, n=n: pickle.loads(pickle.dumps(x, n)) for n in range(pickle.HIGHEST_PROTOCOL + 1)),
]


class Named(Pose):
    """As users derive: with arguments of its own, and something beside the fields."""

    def __init__(self, name: str, shift: float = 0.0) -> None:
        super().__init__(translation=[shift, 0, 0])
        vars(self)["name"] = name


class Labelled(Body):
    pass


def bits(pose: Pose) -> bytes:
    return pose.rotation.tobytes() + pose.translation.tobytes()


@pytest.mark.parametrize(
    ("rotation", "translation"),
    [
        (TURN, SHIFT),
        (np.asfortranarray(TURN), SHIFT[::1]),
        (TURN.tolist(), SHIFT.tolist()),
        (tuple(map(tuple, TURN.tolist())), tuple(SHIFT.tolist())),
        (np.ma.array(TURN), np.array([*SHIFT, 7.0])[:3]),
        (np.repeat(TURN, 2, axis=1)[:, ::2], np.repeat(SHIFT, 2)[::2]),
        (TURN.astype(">f8"), SHIFT.astype(">f8")),
        (memoryview(TURN), SHIFT.astype(np.longdouble)),
    ],
)
def test_poses_are_the_same_to_the_bit_whatever_they_are_made_of(rotation, translation):
    made = Pose(rotation, translation)

    assert bits(made) == TURN.tobytes() + SHIFT.tobytes()
    assert bits(Pose(translation=translation, rotation=rotation)) == bits(made)
    for field in (made.rotation, made.translation):
        assert type(field) is np.ndarray
        assert field.dtype == np.float64
        assert not field.flags.writeable


@pytest.mark.parametrize(
    "shift", [[1, 2, 3], (1, 2.5, -3), np.array([1, 2, 3]), [np.float64(1), 2, 3]]
)
def test_shifts_of_any_numbers_are_taken(shift):
    assert Pose(translation=shift).translation.tolist() == [float(x) for x in shift]


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (
            ([[2, 0, 0], [0, 1, 0], [0, 0, 1]],),
            "rotation: is not orthonormal to 1e-09: Q Q^T is off by 3",
        ),
        ((np.diag([1.0, 1.0, 1.0 + 6e-10]),), "rotation: is not orthonormal to 1e-09"),
        ((np.diag([1.0, 1.0, -1.0]),), "rotation: is a reflection (determinant -1)"),
        ((np.full((3, 3), np.nan),), "rotation[0, 0]: is nan; coordinates must be finite"),
        ((np.full((3, 3), 1e300),), "rotation: is not orthonormal"),
        ((np.eye(4),), "rotation: has shape (4, 4), expected (3, 3)"),
        ((np.eye(3), np.zeros(4)), "translation: has shape (4,), expected (3)"),
        ((None, [0, np.inf, 0]), "translation[1]: is inf; coordinates must be finite"),
        ((None, np.array([0, 0, np.nan])), "translation[2]: is nan"),
        ((None, [10**400, 0, 0]), "translation: expected numbers of shape (3)"),
        ((None, ["x", 0, 0]), "translation: expected numbers of shape (3)"),
        ((None, [1, 2]), "translation: has shape (2,), expected (3)"),
    ],
)
def test_poses_are_refused_in_the_same_words(arguments, text):
    with pytest.raises(MotionError) as refused:
        Pose(*arguments)

    assert str(refused.value).startswith(text)


def test_defects_are_judged_alike_in_both_ways():
    for defect in np.linspace(4.9999e-10, 5.0001e-10, 41):
        matrix = np.diag([1.0, 1.0, 1.0 + defect])
        told = []
        for given in (matrix, matrix.tolist()):
            try:
                told.append(bits(Pose(given)))
            except MotionError as fault:
                told.append(str(fault))
        assert told[0] == told[1]


@pytest.mark.parametrize(
    "made", [lambda: Pose(1, 2, 3), lambda: Pose(nonsense=1), lambda: Pose((), rotation=())]
)
def test_wrong_calls_are_type_errors_that_name_the_class(made):
    with pytest.raises(TypeError, match=r"Pose\.__init__"):
        made()


def test_body_names_what_is_missing():
    with pytest.raises(TypeError, match=r"Body\.__init__.*'shape'"):
        Body(pose=Pose())


def test_signatures_and_fields_are_known():
    assert list(inspect.signature(Pose).parameters) == ["rotation", "translation"]
    assert list(inspect.signature(Body).parameters) == ["shape", "pose", "motion"]
    assert [field.name for field in dataclasses.fields(Pose)] == ["rotation", "translation"]
    assert [field.name for field in dataclasses.fields(Body)] == ["shape", "pose", "motion"]
    assert all(field.default is dataclasses.MISSING for field in dataclasses.fields(Body))
    assert "x(0) = Q p + s" in Pose.__doc__
    assert bits(dataclasses.replace(Pose(TURN), translation=[1, 2, 3])) == bits(
        Pose(TURN, [1, 2, 3])
    )


def test_what_the_caller_does_to_an_array_later_changes_nothing():
    turn, shift = TURN.copy(), SHIFT.copy()
    pose = Pose(turn, shift)

    turn[:], shift[:] = 0, 7

    assert bits(pose) == TURN.tobytes() + SHIFT.tobytes()
    assert pose.rotation is pose.rotation


@pytest.mark.parametrize("copied", COPIED)
def test_copies_and_pickles_are_the_same(copied):
    pose, named = Pose(TURN, SHIFT), Named("pin", 2.0)
    body = Labelled(TREE, pose)
    vars(body)["note"] = "kept"

    assert bits(copied(pose)) == bits(pose)
    assert not copied(pose).rotation.flags.writeable
    again = copied(named)
    assert (type(again), again.name, bits(again)) == (Named, "pin", bits(named))
    other = copied(Body("gear.stl", pose, Motion([0, 0, 1])))
    assert other.shape == "gear.stl"
    assert bits(other.pose) == bits(pose)
    assert other.motion.linear_velocity.tolist() == [0, 0, 1]
    if copied is copy.copy:  # trees are not pickled
        twin = copied(body)
        assert (type(twin), twin.note, twin.shape, twin.pose) == (Labelled, "kept", TREE, pose)
        assert collide(twin, body).collides


def test_pickles_of_earlier_versions_are_read():
    # Those of a class that held its fields in a dictionary.
    pose = Pose.__new__(Pose)
    pose.__setstate__({"rotation": TURN, "translation": SHIFT})

    assert bits(pose) == TURN.tobytes() + SHIFT.tobytes()


def test_fields_are_read_only():
    body = Body(TREE, Pose(TURN))

    for thing, names in (
        (body, ("shape", "pose", "motion")),
        (body.pose, ("rotation", "translation")),
    ):
        for name in (*names, "nonsense"):
            with pytest.raises(FrozenInstanceError):
                setattr(thing, name, None)
            with pytest.raises(FrozenInstanceError):
                delattr(thing, name)
    for name in ("placed", "at_rest"):
        with pytest.raises(AttributeError):
            setattr(body, name, None)


def test_objects_are_equal_and_hashed_by_identity():
    pose, body = Pose(TURN), Body(TREE)

    assert pose != Pose(TURN)
    assert body != Body(TREE)
    assert len({pose, Pose(TURN), body, Body(TREE), pose, body}) == 4
    assert isinstance(pose, Pose)
    assert repr(Body("gear.stl")) == "Body(shape='gear.stl', pose=Pose(), motion=Motion())"


def test_derived_poses_and_bodies_are_taken():
    class Crane(Body):
        def __init__(self, height: float) -> None:
            super().__init__(TREE, Named("hook", height), motion=Motion())

    high = Crane(9.0)

    assert high.pose.translation.tolist() == [9.0, 0.0, 0.0]
    assert high.at_rest is not None
    assert not collide(high, Body(TREE)).collides
    assert collide(Crane(0.0), TREE).collides


def test_body_rests_where_its_motion_does():
    path = Motion.through([0, 1], [Pose(), Pose(translation=[1, 0, 0])])

    assert Body(TREE).at_rest is not None
    assert Body(TREE, motion=Motion([0, 0, 0], None, [1, 2, 3])).at_rest is not None
    for motion in (Motion([0, 0, 1]), path):
        assert Body(TREE, motion=motion).at_rest is None
        assert Body(TREE, motion=motion).placed is not None
    assert Body("gear.stl").placed is None
    assert Body(TREE.mesh).at_rest is None
    assert Body(TREE, motion=path).pose is path.poses[0]


def test_objects_can_be_watched_and_cycles_are_collected():
    class Part(Body):
        pass

    class Spot(Pose):
        pass

    spot = Spot(TURN, SHIFT)
    part = Part(TREE, spot)
    vars(spot)["holder"] = part
    vars(part)["me"] = part
    watched = [weakref.ref(spot), weakref.ref(part), weakref.ref(Body(TREE, Pose(TURN)))]

    del spot, part
    gc.collect()

    assert [ref() for ref in watched] == [None, None, None]


def test_body_keeps_its_tree_alive():
    tree = ObbTree.build(TREE.mesh)
    body, watched = Body(tree), weakref.ref(tree)

    del tree
    gc.collect()
    assert watched() is body.shape
    assert collide(body, body).collides
    del body
    gc.collect()
    assert watched() is None


def test_objects_made_past_their_constructor_are_harmless():
    body = Body.__new__(Body)

    assert body.placed is None
    assert body.at_rest is None
    with pytest.raises(AttributeError, match="shape"):
        _ = body.shape
    assert Pose.__new__(Pose).is_identity
