"""Steps of frozen orientation: modelled paths against true ones, within what is claimed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest
from movers.meshes import angle_bar, box, cube, octahedron, star, tetrahedron
from oracles.rigid import rigid_point

from obbcli import Accuracy, Body, Mesh, Motion, MotionError, ObbTree, Pose, Status, first_contact
from obbcli.questions.legs.steps import steps_of
from obbcli.questions.pair_question import PairQuestion

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from obbcli.questions.legs.leg import Leg

    Path = Callable[[float], NDArray[np.float64]]

TREES = [ObbTree.build(Mesh(*make())) for make in (angle_bar, cube, octahedron, star, tetrahedron)]
INTEGRATORS = ("exact", "euler", "rk4")


class Moving(NamedTuple):
    """A body and where its vertices truly are, of closed forms in doubles."""

    body: Body
    path: Path


def turn(vector: Any) -> NDArray[np.float64]:
    """Return a rotation matrix by the formula of Rodrigues."""
    angle = float(np.linalg.norm(vector))
    if angle == 0:
        return np.eye(3)
    x, y, z = np.asarray(vector) / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix: NDArray[np.float64] = (
        np.eye(3) + math.sin(angle) * cross + 2 * math.sin(angle / 2) ** 2 * cross @ cross
    )
    return matrix


def screw(draw: np.random.Generator, turns: float) -> Moving:
    """Return a body at constant velocities that turns by about so many turns a second."""
    tree = TREES[draw.integers(len(TREES))]
    start, place = turn(draw.normal(size=3)), draw.normal(size=3) * 3
    pivot = place + draw.normal(size=3) * draw.choice([0.0, 0.3, 3.0])
    velocity, spin = draw.normal(size=3), draw.normal(size=3) * 2 * math.pi * turns
    if draw.integers(4) == 0:
        spin *= np.eye(3)[draw.integers(3)]

    def path(time: float) -> NDArray[np.float64]:
        arms = tree.vertices @ start.T + (place - pivot)
        return pivot + time * velocity + arms @ turn(time * spin).T

    return Moving(Body(tree, Pose(start, place), Motion(velocity, spin, pivot)), path)


def through_poses(draw: np.random.Generator, turns: float) -> Moving:
    """Return a body that goes through five poses between 0 and 1 s."""
    tree = TREES[draw.integers(len(TREES))]
    times = np.sort(draw.uniform(0, 1, 5))
    ways = draw.normal(size=(4, 3))
    ways *= np.minimum(turns * 1.5, 3.1 / np.linalg.norm(ways, axis=1))[:, None]
    places = draw.normal(size=(5, 3)) * 2
    frames = [turn(draw.normal(size=3))]
    for way in ways:
        frames.append(turn(way) @ frames[-1])

    def path(time: float) -> NDArray[np.float64]:
        time = min(max(time, times[0]), times[-1])
        k = min(int(np.searchsorted(times, time, "right")) - 1, 3)
        share = (time - times[k]) / (times[k + 1] - times[k])
        center = (1 - share) * places[k] + share * places[k + 1]
        return center + tree.vertices @ (turn(share * ways[k]) @ frames[k]).T

    poses = [Pose(frame, place) for frame, place in zip(frames, places, strict=True)]
    return Moving(Body(tree, motion=Motion.through(times, poses)), path)


def steps(
    bodies: tuple[Body, Body], duration: float, count: int, integrator: Any = "exact"
) -> list[Leg]:
    accuracy = Accuracy(method="sampled", integrator=integrator, steps=count)
    return list(steps_of(PairQuestion.of(*bodies, duration, accuracy)))


def modelled(body: Body, time: float) -> NDArray[np.float64]:
    """Return where a step has its vertices, so long after its start."""
    assert isinstance(body.shape, ObbTree)
    assert not body.motion.angular_velocity.any()
    return body.pose.apply(body.shape.vertices) + time * body.motion.linear_velocity


def worst(leg: Leg, paths: tuple[Path, Path], samples: int) -> float:
    """Return by how much the relative path of any two vertices is seen to be off in a step."""
    off = 0.0
    for time in np.linspace(0, leg.duration, samples):
        both = (
            np.linalg.norm(modelled(body, time) - path(leg.start + time), axis=1).max()
            for body, path in zip(leg.bodies, paths, strict=True)
        )
        off = max(off, sum(map(float, both)))
    return off


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("kinds", [(screw, screw), (screw, through_poses), (through_poses,) * 2])
def test_paths_are_within_what_is_claimed_and_near_it(kinds: Any, integrator: str):
    ratios = []
    for seed in range(130):
        draw = np.random.default_rng(seed)
        turns = 10.0 ** draw.uniform(-3, 0.5)
        a, b = (kind(draw, turns) for kind in kinds)
        found = []
        for leg in steps((a.body, b.body), 1.0, int(draw.choice([1, 2, 3, 7, 20])), integrator):
            seen = worst(leg, (a.path, b.path), 9)
            assert seen <= leg.slack + 1e-13
            found.append((leg.slack, seen))
        # A short last step may be seen too rarely; most of the steps say how wide the bound is.
        ratios.append(max(slack for slack, _ in found) / max(seen for _, seen in found))

    assert np.median(ratios) < 2
    assert np.quantile(ratios, 0.95) < 5
    assert max(ratios) < 10


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_rounding_of_bodies_far_away_is_counted(integrator: str):
    spin, pivot, velocity = (1e-9, 2e-9, -1e-9), (3e9, -7e8, 1.1e9), (5e7, 3e7, -1e8)
    start = Pose((0.1, 0.2, 0.3), (2e9, 1e9, -4e8))
    body = Body(TREES[1], start, Motion(velocity, spin, pivot))
    rest = Body(TREES[0])
    vertices = start.apply(TREES[1].vertices)
    seen = 0.0

    for leg in steps((body, rest), 30.0, 9, integrator):
        points = modelled(leg.bodies[0], 0.0)
        for vertex, point in zip(vertices, points, strict=True):
            truth = rigid_point(vertex, velocity, spin, pivot, leg.start)
            off = math.dist([float(x - y) for x, y in zip(point, truth, strict=True)], (0, 0, 0))
            assert off <= leg.slack
            seen = max(seen, off)

    assert seen > 0


def test_what_rests_or_goes_straight_is_off_by_nothing_or_rounding():
    fan = screw(np.random.default_rng(1), 0.5).body
    alone = steps((fan, fan), 1.0, 4)
    still = steps((fan, Body(TREES[0], Pose(translation=(5, 5, 5)))), 1.0, 4)
    going = steps((fan, Body(TREES[0], motion=Motion((1, 2, 3)))), 1.0, 4)

    for both, one, other in zip(alone, still, going, strict=True):
        assert one.slack == both.slack / 2
        assert one.slack <= other.slack <= one.slack + 1e-12
    assert still[3].bodies[1] is still[0].bodies[1]
    assert np.array_equal(going[3].bodies[1].pose.translation, [0.75, 1.5, 2.25])


def test_bodies_that_do_not_turn_make_one_exact_step():
    a = Body(TREES[0], Pose((1, 2, 3), (4, 5, 6)), Motion((1, 2, 3)))

    (leg,) = steps((a, Body(TREES[1])), 3.0, 100)

    assert leg.slack == 0
    assert (leg.start, leg.duration) == (0, 3)
    assert leg.bodies[0] is a


@pytest.mark.parametrize("turns", [1, 1.5, 12, 1e6])
@pytest.mark.parametrize("count", [1, 3])
def test_steps_longer_than_a_turn_are_off_by_the_diameter(turns: float, count: int):
    # About its corner; the others are up to 2 sqrt(3) from it, 2 sqrt(2) from the axis.
    spin = (0, 0, 2 * math.pi * turns * count)
    body = Body(TREES[1], motion=Motion((1, 0, 0), spin, (-1, -1, -1)))

    slacks = [leg.slack for leg in steps((body, Body(TREES[0])), 1.0, count)]

    assert slacks == pytest.approx([4 * math.sqrt(2)] * count, rel=1e-9)


@pytest.mark.parametrize("count", [1, 2, 8, 100])
def test_frozen_frame_is_off_by_the_chord_of_its_turn(count: int):
    body = Body(TREES[1], motion=Motion((0, 5, 0), (0, 3, 0), (0, 0, 0)))

    for leg in steps((body, Body(TREES[0])), 1.0, count):
        chord = 2 * math.sqrt(2) * math.sin(min(3 / count, math.pi) / 2)
        assert leg.slack == pytest.approx(chord, rel=1e-9)


def test_corner_that_a_chord_cuts_is_counted():
    poses = [Pose(translation=place) for place in ((0, 0, 0), (1, 1, 0), (2, 0, 0))]
    body = Body(TREES[1], motion=Motion.through([0, 1, 2], poses))

    slacks = [
        [leg.slack for leg in steps((body, Body(TREES[0])), 2.0, count)] for count in (1, 2, 3)
    ]

    assert slacks[0] == pytest.approx([1.0], rel=1e-9)
    assert slacks[1] == pytest.approx([0, 0], abs=1e-12)
    assert slacks[2] == pytest.approx([0, 1 / 3, 0], abs=1e-12)


@pytest.mark.parametrize("count", [1, 2, 4])
def test_poses_that_are_not_quite_rigid_are_counted(count: int):
    # From one to the other, and back, the path jumps: no turn makes a cube a little longer.
    crooked = Pose(np.eye(3) + 4e-10 * np.eye(3)[::-1])
    motion = Motion.through([0, 1, 2], [Pose(), crooked, Pose()])

    for leg in steps((Body(TREES[1], motion=motion), Body(TREES[0])), 2.0, count):
        for time in (leg.start, 1.0, leg.start + leg.duration):
            if leg.start <= time <= leg.start + leg.duration:
                truth = motion.pose_at(time).apply(TREES[1].vertices)
                off = modelled(leg.bodies[0], time - leg.start) - truth
                assert np.linalg.norm(off, axis=1).max() <= leg.slack
        assert leg.slack < 5e-9


def test_several_turns_in_a_step_are_off_by_no_more_than_the_diameter():
    poses = [Pose((3.0 * k, 0, 0)) for k in range(5)]
    body = Body(TREES[1], motion=Motion.through(range(5), poses))

    (leg,) = steps((body, Body(TREES[0])), 4.0, 1)

    assert leg.slack == pytest.approx(2 * math.sqrt(3), rel=1e-7)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_integrated_frames_start_from_the_first_pose(integrator: str):
    poses = [Pose((0.3, 0.5, 1.0)), Pose((0.4, 0.8, 1.1))]
    body = Body(TREES[0], motion=Motion.through([0, 1], poses))

    assert max(leg.slack for leg in steps((body, Body(TREES[1])), 1.0, 100, integrator)) < 0.03


def test_frame_of_the_end_is_that_of_the_next_start():
    moving = screw(np.random.default_rng(3), 0.1).body
    assert isinstance(moving.shape, ObbTree)

    for leg in steps((moving, Body(TREES[0])), 2.0, 5):
        truth = moving.motion.pose_at(leg.start, moving.pose)
        np.testing.assert_allclose(leg.bodies[0].pose.rotation, truth.rotation, atol=1e-14)
        np.testing.assert_allclose(leg.bodies[0].pose.translation, truth.translation, atol=1e-13)


@pytest.mark.parametrize(("duration", "count"), [(0.1, 7), (1e300, 3), (3.3, 1000), (15e-324, 10)])
def test_steps_cover_the_duration_without_a_gap(duration: float, count: int):
    body = Body(TREES[1], motion=Motion(None, (0, 0, 1e-9), (0, 0, 0)))

    found = steps((body, Body(TREES[0])), duration, count)

    assert found[0].start == 0
    # As many as there are doubles, where those are few.
    assert len(found) == min(count, duration / 5e-324)
    for leg, end in zip(found, [*(leg.start for leg in found[1:]), duration], strict=True):
        assert math.fsum((leg.start, leg.duration, -end)) >= 0
        assert leg.duration <= (end - leg.start) * (1 + 2.0**-51)


@pytest.mark.parametrize("velocity", [(1e308, 0, 0), (1e306, 0, 0)])
def test_positions_beyond_doubles_are_refused(velocity: tuple[float, ...]):
    body = Body(TREES[1], motion=Motion(velocity, (0, 0, 1), (0, 0, 0)))

    with pytest.raises(MotionError, match=r"^motion: positions leave"):
        steps((body, Body(TREES[0])), 1000.0, 4)


@pytest.mark.parametrize("shift", [1e300, -1e306])
def test_huge_scenes_are_stepped(shift: float):
    tree = ObbTree.build(Mesh(*box((-1e300, -1e300, -1e300), (1e300, 1e300, 1e300))))
    body = Body(tree, Pose(translation=(shift, 0, 0)), Motion(None, (0, 0, 1)))

    for leg in steps((body, Body(TREES[0])), 1.0, 4):
        chord = 2 * math.sqrt(2) * 1e300 * math.sin(0.125)
        assert chord <= leg.slack <= 1.001 * chord + 2.0**-40 * abs(shift)


def test_euler_refuses_a_step_of_which_nothing_is_left():
    still = Mesh(*cube())
    exact, euler = (Accuracy(method="sampled", steps=2, integrator=i) for i in ("exact", "euler"))
    spin = Motion(None, (1e15, 1e15, 0))
    away = Body(still, Pose(translation=(9, 0, 0)), spin)

    with pytest.raises(MotionError, match=r"^steps: too few"):
        first_contact(away, still, 1.0, euler)
    assert first_contact(away, still, 1.0, exact).status is Status.SEPARATED
