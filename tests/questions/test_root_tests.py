"""Root boxes alone: what they prove apart, against rational arithmetic on the posed vertices.

Built trees have boxes a little wider than what they hold. Here boxes are written by hand as tight
as can be, so that where boxes graze, surfaces do.
"""

from __future__ import annotations

import numpy as np
import pytest
from oracles.mesh import mesh_pairs

from obbcli import Body, Mesh, ObbTree, Pose, collide, kernels

NODE = np.dtype([("center", "3f8"), ("half_extents", "3f4"), ("rotation", "4f4"), ("links", "3u4")])

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
        *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
# Of the size: on both sides of the margin, 2^-40 of some sizes.
GAPS = [sign * 2.0**-k for k in (3, 20, 30, 36, 40, 44, 48, 52, 56) for sign in (1, -1)] + [0.0]


def turned(rng: np.random.Generator, *, is_skew: bool = False) -> np.ndarray:
    """Return a random rotation; where it is skew, by nearly as much as poses may be."""
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.linalg.det(q)
    if is_skew:
        q = q @ np.diag([1 + 4e-10, 1 - 4e-10, 1 + 4e-10])
    return q


def extents_of(rng: np.random.Generator) -> np.ndarray:
    """Return half extents that floats hold."""
    return rng.uniform(0.1, 1, size=3).astype(np.float32).astype(float)


def aligned(root: np.ndarray) -> np.ndarray:
    """Return a node as bytes at the start of a cache line."""
    room = np.empty(128, dtype=np.uint8)
    start = -room.ctypes.data % 64
    room[start : start + 64] = root.view(np.uint8)
    return room[start : start + 64].reshape(1, 64)


class Cube:
    """A cube, and a tree of the kernels whose root box is no wider than it."""

    def __init__(self, extents: np.ndarray, exponent: int = 0) -> None:
        self.vertices = np.ldexp(extents * CORNERS, exponent)
        root = np.zeros(1, dtype=NODE)
        root["half_extents"] = extents
        root["rotation"][:, 0] = 1
        root["links"] = 6, 6, 0
        self.tree = kernels.Tree(
            self.vertices,
            FACES.astype(np.uint32),
            np.arange(12, dtype=np.uint32),
            aligned(root),
            exponent,
        )

    def check(self, poses: tuple[Pose, Pose], *, is_far: bool = False) -> None:
        """Assert that what is said of two such cubes is so, and that they are apart if far."""
        meet = len(mesh_pairs(*(x for pose in poses for x in (pose.apply(self.vertices), FACES))))
        for first, second in (poses, poses[::-1]):
            a, b = kernels.Placed(self.tree, first), kernels.Placed(self.tree, second)
            is_apart = kernels.roots_are_apart(a, b)
            assert not (is_apart and meet)
            assert is_apart or not is_far


@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("exponent", [0, -280, 280, 12])
@pytest.mark.parametrize("is_skew", [False, True])
def test_faces_that_graze_are_apart_only_where_surfaces_are(gap, exponent, is_skew):
    rng = np.random.default_rng([exponent + 300, GAPS.index(gap), is_skew])
    unit = 2.0**exponent
    for _ in range(6):
        extents = extents_of(rng)
        q = turned(rng, is_skew=is_skew)
        place = rng.normal(size=3) * rng.choice([0.0, 1.0, 1000.0])
        axis = rng.integers(3)
        shift = rng.uniform(-0.5, 0.5, size=3) * extents
        shift[axis] = 2 * extents[axis] + gap * (1 + abs(place).max())
        poses = Pose(q, unit * place), Pose(q, unit * (place + q @ shift))

        Cube(extents, exponent).check(poses, is_far=gap > (2**-26 if is_skew else 2**-37))


