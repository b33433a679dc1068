"""Depth limits, coarse leaves, budgets and refusals: what is not known is said, never guessed."""

from __future__ import annotations

import signal
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import oracles
import pytest
import scenes
import tree_oracles
from oracles_exact import Box
from oracles_mesh import mesh_distance_squared, mesh_pairs, posed
from tree_meshes import bumpy_grid, needles, soup

import obbcli
from obbcli import (
    Accuracy,
    Body,
    Mesh,
    Motion,
    MotionError,
    ObbTree,
    Pose,
    Status,
    UnresolvedError,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

STRIP = (soup(12, 8)[0] * (1.0, 1e-3, 1e-6), soup(12, 8)[1])
SURFACES = {
    "soups": (soup(12, 1), soup(12, 2)),
    "sheet and soup": (bumpy_grid(3), soup(12, 3)),
    "needles": (needles(8), soup(8, 4)),
    "strips": (STRIP, STRIP),
}


def _posed_pairs(name: str) -> Iterator[tuple[Any, Any, Any]]:
    """Yield two surfaces and a pose of the second: crossing, near, apart, nearly orthonormal."""
    a, b = SURFACES[name]
    for seed in range(6):
        rotation = scenes.random_rotation(seed)
        if seed % 2:
            rotation = rotation + 1e-10 * np.random.default_rng(seed).uniform(-1, 1, (3, 3))
        direction = np.random.default_rng(seed + 9).normal(size=3)
        reach = 0.3 * seed * np.ptp(a[0], axis=0).max()
        center = a[0].mean(axis=0) - rotation @ b[0].mean(axis=0)
        yield a, b, (rotation, center + direction / np.linalg.norm(direction) * reach)


def _coarse() -> Iterator[Accuracy]:
    for depth_a, depth_b in ((0, 0), (1, 1), (2, 2), (3, 3), (0, None), (None, 0), (1, 3), (4, 1)):
        yield Accuracy(max_depth_a=depth_a, max_depth_b=depth_b)
    yield Accuracy(leaves="boxes")
    yield Accuracy(leaves="boxes", max_depth_a=2)


@pytest.mark.parametrize("leaf_size", [1, 3])
@pytest.mark.parametrize("name", SURFACES)
def test_coarse_answers_keep_separated_a_proof_and_bound_the_gap(name: str, leaf_size: int) -> None:
    seen = set()
    for a, b, (rotation, translation) in _posed_pairs(name):
        world = posed(b[0], rotation, translation)
        touches = bool(mesh_pairs(a[0], a[1], world, b[1]))
        square = mesh_distance_squared(a[0], a[1], world, b[1])[0]
        tree_a = ObbTree.build(Mesh(*a), leaf_size=leaf_size)
        tree_b = ObbTree.build(Mesh(*b), leaf_size=leaf_size)
        for accuracy in _coarse():
            answer = obbcli.collide(
                tree_a, Body(tree_b, Pose(rotation, translation)), accuracy=accuracy
            )
            seen.add((answer.status, answer.approximate))
            if answer.status is Status.SEPARATED:
                assert not touches
                assert (answer.approximate, answer.error_bound) == (False, 0.0)
            elif answer.approximate:
                assert answer.witness is None
                assert square <= Fraction(answer.error_bound) ** 2
            else:
                assert touches

    assert (Status.SEPARATED, False) in seen
    assert (Status.OVERLAP_AT_START, True) in seen


@pytest.mark.parametrize("name", SURFACES)
def test_depth_limits_below_the_tree_change_nothing(name: str) -> None:
    for a, b, pose in _posed_pairs(name):
        tree_a, body_b = ObbTree.build(Mesh(*a)), Body(ObbTree.build(Mesh(*b)), Pose(*pose))
        exact = obbcli.collide(tree_a, body_b)
        depths = len(tree_a.levels), len(ObbTree.build(Mesh(*b)).levels)

        limited = obbcli.collide(
            tree_a, body_b, accuracy=Accuracy(max_depth_a=depths[0], max_depth_b=depths[1])
        )

        assert (limited.status, limited.witness) == (exact.status, exact.witness)
        assert (limited.approximate, limited.error_bound) == (False, 0.0)


def _root_box(tree: ObbTree) -> Box:
    node = tree._arrays.nodes.view(tree_oracles.NODE)[0, 0]
    unit = 2.0**tree._arrays.scale_exponent
    halves = node["half_extents"].astype(np.float64) * unit
    return Box(node["center"] * unit, tree_oracles.axes_of(node["rotation"]), halves)


@pytest.mark.parametrize("fit", ["triangles", "points", "hull", "min-volume", "axis-aligned"])
def test_depth_0_compares_the_root_boxes(fit: Any) -> None:
    roots = Accuracy(max_depth_a=0, max_depth_b=0)
    said = []
    for seed in range(40):
        a, (vertices, faces) = soup(5, seed), soup(5, seed + 50)
        trees = [
            ObbTree.build(Mesh(*surface), fit)
            for surface in (a, (vertices + np.array([1.5 + seed / 40, 1.0, 0.5]), faces))
        ]
        boxes = [_root_box(tree) for tree in trees]

        answer = obbcli.collide(*trees, accuracy=roots)

        gap = oracles.boxes_separation(*boxes)
        if gap <= 0 or gap > 1e-9:
            said.append(answer.status)
            assert answer.status is (Status.OVERLAP_AT_START if gap <= 0 else Status.SEPARATED)
    assert set(said) == {Status.OVERLAP_AT_START, Status.SEPARATED}


@pytest.mark.parametrize("exponent", [0, -200, -600, -850])
def test_error_bound_covers_a_corner_of_a_box_far_from_what_it_holds(exponent: int) -> None:
    # Specks at two corners of a square; the other surface lies at a third one, 1 away from both.
    # It also has a triangle of size 1 far away, which sets the scale at which boxes are tested.
    speck = np.array([[0.0, 0.0, 0.0], [1e-9, 0.0, 0.0], [0.0, 1e-9, 0.0]])
    faces = [(0, 1, 2), (3, 4, 5)]
    unit = 2.0**exponent
    specks = np.concatenate((speck, speck + np.array([1.0, 1.0, 0.0]))) * unit
    a = ObbTree.build(Mesh(specks, faces), "axis-aligned")
    third = (np.concatenate((speck, speck)) + np.array([1.0, 0.0, 0.0])) * unit
    b = Mesh(np.concatenate((third, speck * 1e9 + 100.0)), [*faces, (6, 7, 8)])
    coarse = Accuracy(max_depth_a=0)

    answer = obbcli.collide(a, ObbTree.build(b, split="center"), accuracy=coarse)

    assert (answer.status, answer.approximate) == (Status.OVERLAP_AT_START, True)
    assert 1.0 - 1e-8 <= answer.error_bound / unit <= 1.5
    assert obbcli.collide(a, b).status is Status.SEPARATED


def test_error_bound_counts_how_far_a_pose_is_from_orthonormal() -> None:
    # A speck beside a needle whose pose is skewed by 6e-10, which widens what boxes call contact.
    speck = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * 1e-9
    specks = ObbTree.build(Mesh(speck, [(0, 1, 2), (0, 1, 3)]), "axis-aligned")
    corners = [[-0.2571, 0.8779, 0.0712], [0.1223, -0.4184, -0.034], [0.0007, -0.0015, 0.0002]]
    needle = Mesh(np.array(corners), [(0, 1, 2)])
    turn = [[0.4879, 0.8702, -0.0688], [0.0224, 0.0663, 0.9975], [0.8726, -0.4882, 0.0128]]
    left, _, right = np.linalg.svd(turn)
    rotation = left @ right @ (np.eye(3) + 3e-10 * (1 - np.eye(3)))
    away = np.array([-3.733, -1.0611, 0.0635])
    widest = 0.0
    for gap in np.geomspace(1e-6, 1e-3, 60):
        pose = Pose(rotation, gap * away)

        answer = obbcli.collide(specks, Body(needle, pose), accuracy=Accuracy(max_depth_a=0))

        if answer.approximate:
            world = posed(needle.vertices, rotation, pose.translation)
            square = mesh_distance_squared(speck, specks.mesh.triangles, world, [(0, 1, 2)])[0]
            assert square <= Fraction(answer.error_bound) ** 2
            widest = float(square) ** 0.5
    assert 1e-4 < widest < 1e-3


def _sheets() -> tuple[ObbTree, ObbTree]:
    """Return sheets, one above the other, without boxes to tell their triangles apart by."""
    vertices, faces = bumpy_grid(12)
    above = vertices + np.array([0.0, 0.0, 1e-3])
    a, b = (ObbTree.build(Mesh(v, faces), max_depth=0) for v in (vertices, above))
    return a, b


def test_iteration_limits_leave_the_answer_open_or_right() -> None:
    a, b = ObbTree.build(Mesh(*soup(60, 1))), ObbTree.build(Mesh(*soup(60, 2)))
    exact = obbcli.collide(a, b)
    assert exact.collides
    for most in range(1, exact.stats.pops + 2):
        answer = obbcli.collide(a, b, accuracy=Accuracy(max_iterations=most))

        assert answer.stats.pops == min(most, exact.stats.pops)
        if most < exact.stats.pops:
            assert (answer.status, answer.witness) == (Status.UNRESOLVED, None)
            with pytest.raises(UnresolvedError, match="max_iterations"):
                _ = answer.collides
        else:
            assert answer.witness == exact.witness


def test_iteration_limit_of_many_slices_is_kept_to_the_pop() -> None:
    a, b = _sheets()
    whole = obbcli.collide(a, b)
    assert whole.stats.pops > 40_000

    answer = obbcli.collide(a, b, accuracy=Accuracy(max_iterations=40_000))

    assert (answer.status, answer.stats.pops) == (Status.UNRESOLVED, 40_000)
    assert whole.status is Status.SEPARATED


@pytest.mark.parametrize("swapped", [False, True])
def test_pop_takes_few_triangles_out_of_a_large_leaf(swapped: bool) -> None:
    # So that the stack stays small and clocks are looked at, whatever a leaf holds.
    large = ObbTree.build(Mesh(*bumpy_grid(60)), max_depth=0)
    two = Mesh(np.array([[25.0, 25, 0.1], [35, 25, 0.2], [30, 35, 0]]), [(0, 1, 2), (0, 2, 1)])
    pair = (two, large) if swapped else (large, two)
    before = (0, 0)
    for most in range(1, 300):
        stats = obbcli.collide(*pair, accuracy=Accuracy(max_iterations=most)).stats
        after = (stats.box_tests, stats.triangle_tests)

        assert sum(after) - sum(before) <= 100
        before = after


@pytest.mark.parametrize("counts", [(63, 1), (64, 1), (65, 2), (128, 129), (200, 200)])
def test_large_leaves_give_every_pair_once(counts: tuple[int, int]) -> None:
    surfaces = [soup(count, seed) for seed, count in enumerate(counts)]
    a, b = (ObbTree.build(Mesh(*s), leaf_size=1000) for s in surfaces)
    (va, fa), (vb, fb) = surfaces

    pairs = [tuple(pair) for pair in obbcli.triangle_pairs(a, b).tolist()]

    assert pairs == mesh_pairs(va, fa, vb, fb)
    assert obbcli.collide(a, b).collides == bool(pairs)


def test_timeout_leaves_the_answer_open() -> None:
    a, b = _sheets()

    answer = obbcli.collide(a, b, accuracy=Accuracy(timeout=0.0))

    assert answer.status is Status.UNRESOLVED
    assert obbcli.collide(a, b, accuracy=Accuracy(timeout=1e9)).status is Status.SEPARATED


def test_signals_are_heard_while_a_long_question_runs() -> None:
    heard = []

    def hear(*_: object) -> None:
        heard.append(True)
        if len(heard) == 3:
            raise InterruptedError("enough")

    # Tens of millions of pairs to test: nobody waits for them. Signals that nobody hears meanwhile
    # are one when the question has ended.
    crowd = ObbTree.build(Mesh(*needles(6000)))
    before = signal.signal(signal.SIGALRM, hear)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.02, 0.02)
        with pytest.raises(InterruptedError, match="enough"):
            obbcli.triangle_pairs(crowd, crowd)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def test_pair_limit_gives_so_many_of_the_pairs_sorted() -> None:
    mesh = ObbTree.build(Mesh(*bumpy_grid(4)))
    everything = [tuple(pair) for pair in obbcli.triangle_pairs(mesh, mesh).tolist()]
    for limit in (1, 2, 17, len(everything) - 1, len(everything), len(everything) + 1, np.int64(3)):
        pairs = [tuple(pair) for pair in obbcli.triangle_pairs(mesh, mesh, limit=limit).tolist()]

        assert len(pairs) == min(int(limit), len(everything))
        assert pairs == sorted(set(pairs))
        assert set(pairs) <= set(everything)


