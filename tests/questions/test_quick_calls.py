"""`collide` and `first_contact`, in front of which the kernels stand: quick, and hiding nothing."""

from __future__ import annotations

import copy
import dataclasses
import functools
import inspect
import pickle
import pydoc
import sys
import weakref

import numpy as np
import pytest
from mesh_files.cube_files import objects

import obbcli
from obbcli import (
    Accuracy,
    Body,
    Collision,
    FirstContact,
    MeshError,
    Motion,
    MotionError,
    ObbTree,
    Pose,
    Status,
    first_contact,
)
from obbcli import collide as quick

GEAR = "sample_meshes/gear.stl"


@pytest.fixture(scope="module")
def tree() -> ObbTree:
    return ObbTree.build(GEAR, lazy=False)


def without_seconds(answer: Collision | FirstContact) -> dict[str, object]:
    """Return the fields of an answer, its counts among them, but no times of the clock."""
    fields = {field.name: getattr(answer, field.name) for field in dataclasses.fields(answer)}
    return fields | {"stats": answer.stats._replace(seconds={})}


@pytest.mark.parametrize(
    ("function", "name", "home", "said"),
    [
        (quick, "collide", "collide", "Surfaces are closed: touching counts."),
        (first_contact, "first_contact", "first_contact", "SEPARATED is proof"),
    ],
)
def test_function_looks_as_it_is_written(function, name, home, said):
    assert function.__name__ == function.__qualname__ == name
    assert function.__module__ == f"obbcli.questions.{home}"
    assert function.__doc__.startswith("Return whe")
    arguments = ["a", "b", "duration", "accuracy", "solid"]
    more = ["after_release", "released_by"] if name == "first_contact" else []
    assert list(inspect.signature(function).parameters) == [*arguments, *more]
    assert inspect.unwrap(function) is function.__wrapped__
    assert inspect.isroutine(function)
    assert callable(function)
    assert repr(function).startswith(f"<function {name} at ")
    shown = pydoc.plain(pydoc.render_doc(function))
    # Later versions write an argument a line.
    words = "".join(shown.split())
    assert f"{name}(a:'Body|Shape',b:'Body|Shape',duration:'float|None'=None" in words
    assert said in shown


@pytest.mark.parametrize("function", [quick, first_contact])
def test_function_is_pickled_copied_and_watched_as_functions_are(function):
    for number in range(pickle.HIGHEST_PROTOCOL + 1):
        assert pickle.loads(pickle.dumps(function, number)) is function
    assert copy.copy(function) is function
    assert copy.deepcopy(function) is function
    assert weakref.ref(function)() is function
    assert getattr(obbcli, function.__name__) is function


def test_function_is_bound_where_it_is_a_method(tree):
    class Asked(Body):
        touches = quick

    assert Asked(tree).touches(tree).collides
    assert Asked.touches is quick
    assert functools.partial(quick, tree)(tree).collides


@pytest.mark.parametrize("function", [quick, first_contact])
@pytest.mark.parametrize("moves", ["neither", "one", "both", "turning", "alike", "none of a tree"])
def test_answers_are_those_of_the_function(tree, function, moves):
    rng = np.random.default_rng(len(moves))
    statuses = set()
    for number in range(40):
        reach = 3 if number % 3 == 0 else 30  # near ones meet at t = 0
        poses = [Pose(rng.normal(size=3), reach * rng.normal(size=3)) for _ in range(2)]
        motions = [Motion(40 * rng.normal(size=3)), Motion(40 * rng.normal(size=3))]
        if moves in {"neither", "one"}:
            motions[number % 2] = Motion()
        if moves == "neither":
            motions[1 - number % 2] = Motion()
        if moves == "turning":
            motions[0] = Motion(rng.normal(size=3), rng.normal(size=3))
        if moves == "alike":
            motions[1] = motions[0]
        a, b = (Body(tree, pose, motion) for pose, motion in zip(poses, motions, strict=True))
        if moves == "none of a tree":
            a, b = (tree, b) if number % 2 else (a, tree)

        found, asked = function(a, b), function.__wrapped__(a, b)

        assert type(found) is type(asked)
        assert without_seconds(found) == without_seconds(asked)
        statuses.add(found.status)
    assert statuses >= {Status.SEPARATED, Status.OVERLAP_AT_START}
    assert Status.CONTACT in statuses or moves in {"neither", "alike"}


@pytest.mark.parametrize("function", [quick, first_contact])
def test_trees_that_grow_answer_alike(function):
    rng = np.random.default_rng(8)
    for _ in range(6):
        poses = [Pose(rng.normal(size=3), 15 * rng.normal(size=3)) for _ in range(2)]
        up = Motion([0, 0, 9.0])
        answers = []
        for ask in (function, function.__wrapped__):
            a, b = (Body(ObbTree.build(GEAR), pose, up) for pose in poses)
            answers.append(without_seconds(ask(a, Body(b.shape, b.pose))))
        assert answers[0] == answers[1]


