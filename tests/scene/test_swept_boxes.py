"""Boxes that travel with bodies hold every vertex at every time, and are not much wider."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scenes.random_scenes import CUBE, MESHES, random_motion

from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Pose
from obbcli.motion.path import PathMotion
from obbcli.questions.legs.steps import steps_of
from obbcli.questions.pair_question import PairQuestion
from obbcli.scene.swept_boxes import SweptBoxes, swept_boxes

if TYPE_CHECKING:
    from numpy.typing import NDArray


def boxes_of(body: Body, duration: float = 1.0, **accuracy: Any) -> SweptBoxes:
    """Return the boxes of one body on a mesh."""
    assert isinstance(body.shape, Mesh)
    return swept_boxes([body], [body.shape], duration, Accuracy(**accuracy))


def turned(vector: NDArray[Any], points: NDArray[Any]) -> NDArray[Any]:
    """Return points turned about the origin by a rotation vector (Rodrigues)."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return points
    axis = vector / angle
    across = np.cross(axis, points)
    return points + np.sin(angle) * across + (1 - np.cos(angle)) * np.cross(axis, across)


def vertices_at(body: Body, time: float) -> NDArray[Any]:
    """Return the vertices in the world."""
    assert isinstance(body.shape, Mesh)
    pose, motion, points = body.pose, body.motion, body.shape.vertices
    if isinstance(motion, PathMotion):
        pose = motion.pose_at(time)
        return points @ pose.rotation.T + pose.translation
    placed = points @ pose.rotation.T + pose.translation
    pivot = motion.pivot
    if pivot is None:
        pivot = pose.rotation @ body.shape.surface_centroid + pose.translation
    shift = pivot + time * motion.linear_velocity
    return turned(time * motion.angular_velocity, placed - pivot) + shift


def least_room(body: Body, swept: SweptBoxes, times: NDArray[Any]) -> float:
    """Return by how much any vertex is at least inside of a box at all times; each has a box."""
    least = np.inf
    for time in times.tolist():
        is_now = (swept.times[:, 0] <= time) & (time <= swept.times[:, 1])
        assert is_now.any()
        points = vertices_at(body, time)
        for (start, _), row in zip(swept.times[is_now], swept.boxes[is_now], strict=True):
            shift = (time - start) * row[6:]
            inside = np.minimum(points - (row[:3] + shift), row[3:6] + shift - points)
            least = min(least, float(inside.min()))
    return least


@pytest.mark.parametrize("seed", range(40))
def test_boxes_hold_their_bodies(seed: int) -> None:
    rng = np.random.default_rng(seed)
    pose = Pose(rng.uniform(-2, 2, 3), rng.uniform(-9, 9, 3))
    motion = random_motion(rng, pose, 5.0)
    pose = Pose() if isinstance(motion, PathMotion) else pose
    body = Body(MESHES[seed % 3], pose, motion)

    swept = boxes_of(body)

    assert least_room(body, swept, np.linspace(0, 1, 401)) > 0


@pytest.mark.parametrize("scale", [1e-300, 1e-150, 1e-9, 1e9, 1e150, 1e290])
@pytest.mark.parametrize("seed", range(4))
def test_boxes_hold_bodies_of_any_size(seed: int, scale: float) -> None:
    rng = np.random.default_rng(seed)
    mesh = Mesh(scale * CUBE.vertices, CUBE.triangles)
    pose = Pose(rng.uniform(-2, 2, 3), scale * rng.uniform(-9, 9, 3))
    motion = Motion(scale * rng.uniform(-5, 5, 3), rng.uniform(-4, 4, 3))
    body = Body(mesh, pose, motion)

    swept = boxes_of(body)

    assert least_room(body, swept, np.linspace(0, 1, 101)) > 0
    width = float((swept.boxes[0, 3:6] - swept.boxes[0, :3]).max())
    assert width < 2 * 3**0.5 * scale * (1 + 1e-8)


def test_spin_about_an_axis_of_coordinates_leaves_its_length_alone() -> None:
    body = Body(CUBE, motion=Motion(None, [0, 0, 1000.0]))

    (row,) = boxes_of(body).boxes

    root = 2**0.5
    assert row[:6] == pytest.approx([-root, -root, -1, root, root, 1], rel=1e-9)


def test_slow_spin_widens_by_its_chord_alone() -> None:
    body = Body(CUBE, motion=Motion(None, [0, 0.01, 0], [0, 5, 0]))

    (row,) = boxes_of(body).boxes

    reach = 1 + 2 * 2**0.5 * np.sin(0.005)
    assert row[:6] == pytest.approx([-reach, -1, -reach, reach, 1, reach], rel=1e-9)


