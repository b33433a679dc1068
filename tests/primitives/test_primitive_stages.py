"""Which stage decides a pair: doubles where they can, integers where they must."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from obbcli import kernels
from obbcli.primitives import Obb, Triangle

RESTING = np.zeros((1, 3))
MEETS, EXACT = 1, 2

FLOOR = np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0]])
CUBE = Obb([0, 0, 0], np.eye(3), [1, 1, 1])
TURNED = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]


def verdict(a: Any, b: Any, velocity: Any = (0, 0, 0), duration: float = 0.0) -> int:
    """Return the kernel's byte about one pair."""
    found = np.empty(1, dtype=np.uint8)
    moving = np.array([velocity], dtype=np.float64)
    times = np.array([duration])
    kernels.primitive_intersects(a.rows, b.rows, RESTING, moving, times, 1, found)
    return int(found[0])


def triangle(vertices: Any) -> Triangle:
    return Triangle(np.array(vertices, dtype=np.float64))


THROUGH = [[1, 1, -1], [1.5, 1, 1], [1, 1.75, 1]]


@pytest.mark.parametrize(
    ("b", "wanted"),
    [
        (THROUGH, MEETS),
        (np.add(THROUGH, [0, 0, 3]), 0),
        (np.add(THROUGH, [5, 0, 0]), 0),
        (np.add(THROUGH, [0, 0, 1]), MEETS | EXACT),
        (np.add(THROUGH, [0, 0, 1 + 1e-9]), 0),
        ([[4, 0, 0], [6, 0, 1], [6, 1, 2]], MEETS | EXACT),
        (np.add(FLOOR, [1, 1, 0]), MEETS | EXACT),
        (np.add(FLOOR, [9, 9, 0]), 0),
        ([[3, 3, 0], [9, 3, 0], [3, 9, 0]], 0),
        ([[2, 2, 0], [9, 3, 0], [3, 9, 0]], MEETS | EXACT),
        ([[1, 1, 0]] * 3, MEETS | EXACT),
    ],
)
def test_triangles_are_left_to_integers_where_they_only_touch(b: Any, wanted: int) -> None:
    assert verdict(triangle(FLOOR), triangle(b)) == wanted


@pytest.mark.parametrize("exponent", [-1000, -200, 200, 900])
def test_sizes_out_of_the_filters_range_are_left_to_integers(exponent: int) -> None:
    a, b = np.ldexp(FLOOR, exponent), np.ldexp(THROUGH, exponent)
    small, large = np.ldexp(1.0, exponent), np.ldexp(3.0, exponent)

    assert verdict(triangle(a), triangle(b)) & MEETS
    # Boxes are bounded by absolute terms; far beyond those, doubles do not try.
    box_a = Obb([0, 0, 0], np.eye(3), [small] * 3)
    box_b = Obb([large, 0, 0], np.eye(3), [small] * 3)
    assert verdict(box_a, box_b) == (EXACT if abs(exponent) > 600 or exponent > 100 else 0)


@pytest.mark.parametrize(
    ("gap", "wanted"), [(1e-3, 0), (1e-6, 0), (1e-9, 0), (1e-12, 0), (0.0, MEETS | EXACT)]
)
def test_boxes_that_nearly_touch_need_no_integers(gap: float, wanted: int) -> None:
    other = Obb([2 + gap, 0.5, 0.25], np.eye(3), [1, 1, 1])

    assert verdict(CUBE, other) == wanted


def test_boxes_whose_axes_are_barely_orthonormal_are_taken_literally() -> None:
    skew = np.eye(3)
    skew[0, 1] = 9e-10
    leaning = Obb([0, 0, 0], skew, [1, 1, 1])

    # The corner at y = 1 + 9e-10 is beyond where a rectangular box would end.
    assert verdict(leaning, Obb([0.5, 2 + 8e-10, 0], np.eye(3), [1, 1, 1])) & MEETS
    assert not verdict(leaning, Obb([0.5, 2 + 10e-10, 0], np.eye(3), [1, 1, 1])) & MEETS


def test_parallel_boxes_that_overlap_need_no_integers() -> None:
    for axes in (np.eye(3), TURNED):
        a, b = (Obb(center, axes, [1, 2, 3]) for center in ([0, 0, 0], [0.5, 0.25, 1]))

        assert verdict(a, b) == MEETS
        assert verdict(a, b, [0.25, 0, 0], 1.0) == MEETS


@pytest.mark.parametrize(
    ("velocity", "duration", "wanted"),
    [
        ((0, 0, -1), 1.0, 0),
        ((0, 0, -1), 3.0, MEETS),
        ((0, 0, -1), 2.0, MEETS | EXACT),
        ((1, 0, 0), 9.0, 0),
        ((1, 0, -1e-30), 9.0, 0),
    ],
)
def test_moving_pairs_are_left_to_integers_where_time_runs_out_at_contact(
    velocity: Any, duration: float, wanted: int
) -> None:
    above = triangle(np.add(THROUGH, [0, 0, 3]))
    box = Obb([1, 1, 3], np.eye(3), [1, 1, 1])

    assert verdict(triangle(FLOOR), above, velocity, duration) == wanted
    assert verdict(triangle(FLOOR), box, velocity, duration) == wanted
    assert verdict(Obb([1, 1, -1], np.eye(3), [3, 3, 1]), box, velocity, duration) == wanted