def test_motions_through_poses_go_to_the_function(tree):
    path = Motion.through([0, 3], [Pose(translation=[0, 0, 500]), Pose()])

    found = first_contact(Body(tree, motion=path), tree)

    assert 0 < found.time < 3


def test_labels_are_looked_at(tree):
    one, other = (ObbTree.build(tree.mesh.in_unit(unit)) for unit in ("m", "mm"))

    for motion in (Motion(), Motion([0, 0, 1])):
        with pytest.raises(MeshError, match="A is in m, B in mm"):
            quick(Body(one, motion=motion), Body(other))
        with pytest.raises(MeshError, match="A is in m, B in mm"):
            first_contact(Body(one, motion=motion), Body(other))


def no_function(*_, **__):
    raise AssertionError("the kernels answer this alone")


@pytest.mark.parametrize("unit_b", ["m", None])
def test_units_that_agree_are_left_to_the_kernels(tree, unit_b, monkeypatch):
    one = ObbTree.build(tree.mesh.in_unit("m"), lazy=False)
    other = one if unit_b else tree
    away = Body(other, Pose(translation=[0, 0, 500]))
    wanted = [quick(one, away, 0.0), quick(one, Body(other), 0.0)]
    monkeypatch.setattr(sys.modules[quick.__module__], "collide_pair", no_function)

    found = [quick(one, away), quick(one, Body(other))]

    assert [answer.collides for answer in found] == [False, True]
    assert [*map(without_seconds, found)] == [*map(without_seconds, wanted)]


def test_parts_are_named_of_what_the_kernels_found(tmp_path, monkeypatch):
    path = tmp_path / "cubes.obj"
    path.write_text(objects(base=0.0, arm=1.0, tip=10.0))
    a, b = (ObbTree.build(f"{path}#{names}") for names in ("[bt]*", "arm"))
    monkeypatch.setattr(sys.modules[quick.__module__], "collide_pair", no_function)

    for bodies in ((a, b), (Body(a), Body(b)), (Body(a, motion=Motion([1, 0, 0])), Body(b))):
        for answer in (quick(*bodies), first_contact(*bodies)):
            assert answer.collides
            assert (answer.part_a, answer.part_b) == ("base", "arm")
    apart = quick(Body(a), Body(b, Pose(translation=[0, 0, 50])))
    assert (apart.collides, apart.part_a, apart.part_b) == (False, None, None)


def test_motion_that_leaves_the_range_of_double_is_refused(tree):
    fast = Body(tree, motion=Motion([1e308, 1e308, 0]))

    for function in (quick, first_contact):
        with pytest.raises(MotionError, match=r"^motion: "):
            function(fast, Body(tree, Pose(translation=[500, 0, 0])))


def test_trees_and_mixed_arguments_are_taken(tree):
    assert quick(tree, tree).collides
    assert quick(tree, Body(tree)).collides
    assert quick(GEAR, tree).collides
    assert quick(tree, tree.mesh).collides
    assert not quick(tree, Body(tree, Pose(translation=[0, 0, 500]))).collides


def test_all_other_questions_go_to_the_function(tree):
    up = Body(tree, Pose(translation=[0, 0, 500]), Motion([0, 0, -500]))

    assert quick(tree, up).status is Status.CONTACT
    assert quick(up, tree).status is Status.CONTACT
    assert quick(tree, up, 0.0).status is Status.SEPARATED
    assert quick(tree, tree, accuracy=Accuracy(max_iterations=1)).status is Status.UNRESOLVED


@pytest.mark.parametrize(
    ("call", "error", "text"),
    [
        (
            lambda _: quick(),
            TypeError,
            r"collide\(\) missing 2 required positional arguments: 'a' and 'b'",
        ),
        (lambda t: quick(t), TypeError, r"collide\(\) missing 1 required positional argument: 'b'"),
        (lambda t: quick(t, t, nonsense=1), TypeError, "unexpected keyword argument 'nonsense'"),
        (
            lambda t: quick(t, 7),
            MotionError,
            "shape: is of type int; pass an ObbTree, a Mesh, a Part or a path",
        ),
        (lambda t: quick(t, None), MotionError, "shape: is of type NoneType"),
        (lambda t: quick("nowhere.stl", t), MeshError, "nowhere.stl: no such file"),
        (
            lambda t: quick(t, Body(t, Pose(translation=[1e308, 0, 0]))),
            MotionError,
            "pose: posed coordinates would exceed the range of double",
        ),
    ],
)
def test_errors_are_those_of_the_function(tree, call, error, text):
    with pytest.raises(error, match=text):
        call(tree)


def test_property_that_raises_is_not_hidden():
    class Broken:
        bounds = None

        @property
        def at_rest(self) -> None:
            raise RuntimeError("broken")

    with pytest.raises(RuntimeError, match="broken"):
        quick(Broken(), Broken())
