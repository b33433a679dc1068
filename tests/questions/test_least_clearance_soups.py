"""Least clearances of random triangles, some degenerate, that turn as fast as 100 rad/s."""

from __future__ import annotations

import numpy as np
import pytest
from movers.answers import as_body
from oracles.gaps import gap_at
from oracles.screw import Mover

from obbcli import clearance

GOLDEN = 0.6180339887498949
TIMES = np.linspace(0.0, 1.0, 201)


def soup(random, spin_of=None):
    """Return a few triangles with a random motion; `spin_of` is a body to share an axis with."""
    count = int(random.integers(1, 5))
    vertices = random.normal(size=(3 * count, 3)) * random.choice([0.1, 1, 3])
    if random.random() < 0.2:
        vertices[1] = vertices[0]
    if random.random() < 0.2:
        vertices[2] = 0.5 * (vertices[0] + vertices[1])
    spin = random.normal(size=3) * random.choice([0, 0.5, 3, 12, 40])
    if spin_of is not None and random.random() < 0.3:
        spin = spin_of.spin * random.choice([1, -1, 2, 0.5])
    place = random.normal(size=3) * random.choice([1, 3])
    velocity = random.normal(size=3) * random.choice([0, 1, 4])
    pivot = place + random.normal(size=3) * random.choice([0, 1, 3])
    faces = np.arange(3 * count).reshape(-1, 3)
    return Mover(vertices, faces, np.eye(3), place, velocity, spin, pivot)


def least_by_descent(a, b, distances):
    """Return the least distance near the nearest samples, by the golden section."""
    least = min(distances)
    for place in np.argsort(distances)[:3]:
        low, high = max(TIMES[place] - 0.005, 0.0), min(TIMES[place] + 0.005, 1.0)
        for _ in range(30):
            left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
            if gap_at(a, b, left) < gap_at(a, b, right):
                high = right
            else:
                low = left
        least = min(least, gap_at(a, b, 0.5 * (low + high)))
    return least


@pytest.mark.parametrize("seed", range(16))
def test_no_distance_on_the_way_is_below_the_bracket(seed):
    random = np.random.default_rng(seed)
    a = soup(random)
    b = soup(random, a)
    tolerance = float(random.choice([1e-3, 1e-6, 1e-9]))
    answer = clearance(as_body(a), as_body(b), 1.0, tolerance=tolerance)
    low, high = answer.minimum.bounds
    distances = [gap_at(a, b, time) for time in TIMES]

    assert answer.complete
    assert least_by_descent(a, b, distances) >= low - 1e-12
    if answer.first_contact is None:
        assert high - low <= tolerance * high + 1e-10
        assert gap_at(a, b, answer.minimum.time) == pytest.approx(high, abs=1e-10)
        for time, distance in zip(TIMES, distances, strict=True):
            is_told = any(lo <= time <= hi for lo, hi in answer.minimum.when)
            assert is_told or distance > high - 1e-12
