"""The bound that weights of rows prove over the corners of a box, by exact sums and by duality."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from obbcli import kernels

CORNERS = 8


def solve(rows: Any, demands: Any = ()) -> tuple[float, Any, Any]:
    """Return the bound, all weights, and the weights of the corners."""
    bound, weights, corners = kernels.solve_matrix_game(
        np.array(rows, dtype=np.float64).reshape(-1, CORNERS),
        np.array(demands, dtype=np.float64).reshape(-1, CORNERS),
    )
    return bound, np.array(weights), np.array(corners)


def proven(rows: Any, demands: Any, weights: Any) -> Fraction:
    """Return the largest of the weighted sums over the corners, exactly, the rows' made a mean."""
    exact = [Fraction(float(w)) for w in weights]
    assert min(exact) >= 0
    total = sum(exact[: len(rows)])
    all_rows = [*rows, *demands]
    shares = [w / total if k < len(rows) else w for k, w in enumerate(exact)]
    return max(
        sum(w * Fraction(float(row[k])) for w, row in zip(shares, all_rows, strict=True))
        for k in range(CORNERS)
    )


@pytest.mark.parametrize("scale", [1e-300, 1e-12, 1.0, 1e12, 1e300])
@pytest.mark.parametrize("demand_count", [0, 1, 5])
def test_bound_is_proven_and_attained(scale, demand_count):
    random = np.random.default_rng(demand_count)
    for row_count in (1, 2, 3, 8, 20):
        rows = scale * random.normal(size=(row_count, CORNERS))
        demands = random.normal(size=(demand_count, CORNERS)) + 0.8
        bound, weights, corners = solve(rows, demands)
        assert proven(rows, demands, weights) <= Fraction(bound)
        assert corners.sum() == pytest.approx(1)
        assert corners.min() >= 0
        # No weights prove less than the least row at a mix of corners that meets all demands.
        assert (demands @ corners >= -1e-9).all()
        assert bound - (rows @ corners).min() <= 1e-9 * scale


def test_equal_rows_are_the_row():
    row = np.arange(CORNERS) / 4
    bound, weights, _ = solve([row] * 5)
    assert bound == pytest.approx(1.75)
    assert weights.sum() == pytest.approx(1)


def test_demand_that_no_corner_meets_leaves_nothing():
    rows = np.ones((2, CORNERS))
    bound, _, _ = solve(rows, [np.full(CORNERS, -1.0)])
    assert bound < 1 - 1e-3


def test_linear_rows_over_a_box_meet_between_corners():
    ends = np.array([[k & 1, k >> 1 & 1, k >> 2 & 1] for k in range(CORNERS)], dtype=float)
    x, y, _ = ends.T
    # min(x, 1 - x, y + 1/4) is at most 1/2; with y <= 1/8, or 1/8 - y >= 0, at most 3/8.
    bound, _, corners = solve([x, 1 - x, y + 0.25])
    assert bound == pytest.approx(0.5)
    assert x @ corners == pytest.approx(0.5)
    bound, _, corners = solve([x, 1 - x, y + 0.25], [0.125 - y])
    assert bound == pytest.approx(0.375)
    assert y @ corners == pytest.approx(0.125)


def test_numbers_that_are_none_prove_nothing():
    rows = np.ones((2, CORNERS))
    rows[1, 3] = np.nan
    assert solve(rows)[0] >= 1  # the other row alone proves that
    assert solve(np.full((1, CORNERS), np.nan))[0] == np.inf


def test_games_without_rows_or_with_too_many_are_refused():
    for count in (0, 33):
        with pytest.raises(ValueError, match="1 to 32"):
            solve(np.ones((count, CORNERS)))
