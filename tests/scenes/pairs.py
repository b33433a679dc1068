"""Pairs of surfaces with a pose and what is known about them, shared by tests and benches.

Nothing here imports the package. What a pair claims follows from how it is made, and `test_scenes`
checks it by other means. Every class exists at any number of triangles a surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from meshes.surfaces import Surface, blob, box, sheet, sphere, torus
from oracles.mesh import posed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

NESTED_RADIUS = 0.9375
RING_TUBE_RADIUS = 0.4375
SHEET_HEIGHT = 0.125
SHEET_GAP = 2.0**-7
PLATE_THICKNESS = 2.0**-6
PLATE_GAP = 2.0**-10


@dataclass(frozen=True, eq=False)
class Pair:
    """Two surfaces and the pose of the second.

    Attributes:
        name: the pose class.
        a, b: the surfaces, each in its own coordinates; a's are the world's.
        rotation: (3, 3), of b.
        translation: (3,), of b.
        touches: whether the surfaces meet, touching included; None where nothing says so.
        distance: bounds on the distance of the surfaces, or None.
    """

    name: str
    a: Surface
    b: Surface
    rotation: Floats
    translation: Floats
    touches: bool | None
    distance: tuple[float, float] | None = None

    @property
    def size(self) -> float:
        """The larger of the two boxes' diagonals."""
        return max(self.a.diagonal, self.b.diagonal)

    @property
    def posed_b(self) -> Floats:
        """The vertices of b in the world (V, 3)."""
        return posed(self.b.vertices, self.rotation, self.translation)


