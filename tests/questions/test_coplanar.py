"""Triangles of one plane meet as exact arithmetic says, needles and points among them.

Of such pairs no axis out of the plane decides, and those in it are exact unless doubles are sure.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from oracles.mesh import mesh_pairs

import obbcli
from obbcli import Body, Mesh, ObbTree

COUNT = 14
SCALES = (1.0, 2.0**-300, 2.0**90, 2.0**400)


def _in_plane(random: Any, reach: int) -> Any:
    """Return the vertices of `COUNT` triangles in one plane through 0, exact in doubles.

    A third of them are needles: their corners are on a line, or one unit off it.
    """
    across, along = random.integers(-20, 21, (2, 3))
    places = random.integers(-reach, reach + 1, (2 * COUNT, 3, 2))
    needles = places[::3]
    needles[..., 1] = 2 * needles[..., 0] + random.integers(0, 2, needles.shape[:2])
    points = places[..., :1] * across + places[..., 1:] * along
    points[1::4, 0] = points[0::4, 1]  # corners that two triangles share
    return points.astype(np.float64).reshape(2, 3 * COUNT, 3)


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("seed", range(12))
def test_triangles_of_one_plane_meet_as_exact_arithmetic_says(seed: int, scale: float) -> None:
    random = np.random.default_rng(seed)
    faces = np.arange(3 * COUNT).reshape(-1, 3)
    vertices = scale * _in_plane(random, int(random.choice([3, 10, 1000, 100_000])))
    bodies = [Body(ObbTree.build(Mesh(v, faces))) for v in vertices]

    found = obbcli.triangle_pairs(*bodies)

    truth = mesh_pairs(vertices[0], faces, vertices[1], faces)
    assert [tuple(pair) for pair in found.tolist()] == truth
    assert obbcli.collide(*bodies).collides == bool(truth)
