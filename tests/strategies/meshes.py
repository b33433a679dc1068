"""Hypothesis strategies for small meshes: soups with shared, degenerate and repeated triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from hypothesis import strategies as st
from strategies.still import SCALES, points

if TYPE_CHECKING:
    from collections.abc import Callable

    Draw = Callable[..., Any]


class Soup(NamedTuple):
    """Vertices float64 (V, 3) and faces int64 (F, 3), at least one face."""

    vertices: Any
    faces: Any


@st.composite
def meshes(draw: Draw, max_vertices: int = 10, max_faces: int = 12) -> Soup:
    """Return a mesh; faces may repeat vertices, each other, and leave vertices unused."""
    vertices = np.array(draw(st.lists(points(), min_size=1, max_size=max_vertices)))
    index = st.integers(0, len(vertices) - 1)
    faces = draw(st.lists(st.tuples(index, index, index), min_size=1, max_size=max_faces))
    if draw(st.booleans()):
        faces = [*faces, faces[0], faces[-1][::-1]]
    return Soup(vertices, np.array(faces, dtype=np.int64))


@st.composite
def mesh_pairs(draw: Draw, max_vertices: int = 10, max_faces: int = 12) -> tuple[Soup, Soup]:
    """Return two meshes in one scale, at times sharing vertices exactly."""
    a = draw(meshes(max_vertices, max_faces))
    b = draw(meshes(max_vertices, max_faces))
    if draw(st.booleans()):
        shared = min(len(a.vertices), len(b.vertices)) // 2
        b.vertices[:shared] = a.vertices[:shared]
    exponent = draw(SCALES)
    return _scaled(a, exponent), _scaled(b, exponent)


def _scaled(mesh: Soup, exponent: int) -> Soup:
    return Soup(np.ldexp(mesh.vertices, exponent), mesh.faces)


@st.composite
def grids(draw: Draw, max_cells: int = 6) -> Soup:
    """Return a folded sheet of n x m cells: shared edges, coplanar neighbours, integer heights."""
    n, m = draw(st.tuples(*[st.integers(1, max_cells)] * 2))
    heights = draw(
        st.lists(st.integers(-2, 2), min_size=(n + 1) * (m + 1), max_size=(n + 1) * (m + 1))
    )
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(m + 1.0), indexing="ij")
    vertices = np.column_stack((x.ravel(), y.ravel(), np.array(heights, dtype=np.float64)))
    corner = (np.arange(n)[:, None] * (m + 1) + np.arange(m)).ravel()
    lower = np.column_stack((corner, corner + m + 1, corner + 1))
    upper = np.column_stack((corner + m + 2, corner + 1, corner + m + 1))
    return Soup(vertices, np.concatenate((lower, upper)).astype(np.int64))
