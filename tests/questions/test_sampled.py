"""The sampled method's answers: convergence, misses, bounds on true surfaces, limits, agreement."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from movers.meshes import angle_bar, box, cube, octahedron, star, tetrahedron
from oracles.mesh import mesh_distance_squared
from scenes.pairs import random_rotation

import obbcli
from obbcli import Accuracy, Body, FirstContact, Mesh, Motion, ObbTree, Pose, Status

if TYPE_CHECKING:
    from obbcli.accuracy import Integrator

INTEGRATORS: tuple[Integrator, ...] = ("exact", "euler", "rk4")
CUBE = Mesh(*cube())
# Its upper edge comes to a height of 2 sin x + cos x / 16 after a turn by x.
ARM = Mesh(*box((0.0, -0.0625, -0.0625), (2.0, 0.0625, 0.0625)))
SHELF = Mesh(*box((-8.0, 1.0, -9.0), (8.0, 2.0, 10.0)))
HITS = math.asin(1 / math.hypot(2, 0.0625)) - math.atan2(0.0625, 2)


def sampled(steps: int, integrator: Integrator = "exact", **more: Any) -> Accuracy:
    return Accuracy(method="sampled", steps=steps, integrator=integrator, **more)


def swing(speed: float = 1.0) -> Body:
    """Return an arm that turns about z, and hits the shelf after a turn by `HITS`."""
    return Body(ARM, motion=Motion(None, (0, 0, speed), (0, 0, 0)))


def random_pair(seed: int, meshes: Any = (cube, octahedron, tetrahedron)) -> tuple[Body, Body]:
    """Return two bodies that turn, and mostly meet within 2 s."""
    draw = np.random.default_rng(seed)
    bodies = []
    for side in (-1, 1):
        place = np.array([2.2 * side, 0, 0]) + draw.normal(size=3) * 0.3
        velocity = np.array([-1.2 * side, 0, 0]) + draw.normal(size=3) * 0.5
        motion = Motion(velocity, draw.normal(size=3), place + draw.normal(size=3) * 0.2)
        tree = ObbTree.build(Mesh(*meshes[draw.integers(len(meshes))]()), leaf_size=2)
        bodies.append(Body(tree, Pose(random_rotation(seed * 2 + 1 + side), place), motion))
    return bodies[0], bodies[1]


def gap_at(a: Body, b: Body, time: float) -> float:
    """Return the exact distance of two moving bodies' vertices posed at a time in closed form."""
    surfaces: list[Any] = []
    for body in (a, b):
        tree = body.shape
        assert isinstance(tree, ObbTree)
        pose = body.motion.pose_at(time, body.pose)
        surfaces += [pose.apply(tree.vertices), tree.mesh.triangles]
    return math.sqrt(mesh_distance_squared(*surfaces)[0])


def at(answer: FirstContact) -> float:
    assert answer.status is Status.CONTACT
    assert answer.evidence == "sampled"
    assert answer.approximate
    assert answer.time is not None
    assert answer.time_bounds is not None
    assert answer.time_bounds[0] == answer.time
    return answer.time


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_time_comes_nearer_to_the_true_one_with_every_step(integrator: Integrator):
    for steps in (10, 100, 1000):
        answer = obbcli.first_contact(swing(), SHELF, 1.0, sampled(steps, integrator))

        # The frame lags by up to a step; Euler's by a third of the cube of each step's angle more.
        assert -1e-12 <= at(answer) - HITS <= (1 if integrator == "exact" else 1.2) / steps
        assert 0 < answer.error_bound <= 2.2 / steps


@pytest.mark.parametrize("seed", range(12))
def test_random_times_come_nearer_to_the_proven_ones(seed: int):
    a, b = random_pair(seed)
    truth = obbcli.first_contact(a, b, 2.0)
    answers = [obbcli.first_contact(a, b, 2.0, sampled(steps)) for steps in (20, 2000)]

    assert [answer.status for answer in answers] == [truth.status] * 2
    assert answers[1].error_bound < 0.02
    if truth.time is not None:
        assert abs(at(answers[1]) - truth.time) <= 2e-3
        assert answers[1].triangle_a is not None


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_surfaces_are_as_near_as_a_contact_claims(integrator: Integrator):
    contacts = 0
    for seed in range(60):
        a, b = random_pair(seed)
        steps = (1, 2, 5, 30)[seed % 4]
        more = ({}, {"max_depth_a": 1}, {"leaves": "boxes"})[seed % 3]

        answer = obbcli.first_contact(a, b, 2.0, sampled(steps, integrator, **more))

        if answer.status is Status.CONTACT:
            contacts += 1
            assert gap_at(a, b, at(answer)) <= answer.error_bound + 1e-12
    assert contacts > 30