@pytest.mark.parametrize("limit", [0, -1, 1.5, "3", float("nan"), True, [1], -(2**70)])
def test_pair_limit_that_is_no_whole_number_above_0_is_refused(limit: Any) -> None:
    with pytest.raises(MotionError, match=r"^limit: "):
        obbcli.triangle_pairs(Mesh(*soup(2)), Mesh(*soup(2)), limit=limit)


def test_pair_limit_beyond_64_bits_is_no_limit() -> None:
    mesh = Mesh(*bumpy_grid(3))

    everything = obbcli.triangle_pairs(mesh, mesh)

    assert np.array_equal(obbcli.triangle_pairs(mesh, mesh, limit=2**70), everything)


@pytest.mark.parametrize(
    ("where", "question"),
    [
        ("duration", {"duration": -1.0}),
        ("duration", {"duration": float("nan")}),
        ("duration", {"duration": float("inf")}),
        ("duration", {"duration": "x"}),
        ("duration", {"duration": "1"}),
        ("duration", {"duration": [1.0]}),
        ("duration", {"duration": 10**400}),
        ("duration", {"duration": -(10**400)}),
    ],
    ids=str,
)
def test_what_is_not_answered_is_refused_by_name(where: str, question: dict[str, Any]) -> None:
    a = Body(Mesh(*soup(3)), motion=question.pop("a", Motion()))
    b = Body(Mesh(*soup(3)), motion=question.pop("b", Motion()))

    with pytest.raises(MotionError) as refused:
        obbcli.collide(a, b, **question)
    assert refused.value.where == where


