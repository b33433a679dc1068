"""Volumes of random pairs of solids against manifold3d, a second opinion."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import trimesh
from scenes.pairs import random_rotation

from obbcli import Body, Mesh, ObbTree, Pose, kernels
from obbcli.view.shared_solid import shared_solid

pytestmark = pytest.mark.needs("manifold3d")

# What manifold3d may be off by: it moves coordinates by about 1e-12 of solids some units large.
ROUNDING = 1e-9


def solid(random: np.random.Generator) -> Mesh:
    """Return a box, thin or not, a cylinder, a tube or a ball, often on a grid."""
    steps = random.integers(1, 8, 6) / 4 if random.random() < 0.6 else random.uniform(0.1, 2, 6)
    kind = random.integers(5)
    if kind == 0:
        made = trimesh.creation.box(extents=steps[:3])
    elif kind == 1:
        made = trimesh.creation.box(extents=(2, 2, 10.0 ** -random.integers(1, 10)))
    elif kind == 2:
        made = trimesh.creation.cylinder(steps[0], steps[1], sections=int(random.integers(3, 24)))
    elif kind == 3:
        sections = int(random.integers(4, 24))
        made = trimesh.creation.annulus(0.5, 1.25, steps[0], sections=sections)
    else:
        made = trimesh.creation.icosphere(subdivisions=int(random.integers(3)), radius=steps[0])
    shift = steps[3:] - 1
    return Mesh(np.asarray(made.vertices, np.float64) + shift, np.asarray(made.faces))


@pytest.mark.parametrize("seed", range(8))
def test_random_pairs_agree_with_manifold(seed: int) -> None:
    random = np.random.default_rng(seed)

    for _ in range(12):
        trees = [ObbTree.build(solid(random)) for _ in range(2)]
        poses = [Pose(), Pose()]
        if random.random() < 0.5:
            turn = random_rotation(int(random.integers(1000)))
            poses = [Pose(turn, random.normal(size=3)) for _ in range(2)]
        bodies: Any = tuple(map(Body, trees, poses))
        asked = [x for tree, pose in zip(trees, poses, strict=True) for x in (tree, pose)]
        query = kernels.ColumnVolume(*(x.kernel for x in asked))
        while not query.advance(2**40):
            pass

        low, high = query.bounds
        volume = shared_solid(bodies).volume
        assert low <= high <= low + 1e-6 * max(high, 1e-3)
        assert low - ROUNDING <= volume <= high + ROUNDING