def test_contact_between_two_samples_is_missed_and_the_bound_allows_for_it():
    # Half a turn: the arm is through a post at a quarter before the second sample.
    post = Mesh(*box((-0.25, 1.0, -0.25), (0.25, 1.5, 0.25)))
    truth = obbcli.first_contact(swing(math.pi), post, 1.0)
    blind = obbcli.first_contact(swing(math.pi), post, 1.0, sampled(1))
    seeing = obbcli.first_contact(swing(math.pi), post, 1.0, sampled(30))

    assert truth.status is Status.CONTACT
    assert blind.status is Status.SEPARATED
    assert blind.approximate
    assert not blind.collides
    assert blind.error_bound == pytest.approx(2 * math.hypot(2, 0.0625), rel=1e-9)
    assert truth.time is not None
    assert at(seeing) >= truth.time


def test_jump_to_the_next_frame_is_contact_when_it_comes():
    answer = obbcli.first_contact(swing(), SHELF, 1.0, sampled(10))

    # Frames at 0, 0.1, ..: the first that reaches the shelf is at 0.5, and nothing else moves.
    assert answer.time_bounds == (0.5, 0.5)
    assert answer.distance == 0
    assert answer.triangle_a is not None


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("steps", [1, 7])
def test_bodies_that_do_not_turn_are_answered_as_proven(integrator: Integrator, steps: int):
    a = Body(CUBE, Pose((0.1, 0.2, 0.3), (0, 0, 5)), Motion((0.1, 0, -2)))
    for duration in (1.0, 4.0):
        truth = obbcli.first_contact(a, CUBE, duration)

        answer = obbcli.first_contact(a, CUBE, duration, sampled(steps, integrator))

        assert answer.status is truth.status
        assert answer.time_bounds == truth.time_bounds
        assert (answer.point, answer.feature) == (truth.point, truth.feature)
        assert answer.approximate
        assert answer.error_bound == 0


def test_contact_at_the_start_is_exact_and_proven():
    spin = Motion((0, 0, 1), (1, 2, 3))
    for start in (Pose(translation=(2, 0, 0)), Pose((0, 0, 1), (1, 0, 0))):
        truth = obbcli.first_contact(Body(CUBE, start, spin), CUBE)

        answer = obbcli.first_contact(Body(CUBE, start, spin), CUBE, None, sampled(5))

        assert answer == answer.__class__(**{**vars(truth), "stats": answer.stats})
        assert answer.status is Status.OVERLAP_AT_START
        assert (answer.evidence, answer.approximate, answer.error_bound) == (
            "intersecting", False, 0)  # fmt: skip


@pytest.mark.parametrize("duration", [0, 1])
def test_rest_is_not_sampled(duration: float):
    turning = Motion(None, (0, 0, 3) if duration == 0 else None)
    away = Body(CUBE, Pose(translation=(5, 0, 0)), turning)

    answer = obbcli.first_contact(away, CUBE, duration, sampled(5))
    collision = obbcli.collide(away, CUBE, duration, sampled(5))

    assert answer.status is collision.status is Status.SEPARATED
    assert not answer.approximate
    assert not collision.approximate


def test_clearance_counts_on_sampled_paths():
    fall = Body(CUBE, Pose(translation=(0, 9.5, 0)), Motion((0, -2, 0), (0, 1, 0)))

    answer = obbcli.first_contact(fall, SHELF, 10.0, sampled(50, clearance=0.5))

    # About the axis it turns about the cube is as high as it ever was: 6.5 above the shelf.
    assert at(answer) == pytest.approx(3.0, abs=1e-8)
    assert answer.distance == pytest.approx(0.5)


@pytest.mark.parametrize("limits", [{"max_depth_a": 0, "max_depth_b": 0}, {"leaves": "boxes"}])
def test_boxes_stand_for_triangles_on_sampled_paths(limits: Any):
    tree = ObbTree.build(Mesh(*star()), leaf_size=100)
    a = Body(tree, Pose(translation=(0, 0, 9)), Motion((0, 0, -1), (0, 0, 1)))

    whole = obbcli.first_contact(a, tree, 10.0, sampled(20))
    answer = obbcli.first_contact(a, tree, 10.0, sampled(20, **limits))

    assert at(answer) <= at(whole)
    assert answer.feature == "box"
    assert answer.time_bounds == (answer.time, None)
    assert answer.triangle_a is None
    assert answer.error_bound > whole.error_bound


