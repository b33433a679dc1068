"""Answers name the selected parts that their triangles are of, however they were asked for.

A file holds cubes of 12 faces each, one after the other, so that row r of a selection is of its
part number r // 12.
"""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest
from mesh_files.cube_files import objects

import obbcli
from obbcli import Accuracy, Body, Motion, ObbTree, Pose, Scene

# Where each cube begins along x.
PLACES = {"base": 0.0, "arm": 1.0, "tip": 10.0}


@pytest.fixture
def robot(tmp_path):
    """Write a file of cubes: arm touches base, tip is far off."""
    path = tmp_path / "robot.obj"
    path.write_text(objects(**PLACES))
    return path


def kinds_of(selection):
    """Return a selection as each kind of shape that a question takes."""
    mesh = obbcli.load_mesh(selection)
    built = ObbTree.build(mesh)
    data = ObbTree.from_bytes(built.to_bytes())
    return {
        "path": str(selection),
        "mesh": mesh,
        "tree": built,
        "file": data,
        "body": Body(built),
        "posed": Body(built, Pose(translation=[0, 0, 0])),
    }


KINDS = ("path", "mesh", "tree", "file", "body", "posed")


def part_of(row, names):
    return None if row is None else names[row // 12]


def assert_named(answer, names_a, names_b):
    rows = answer.witness if hasattr(answer, "witness") else (answer.triangle_a, answer.triangle_b)
    a, b = rows or (None, None)
    assert (answer.part_a, answer.part_b) == (part_of(a, names_a), part_of(b, names_b))


@pytest.mark.parametrize("kind", KINDS)
def test_bodies_at_rest_name_their_parts(robot, kind):
    a = kinds_of(f"{robot}#[bt]*")[kind]
    b = kinds_of(f"{robot}#[at]*")[kind]
    names = ("base", "tip"), ("arm", "tip")

    yes, first = obbcli.collide(a, b), obbcli.first_contact(a, b)

    assert yes.witness is not None
    assert_named(yes, *names)
    assert_named(first, *names)
    for contact in obbcli.contacts(a, b):
        assert_named(contact, *names)


@pytest.mark.parametrize("kind", KINDS)
def test_only_selected_parts_are_named(robot, kind):
    arms = kinds_of(f"{robot}#[at]*")[kind]
    whole = kinds_of(robot)[kind]
    other = Body(ObbTree.build(str(robot)), Pose(translation=[0, 0.5, 0]))

    assert obbcli.collide(arms, other).part_a in ("arm", "tip")
    assert obbcli.collide(arms, other).part_b is None
    assert (obbcli.collide(whole, other).part_a, obbcli.collide(whole, other).part_b) == (None,) * 2


def test_what_does_not_touch_has_no_parts(robot):
    apart = obbcli.collide(f"{robot}#base", f"{robot}#tip")

    assert (apart.status.value, apart.part_a, apart.part_b) == ("separated", None, None)


@pytest.mark.parametrize(
    "motion",
    [
        Motion([-8.5, 0, 0]),
        Motion.through([0.0, 1.0], [Pose(), Pose(translation=[-8.5, 0, 0])]),
        Motion.through([0, 1, 2], [Pose(), Pose([0, 0, 0.1], [-3, 0, 0]), Pose(None, [-9, 0, 0])]),
    ],
    ids=["steady", "poses", "turning"],
)  # fmt: skip
def test_moving_bodies_name_their_parts(robot, motion):
    a = Body(f"{robot}#tip", motion=motion)
    b = f"{robot}#[ab]*"
    names = ("tip",), ("base", "arm")

    answers = [obbcli.collide(a, b), obbcli.first_contact(a, b), *obbcli.contacts(a, b)]

    assert len(answers) > 3
    for answer in answers:
        assert answer.part_a == "tip"
        assert_named(answer, *names)
    # The arm ends at x = 2, the base at 1: the arm is met first.
    assert answers[1].part_b == "arm"


def test_sampled_and_coarse_answers_name_what_they_know(robot):
    a = Body(f"{robot}#tip", motion=Motion([-8.5, 0, 0]))
    sampled = obbcli.first_contact(a, f"{robot}#[ab]*", 1.0, Accuracy(method="sampled", steps=9))
    boxes = obbcli.first_contact(a, f"{robot}#[ab]*", 1.0, Accuracy(max_depth_a=0, max_depth_b=0))

    assert sampled.triangle_b is not None
    assert_named(sampled, ("tip",), ("base", "arm"))
    assert (boxes.evidence, boxes.part_a, boxes.part_b) == ("boxes", None, None)


def test_distance_names_the_parts_of_its_triangles(robot):
    found = obbcli.distance(f"{robot}#tip", f"{robot}#[ab]*")

    assert (found.part_a, found.part_b) == ("tip", "arm")
    assert_named(found, ("tip",), ("base", "arm"))
    assert obbcli.distance(str(robot), f"{robot}#tip").part_b == "tip"


def test_scenes_name_the_parts_of_their_bodies(robot):
    bodies = {"left": f"{robot}#[bt]*", "right": f"{robot}#[at]*", "all": str(robot)}

    first = {(one.body_a, one.body_b): one for one in Scene(bodies).first_contacts()}
    every = list(Scene(bodies).contacts(pairs=[("left", "right")]))

    assert first["left", "right"].part_a in ("base", "tip")
    assert first["right", "all"].part_a in ("arm", "tip")
    assert first["right", "all"].part_b is None
    for one in [first["left", "right"], *every]:
        assert (one.part_a, one.part_b) == (one.contact.part_a, one.contact.part_b)
        assert_named(one.contact, ("base", "tip"), ("arm", "tip"))


@pytest.mark.parametrize("threads", [1, 2])
def test_sweeps_have_columns_of_parts(robot, threads):
    a, b = f"{robot}#tip", f"{robot}#[ab]*"
    motions = [Motion([-speed, 0, 0]) for speed in (1, 8.5, 9.5)]
    path = Motion.through([0.0, 1.0], [Pose(), Pose(translation=[-9, 0, 0])])

    rows = obbcli.sweep(a, b, [*motions, path], threads=threads)

    assert rows["status"].tolist() == ["separated", "contact", "contact", "contact"]
    assert rows["part_a"].tolist() == ["", "tip", "tip", "tip"]
    assert rows["part_b"].tolist() == [
        "",
        *(("base", "arm")[t // 12] for t in rows["triangle_b"][1:]),
    ]
    assert "arm" in rows["part_b"]


def test_sweeps_of_whole_files_have_empty_columns_of_parts(robot):
    rows = obbcli.sweep(str(robot), str(robot), [Motion()])

    assert (rows["part_a"].tolist(), rows["part_b"].tolist()) == ([""], [""])
    both = np.concatenate([rows, obbcli.sweep(f"{robot}#base", f"{robot}#arm", [Motion()])])
    assert both["part_b"].tolist() == ["", "arm"]


def test_a_part_without_a_name_is_named_so(tmp_path):
    path = tmp_path / "plain.obj"
    path.write_text(objects(base=0.0).split("\n", 1)[1])

    assert obbcli.collide(f"{path}#**", str(path)).part_a == ""


def test_answers_stay_values(robot):
    a, b = ObbTree.build(f"{robot}#base"), ObbTree.build(f"{robot}#arm")
    for ask in (obbcli.collide, obbcli.first_contact, obbcli.distance):
        answer = ask(a, b)

        assert pickle.loads(pickle.dumps(answer)) == answer  # our own bytes
        assert replace(answer, part_b="other").part_a == "base"
        assert "part_b='arm'" in repr(answer)
        assert replace(answer, part_b="other") != answer


def test_trees_tell_the_part_of_a_row(robot):
    tree = ObbTree.build(f"{robot}#**")

    assert [tree.part_of(row) for row in (0, 11, 12, 35)] == ["base", "base", "arm", "tip"]
    assert tree.part_of(None) is None
    assert ObbTree.build(str(robot)).part_of(0) is None
