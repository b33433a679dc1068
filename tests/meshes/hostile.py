"""Surfaces made to hurt: of any number of triangles, in pairs, with the way that one of them goes.

Shared by tests, which ask small ones and count, and by the bench, which asks large ones and looks
at the clock. Nothing here imports the package.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from meshes.surfaces import Surface, sheet, sphere

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

Triple = tuple[float, float, float]
ZERO: Triple = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class HostilePair:
    """Two surfaces, and where and how the second one moves.

    Attributes:
        a, b: the surfaces; a's coordinates are the world's.
        apart: (3,), shift of b at which the two are apart.
        close: (3,), shift of b at which as much as possible touches.
        velocity: (3,), mesh units a second, from `apart` towards a: they meet within a second.
        spin: (3,), rad/s.
    """

    a: Surface
    b: Surface
    apart: Triple
    close: Triple
    velocity: Triple
    spin: Triple = (0.5, 0.25, 2.0)


def soup(triangles: Floats) -> Surface:
    """Return triangles (N, 3, 3) that share no vertices."""
    count = len(triangles)
    return Surface(triangles.reshape(-1, 3).copy(), np.arange(3 * count).reshape(-1, 3))


def coincident(count: int) -> Surface:
    """Return one triangle so many times."""
    return Surface(
        np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.25]]),
        np.tile(np.arange(3), (count, 1)),
    )


def needles(count: int) -> Surface:
    """Return needles that all pass through the origin: 2 long, a millionth wide."""
    rng = np.random.default_rng(1)
    way = rng.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    side = 1e-6 * np.cross(way, [0.6, 0.0, 0.8])
    return soup(np.stack([way + side, way - side, -way], axis=1))


def crossing(count: int) -> Surface:
    """Return triangles of which any two cross: each holds a piece of the z axis about z = 0."""
    rng = np.random.default_rng(2)
    angle = rng.uniform(0, np.pi, count)
    out = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    return soup(np.stack([-out - up, -out + up, 2 * out], axis=1))


def huge_and_tiny(count: int) -> Surface:
    """Return one triangle a million wide, and a cloud of tiny ones on both its sides."""
    rng = np.random.default_rng(3)
    tiny = rng.uniform(-1, 1, (count - 1, 1, 3)) + 1e-3 * rng.uniform(-1, 1, (count - 1, 3, 3))
    huge = 1e6 * np.array([[[-1.0, -1.0, 0.0], [2.0, -1.0, 0.0], [-1.0, 2.0, 0.0]]])
    return soup(np.concatenate([huge, tiny]))


def points(count: int) -> Surface:
    """Return triangles that are points or segments, all degenerate."""
    rng = np.random.default_rng(4)
    ends = rng.uniform(-1, 1, (count, 2, 3))
    ends[::2, 1] = ends[::2, 0]
    ends[1::2, 1] = ends[1::2, 0] + 0.01 * ends[1::2, 1]
    return soup(ends[:, [0, 1, 1]])


def chain(count: int) -> Surface:
    """Return a spiral that shrinks by the same factor from triangle to triangle: deep trees."""
    k = np.arange(count + 2)
    radius = 2.0 ** (-600.0 * k / count)
    angle = 0.7 * k
    path = np.stack([radius * np.cos(angle), radius * np.sin(angle), radius], axis=1)
    return Surface(path, np.stack([k[:-2], k[1:-1], k[2:]], axis=1))


def stacked(count: int) -> Surface:
    """Return flat grids on top of one another, sixteen times the same."""
    layer = sheet(max(count // 16, 2))
    faces = [layer.faces + k * len(layer.vertices) for k in range(16)]
    return Surface(np.tile(layer.vertices, (16, 1)), np.concatenate(faces))


def bowl_and_spike(count: int) -> tuple[Surface, Surface]:
    """Return a wide cone about z and a narrow one, whose tip is as near to all of the first."""
    angle = np.linspace(0, 2 * np.pi, count + 1)
    rim = np.stack([np.cos(angle), np.sin(angle), np.ones(count + 1)], axis=1)
    k = np.arange(count)
    faces = np.stack([np.zeros(count, int), 1 + k, 2 + k], axis=1)
    tip = np.zeros((1, 3))
    bowl = np.concatenate([tip, rim * [1.0, 1.0, 0.5]])
    spike = np.concatenate([tip, rim * [0.125, 0.125, 1.0]])
    return Surface(bowl, faces), Surface(spike, faces)


def scaled(surface: Surface, factor: float) -> Surface:
    """Return the surface in other units."""
    return Surface(surface.vertices * factor, surface.faces)


def _with_copy(
    make: Callable[[int], Surface], apart: Triple, velocity: Triple
) -> Callable[[int], HostilePair]:
    def pair(count: int) -> HostilePair:
        surface = make(count)
        return HostilePair(surface, surface, apart, ZERO, velocity)

    return pair


def _spheres(factor: float) -> Callable[[int], HostilePair]:
    def pair(count: int) -> HostilePair:
        outer = sphere(count)
        inner = Surface(0.9375 * outer.vertices, outer.faces)
        far, near = 0.03125 * factor, 0.0625 * factor
        return HostilePair(
            scaled(outer, factor), scaled(inner, factor), ZERO, (0.0, 0.0, near), (far, 0.0, near)
        )

    return pair


def _bowl(count: int) -> HostilePair:
    bowl, spike = bowl_and_spike(count)
    return HostilePair(bowl, spike, (0.0, 0.0, 0.125), ZERO, (0.0, 0.0, -0.25))


UP: Triple = (0.0, 0.0, 0.125)
DOWN: Triple = (0.0, 0.0, -0.25)

HOSTILE: dict[str, Callable[[int], HostilePair]] = {
    "coincident": _with_copy(coincident, UP, DOWN),
    "needles": _with_copy(needles, (2.5, 0.0, 0.0), (-2.0, 0.0, 0.0)),
    "crossing": _with_copy(crossing, (0.0, 0.0, 3.0), (0.0, 0.0, -2.0)),
    "grids": _with_copy(sheet, UP, DOWN),
    "stacked grids": _with_copy(stacked, UP, DOWN),
    "nested spheres": _spheres(1.0),
    "huge and tiny": _with_copy(huge_and_tiny, (0.0, 0.0, 4.0), (0.0, 0.0, -6.0)),
    "points": _with_copy(points, (2.5, 0.0, 0.0), (-2.0, 0.0, 0.0)),
    "chain": _with_copy(chain, (0.0, 0.0, 2.5), (0.0, 0.0, -2.0)),
    "bowl and spike": _bowl,
    "at 1e150": _spheres(1e150),
    "at 1e-150": _spheres(1e-150),
    "subnormal": _spheres(2.0**-1060),
}
"""By name: what makes a pair with so many triangles a surface."""
