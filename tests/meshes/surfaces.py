"""Deterministic closed surfaces of any number of triangles, from NumPy alone.

`scenes.pairs` places them in pairs. Coordinates lie on a grid of 2**-24, so that a shift by a
coordinate rounds nothing, and faces turn counter-clockwise seen from outside.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int64]

GRID = 2.0**-24
BLOB_WAVES = 6
BLOB_HEIGHT = 0.5


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles: vertices float64 (V, 3), faces int64 (F, 3); read-only."""

    vertices: Floats
    faces: Indices

    def __post_init__(self) -> None:
        self.vertices.setflags(write=False)
        self.faces.setflags(write=False)

    @property
    def diagonal(self) -> float:
        """The length of the diagonal of the axis-aligned box."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))


def _on_grid(vertices: Floats) -> Floats:
    return np.round(vertices / GRID) * GRID


def _icosahedron() -> tuple[Floats, Indices]:
    golden = (1 + 5**0.5) / 2
    corners = np.array([(0.0, s, t * golden) for s in (-1, 1) for t in (-1, 1)])
    corners = np.concatenate([np.roll(corners, k, axis=1) for k in range(3)])
    near = np.linalg.norm(corners[:, None] - corners[None], axis=2)
    edge = np.isclose(near, 2.0)
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if edge[i, j] and edge[j, k] and edge[i, k]
    ]
    turned = [f if np.linalg.det(corners[list(f)]) > 0 else (f[0], f[2], f[1]) for f in faces]
    return corners / np.linalg.norm(corners[0]), np.array(turned, dtype=np.int64)


@lru_cache(maxsize=4)
def geodesic(triangles: int) -> tuple[Floats, Indices]:
    """Return unit directions (V, 3) and the faces of an icosahedron cut f-fold, 20 f**2 of them."""
    f = max(1, round((triangles / 20) ** 0.5))
    corners, base = _icosahedron()
    # One corner lattice: i steps towards the second corner, j towards the third.
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(f + 1), np.arange(f + 1), indexing="ij"))
    i, j = i[i + j <= f], j[i + j <= f]
    number = np.full((f + 1, f + 1), -1, dtype=np.int64)
    number[i, j] = np.arange(len(i))
    up = np.array(
        [
            (number[a, b], number[a + 1, b], number[a, b + 1])
            for a, b in zip(i, j, strict=True)
            if a + b < f
        ]
    )
    down = np.array(
        [
            (number[a + 1, b], number[a + 1, b + 1], number[a, b + 1])
            for a, b in zip(i, j, strict=True)
            if a + b < f - 1
        ],
        dtype=np.int64,
    ).reshape(-1, 3)
    lattice = np.concatenate([up, down])
    weights = np.stack([f - i - j, i, j], axis=1)
    # A point on an edge belongs to two base faces: its weighted corners, sorted, name it once.
    codes = np.where(weights[None] > 0, base[:, None, :] * (f + 1) + weights[None], -1)
    names = np.sort(codes, axis=2) + 1
    span = 12 * (f + 1) + 1
    keys = (names[..., 0] * span + names[..., 1]) * span + names[..., 2]
    _, first, vertex = np.unique(keys.ravel(), return_index=True, return_inverse=True)
    points = np.einsum("pk,fkx->fpx", weights.astype(np.float64), corners[base]).reshape(-1, 3)[
        first
    ]
    faces = vertex.reshape(len(base), -1)[:, lattice].reshape(-1, 3).astype(np.int64)
    return points / np.linalg.norm(points, axis=1)[:, None], faces


@lru_cache(maxsize=8)
def sphere(triangles: int, radius: float = 1.0) -> Surface:
    """Return a geodesic sphere with its vertices on `radius`."""
    directions, faces = geodesic(triangles)
    return Surface(_on_grid(radius * directions), faces.copy())


@lru_cache(maxsize=8)
def blob(triangles: int, seed: int = 0) -> Surface:
    """Return a bumpy closed surface, star-shaped about 0, of radius 0.5 to 1.5."""
    directions, faces = geodesic(triangles)
    random = np.random.default_rng(seed)
    waves = random.normal(size=(BLOB_WAVES, 3)) * 3.0
    phases = random.uniform(0, 2 * np.pi, BLOB_WAVES)
    height = np.sin(directions @ waves.T + phases).mean(axis=1)
    return Surface(_on_grid(directions * (1 + BLOB_HEIGHT * height)[:, None]), faces.copy())


def _quads(number: Indices) -> Indices:
    """Return the triangles of a lattice of vertex numbers (M, N)."""
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    return np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)


@lru_cache(maxsize=8)
def torus(triangles: int, tube_radius: float) -> Surface:
    """Return a torus about z whose tube follows the unit circle; its vertices lie on the torus."""
    around_tube = max(3, round((triangles / 4) ** 0.5))
    around_axis = 2 * around_tube
    axis_angle = np.arange(around_axis) * (2 * np.pi / around_axis)
    tube_angle = np.arange(around_tube) * (2 * np.pi / around_tube)
    u, v = np.meshgrid(axis_angle, tube_angle, indexing="ij")
    ring = 1 + tube_radius * np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), tube_radius * np.sin(v)], axis=-1)
    number = np.arange(around_axis * around_tube).reshape(around_axis, around_tube)
    wrapped = np.pad(number, ((0, 1), (0, 1)), mode="wrap")
    return Surface(_on_grid(vertices.reshape(-1, 3)), _quads(wrapped))


@lru_cache(maxsize=8)
def box(triangles: int, sides: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Surface:
    """Return the box [0, sides], each side a lattice of 12 m**2 triangles in all."""
    m = max(1, round((triangles / 12) ** 0.5))
    steps = np.arange(m + 1)
    u, v = np.meshgrid(steps, steps, indexing="ij")
    patches, points = [], []
    for axis in range(3):
        for end in (0, m):
            lattice = np.empty((m + 1, m + 1, 3), dtype=np.int64)
            lattice[..., axis] = end
            # On the near side the other axes change places: the face still looks outwards.
            one, two = ((axis + 1) % 3, (axis + 2) % 3) if end else ((axis + 2) % 3, (axis + 1) % 3)
            lattice[..., one], lattice[..., two] = u, v
            points.append(lattice.reshape(-1, 3))
            patches.append(_quads((len(patches) * u.size) + np.arange(u.size).reshape(u.shape)))
    keys = np.concatenate(points) @ np.array([(m + 1) ** 2, m + 1, 1])
    _, first, vertex = np.unique(keys, return_index=True, return_inverse=True)
    corners = np.concatenate(points)[first] / m * np.array(sides)
    return Surface(
        _on_grid(corners), vertex[np.concatenate(patches)].reshape(-1, 3).astype(np.int64)
    )


@lru_cache(maxsize=4)
def sheet(triangles: int, height: float = 0.0) -> Surface:
    """Return an open, wavy sheet over the unit square: z = height sin(2 pi x) sin(2 pi y)."""
    m = max(1, round((triangles / 2) ** 0.5))
    x, y = np.meshgrid(np.arange(m + 1) / m, np.arange(m + 1) / m, indexing="ij")
    z = height * np.sin(2 * np.pi * x) * np.sin(2 * np.pi * y)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    return Surface(_on_grid(vertices), _quads(np.arange((m + 1) ** 2).reshape(m + 1, m + 1)))
