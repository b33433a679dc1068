"""How quick calls of the kernels run: signals end them, seconds are told, any may be the first."""

from __future__ import annotations

import signal
import subprocess
import sys

import numpy as np
import pytest

import obbcli
from obbcli import Body, ObbTree, Pose
from obbcli import collide as quick

GEAR = "sample_meshes/gear.stl"


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


def test_seconds_of_a_question_that_ended_at_once_are_zero():
    tree = ObbTree.build(GEAR, lazy=False)
    far = Body(tree, Pose(translation=[500, 0, 0]))

    assert quick(tree, far).stats.seconds == {"load": 0.0, "query": 0.0}


def test_seconds_of_a_question_that_goes_on_are_measured():
    here = Body(ObbTree.build(GEAR))
    there = Body(ObbTree.build(GEAR), Pose([0, 0, 0.01]))

    stats = quick(here, there).stats

    assert stats.pops > 0
    assert stats.seconds["query"] > 0


def test_a_first_contact_is_the_first_question_of_a_process() -> None:
    code = """
import numpy as np
from obbcli import Body, Mesh, Motion, ObbTree, Pose, first_contact
corners = [(i, j, k) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4)]
faces += [(2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]
tree = ObbTree.build(Mesh(np.array(corners, float), faces), lazy=False)
for x in (0.5, 1.0, 1.01, 3.0):
    print(first_contact(tree, Body(tree, Pose((0.3, -0.2, 0.5), (x, 0.1, -0.2)))).status)
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)

    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout.split() == ["overlap_at_start"] * 3 + ["separated"]


def test_kernels_refuse_to_answer_before_they_know_the_class_of_answers() -> None:
    code = """
from obbcli import Mesh, ObbTree, Pose, kernels
from obbcli.accuracy import Accuracy
from obbcli.questions.border import limits_of
tree = ObbTree.build(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), lazy=False)
placed = kernels.Placed(tree.kernel, Pose().kernel)
kernels.collide(placed, placed, limits_of(Accuracy()), 0.0)
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)

    assert ended.returncode == 1
    assert "set_answer_classes() comes before questions at rest" in ended.stderr