@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("exponent", [0, -280, 280])
@pytest.mark.parametrize("is_skew", [False, True])
def test_corners_that_graze_are_apart_only_where_surfaces_are(gap, exponent, is_skew):
    rng = np.random.default_rng([exponent + 300, GAPS.index(gap)])
    for _ in range(4):
        extents = extents_of(rng)
        q = turned(rng, is_skew=is_skew)
        # From one middle to the other through corners of both.
        half = np.ldexp(q @ ((1 + gap) * extents), exponent)

        Cube(extents, exponent).check((Pose(q, -half), Pose(q, half)))


@pytest.mark.parametrize("gap", GAPS)
def test_corners_on_faces_graze(gap):
    rng = np.random.default_rng(GAPS.index(gap))
    for _ in range(20):
        extents = extents_of(rng)
        first, second = turned(rng), turned(rng)
        # The lowest corner of the second cube, as seen from a face of the first.
        axis = rng.integers(3)
        corner = -extents * np.sign(first[:, axis] @ second)
        inside = rng.uniform(-0.9, 0.9, size=3) * extents
        inside[axis] = extents[axis] + gap
        poses = Pose(first), Pose(second, first @ inside - second @ corner)

        Cube(extents).check(poses, is_far=gap > 2**-37)


@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("exponent", [0, -280, 280])
@pytest.mark.parametrize("is_skew", [False, True])
def test_edges_that_graze_are_apart_only_where_surfaces_are(gap, exponent, is_skew):
    rng = np.random.default_rng([exponent + 300, GAPS.index(gap), 2])
    diagonal = np.array([1, 1, 0]) / np.sqrt(2)
    for _ in range(6):
        extents = extents_of(rng)
        middle = extents * (1, 1, 0)  # of the edge along z, which looks along the diagonal
        whole = turned(rng, is_skew=is_skew)
        # The second cube's edge looks back and is turned about the diagonal: only the product of
        # both edges parts the cubes.
        angle = rng.uniform(0.4, 2.7)
        x, y = np.outer(diagonal, diagonal), np.cross(np.eye(3), diagonal)
        about = np.cos(angle) * np.eye(3) + (1 - np.cos(angle)) * x - np.sin(angle) * y
        back = about @ np.diag([-1.0, -1.0, 1.0])
        place = middle + gap * diagonal - back @ middle
        poses = Pose(whole), Pose(whole @ back, np.ldexp(whole @ place, exponent))

        Cube(extents, exponent).check(poses, is_far=gap > (2**-25 if is_skew else 2**-37))


def test_turned_boxes_are_apart_only_where_surfaces_are():
    rng = np.random.default_rng(5)
    apart = 0
    for _ in range(400):
        cube = Cube(extents_of(rng))
        poses = Pose(turned(rng)), Pose(turned(rng), rng.normal(size=3))

        cube.check(poses)
        a, b = (kernels.Placed(cube.tree, pose) for pose in poses)
        apart += kernels.roots_are_apart(a, b)
    assert 20 < apart < 380


def test_count_is_one_pair_of_boxes_however_it_is_tested():
    tree = ObbTree.build(Mesh(CORNERS, FACES))
    for shift in ((9, 0, 0), (2.1, 0, 0)):
        stats = collide(Body(tree), Body(tree, Pose(translation=shift))).stats

        assert (stats.box_tests, stats.triangle_tests, stats.pops) == (1, 0, 0)


@pytest.mark.parametrize("exponent", [-310, 310, 1000])
def test_scales_beyond_these_tests_are_left_to_the_query(exponent):
    tree = ObbTree.build(Mesh(2.0**exponent * CORNERS, FACES))
    a, b = Body(tree), Body(tree, Pose(translation=(9 * 2.0**exponent, 0, 0)))

    assert not kernels.roots_are_apart(a, b)
    assert not collide(a, b).collides


def test_single_triangles_are_left_to_the_query():
    tree = ObbTree.build(Mesh(CORNERS[:3], [[0, 1, 2]]))
    a, b = Body(tree), Body(tree, Pose(translation=(9, 0, 0)))

    assert not kernels.roots_are_apart(a, b)
    assert not collide(a, b).collides
