"""The kernels' convex hull against all supporting planes in whole numbers, whatever the points."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.exact import cross, dot, subtract
from strategies.still import examples

from obbcli import kernels

ALL = 2**40
# Few values a coordinate, so that most points coincide or share lines and planes.
GRID_POINTS = st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=1, max_size=12)
LOOSE_POINTS = st.lists(st.tuples(*[st.integers(-1000, 1000)] * 3), min_size=1, max_size=14)


def hull_of(points: Any, max_vertices: int = ALL) -> tuple[int, list[int], list[tuple[int, ...]]]:
    array = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
    rank, vertices, triangles = kernels.convex_hull(array, max_vertices)
    return rank, vertices.tolist(), [tuple(three) for three in triangles.tolist()]


def plane(p: Any, q: Any, r: Any) -> tuple[Any, ...] | None:
    """Return the oriented plane through points as coprime integers, or None for those in line."""
    normal = cross(subtract(q, p), subtract(r, p))
    if normal == (0, 0, 0):
        return None
    divisor = math.gcd(*normal)
    normal = tuple(component // divisor for component in normal)
    return (*normal, dot(normal, p))


def supporting_planes(points: Any) -> set[tuple[Any, ...]]:
    """Return every plane through three points with none beyond it, by trying all."""
    found = set()
    for p, q, r in itertools.combinations(sorted(set(points)), 3):
        for candidate in (plane(p, q, r), plane(p, r, q)):
            if candidate and all(dot(candidate[:3], other) <= candidate[3] for other in points):
                found.add(candidate)
    return found


def rank_of(points: Any) -> int:
    """Return the dimension that the points span, by elimination in rationals."""
    rows = [[Fraction(x) for x in subtract(p, points[0])] for p in points]
    rank = 0
    for column in range(3):
        pivot = next((row for row in rows[rank:] if row[column]), None)
        if pivot is None:
            continue
        rows.remove(pivot)
        rows = [
            [x - row[column] / pivot[column] * y for x, y in zip(row, pivot, strict=True)]
            if index >= rank
            else row
            for index, row in enumerate(rows)
        ]
        rows.insert(rank, pivot)
        rank += 1
    return rank


def assert_closed(triangles: list[tuple[int, ...]], points: Any) -> None:
    """Every edge is passed once each way, by different corners: one closed surface."""
    corners = [tuple(points[i] for i in three) for three in triangles]
    edges = [(t[k], t[(k + 1) % 3]) for t in corners for k in range(3)]
    assert len(set(edges)) == len(edges)
    assert {(q, p) for p, q in edges} == set(edges)
    assert len({p for t in corners for p in t}) - len(edges) // 2 + len(corners) == 2


def assert_hull(points: Any) -> None:
    rank, vertices, triangles = hull_of(points)
    assert rank == rank_of(points)
    assert all(0 <= index < len(points) for index in vertices)
    taken = [points[i] for i in vertices]
    assert len(set(taken)) == len(taken)
    if rank == 3:
        assert_closed(triangles, points)
        found = {plane(*(points[i] for i in three)) for three in triangles}
        assert found == supporting_planes(points)
    elif rank == 2:
        assert len(triangles) == len(vertices) - 2
        (found_plane,) = {plane(*(points[i] for i in three)) for three in triangles}
        assert found_plane is not None
        for p, q in itertools.pairwise([*taken, taken[0]]):
            inward = cross(found_plane[:3], subtract(q, p))
            assert all(dot(inward, subtract(r, p)) >= 0 for r in points)
            # Corners alone: whatever else is on an edge is left out.
            assert sum(dot(inward, subtract(r, p)) == 0 for r in taken) == 2
    else:
        assert triangles == []
        assert len(taken) == rank + 1
        low, high = min(points), max(points)
        assert {low, high} == set(taken)


@given(points=GRID_POINTS)
@examples(400)
def test_hull_of_degenerate_points_is_that_of_all_supporting_planes(points: Any) -> None:
    assert_hull(points)


@given(points=LOOSE_POINTS)
@examples(100)
def test_hull_of_points_at_random_is_that_of_all_supporting_planes(points: Any) -> None:
    assert_hull(points)


@pytest.mark.parametrize(
    "points",
    [
        list(itertools.product(range(3), repeat=3)),
        list(itertools.product(range(4), range(3), [7])),
        [(i, i, 2 * i) for i in range(20)],
        [(5, 5, 5)] * 9,
        [(x, y, x - 2 * y) for x in range(4) for y in range(4)],
        [*itertools.product((0, 9), repeat=3), (4, 4, 4), (9, 4, 4), (4, 9, 9)],
    ],
    ids=["cube", "flat grid", "line", "one point", "tilted grid", "points on faces"],
)
def test_hull_of_regular_points_is_that_of_all_supporting_planes(points: Any) -> None:
    assert_hull(points)


@pytest.mark.parametrize("is_regular", [False, True])
@pytest.mark.parametrize("exponent", [-1040, -300, 0, 300, 490])
def test_order_and_scale_of_points_change_no_corner(exponent: int, is_regular: bool) -> None:
    random = np.random.default_rng(5)
    points = random.normal(size=(300, 3)) * (1.0, 0.5, 0.01)
    if is_regular:  # equally far ones everywhere
        points = np.array([p for p in itertools.product(range(-4, 5), repeat=3) if dot(p, p) < 17])
    order = random.permutation(len(points))

    rank, vertices, triangles = hull_of(points)
    other_rank, other, others = hull_of(np.ldexp(points[order].astype(float), exponent))

    if exponent == -1040:  # extents that small count as none
        assert (other_rank, len(other)) == (0, 1)
        return
    assert other_rank == rank == 3
    assert [order[i] for i in other] == vertices
    assert [tuple(order[i] for i in three) for three in others] == triangles


@pytest.mark.parametrize("flatness", [1.0, 1e-9, 1e-12])
def test_no_point_lies_further_outside_than_rounding_to_the_grid(flatness: float) -> None:
    # A ball flattened and turned: 10,000 points, most of them near a face.
    random = np.random.default_rng(6)
    ball = random.normal(size=(10_000, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    points = (ball * (1.0, 0.7, flatness)) @ turn

    rank, vertices, triangles = hull_of(points)

    # The axis that the ball is flat along, turned by nothing to everything.
    tilts = 10.0 ** -random.uniform(0, 14, (2000, 1)) * random.normal(size=(2000, 3))
    directions = turn[2] + tilts
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    beyond = (points @ directions.T).max(axis=0) - (points[vertices] @ directions.T).max(axis=0)
    steps = 2.0**-40 * np.ptp(points, axis=0)
    assert rank == 3
    assert sorted(vertices) == sorted({i for three in triangles for i in three})
    assert (beyond <= 2 * np.abs(directions) @ steps).all()


def test_limited_hull_takes_the_farthest_points_first() -> None:
    random = np.random.default_rng(7)
    ball = random.normal(size=(2000, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]

    volumes = []
    for limit in (4, 5, 16, 64, 256, ALL):
        rank, vertices, triangles = hull_of(ball, limit)
        assert rank == 3
        assert len(vertices) == min(limit, 2000)
        volumes.append(np.linalg.det(ball[np.array(triangles)]).sum() / 6)

    assert volumes == sorted(volumes)
    # As near as the best of so many points can be: a sphere's volume is missed by about 10 / n.
    assert volumes[4] > 0.95 * volumes[5] > 0.95 * 0.99 * 4 / 3 * np.pi


def test_no_points_have_no_hull() -> None:
    assert hull_of(np.empty((0, 3))) == (0, [], [])