def random_rotation(seed: int) -> Floats:
    """Return a rotation matrix, evenly distributed, that follows from `seed` alone."""
    w, x, y, z = np.random.default_rng(seed).normal(size=4)
    s = 2 / (w * w + x * x + y * y + z * z)
    return np.array(
        [
            [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
            [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
            [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
        ]
    )


# Exact in doubles: a third of a turn about (1, 1, 1), a quarter about x, and so on.
THIRD_TURN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
QUARTER_TURN_X = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def facing(name: str, a: Surface, b: Surface, rotation: Floats, gap: float) -> Pair:
    """Place b so that its lowest vertex along x lies `gap` beyond a's highest one.

    With gap > 0 the planes through these vertices part the surfaces, and the vertices are as near
    as any points; with 0 the vertices coincide; with gap < 0 nothing is known.
    """
    turned = posed(b.vertices, rotation, np.zeros(3))
    high, low = a.vertices[np.argmax(a.vertices[:, 0])], turned[np.argmin(turned[:, 0])]
    translation = high - low + np.array([gap, 0.0, 0.0])
    slack = 1e-12 * (gap != 0)
    bounds = (gap - slack, gap + slack) if gap >= 0 else None
    return Pair(name, a, b, rotation, translation, None if gap < 0 else gap == 0, bounds)


def _blobs_apart(name: str, fraction: float, rotation: Floats) -> Callable[[int], Pair]:
    def make(triangles: int) -> Pair:
        a, b = blob(triangles, 1), blob(triangles, 2)
        size = max(a.diagonal, b.diagonal)
        return facing(name, a, b, rotation, fraction * size)

    return make


def _penetrating(triangles: int) -> Pair:
    a, b = blob(triangles, 1), blob(triangles, 2)
    size = max(a.diagonal, b.diagonal)
    pair = facing("penetrating", a, b, random_rotation(3), -1e-2 * size)
    # The foremost vertex of a lies inside b, which lies partly outside a.
    return Pair(pair.name, a, b, pair.rotation, pair.translation, touches=True)


def _deep(triangles: int) -> Pair:
    # Radii are 0.5 to 1.5 and about alike: neither surface holds the other whole.
    return Pair(
        "deep",
        blob(triangles, 1),
        blob(triangles, 2),
        random_rotation(4),
        np.array([0.5, 0.25, 0.125]),
        touches=True,
    )


def _stacked(triangles: int) -> Pair:
    a = box(triangles)
    return Pair(
        "stacked", a, a, THIRD_TURN, np.array([1.0, 0.25, 0.125]), touches=True, distance=(0.0, 0.0)
    )


def _interlocked(triangles: int) -> Pair:
    # The centre lines are linked unit circles; 1 + 2 (1 - cos s) (1 + cos t) is the square of their
    # points' distance. Chords leave the tube by at most their sagitta, where it is a saddle.
    a = torus(triangles, RING_TUBE_RADIUS)
    gap = 1 - 2 * RING_TUBE_RADIUS
    sag = (1 + RING_TUBE_RADIUS) * float(1 - np.cos(np.pi / np.sqrt(triangles)))
    return Pair(
        "interlocked",
        a,
        a,
        QUARTER_TURN_X,
        np.array([1.0, 0.0, 0.0]),
        touches=False,
        distance=(gap - 2 * sag, gap + 2 * sag),
    )


def _nested(triangles: int) -> Pair:
    a, b = sphere(triangles), sphere(triangles, NESTED_RADIUS)
    corners = a.vertices[a.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inradius = (normals * corners[:, 0]).sum(axis=1) / np.linalg.norm(normals, axis=1)
    bounds = (float(inradius.min()) - NESTED_RADIUS - 1e-6, 1 - NESTED_RADIUS)
    return Pair("nested", a, b, random_rotation(5), np.zeros(3), touches=False, distance=bounds)


def _plates(triangles: int) -> Pair:
    a = box(triangles, (1.0, 1.0, PLATE_THICKNESS))
    # b lies along a, moved in its plane and turned in it, so that no edge lies above an edge.
    c, s = 0.8, 0.6
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    shift = np.array([0.25, 0.125, PLATE_THICKNESS + PLATE_GAP])
    return Pair("plates", a, a, turn, shift, touches=False, distance=(PLATE_GAP, PLATE_GAP))


def _sheets(triangles: int) -> Pair:
    # One graph above the other: along z they are the gap apart, across a slope somewhat less.
    a = sheet(triangles, SHEET_HEIGHT)
    steepest = 2 * np.pi * SHEET_HEIGHT * 2**0.5
    bounds = (SHEET_GAP / float(np.hypot(1, steepest)), SHEET_GAP)
    return Pair(
        "sheets", a, a, np.eye(3), np.array([0.0, 0.0, SHEET_GAP]), touches=False, distance=bounds
    )


def _random(seed: int) -> Callable[[int], Pair]:
    def make(triangles: int) -> Pair:
        random = np.random.default_rng(seed)
        direction = random.normal(size=3)
        translation = direction / np.linalg.norm(direction) * random.uniform(1.8, 2.6)
        a, b = blob(triangles, 1), blob(triangles, 2)
        return Pair(f"random_{seed}", a, b, random_rotation(seed), translation, touches=None)

    return make


POSE_CLASSES: dict[str, Callable[[int], Pair]] = {
    "far": _blobs_apart("far", 3.0, random_rotation(0)),
    "gap_1e-1": _blobs_apart("gap_1e-1", 1e-1, random_rotation(1)),
    "gap_1e-2": _blobs_apart("gap_1e-2", 1e-2, random_rotation(1)),
    "gap_1e-3": _blobs_apart("gap_1e-3", 1e-3, random_rotation(1)),
    "touching": _blobs_apart("touching", 0.0, THIRD_TURN),
    "stacked": _stacked,
    "penetrating": _penetrating,
    "deep": _deep,
    "interlocked": _interlocked,
    "nested": _nested,
    "plates": _plates,
    "sheets": _sheets,
    "random_11": _random(11),
    "random_12": _random(12),
    "random_16": _random(16),
}


def pairs(triangles: int) -> Iterator[Pair]:
    """Yield one pair of every pose class, each surface of about `triangles` triangles."""
    for make in POSE_CLASSES.values():
        yield make(triangles)
