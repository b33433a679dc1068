"""The strategies reach the hard sets they aim at, and there the oracles agree with each other."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from hypothesis import given
from oracles import distance as oracles_distance
from oracles import lp as oracles_lp
from oracles import mesh as oracles_mesh
from oracles import moving as oracles_moving
from oracles import still as oracles
from oracles.exact import box_hull, triangle_hull
from strategies import boxes as strategies_boxes
from strategies import meshes as strategies_meshes
from strategies import moving as strategies_moving
from strategies import still as strategies

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from hypothesis.strategies import SearchStrategy

SMALLEST_NORMAL = 2.0**-1022


def _reached(
    strategy: SearchStrategy[Any], count: int, check: Callable[[Any], Iterator[str]]
) -> Counter[str]:
    """Run `check` on `count` examples; return how often it named each set."""
    seen: Counter[str] = Counter()

    @strategies.examples(count)
    @given(strategy)
    def run(example: Any) -> None:
        seen.update(check(example))

    run()
    return seen


def _static_sets(separation: Fraction, size: float) -> Iterator[str]:
    yield "apart" if separation > 0 else "touching" if separation == 0 else "overlapping"
    if 0 < abs(separation) < Fraction(size) / 10**6:
        yield "nearly touching"
    if 0 < size < SMALLEST_NORMAL:
        yield "subnormal"
    if size > 2.0**300:
        yield "huge"


def test_triangle_pairs_reach_every_set_and_three_oracles_agree() -> None:
    def check(pair: strategies.TrianglePair) -> Iterator[str]:
        a, b = pair
        hulls = triangle_hull(a), triangle_hull(b)
        verdict = oracles.triangles_intersect(a, b)
        assert a.shape == b.shape == (3, 3)
        assert oracles.triangles_intersect(b[::-1], a[[1, 2, 0]]) == verdict
        assert oracles.triangles_intersect_by_features(a, b) == verdict
        assert oracles_lp.hulls_intersect_lp(*hulls) == verdict
        assert (oracles_distance.hulls_distance_squared(*hulls) == 0) == verdict
        separation = oracles.triangles_separation(a, b)
        assert (separation <= 0) == verdict
        yield from _static_sets(separation, float(np.abs(pair).max()))
        yield from (f"{len({tuple(p) for p in t.tolist()})} vertices" for t in pair)

    seen = _reached(strategies.triangle_pairs(), 300, check)

    wanted = {"apart", "touching", "overlapping", "nearly touching", "subnormal", "huge"}
    assert wanted | {"1 vertices", "2 vertices", "3 vertices"} <= set(seen)
    assert min(seen["apart"], seen["touching"]) > 30


def test_box_pairs_reach_every_set_and_two_oracles_agree() -> None:
    def check(pair: strategies_boxes.BoxPair) -> Iterator[str]:
        a, b = pair
        verdict = oracles.boxes_intersect(a, b)
        assert oracles.boxes_intersect(b, a) == verdict
        assert oracles_lp.hulls_intersect_lp(box_hull(a), box_hull(b)) == verdict
        for box in pair:
            assert np.abs(box.axes @ box.axes.T - np.eye(3)).max() < 1e-14
            assert (box.half_extents >= 0).all()
            yield "left-handed" if np.linalg.det(box.axes) < 0 else "right-handed"
            yield f"{np.count_nonzero(box.half_extents)} dimensions"
        separation = oracles.boxes_separation(a, b)
        assert (separation <= 0) == verdict
        size = max(x.max() for x in (*np.abs((a.center, b.center)), a.half_extents, b.half_extents))
        yield from _static_sets(separation, float(size))

    seen = _reached(strategies_boxes.box_pairs(), 300, check)

    wanted = {"apart", "touching", "overlapping", "nearly touching", "subnormal", "huge"}
    wanted |= {f"{n} dimensions" for n in range(4)} | {"left-handed", "right-handed"}
    assert wanted <= set(seen)
    assert min(seen["apart"], seen["touching"], seen["overlapping"]) > 8


def test_triangle_boxes_reach_every_set_and_two_oracles_agree() -> None:
    def check(pair: strategies_boxes.TriangleBox) -> Iterator[str]:
        verdict = oracles.triangle_box_intersect(*pair)
        hulls = triangle_hull(pair.triangle), box_hull(pair.box)
        assert oracles_lp.hulls_intersect_lp(*hulls) == verdict
        separation = oracles.triangle_box_separation(*pair)
        assert (separation <= 0) == verdict
        yield from _static_sets(separation, float(np.abs(pair.triangle).max()))

    seen = _reached(strategies_boxes.triangle_boxes(), 300, check)

    assert {"apart", "touching", "overlapping", "nearly touching", "huge"} <= set(seen)
    assert min(seen["apart"], seen["touching"], seen["overlapping"]) > 8


def _check_moving(hull_a: Any, hull_b: Any) -> Callable[[strategies_moving.Moving], Iterator[str]]:
    def check(moving: strategies_moving.Moving) -> Iterator[str]:
        a, b, *motion = moving
        assert all(np.isfinite(part).all() for part in motion)
        interval = oracles_moving.contact_interval(hull_a(a), hull_b(b), *motion)
        assert interval == oracles_lp.contact_interval_lp(hull_a(a), hull_b(b), *motion)
        if (moving.velocity_a == moving.velocity_b).all():
            yield "no relative motion"
        if interval is None:
            yield "never"
            return
        first, last = interval
        assert 0 <= first <= last <= Fraction(moving.duration)
        if first == 0:
            yield "at start"
        else:
            yield "at end" if float(first) == moving.duration else "between"
        yield "lasting" if last == moving.duration else "passing"

    return check


MOVING_SETS = {"never", "at start", "at end", "between", "lasting", "passing", "no relative motion"}


def test_moving_triangle_pairs_reach_every_set_and_two_oracles_agree() -> None:
    check = _check_moving(triangle_hull, triangle_hull)
    seen = _reached(strategies_moving.moving_triangle_pairs(), 250, check)

    assert set(seen) == MOVING_SETS
    assert min(seen["never"], seen["between"]) > 10


def test_moving_box_pairs_reach_every_set_and_two_oracles_agree() -> None:
    check = _check_moving(box_hull, box_hull)
    seen = _reached(strategies_moving.moving_box_pairs(), 250, check)

    assert set(seen) == MOVING_SETS
    assert min(seen["never"], seen["between"]) > 10


def test_moving_triangle_boxes_reach_every_set_and_two_oracles_agree() -> None:
    check = _check_moving(triangle_hull, box_hull)
    seen = _reached(strategies_moving.moving_triangle_boxes(), 250, check)

    assert set(seen) == MOVING_SETS
    assert min(seen["never"], seen["between"]) > 10


def test_mesh_oracles_agree_with_every_pair_decided_alone() -> None:
    def check(pair: tuple[strategies_meshes.Soup, strategies_meshes.Soup]) -> Iterator[str]:
        a, b = pair
        assert a.faces.min() >= 0
        assert a.faces.max() < len(a.vertices)
        expected = [
            (i, j)
            for i, face_a in enumerate(a.faces)
            for j, face_b in enumerate(b.faces)
            if oracles.triangles_intersect_by_features(a.vertices[face_a], b.vertices[face_b])
        ]
        assert oracles_mesh.mesh_pairs(*a, *b) == expected
        square, nearest = oracles_mesh.mesh_distance_squared(*a, *b)
        assert (square == 0) == bool(expected)
        assert not expected or nearest == expected
        intervals = oracles_mesh.mesh_contact_intervals(a, b, (0.0,) * 3, (0.0,) * 3, 1.0)
        assert sorted(intervals) == expected
        yield "meeting" if expected else "apart"

    seen = _reached(strategies_meshes.mesh_pairs(6, 6), 60, check)

    assert set(seen) == {"meeting", "apart"}


def test_grids_are_sheets_whose_inner_edges_are_shared_twice() -> None:
    def check(sheet: strategies_meshes.Soup) -> Iterator[str]:
        edges = Counter(
            frozenset((int(face[i - 1]), int(face[i]))) for face in sheet.faces for i in range(3)
        )
        assert set(edges.values()) <= {1, 2}
        yield "single" if len(sheet.faces) == 2 else "many"

    assert set(_reached(strategies_meshes.grids(2), 40, check)) == {"single", "many"}
