"""`distance` under every limit of `Accuracy`, and where it refuses: what is said stays proven."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from claims.distance import assert_points_say_it
from hypothesis import given
from hypothesis import strategies as st
from meshes.nasty import soup
from oracles.mesh import mesh_distance_squared
from scenes.pairs import POSE_CLASSES
from strategies.meshes import mesh_pairs
from strategies.still import examples

import obbcli
from obbcli.questions.distance import measure
from obbcli.questions.pair_question import PairQuestion

SCENES = ("far", "gap_1e-1", "gap_1e-3", "interlocked", "nested", "plates", "deep")


def at_rest(a, b, **accuracy):
    """Return the question about two bodies at t = 0."""
    return PairQuestion.of(a, b, 0.0, obbcli.Accuracy(**accuracy))


def bodies_of(name: str, triangles: int = 600, **options) -> tuple[obbcli.Body, obbcli.Body]:
    """Return the two bodies of a scene, over trees built with `options`."""
    pair = POSE_CLASSES[name](triangles)
    a, b = (
        obbcli.ObbTree.build(obbcli.Mesh(s.vertices, s.faces), **options) for s in (pair.a, pair.b)
    )
    return obbcli.Body(a), obbcli.Body(b, pose=obbcli.Pose(pair.rotation, pair.translation))


def assert_holds(coarse: obbcli.Distance, fine: obbcli.Distance) -> None:
    """Assert that the bounds hold whatever lies within those of another answer."""
    assert 0 <= coarse.bounds[0] <= fine.bounds[1]
    assert coarse.bounds[0] <= coarse.bounds[1]
    assert fine.bounds[0] <= coarse.bounds[1]
    assert coarse.distance == coarse.bounds[1]


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("tolerance", [1e-6, 1e-2, 1.0, 1e300])
def test_distance_stops_at_a_tolerance(name, tolerance):
    a, b = bodies_of(name)
    fine = obbcli.distance(a, b)

    coarse = obbcli.distance(a, b, obbcli.Accuracy(distance_tolerance=tolerance))

    assert_holds(coarse, fine)
    assert coarse.bounds[1] - coarse.bounds[0] <= tolerance
    assert coarse.stats.pops <= fine.stats.pops


@pytest.mark.parametrize("name", SCENES)
def test_distance_of_boxes_is_bounded_at_every_depth(name):
    a, b = bodies_of(name)
    fine = obbcli.distance(a, b)

    for depth_a, depth_b in ((0, 0), (0, 3), (4, 0), (2, 5), (5, 5), (None, 3), (99, 99)):
        answer, is_complete = measure(at_rest(a, b, max_depth_a=depth_a, max_depth_b=depth_b))

        assert is_complete
        assert_holds(answer, fine)
        if depth_a == depth_b == 99:
            assert answer.bounds == fine.bounds


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("leaf_size", [1, 5, 40])
def test_distance_of_coarse_leaves_is_bounded(name, leaf_size):
    a, b = bodies_of(name, leaf_size=leaf_size)
    fine = obbcli.distance(a, b)

    coarse = obbcli.distance(a, b, obbcli.Accuracy(leaves="boxes"))

    assert_holds(coarse, fine)
    if leaf_size == 1:
        assert coarse.bounds == fine.bounds


@pytest.mark.parametrize("name", SCENES)
def test_distance_at_a_limit_of_pops_is_bounded(name):
    a, b = bodies_of(name)
    fine = obbcli.distance(a, b)

    for pops in (1, 7, 50, 700):
        answer, is_complete = measure(at_rest(a, b, max_iterations=pops))

        assert answer.stats.pops <= pops
        assert is_complete == (fine.stats.pops <= pops)
        assert_holds(answer, fine)


@pytest.mark.parametrize("name", ["gap_1e-1", "nested"])
def test_distance_bounds_only_close_with_more_pops(name):
    a, b = bodies_of(name)

    answers = [obbcli.distance(a, b, obbcli.Accuracy(max_iterations=2**k)) for k in range(16)]

    lows, highs = zip(*(answer.bounds for answer in answers), strict=True)
    assert list(lows) == sorted(lows)
    assert list(highs) == sorted(highs, reverse=True)


def test_distance_at_a_timeout_is_bounded():
    a, b = bodies_of("nested", 20_000)

    answer, is_complete = measure(at_rest(a, b, timeout=0.0))

    assert not is_complete
    assert 0 <= answer.bounds[0] < answer.bounds[1]


@given(mesh_pairs(), st.integers(0, 4), st.integers(0, 4), st.integers(1, 5), st.booleans())
@examples(100)
def test_coarse_distance_of_meshes_holds_the_exact_one(pair, depth_a, depth_b, leaf_size, boxes):
    a, b = pair
    leaves = "boxes" if boxes else "triangles"
    accuracy = obbcli.Accuracy(max_depth_a=depth_a, max_depth_b=depth_b, leaves=leaves)
    trees = (obbcli.ObbTree.build(obbcli.Mesh(*m), leaf_size=leaf_size) for m in (a, b))

    answer = obbcli.distance(*trees, accuracy)

    square = mesh_distance_squared(*a, *b)[0]
    low, high = map(Fraction, answer.bounds)
    assert low**2 <= square <= high**2
    assert_points_say_it(
        answer, a.vertices[a.faces[answer.triangle_a]], b.vertices[b.faces[answer.triangle_b]]
    )


# Orders of magnitude and ends of the range


@pytest.mark.parametrize("exponent", [-1020, -700, -300, 300, 700, 1015])
def test_distance_of_meshes_scales_with_powers_of_two_to_the_last_bit(exponent):
    vertices, faces = soup(60)
    vertices = np.round(vertices * 2**10) / 2**10  # no digit is lost at either end
    far = vertices + np.array([9.0, 0.5, 0.0])

    plain = obbcli.distance(obbcli.Mesh(vertices, faces), obbcli.Mesh(far, faces))
    scaled = obbcli.distance(
        obbcli.Mesh(np.ldexp(vertices, exponent), faces),
        obbcli.Mesh(np.ldexp(far, exponent), faces),
    )

    assert plain.bounds[0] > 0
    assert scaled.bounds == tuple(np.ldexp(plain.bounds, exponent))
    assert scaled.point_a == tuple(np.ldexp(plain.point_a, exponent))
    assert (scaled.triangle_a, scaled.triangle_b) == (plain.triangle_a, plain.triangle_b)
    assert scaled.stats[:4] == plain.stats[:4]


def test_distance_beyond_the_largest_double_is_refused():
    corner = 1.7e308 * np.array([[1.0, 1, 1], [1, 1, 0.9], [1, 0.9, 1]])

    with pytest.raises(obbcli.MotionError, match="exceeds the range of double"):
        obbcli.distance(obbcli.Mesh(corner, [[0, 1, 2]]), obbcli.Mesh(-corner, [[0, 1, 2]]))


def test_distance_of_poses_out_of_range_is_refused():
    mesh = obbcli.Mesh([[0, 0, 0], [1e308, 0, 0], [0, 1e308, 0]], [[0, 1, 2]])

    with pytest.raises(obbcli.MotionError, match="posed coordinates would exceed"):
        obbcli.distance(mesh, obbcli.Body(mesh, pose=obbcli.Pose(translation=(1e308, 0, 0))))


def test_distance_of_the_smallest_doubles_is_not_lost():
    tiny = 5e-324
    a = obbcli.Mesh([[0, 0, 0], [tiny, 0, 0], [0, tiny, 0]], [[0, 1, 2]])
    b = obbcli.Mesh([[0, 0, 3 * tiny], [tiny, 0, 3 * tiny], [0, tiny, 3 * tiny]], [[0, 1, 2]])

    answer = obbcli.distance(a, b)

    assert answer.bounds[0] <= 3 * tiny <= answer.bounds[1]
    assert answer.bounds[0] > 0
    assert answer.bounds[1] <= 4 * tiny


def test_distance_takes_paths_trees_and_meshes_alike(tmp_path):
    vertices, faces = soup(30)
    mesh = obbcli.Mesh(vertices, faces)
    tree = obbcli.ObbTree.build(mesh)
    path = tmp_path / "soup.obbt"
    tree.save(path)
    other = obbcli.Mesh(vertices + np.array([7.0, 0.0, 0.0]), faces)

    answers = [obbcli.distance(shape, other) for shape in (mesh, tree, path, obbcli.Body(tree))]

    assert len({(answer.bounds, answer.point_a, answer.triangle_a) for answer in answers}) == 1
    assert answers[2].stats.nodes_built_a == tree.node_count


def test_distance_refuses_what_is_no_shape():
    with pytest.raises(obbcli.MotionError, match="pass an ObbTree, a Mesh, a Part or a path"):
        obbcli.distance(42, obbcli.Mesh(*soup(1)))


def test_distance_of_a_damaged_tree_is_refused(tmp_path):
    tree = obbcli.ObbTree.build(obbcli.Mesh(*soup(30)))
    path = tmp_path / "soup.obbt"
    tree.save(path)
    data = path.read_bytes()
    half = len(data) // 2  # beyond it are vertices and triangles, some of which any answer reads
    path.write_bytes(data[:half] + bytes(byte ^ 1 for byte in data[half:]))

    with pytest.raises(obbcli.TreeFileError):
        obbcli.distance(path, tree)
