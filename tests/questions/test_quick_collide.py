"""`collide` as a function: what stands before it answers bodies at rest and hides nothing."""

from __future__ import annotations

import copy
import functools
import inspect
import pickle
import pydoc
import signal
import weakref

import numpy as np
import pytest

import obbcli
from obbcli import Accuracy, Body, Collision, MeshError, Motion, MotionError, ObbTree, Pose, Status
from obbcli import collide as quick
from obbcli.questions import collide as module

GEAR = "sample_meshes/gear.stl"


@pytest.fixture(scope="module")
def tree() -> ObbTree:
    return ObbTree.build(GEAR, lazy=False)


def test_function_looks_as_it_is_written():
    assert quick.__name__ == quick.__qualname__ == "collide"
    assert quick.__module__ == "obbcli.questions.collide"
    assert quick.__doc__.startswith("Return whether two bodies touch")
    assert list(inspect.signature(quick).parameters) == ["a", "b", "duration", "accuracy", "solid"]
    assert inspect.unwrap(quick) is quick.__wrapped__
    assert inspect.isroutine(quick)
    assert callable(quick)
    assert repr(quick).startswith("<function collide at ")
    shown = pydoc.plain(pydoc.render_doc(quick))
    assert "collide(a: 'Body | Shape', b: 'Body | Shape', duration: 'float | None' = None" in shown
    assert "Surfaces are closed: touching counts." in shown


def test_function_is_pickled_copied_and_watched_as_functions_are():
    for number in range(pickle.HIGHEST_PROTOCOL + 1):
        assert pickle.loads(pickle.dumps(quick, number)) is quick
    assert copy.copy(quick) is quick
    assert copy.deepcopy(quick) is quick
    assert weakref.ref(quick)() is quick
    assert obbcli.collide is module.collide is quick


def test_function_is_bound_where_it_is_a_method(tree):
    class Asked(Body):
        touches = quick

    assert Asked(tree).touches(tree).collides
    assert Asked.touches is quick
    assert functools.partial(quick, tree)(tree).collides


def test_answers_are_those_of_the_function(tree):
    rng = np.random.default_rng(3)
    for _ in range(60):
        poses = [Pose(rng.normal(size=3), 25 * rng.normal(size=3)) for _ in range(2)]
        a, b = (Body(tree, pose) for pose in poses)

        found, asked = quick(a, b), quick.__wrapped__(a, b)

        assert type(found) is Collision
        assert found.status is asked.status
        assert found.witness == asked.witness
        assert found.stats.counts == asked.stats.counts
        assert found.stats[4:8] == asked.stats[4:8]
        assert quick(a, b=b).witness == quick(a=a, b=b).witness == found.witness


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


def ask_for_ever(a: ObbTree, b: Body) -> None:
    while True:
        quick(a, b)


def test_handler_of_a_signal_ends_a_question():
    class StopError(Exception):
        pass

    def stop(*_: object) -> None:
        raise StopError

    # Two sheets that cross nowhere near their middles: millions of pairs of boxes.
    angles = np.linspace(0, 2 * np.pi, 60001)[:-1]
    ring = np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    vertices = np.concatenate([ring, ring * [0.9, 0.9, 1] + [0, 0, 0.2]])
    n = len(angles)
    rows = np.arange(n)
    faces = np.column_stack([rows, (rows + 1) % n, rows + n])
    tree = ObbTree.build(obbcli.Mesh(vertices, faces), lazy=False)
    near = Body(tree, Pose(translation=[0, 0, 1e-9]))
    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, 0.02)
    try:
        with pytest.raises(StopError):
            ask_for_ever(tree, near)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_seconds_of_a_question_that_ended_at_once_are_zero(tree):
    far = Body(tree, Pose(translation=[500, 0, 0]))

    assert quick(tree, far).stats.seconds == {"load": 0.0, "query": 0.0}


def test_seconds_of_a_question_that_goes_on_are_measured():
    here = Body(ObbTree.build(GEAR))
    there = Body(ObbTree.build(GEAR), Pose([0, 0, 0.01]))

    stats = quick(here, there).stats

    assert stats.pops > 0
    assert stats.seconds["query"] > 0
