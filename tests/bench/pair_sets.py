"""Many pairs of boxes and triangles at once: random, just apart, touching, on a small grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.primitives import Obb, Triangle, first_contact

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

KINDS = ("triangles", "boxes", "box_triangle")
DURATION = 2.0
# Frames whose entries are whole numbers.
GRID_FRAMES = np.array([np.eye(3)[list(order)] for order in ((0, 1, 2), (1, 2, 0), (1, 0, 2))])


@dataclass(frozen=True)
class Pairs:
    """Shapes as the kernels' rows: a triangle's 9 numbers, a box's 15; B's velocity against A's."""

    kind: str
    a: Floats
    b: Floats
    velocity: Floats
    duration: float

    @property
    def shapes(self) -> tuple[Any, Any]:
        """The shapes as the library takes them."""
        return shape_of(self.a), shape_of(self.b)

    def taken(self, rows: Any) -> Pairs:
        """Return some of the pairs."""
        return Pairs(self.kind, self.a[rows], self.b[rows], self.velocity[rows], self.duration)


def shape_of(rows: Floats) -> Obb | Triangle:
    """Return the library's shapes of some rows."""
    if rows.shape[1] == Triangle.ROW_LENGTH:
        return Triangle(rows.reshape(-1, 3, 3))
    return Obb(rows[:, :3], rows[:, 3:12].reshape(-1, 3, 3), rows[:, 12:])


def random_pairs(kind: str, count: int, seed: int) -> Pairs:
    """Return shapes of about unit size and distance, approaching each other more or less."""
    rng = np.random.default_rng(seed)
    a, b = (_random_rows(rng, name, count) for name in _names(kind))
    apart = rng.normal(size=(count, 3))
    b = moved(b, apart)
    return Pairs(kind, a, b, rng.normal(size=(count, 3)) - apart, DURATION)


def grid_pairs(kind: str, count: int, seed: int, size: int = 4) -> Pairs:
    """Return shapes on a grid of small whole numbers: touching, coplanar, degenerate and flat."""
    rng = np.random.default_rng(seed)
    a, b = (_grid_rows(rng, name, count, size) for name in _names(kind))
    velocity = rng.integers(-3, 4, (count, 3)).astype(np.float64)
    return Pairs(kind, a, b, velocity, DURATION)


def at_contact(pairs: Pairs, gaps: Floats | float = 0.0) -> Pairs:
    """Return those pairs that come into contact, moved to where they do, less a relative gap.

    Every other velocity is then turned along the surfaces, so that the shapes graze.
    """
    contacts: Any = first_contact(*pairs.shapes, 0, pairs.velocity, pairs.duration)
    began_apart = contacts.time > 0
    rows, times = contacts.rows[began_apart], contacts.time[began_apart]
    if np.ndim(gaps):
        gaps = np.resize(np.asarray(gaps), len(times))
    chosen = pairs.taken(rows)
    way = (times * (1 - gaps))[:, np.newaxis] * chosen.velocity
    velocity = chosen.velocity.copy()
    normals = contacts.normal[began_apart][::2]
    along = np.einsum("nd,nd->n", velocity[::2], normals)
    velocity[::2] -= along[:, np.newaxis] * normals
    return Pairs(pairs.kind, chosen.a, moved(chosen.b, way), velocity, pairs.duration)


def parallel_pairs(kind: str, count: int, seed: int) -> Pairs:
    """Return shapes whose edges are parallel but for 1e-4 to 1e-16, side by side."""
    pairs = random_pairs(kind, count, seed)
    rng = np.random.default_rng(seed)
    tilt = 10.0 ** -rng.uniform(4, 17, (count, 1, 1)) * rng.normal(size=(count, 3, 3))
    b = pairs.b.copy()
    if kind == "triangles":
        b = pairs.a + tilt.reshape(-1, 9)
    else:
        axes = pairs.a[:, 3:12].reshape(-1, 3, 3) + tilt
        if kind == "boxes":
            turned, mixed = np.linalg.qr(axes.transpose(0, 2, 1))
            turned *= np.sign(np.einsum("nii->ni", mixed))[:, np.newaxis]
            b[:, 3:12] = turned.transpose(0, 2, 1).reshape(-1, 9)
            b[:, :3] = 0
        else:
            b = np.hstack((np.zeros((count, 3)), axes[:, 0], axes[:, 1]))
    offset = rng.normal(size=(count, 3))
    return Pairs(
        kind, pairs.a, moved(b, offset), 0.5 * rng.normal(size=(count, 3)) - offset, DURATION
    )


def moved(rows: Floats, way: Floats) -> Floats:
    """Return the shapes moved: every vertex of a triangle, the center of a box."""
    rows = rows.copy()
    for start in (0, 3, 6) if rows.shape[1] == Triangle.ROW_LENGTH else (0,):
        rows[:, start : start + 3] += way
    return rows


def _names(kind: str) -> tuple[str, str]:
    return {"triangles": ("t", "t"), "boxes": ("b", "b"), "box_triangle": ("b", "t")}[kind]  # type: ignore[return-value]


def _random_rows(rng: Any, name: str, count: int) -> Floats:
    if name == "t":
        return np.asarray(rng.normal(size=(count, 9)))
    frames, _ = np.linalg.qr(rng.normal(size=(count, 3, 3)))
    half = rng.uniform(0.05, 1.0, (count, 3))
    return np.hstack((np.zeros((count, 3)), frames.reshape(-1, 9), half))


def _grid_rows(rng: Any, name: str, count: int, size: int) -> Floats:
    if name == "t":
        return np.asarray(rng.integers(-size, size + 1, (count, 9)).astype(np.float64))
    centers = rng.integers(-size, size + 1, (count, 3))
    frames = GRID_FRAMES[rng.integers(len(GRID_FRAMES), size=count)].reshape(-1, 9)
    return np.hstack((centers, frames, rng.integers(0, 3, (count, 3)))).astype(np.float64)