@pytest.mark.parametrize("seed", range(8))
def test_collide_and_first_contact_agree(seed: int):
    a, b = random_pair(seed + 50, (angle_bar, star, cube))
    for integrator in INTEGRATORS:
        accuracy = sampled(9, integrator)

        found = obbcli.first_contact(a, b, 2.0, accuracy)
        collision = obbcli.collide(a, b, 2.0, accuracy)

        assert collision.status is found.status
        assert collision.approximate
        assert (collision.witness is None) == (found.triangle_a is None)
        assert collision.error_bound == found.error_bound


def test_path_is_sampled_on_the_whole_clock():
    # Rests for a second, turns a quarter by 3 s, then falls: the shelf's top is at 2.
    poses = [Pose(None, (0, 8, 0)), Pose(None, (0, 8, 0)), Pose((0, 1, 0), (0, 8, 0)),
             Pose((0, 1, 0), (0, 0, 0))]  # fmt: skip
    fall = Body(CUBE, motion=Motion.through([0, 1, 3, 7], poses))

    answer = obbcli.first_contact(fall, SHELF, None, sampled(700))
    corner = obbcli.first_contact(fall, SHELF, None, sampled(1))

    assert at(answer) == pytest.approx(5.5, abs=1e-9)
    assert answer.error_bound < 0.02
    assert at(corner) == pytest.approx(7 * 5 / 8, abs=1e-9)
    assert corner.error_bound > 3


def test_bound_is_that_of_the_worst_step():
    # Turns by an eighth in the first second of two; then the frame is as it should be again.
    poses = [Pose(), Pose((0, 0, math.pi / 4))]
    apart = Body(CUBE, Pose(translation=(9, 0, 0)))
    rests = obbcli.first_contact(Body(CUBE, motion=Motion.through([0, 1], poses)), apart, 2.0,
                                 sampled(2))  # fmt: skip
    # Euler's frames drift further off with every step.
    turn = Motion(None, (0.5, 0.7, 1.9))
    first, last = (
        obbcli.first_contact(Body(CUBE, motion=turn), apart, time, sampled(count, "euler"))
        for time, count in ((0.1, 1), (5.0, 50))
    )

    assert rests.error_bound == pytest.approx(2 * math.sqrt(2) * math.sin(math.pi / 8))
    assert last.error_bound > 2 * first.error_bound


def test_only_steps_up_to_the_contact_are_asked():
    early = obbcli.first_contact(swing(), SHELF, 1.0, sampled(100))
    late = obbcli.first_contact(swing(), SHELF, 1e4, sampled(10**6))

    assert early.stats.pops == late.stats.pops
    assert at(late) == pytest.approx(at(early))


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_query_goes_on_pop_by_pop_to_the_same_answer(integrator: Integrator):
    a, b = random_pair(3)
    accuracy = sampled(40, integrator)
    whole = obbcli.first_contact(a, b, 2.0, accuracy)
    query = obbcli.Query(a, b, 2.0, accuracy)
    times = [query.time]

    while not query.is_finished:
        found = query.advance(2)
        times.append(query.time)
        assert query.lower_bound == 0
        if not query.is_finished:
            assert found.status is Status.UNRESOLVED
            assert found.time_bounds == (0, None)

    assert times == sorted(times)
    assert times[-1] == pytest.approx(at(whole), abs=2 / 40)
    assert found.time_bounds == whole.time_bounds
    assert found.error_bound == whole.error_bound


def test_limits_leave_nothing_proven():
    many = obbcli.first_contact(swing(1e-6), SHELF, 1.0, sampled(10**9, max_iterations=1000))
    late = obbcli.first_contact(swing(1e-6), SHELF, 1.0, sampled(10**9, timeout=0.01))

    for answer in (many, late):
        assert answer.status is Status.UNRESOLVED
        assert answer.time_bounds == (0, None)
    assert many.stats.pops <= 1010


def test_one_tree_may_be_both_bodies():
    tree = ObbTree.build(CUBE)
    a = Body(tree, Pose(translation=(-3, 0, 0)), Motion(None, (0, 0, 1)))
    b = Body(tree, Pose(translation=(3, 0, 0)), Motion((-4, 0, 0), (0, 0, -1)))

    answer = obbcli.first_contact(a, b, 2.0, sampled(200))

    # Both are turned by t against each other: corners at sqrt 2 cos(pi / 4 - t) meet.
    truth = obbcli.first_contact(a, b, 2.0)
    assert truth.time is not None
    assert at(answer) == pytest.approx(truth.time, abs=0.02)