def test_motion_plays_no_part_at_the_start() -> None:
    moving = Body(Mesh(*soup(9)), motion=Motion((1, 2, 3), (4, 5, 6)))

    assert obbcli.collide(moving, moving, duration=0.0).collides
    assert len(obbcli.triangle_pairs(moving, moving)) >= 9


@pytest.mark.parametrize("pose", [((0, 0, 1), None), (None, (1.7e308, 0, 0))], ids=str)
def test_pose_that_leaves_the_range_of_double_is_refused(pose: Any) -> None:
    vertices, faces = soup(5)
    huge = Mesh(np.sign(vertices) * 1.7e308, faces)

    assert obbcli.collide(huge, huge).collides
    for a, b in ((Body(huge, Pose(*pose)), huge), (huge, Body(huge, Pose(*pose)))):
        with pytest.raises(MotionError, match="range of double"):
            obbcli.collide(a, b)
        with pytest.raises(MotionError, match="range of double"):
            obbcli.triangle_pairs(a, b)


def test_threads_that_share_a_tree_get_the_same_answers() -> None:
    a, b = ObbTree.build(Mesh(*soup(400, 1))), ObbTree.build(Mesh(*soup(400, 2)))
    bodies = [Body(b, Pose(scenes.random_rotation(k), (k / 10, 0, 0))) for k in range(12)]
    alone = [obbcli.triangle_pairs(a, body).tolist() for body in bodies]

    with ThreadPoolExecutor(6) as pool:
        together = list(pool.map(lambda k: obbcli.triangle_pairs(a, bodies[k % 12]), range(60)))

    assert any(alone)
    assert [pairs.tolist() for pairs in together] == alone * 5