def test_axis_far_away_widens_to_the_ring() -> None:
    body = Body(CUBE, motion=Motion([0, 0, 3], [0, 0, 7.0], [-20, 0, 0]))

    (row,) = boxes_of(body).boxes

    radius = np.hypot(21, 1)
    assert row[:3] == pytest.approx([-20 - radius, -radius, -1], rel=1e-9)
    assert row[6:].tolist() == [0, 0, 3]


def test_boxes_of_a_path_follow_it() -> None:
    times, places = [0.25, 0.5, 0.75], [[0, 0, 0], [8, 0, 0], [8, 8, 0]]
    motion = Motion.through(times, [Pose(translation=place) for place in places])

    swept = boxes_of(Body(CUBE, motion=motion))

    assert swept.times.tolist() == [[0, 0.25], [0.25, 0.5], [0.5, 0.75], [0.75, 1]]
    assert swept.boxes[:, 6:].tolist() == [[0, 0, 0], [32, 0, 0], [0, 32, 0], [0, 0, 0]]
    assert swept.boxes[:, :3] + 1 == pytest.approx(np.array([[0, 0, 0], *places]), abs=1e-9)


@pytest.mark.parametrize("duration", [0.0, 0.3, 0.25, 0.6])
def test_boxes_of_a_path_end_with_the_duration(duration: float) -> None:
    motion = Motion.through([0.25, 0.5], [Pose(), Pose(translation=[1, 0, 0])])

    swept = boxes_of(Body(CUBE, motion=motion), duration)

    assert swept.times[0, 0] == 0
    assert swept.times[-1, 1] == duration
    assert all(end == start for (_, end), (start, _) in pairwise(swept.times.tolist()))


def test_poses_that_no_turn_joins_make_room_for_the_jump() -> None:
    # Orthonormal to 1e-9 and no better: the piece ends that far from the pose after it.
    skew = [[1, 4e-10, 0], [4e-10, 1, 0], [0, 0, 1]]
    spin = Pose([0, 0, 0.1]).rotation @ skew
    body = Body(CUBE, motion=Motion.through([0, 1], [Pose(), Pose(spin)]))
    exact = Body(CUBE, motion=Motion.through([0, 1], [Pose(), Pose([0, 0, 0.1])]))

    wider = boxes_of(body).boxes[0] - boxes_of(exact).boxes[0]

    assert (wider[:2] < -5e-10).all()
    assert (wider[3:5] > 5e-10).all()


@pytest.mark.parametrize("limit", [{"leaves": "boxes"}, {"max_depth_a": 0}, {"max_depth_b": 3}])
def test_boxes_for_triangles_have_room_for_all_boxes(limit: dict[str, Any]) -> None:
    needle = Mesh([[0, 0, 0], [1, 1, 1], [1, 1, 1.001], [0, 0, 0.001]], [[0, 1, 2], [0, 2, 3]])
    for mesh in (*MESHES, CUBE, needle):
        body = Body(mesh)
        low, high = boxes_of(body, **limit).boxes[0, :6].reshape(2, 3)
        tree = ObbTree.build(mesh, leaf_size=len(mesh.triangles))

        # The largest boxes there can be, in any direction: of diameter D, up to sqrt(3) D wide.
        reach = mesh.size * 3**0.5
        assert (low <= mesh.bounds[0] - reach).all()
        assert (high >= mesh.bounds[1] + reach).all()
        assert tree.levels[0].box_count == 1


@pytest.mark.parametrize("integrator", ["exact", "euler", "rk4"])
@pytest.mark.parametrize("seed", range(12))
def test_boxes_hold_sampled_bodies(seed: int, integrator: str) -> None:
    rng = np.random.default_rng(seed)
    pose = Pose(rng.uniform(-2, 2, 3), rng.uniform(-9, 9, 3))
    motion = random_motion(rng, pose, 5.0)
    pose = Pose() if isinstance(motion, PathMotion) else pose
    bar = Mesh(CUBE.vertices * [0.2, 3, 0.5], CUBE.triangles)
    body = Body(bar, pose, motion)
    sampled = {"method": "sampled", "steps": 40, "integrator": integrator}
    low, high, velocity = np.split(boxes_of(body, **sampled).boxes[0], 3)
    pair = PairQuestion.of(body, Body(bar), 1.0, Accuracy(**sampled))

    legs = list(steps_of(pair))

    assert len(legs) in (1, 40)
    for leg in legs if len(legs) == 40 else []:
        frozen = leg.bodies[0]
        for time in (0.0, leg.duration):
            shift = frozen.pose.translation + time * frozen.motion.linear_velocity
            points = bar.vertices @ frozen.pose.rotation.T + shift
            moved = (leg.start + time) * velocity
            assert (low + moved < points).all()
            assert (points < high + moved).all()
