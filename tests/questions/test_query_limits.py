"""Depth limits, coarse leaves, budgets and refusals: what is not known is said, never guessed."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from asking.heard_signals import HeardError, ask_until_heard
from meshes.nasty import bumpy_grid, needles, soup
from oracles.mesh import mesh_pairs
from scenes import pairs as scenes

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
    # Tens of millions of pairs to test: nobody waits for them.
    crowd = ObbTree.build(Mesh(*needles(6000)))

    with pytest.raises(HeardError):
        ask_until_heard(lambda: obbcli.triangle_pairs(crowd, crowd))


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
