"""Boxes on a lattice, whose faces, edges and corners coincide more often than not: all is known."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest
from movers.meshes import box
from scenes.pairs import random_rotation

import obbcli
from obbcli import Body, Mesh, Pose

PLACES = 5


def drawn(random: np.random.Generator) -> tuple[Any, Any]:
    """Return the lower and upper corner of a box on the lattice."""
    while True:
        low, high = np.sort(random.integers(0, PLACES, (2, 3)), axis=0)
        if (low < high).all():
            return low, high


def truth(a: Any, b: Any) -> tuple[str, str | None]:
    """Return the relation of two boxes, by their corners alone."""
    low, high = np.maximum(a[0], b[0]), np.minimum(a[1], b[1])
    if (low > high).any():
        return "clear", None
    if (low == high).any():
        return "touching", None
    inside = [bool((low == one[0]).all() and (high == one[1]).all()) for one in (a, b)]
    if all(inside):
        return "duplicate", None
    if any(inside):
        return "contained", "a" if inside[0] else "b"
    return "overlapping", None


def depth_into(a: Any, b: Any) -> float:
    """Return how deep A's surface reaches into B: the best point of each side of A that is in B.

    A side of A within B is a rectangle; the depth of its points in B is the least of six linear
    functions, each of one coordinate, and so largest where each coordinate is as near to the middle
    of B as the rectangle allows.
    """
    best = 0.0
    for axis, end in product(range(3), (0, 1)):
        low, high = np.maximum(a[0], b[0]).astype(float), np.minimum(a[1], b[1]).astype(float)
        low[axis] = high[axis] = a[end][axis]
        if (low > high).any() or not b[0][axis] < a[end][axis] < b[1][axis]:
            continue
        point = np.clip((b[0] + b[1]) / 2, low, high)
        best = max(best, float(np.minimum(point - b[0], b[1] - point).min()))
    return best


@pytest.mark.parametrize("seed", range(120))
def test_boxes_on_a_lattice(seed) -> None:
    random = np.random.default_rng(seed)
    a, b = drawn(random), drawn(random)
    turn = Pose(random_rotation(seed), random.uniform(-3, 3, 3)) if seed % 2 else Pose()
    bodies = [Body(Mesh(*box(*corners)), turn) for corners in (a, b)]
    relation, inner = truth(a, b)

    found, swapped = obbcli.overlap(*bodies), obbcli.overlap(*bodies[::-1])

    assert (found.relation, found.contained) == (relation, inner)
    assert swapped.relation == relation
    assert swapped.thickness.bounds == found.thickness.bounds
    assert swapped.protrusion_b.bounds == found.protrusion_a.bounds
    assert swapped.distance.bounds == found.distance.bounds
    sides = np.maximum(np.minimum(a[1], b[1]) - np.maximum(a[0], b[0]), 0)
    depths = float(sides.min()), depth_into(a, b), depth_into(b, a)
    for one, depth in zip(
        (found.thickness, found.protrusion_a, found.protrusion_b), depths, strict=True
    ):
        low, high = one.bounds
        assert low - 1e-12 <= depth <= high + 1e-12
    if found.volume is not None:
        low, high = found.volume.bounds
        assert low - 1e-12 <= float(np.prod(sides)) <= high + 1e-12
