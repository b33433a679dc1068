"""Scenes whose contacts follow from a formula: cubes and spheres on known courses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from meshes.surfaces import sphere
from scenes.random_scenes import CUBE

from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Pose, Scene, SceneBody, Status

TURN = 2 * math.pi


def cube(*place: float, velocity: tuple[float, ...] = (0, 0, 0), spin: float = 0.0) -> Body:
    """Return a cube of edge 2 that moves and turns about z."""
    return Body(CUBE, Pose(translation=place), Motion(velocity, [0, 0, spin]))


def found(scene: Scene, **asked: object) -> list[tuple[str, str, float]]:
    """Return names and times."""
    contacts = scene.first_contacts(**asked)  # type: ignore[arg-type]
    return [(one.body_a, one.body_b, one.time) for one in contacts]


def test_cubes_in_a_row_are_hit_one_after_the_other() -> None:
    row = {f"cube {k}": cube(10 * k, 0, 0) for k in range(5)}
    scene = Scene({**row, "bullet": cube(-7, 0.5, 0, velocity=(16, 0, 0))}, duration=2.5)

    # From -7 the bullet reaches 10 k - 2; it has gone 40 when time is over.
    times = [(f"cube {k}", "bullet", (10 * k + 5) / 16) for k in range(4)]
    assert found(scene) == times
    assert found(scene, first=True) == times[:1]


def test_equal_times_come_in_the_order_of_the_bodies() -> None:
    bodies = {"c": cube(0, 0, 0), "a": cube(4, 0, 0, velocity=(-4, 0, 0))}
    bodies |= {"b": cube(0, 4, 0, velocity=(0, -4, 0)), "d": cube(-4, 0, 0, velocity=(4, 0, 0))}

    scene = Scene(bodies)

    assert found(scene)[:3] == [("c", "a", 0.5), ("c", "b", 0.5), ("c", "d", 0.5)]
    assert found(scene, first=True) == [("c", "a", 0.5)]


def test_spinning_spheres_meet_when_centers_are_near_enough() -> None:
    surface = sphere(2000)
    ball = Mesh(surface.vertices, surface.faces)
    radius = float(np.linalg.norm(ball.vertices, axis=1).max())
    bodies = {}
    for k in range(6):
        motion = Motion([-(k + 1), 0, 0], [3, k, -2], [10, 10 * k, 0])
        bodies[f"still {k}"] = Body(ball, Pose(translation=[0, 10 * k, 0]))
        bodies[f"ball {k}"] = Body(ball, Pose(translation=[10, 10 * k, 0]), motion)
    scene = Scene(bodies, duration=20)

    contacts = found(scene)

    assert [names for *names, _ in contacts] == [
        [f"still {k}", f"ball {k}"] for k in reversed(range(6))
    ]
    for k, (*_, time) in zip(reversed(range(6)), contacts, strict=True):
        # The facets are a little inside of the spheres.
        assert (10 - 2 * radius) / (k + 1) <= time <= (10 - 2 * 0.99 * radius) / (k + 1)


def test_turning_bar_meets_the_posts_around_it_in_order() -> None:
    bar = Mesh(CUBE.vertices * [8, 0.25, 0.5], CUBE.triangles)
    post = Mesh(CUBE.vertices * [0.25, 0.25, 4], CUBE.triangles)
    angles = [0.3 * TURN, 0.1 * TURN, 0.45 * TURN, 0.2 * TURN]
    posts = {
        f"post {k}": Body(post, Pose([0, 0, a], [6 * math.cos(a), 6 * math.sin(a), 0]))
        for k, a in enumerate(angles)
    }
    scene = Scene({**posts, "bar": Body(bar, motion=Motion(None, [0, 0, TURN]))}, duration=0.45)

    # The bar's edge is 1/4 before its axis, and so is a post's inner corner, 5.75 from the center.
    early = 2 * math.atan2(0.25, 5.75)
    expected = sorted((a - early) / TURN % 0.5 for a in angles)
    assert [time for *_, time in found(scene)] == pytest.approx(expected, abs=1e-9)
    assert [name for name, *_ in found(scene)] == ["post 1", "post 3", "post 0", "post 2"]


def test_bracket_that_begins_early_is_in_its_place() -> None:
    # One turns about its course: it is met at t = 1/2, and its bracket is wide.
    turning = Body(CUBE, Pose(translation=[5, 40.3, 0.2]), Motion([-6, 0, 0], [5, 0, 0]))
    pair, accuracy = {"c": cube(0, 40, 0), "d": turning}, Accuracy(time_tolerance=0.2)
    (*_, low), *_ = found(Scene(pair, accuracy=accuracy))
    assert 0.49 < low < 0.5
    # The other meets after the bracket begins, and before bounds let the first two meet.
    time = 0.25 + 0.5 * low
    straight = cube(2 + 6 * time, 0.3, 0.2, velocity=(-6, 0, 0))

    contacts = found(Scene({"a": cube(0, 0, 0), "b": straight, **pair}, accuracy=accuracy))

    assert contacts == [("c", "d", low), ("a", "b", pytest.approx(time, abs=1e-15))]
    assert low < contacts[1][2]


def test_clearance_is_kept_between_all_pairs() -> None:
    bodies = {"a": cube(0, 0, 0), "b": cube(4, 0, 0, velocity=(-1, 0, 0)), "c": cube(0, 0, 2.5)}

    assert found(Scene(bodies)) == []
    near = found(Scene(bodies, accuracy=Accuracy(clearance=1.25)))
    assert near == [("a", "c", 0.0), ("a", "b", pytest.approx(0.75)), ("b", "c", near[2][2])]


def test_body_that_comes_back_is_met_on_its_way_back() -> None:
    there = [Pose(), Pose(translation=[20, 0, 0]), Pose(translation=[20, 8, 0])]
    path = Motion.through([0, 1, 2, 3], [*there, Pose(translation=[0, 8, 0])])
    posts = {"on the way back": cube(10, 9, 0), "nowhere": cube(10, 4, 0)}

    assert found(Scene({"walker": Body(CUBE, motion=path), **posts})) == [
        ("walker", "on the way back", pytest.approx(2.4))
    ]


def test_default_duration_is_the_longest_of_all_motions() -> None:
    path = Motion.through([0, 4], [Pose(), Pose(translation=[1, 0, 0])])
    moving, still = cube(0, 0, 0, velocity=(1, 0, 0)), cube(0, 9, 0)

    assert Scene({"a": still, "b": cube(0, 0, 9)}).duration == 0
    assert Scene({"a": still, "b": moving}).duration == 1
    assert Scene({"a": still, "b": moving, "c": Body(CUBE, motion=path)}).duration == 4
    assert Scene({"a": moving}, duration=2).duration == 2


def test_static_bodies_are_not_asked_about_each_other_and_resting_ones_are() -> None:
    bodies = [
        SceneBody("floor", cube(0, 0, 0), static=True),
        SceneBody("wall", cube(1, 0, 0), static=True),
        SceneBody("crate", cube(0, 1, 0)),
    ]

    scene = Scene(bodies)

    assert found(scene) == [("floor", "crate", 0.0), ("wall", "crate", 0.0)]
    contacts = scene.first_contacts()
    assert {one.status for one in contacts} == {Status.OVERLAP_AT_START}
    assert contacts.stats.static == 1


def test_ignored_pairs_and_groups_are_left_out() -> None:
    groups = {"a": "g", "b": "g", "c": "h", "d": "h", "e": None}
    bodies = [SceneBody(name, cube(0, 0, 0), group=group) for name, group in groups.items()]

    def pairs(*ignore: dict[str, list[str]]) -> list[str]:
        return [a + b for a, b, _ in found(Scene(bodies, ignore))]

    every = ["ab", "ac", "ad", "ae", "bc", "bd", "be", "cd", "ce", "de"]
    assert pairs() == every
    assert pairs({"groups": ["g"]}) == [pair for pair in every if pair != "ab"]
    assert pairs({"groups": ["g", "h"]}) == ["ab", "ae", "be", "cd", "ce", "de"]
    assert pairs({"bodies": ["e", "a"]}) == [pair for pair in every if pair != "ae"]
    both = Scene(bodies, [{"bodies": ["a", "b"]}, {"groups": ["g"]}, {"bodies": ["a", "e"]}])
    assert both.first_contacts().stats.ignored == 2


def test_one_body_touches_nothing() -> None:
    contacts = Scene({"alone": ObbTree.build(CUBE)}).first_contacts()

    assert list(contacts) == []
    assert contacts.stats.pairs == 0
