"""Two meshes of which the one travels straight on: hits, misses, grazes and ties; from a seed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from movers.meshes import box
from scenes.pairs import random_rotation

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


class Straight(NamedTuple):
    """Triangles (N, 3, 3) of A at rest and of B, and B's velocity, mesh units a second."""

    a: Floats
    b: Floats
    velocity: Floats


def _apart(rng: Any, reach: float) -> Floats:
    way: Floats = rng.normal(size=3)
    return way * (reach / np.linalg.norm(way))


def _soup(rng: Any) -> Straight:
    a, b = (_cloud(rng, 10.0 ** rng.uniform(-2, 0)) for _ in range(2))
    way = _apart(rng, 4)
    return Straight(a, b + way, -rng.uniform(0.5, 2) * way + rng.normal(size=3) * 0.3)


def _cloud(rng: Any, size: float) -> Floats:
    count = int(rng.integers(1, 40))
    cloud: Floats = rng.normal(size=(count, 1, 3)) / 2 + size * rng.normal(size=(count, 3, 3))
    return cloud


def _lattice(rng: Any) -> Straight:
    # Whole numbers: corners on corners, edges on edges, faces that slide along faces.
    a, b = (rng.integers(-2, 3, (int(rng.integers(1, 20)), 3, 3)) / 1.0 for _ in range(2))
    way = rng.integers(-6, 7, 3) / 1.0
    return Straight(a, b + way, -rng.choice([0.5, 1, 2]) * way + rng.integers(-1, 2, 3))


def _degenerate(rng: Any) -> Straight:
    a, b, velocity = _lattice(rng)
    for triangles in (a, b):
        kind = rng.integers(0, 3, len(triangles))
        triangles[kind > 0, 2] = triangles[kind > 0, 1]  # segments
        triangles[kind > 1, 1:] = triangles[kind > 1, :1]  # points
    return Straight(a, b, velocity)


def _boxes(rng: Any) -> Straight:
    a, b = (np.array(v)[np.array(f)] for v, f in (box((0, 0, 0), (2, 1, 3)),) * 2)
    way = rng.integers(-3, 4, 3) * 1.0
    way[int(rng.integers(3))] = 4 * rng.choice([-1, 1])
    ahead = rng.choice([0, 0, 2.0**-40, -(2.0**-50)], 3)
    return Straight(a, b + way + ahead, -rng.choice([0.5, 1, 2]) * way)


def _sheets(rng: Any) -> Straight:
    # Flat or nearly so, one above the other: it falls, slides, or falls slowly while it slides.
    a, b = (_sheet(rng, rng.choice([0, 1e-12, 0.05])) for _ in range(2))
    way = np.array([*(rng.integers(-4, 5, 2) / 8), rng.choice([0.25, 2.0**-30, 1e-9])])
    slide = rng.integers(-4, 5, 2) / 4
    return Straight(a, b + way, np.array([*slide, -way[2] * rng.choice([0, 0.5, 1, 2])]))


def _sheet(rng: Any, bumps: float) -> Floats:
    cells = int(rng.integers(1, 6))
    x, y = np.meshgrid(np.arange(cells + 1) / 8, np.arange(cells + 1) / 8, indexing="ij")
    p = np.stack([x, y, bumps * rng.normal(size=x.shape)], axis=-1)
    lower = np.stack([p[:-1, :-1], p[1:, :-1], p[1:, 1:]], axis=2)
    upper = np.stack([p[:-1, :-1], p[1:, 1:], p[:-1, 1:]], axis=2)
    return np.concatenate([lower.reshape(-1, 3, 3), upper.reshape(-1, 3, 3)])


def _needles(rng: Any) -> Straight:
    # A million times as long as wide, in boxes of such shapes, close to each other.
    turns = [random_rotation(int(rng.integers(2**32))) for _ in range(2)]
    shape = 10.0 ** rng.uniform(-6, 0, 3)
    a, b = ((rng.uniform(-1, 1, (9, 3, 3)) * shape) @ turn.T for turn in turns)
    way = _apart(rng, 3)
    return Straight(a, b + way, -rng.uniform(0.9, 2) * way)


def _mixed(rng: Any) -> Straight:
    a, b, velocity = _soup(rng)
    return Straight(a, b * 10.0 ** rng.uniform(-6, 0), velocity * 10.0 ** rng.uniform(-3, 0))


KINDS: dict[str, Callable[[Any], Straight]] = {
    "soup": _soup,
    "lattice": _lattice,
    "degenerate": _degenerate,
    "boxes": _boxes,
    "sheets": _sheets,
    "needles": _needles,
    "mixed sizes": _mixed,
}
