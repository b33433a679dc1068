"""The thickness of overlaps at random, against largest balls, sampled points and its own laws."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.solids import joined
from movers.meshes import box, cube, disc, octahedron, tetrahedron
from oracles.ball import distances_from, largest_ball, planes_of
from oracles.solid import winding_by_angles, winding_number
from overlap.random_pairs import lattice_solid
from overlap.test_thickness import answer, size_of
from scenes.pairs import random_rotation

from obbcli import Pose

if TYPE_CHECKING:
    from collections.abc import Iterator

    Meshes = tuple[Any, Any]


def convex(random: np.random.Generator) -> Any:
    """Return a convex body: thick or thin, somewhere about 0, turned or not."""
    kinds = [cube(), tetrahedron(), octahedron(), disc(int(random.integers(3, 8)), 1, -1, 1)]
    vertices, faces = kinds[random.integers(len(kinds))]
    scales = random.choice([0.01, 0.3, 1, 4], 3)
    rotation = np.eye(3) if random.random() < 0.3 else random_rotation(random)
    return (np.asarray(vertices) * scales) @ rotation.T + random.uniform(-0.5, 0.5, 3), faces


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_convex_pairs_have_the_largest_ball_of_their_planes(tolerance):
    random = np.random.default_rng(5)
    for _ in range(100):
        a, b = convex(random), convex(random)
        truth = 2 * largest_ball(np.concatenate((planes_of(*a), planes_of(*b))))
        asked = answer(a, b, tolerance=tolerance)
        low, high = asked.bounds
        assert low - 1e-8 <= truth <= high + 1e-8
        assert asked.is_answered
        assert high - low <= max(tolerance * high, 1e-9 * size_of(a, b))


def frames(a: Any, b: Any) -> Iterator[Meshes]:
    """Yield a pair as it is, swapped and in other frames."""
    yield a, b
    yield b, a
    for seed in (1, 2):
        rotation = random_rotation(np.random.default_rng(seed))
        turned = [(np.asarray(v, dtype=np.float64) @ rotation.T, f) for v, f in (a, b)]
        yield turned[0], turned[1]


def sampled_radius(a: Any, b: Any, random: np.random.Generator) -> float:
    """Return the radius of the largest ball in both about any of some points."""
    low = np.maximum(a[0].min(axis=0), b[0].min(axis=0))
    high = np.minimum(a[0].max(axis=0), b[0].max(axis=0))
    if (low >= high).any():
        return 0.0
    points = random.uniform(low, high, (60, 3))
    radii = np.minimum(distances_from(points, *a), distances_from(points, *b))
    inside = [
        all(round(winding_by_angles(point, *mesh)) != 0 for mesh in (a, b)) for point in points
    ]
    return float(radii[inside].max(initial=0.0))


@pytest.mark.parametrize("start", range(0, 60, 20))
def test_no_bracket_contradicts_another_or_a_point(start):
    for seed in range(start, start + 20):
        random = np.random.default_rng(seed)
        meshes = [lattice_solid(random) for _ in range(2)]
        a, b = ((np.asarray(v, dtype=np.float64), np.asarray(f)) for v, f in meshes)
        noise = 1e-12 * size_of(a, b)
        asked = [answer(*pair) for pair in frames(a, b)]
        low = max(query.bounds[0] for query in asked)
        high = min(query.bounds[1] for query in asked)
        assert all(query.is_answered for query in asked)
        assert low <= high + noise
        assert 2 * sampled_radius(a, b, random) <= high + noise
        point = asked[0].point
        assert (point is not None) is (asked[0].bounds[0] > 0)
        if point is not None:
            for mesh in (a, b):
                assert winding_number(point, *mesh)
                assert 2 * distances_from([point], *mesh)[0] >= asked[0].bounds[0] - noise
            assert_decided(a, b, asked[0].bounds)


def assert_decided(a: Any, b: Any, bounds: tuple[float, float]) -> None:
    """Ask whether the overlap is thicker than a little less and a little more than it is."""
    assert answer(a, b, deeper_than=0.98 * bounds[0]).deeper is True
    assert answer(a, b, deeper_than=1.02 * bounds[1]).deeper is False
    assert answer(a, b, deeper_than=0.0).deeper is True


EXACT_TURN = np.array([[3.0, -4.0, 0.0], [4.0, 3.0, 0.0], [0.0, 0.0, 5.0]])


@pytest.mark.parametrize("turn", [np.eye(3), EXACT_TURN, EXACT_TURN[:, [2, 0, 1]]])
@pytest.mark.parametrize("offset", [0.0, 2.0**-3, 2.0**20, -(2.0**30)])
def test_rounding_never_reaches_the_truth(turn, offset):
    # All coordinates are doubles before and after the turn: the truth is exact, and so is the test.
    scale = np.linalg.norm(turn[0])
    for exponent in range(1, 52 if offset == 0 else 20, 3):
        depth = 2.0**-exponent
        a, b = box((0, 0, 0), (1, 1, 1)), box((1 - depth, -1, -1), (2, 2, 2))
        a, b = (((v + offset) @ turn.T, f) for v, f in (a, b))
        for tolerance in (0.5, 1e-2, 1e-6, 1e-12):
            low, high = answer(a, b, tolerance=tolerance, floor=0.0, max_cells=200).bounds
            assert low <= depth * scale <= high


def test_floor_of_nothing_is_a_bracket_all_the_same():
    a, b = cube(), (cube()[0] + [2.0, 0.5, 0.25], cube()[1])
    low, high = answer(a, b, floor=0.0, max_cells=300).bounds
    assert low == 0
    assert high <= 1e-12


def test_decision_below_rounding_is_left_open():
    a, b = cube(), (cube()[0] + [2.0, 0.5, 0.25], cube()[1])
    asked = answer(a, b, deeper_than=0.0, floor=0.0, max_cells=300)
    assert asked.deeper is None
    assert answer(a, b, deeper_than=0.0, floor=1e-12).deeper is False


def test_cavity_parts_and_internal_faces_count_as_surfaces():
    # The doubled face between two boxes of one mesh parts the balls: a proven lower end.
    two = joined(box((0, 0, 0), (1, 1, 1)), box((1, 0, 0), (2, 1, 1)))
    low, high = answer(two, cube(5)).bounds
    assert low <= 1 <= high
    # Boxes that overlap by half: no ball that no surface passes through is thicker than 1/2:
    crossed = joined(box((0, 0, 0), (1, 1, 1)), box((0.5, 0, 0), (1.5, 1, 1)))
    low, high = answer(crossed, cube(5)).bounds
    assert low <= 0.5 <= high


def test_poses_far_away_keep_what_doubles_keep():
    a, b = cube(), cube()
    for far in (1e3, 1e6, 1e9):
        here, there = Pose(translation=(far, far, far)), Pose(translation=(far + 1.5, far, far))
        low, high = answer(a, b, here, there).bounds
        assert low - 1e-15 * far <= 0.5 <= high + 1e-15 * far
        assert high - low <= 0.01
