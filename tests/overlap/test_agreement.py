"""Brackets of one and the same depth have a number in common: swapped, turned, moved."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.solids import shifted
from meshes.surfaces import blob
from movers.meshes import box
from overlap.asking import ANY_NUMBER, Solid, protrusion, solid
from scenes.pairs import random_rotation

from obbcli import kernels

if TYPE_CHECKING:
    from collections.abc import Iterator

BLOB = blob(320).vertices, blob(320).faces


def thickness(a: Solid, b: Solid) -> tuple[float, float]:
    query = kernels.ThicknessQuery(
        a.tree.kernel,
        a.pose.kernel,
        b.tree.kernel,
        b.pose.kernel,
        tolerance=1e-3,
        floor=1e-9 * max(a.size, b.size),
        max_cells=3000,
    )
    while not query.advance(ANY_NUMBER):
        pass
    return query.bounds


def placements(a: Any, b: Any, seed: int) -> Iterator[tuple[Solid, Solid]]:
    """Yield two meshes in frames that all say the same."""
    common = random_rotation(seed + 1000), np.random.default_rng(seed).normal(size=3)
    yield solid(a), solid(b)
    yield solid(a, *common), solid(b, *common)
    yield solid(shifted(a, (3, 1, 2))), solid(shifted(b, (3, 1, 2)))


def assert_brackets_agree(a: Any, b: Any, seed: int) -> float:
    """Return the greatest thickness that is proven, with all brackets held against each other."""
    said: dict[str, list[tuple[float, float]]] = {"thickness": [], "of a": [], "of b": []}
    for one, other in placements(a, b, seed):
        said["thickness"] += [thickness(one, other), thickness(other, one)]
        said["of a"].append(protrusion(one, other, max_cells=3000).bounds)
        said["of b"].append(protrusion(other, one, max_cells=3000).bounds)

    rounding = 1e-14
    for brackets in said.values():
        for first, second in combinations(brackets, 2):
            assert first[0] <= second[1] + rounding
            assert second[0] <= first[1] + rounding
    return max(low for low, _ in said["thickness"])


@pytest.mark.parametrize("thin", [1e-2, 1e-4, 2e-5])
@pytest.mark.parametrize("seed", range(8))
def test_brackets_of_a_pierced_plate_agree(seed: int, thin: float) -> None:
    plate = box((-2, -2, 0), (2, 2, thin))
    turned = np.asarray(plate[0]) @ random_rotation(seed).T + 0.1, plate[1]

    assert assert_brackets_agree(turned, BLOB, seed) <= thin * (1 + 1e-9)


@pytest.mark.parametrize("thin", [1e-2, 1e-5])
@pytest.mark.parametrize("seed", range(16))
def test_brackets_agree_where_many_directions_are_nearly_one(seed: int, thin: float) -> None:
    # Heights along one of them say nothing along another, though they differ by 1e-6 only.
    random = np.random.default_rng(seed)
    squash = np.ones(3)
    squash[seed % 3] = thin
    surface = blob(320, seed % 5)
    flat = surface.vertices * squash + random.integers(0, 3, 3), surface.faces
    low = random.integers(0, 2, 3)

    assert_brackets_agree(flat, box(low, low + random.integers(1, 4, 3)), seed)
