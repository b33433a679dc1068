"""Random pairs of closed solids on a lattice: flush faces, hollows, plates, many parts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from meshes.solids import joined, shifted, turned_over
from meshes.surfaces import box as fine_box
from movers.meshes import box, disc
from overlap.asking import solid
from scenes.pairs import random_rotation

if TYPE_CHECKING:
    from overlap.asking import Solid


def many(triangles: int, low: Any, high: Any) -> Any:
    """Return a box of so many triangles."""
    sides = tuple(float(top - base) for base, top in zip(low, high, strict=True))
    surface = fine_box(triangles, sides)
    lowest = surface.vertices.min(axis=0)
    return surface.vertices + (np.asarray(low, dtype=float) - lowest), surface.faces


def lattice_solid(random: np.random.Generator) -> Any:
    """Return a closed solid on a small lattice: boxes side by side, hollows, plates, pins."""
    low = random.integers(0, 4, 3)
    high = low + random.integers(1, 4, 3)
    kind = random.integers(5)
    if kind == 0:
        return many(int(random.integers(12, 200)), low, high)
    if kind == 1 and np.all(high - low > 2):
        return joined(box(low, high), turned_over(box(low + 1, high - 1)))
    if kind == 2:
        return joined(
            box(low, high), box(low + (high - low) * [1, 0, 0], high + np.array([1, 0, 0]))
        )
    if kind == 3:
        return shifted(disc(int(random.integers(3, 9)), 2, 0, 3), low)
    return box(low, high)


def placed_pair(seed: int) -> tuple[Solid, Solid]:
    """Return two random solids, aligned in half of the cases, otherwise turned, moved or thin."""
    random = np.random.default_rng(seed)
    meshes = [lattice_solid(random) for _ in range(2)]
    if random.random() < 0.3:
        vertices, faces = meshes[1]
        meshes[1] = np.asarray(vertices) * [1, 1, random.choice([1e-3, 1e-6, 0.01])], faces
    if random.random() < 0.5:
        return solid(meshes[0]), solid(meshes[1])
    common = random_rotation(seed), random.normal(size=3)
    if random.random() < 0.5:
        return solid(meshes[0], *common), solid(meshes[1], *common)
    return solid(meshes[0]), solid(meshes[1], *common)
