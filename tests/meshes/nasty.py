"""Small meshes that a tree must survive, each as vertices and triangles, and arrays at random."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

Surface = tuple[Any, Any]


def soup(count: int, seed: int = 0) -> Surface:
    """Return triangles that share nothing, of sizes 1e-3 to 1."""
    random = np.random.default_rng(seed)
    places = random.uniform(-1, 1, (count, 1, 3))
    sizes = 10.0 ** random.uniform(-3, 0, (count, 1, 1))
    vertices = (places + sizes * random.normal(size=(count, 3, 3))).reshape(-1, 3)
    return vertices, np.arange(3 * count).reshape(-1, 3)


def grid(cells: int, heights: Callable[[Any, Any], Any]) -> Surface:
    """Return a sheet of 2 cells**2 triangles over whole numbers."""
    x, y = np.meshgrid(np.arange(cells + 1.0), np.arange(cells + 1.0), indexing="ij")
    vertices = np.stack([x, y, heights(x, y)], axis=-1).reshape(-1, 3)
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    lower = np.column_stack((corner, corner + cells + 1, corner + 1))
    upper = np.column_stack((corner + cells + 2, corner + 1, corner + cells + 1))
    return vertices, np.concatenate((lower, upper))


def bumpy_grid(cells: int) -> Surface:
    return grid(cells, lambda x, y: np.sin(1.7 * x) * np.cos(2.3 * y))


def staircase(count: int) -> Surface:
    """Return triangles whose centroids halve: the center rule parts off one after the other."""
    scale = np.ldexp(1.0, -np.arange(count))[:, None, None]
    triangle = np.array([[1.0, 0.0, 0.0], [1.25, 0.0, 0.0], [1.0, 0.25, 0.0]])
    return (scale * triangle).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def needles(count: int) -> Surface:
    random = np.random.default_rng(1)
    start = random.uniform(-1, 1, (count, 3))
    end = start + random.normal(size=(count, 3)) * 100
    tip = end + random.normal(size=(count, 3)) * 10.0 ** random.uniform(-14, -6, (count, 1))
    return np.stack([start, end, tip], axis=1).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def mixed_sizes() -> Surface:
    """Return triangles of sizes 1e-30 to 1e30, each about a corner of the next."""
    sizes = 10.0 ** np.arange(-30, 31, 4)[:, None, None]
    random = np.random.default_rng(2)
    vertices = (sizes * random.uniform(-1, 1, (len(sizes), 3, 3))).reshape(-1, 3)
    return vertices, np.arange(len(vertices)).reshape(-1, 3)


def _all_sizes() -> Surface:
    """Return triangles from one end of double's range to the other, all about the origin."""
    exponents = np.repeat([1020, 500, 0, -500, -1030, -1070, -1074], 3)
    integers = np.random.default_rng(4).integers(-3, 4, (len(exponents), 3, 3))
    vertices = np.ldexp(integers.astype(float), exponents[:, None, None]).reshape(-1, 3)
    return vertices, np.arange(len(vertices)).reshape(-1, 3)


def _scaled(surface: Surface, factor: float) -> Surface:
    return surface[0] * factor, surface[1]


def _coincident() -> Surface:
    corners = np.array([[0.1, 0.2, 0.3], [1.1, 0.7, -0.4], [-0.2, 0.9, 0.6]])
    return corners, np.tile([[0, 1, 2], [1, 2, 0], [2, 1, 0]], (334, 1))[:1000]


def _duplicates() -> Surface:
    vertices, triangles = soup(20)
    return vertices, np.concatenate((triangles, triangles[::-1], triangles[:5, ::-1]))


def _collinear() -> Surface:
    steps = np.random.default_rng(3).integers(-50, 50, 90)
    return steps[:, None] * np.array([0.1, 0.7, -0.3]), np.arange(90).reshape(-1, 3)


def _thin() -> Surface:
    vertices, triangles = bumpy_grid(5)
    return vertices * (1.0, 1.0, 1e-30), triangles


def _offset() -> Surface:
    vertices, triangles = bumpy_grid(5)
    return vertices * 1e-3 + (1e8, -1e8, 1e8), triangles


NASTY: dict[str, Callable[[], Surface]] = {
    "one": lambda: soup(1),
    "two": lambda: soup(2),
    "three": lambda: soup(3),
    "soup": lambda: soup(60),
    "coincident": _coincident,
    "duplicates": _duplicates,
    "collinear": _collinear,
    "one point": lambda: (np.full((1, 3), 0.1), np.zeros((40, 3), int)),
    "the origin": lambda: (np.zeros((1, 3)), np.zeros((40, 3), int)),
    "thin": _thin,
    "mixed sizes": mixed_sizes,
    "all sizes": _all_sizes,
    "subnormal": lambda: _scaled(soup(20), 1e-312),
    "smallest": lambda: (np.eye(3) * 5e-324, np.tile([[0, 1, 2], [0, 0, 1]], (5, 1))),
    "1e-300": lambda: _scaled(soup(20), 1e-300),
    "1e300": lambda: _scaled(soup(20), 1e300),
    "largest": lambda: (np.sign(soup(20)[0]) * 1.7e308, soup(20)[1]),
    "offset": _offset,
    "planar grid": lambda: grid(5, lambda x, y: x - 2.0 * y),
    "needles": lambda: needles(30),
    "staircase": lambda: staircase(40),
}
