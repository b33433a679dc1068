"""Random questions about moving pairs: bodies that hit, graze and miss each other.

Bodies turn about the origin of their mesh's coordinates, so that a pose's translation is where the
pivot is: what a library that takes two poses and interpolates them means by a path.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from meshes.surfaces import Surface, blob
from scenes.pairs import random_rotation

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

MOTIONS = ("translation", "one rotating", "both rotating")
OUTCOMES = ("hit", "grazing", "miss")
DURATION = 1.0
# Less than half a turn: poses at the ends could not say more.
SPINS = (0.5, 3.0)
# Of the size: how far a grazing path lies from the one that just touches.
GRAZES = (1e-6, 1e-3)
# Halvings of the sideways shift between a hit and a miss: to 6e-8 of the bodies' radii.
HALVINGS = 24
# The smallest is for Tight-Inclusion, which takes seconds a question beyond it.
BLOBS = (500, 10_000, 100_000)
QUICK_BLOBS = (500, 10_000)
MESH_PAIRS = (("cow", "spot"), ("fandisk", "rocker-arm"), ("rocker-arm", "cow"))


@dataclass(frozen=True, eq=False)
class Path3:
    """How one body moves: `x(t) = R(t spin) rotation p + center + t velocity`."""

    rotation: Floats
    center: Floats
    velocity: Floats
    spin: Floats

    @cached_property
    def _cross(self) -> Floats:
        x, y, z = self.spin / max(float(np.linalg.norm(self.spin)), 1e-300)
        return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])

    @cached_property
    def speed(self) -> float:
        """Angular speed, rad/s."""
        return float(np.linalg.norm(self.spin))

    def at(self, t: float) -> tuple[Floats, Floats]:
        """Return rotation (3, 3) and translation (3,) at a time."""
        place = self.center + t * self.velocity
        if not self.speed:
            return self.rotation, place
        angle, k = t * self.speed, self._cross
        turn = np.eye(3) + math.sin(angle) * k + (2 * math.sin(angle / 2) ** 2) * (k @ k)
        return turn @ self.rotation, place


@dataclass(frozen=True, eq=False)
class Moving:
    """A question: two surfaces, how they move in [0, 1] s, and what is expected of them."""

    name: str
    motion: str
    outcome: str
    index: int
    a: Surface
    b: Surface
    path_a: Path3
    path_b: Path3
    # Of the size, how far sideways from just touching; positive: beyond. None where not grazing.
    offset: float | None = None

    @cached_property
    def size(self) -> float:
        """The larger of the two boxes' diagonals."""
        return max(_diagonal(self.a), _diagonal(self.b))

    @cached_property
    def closing_speed(self) -> float:
        """No points of the two approach each other faster."""
        drift = float(np.linalg.norm(self.path_b.velocity - self.path_a.velocity))
        turning = self.path_a.speed * radius(self.a) + self.path_b.speed * radius(self.b)
        return drift + turning

    def relative(self, t: float) -> tuple[Floats, Floats]:
        """Return rotation and translation of B as A sees it."""
        (turn_a, place_a), (turn_b, place_b) = self.path_a.at(t), self.path_b.at(t)
        return turn_a.T @ turn_b, turn_a.T @ (place_b - place_a)

    def shifted(self, step: Floats) -> Moving:
        """Return the question with B's path moved sideways."""
        path = replace(self.path_b, center=self.path_b.center + step)
        return replace(self, path_b=path)


@lru_cache(maxsize=16)
def radius(surface: Surface) -> float:
    """Return the largest distance of a vertex from the origin."""
    return float(np.linalg.norm(surface.vertices, axis=1).max())


@lru_cache(maxsize=16)
def _diagonal(surface: Surface) -> float:
    return surface.diagonal


def mesh_pairs(quick: bool, folder: Path | None) -> Iterator[tuple[str, Surface, Surface]]:
    """Yield named pairs of surfaces: blobs, and the meshes of a folder where one is given."""
    for triangles in QUICK_BLOBS if quick else BLOBS:
        yield f"blobs {triangles:,}", blob(triangles, 1), blob(triangles, 2)
    if folder is not None:
        loaded = {name: normalized(folder / f"{name}.obj") for pair in MESH_PAIRS for name in pair}
        for one, two in MESH_PAIRS[:1] if quick else MESH_PAIRS:
            yield f"{one}, {two}", loaded[one], loaded[two]


def normalized(path: Path) -> Surface:
    """Return a mesh about the origin, its box's diagonal 2."""
    import obbcli

    mesh = obbcli.load_mesh(path)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    scale = 2.0 / float(np.linalg.norm(high - low))
    vertices = (mesh.vertices - (low + high) / 2) * scale
    return Surface(vertices, np.array(mesh.triangles, dtype=np.int64))


def questions(
    name: str,
    surfaces: tuple[Surface, Surface],
    motion: str,
    outcome: str,
    count: int,
    collides: Callable[[Moving], bool],
) -> Iterator[Moving]:
    """Yield random questions of one kind; `collides` sorts them, and is checked elsewhere."""
    for index in range(count):
        seed = [len(surfaces[0].faces), MOTIONS.index(motion), OUTCOMES.index(outcome), index]
        rng = np.random.default_rng(seed)
        while (found := _drawn(rng, name, surfaces, motion, outcome, index, collides)) is None:
            pass
        yield found


def _drawn(rng: Any, name: str, surfaces: Any, *kind: Any) -> Moving | None:
    """Return a random question if it is of the kind wanted."""
    motion, outcome, index, collides = kind
    through, sideways, reach = _through(rng, name, surfaces, motion, outcome, index)
    if outcome == "grazing":
        return _grazing(rng, through, sideways, reach, collides)
    drawn = through.shifted(rng.uniform(0, reach) * sideways)
    return drawn if collides(drawn) == (outcome == "hit") else None


def _through(rng: Any, name: str, surfaces: Any, *kind: Any) -> tuple[Moving, Floats, float]:
    """Return B's center passing A's, a direction across, and how far across nothing can meet."""
    motion, outcome, index = kind
    a, b = surfaces
    reach = radius(a) + radius(b)
    towards, across, drift = rng.normal(size=(3, 3))
    towards /= np.linalg.norm(towards)
    across -= towards * (across @ towards)
    across /= np.linalg.norm(across)
    start = reach * rng.uniform(1.05, 1.5)
    travel = start * rng.uniform(1.0, 2.0)
    velocity = 0.5 * reach * drift
    center = rng.normal(size=3)
    spins = [_spin(rng) if motion != "translation" else np.zeros(3) for _ in range(2)]
    if motion == "one rotating":
        spins[0] = np.zeros(3)
    seeds = rng.integers(2**32, size=2)
    path_a = Path3(random_rotation(int(seeds[0])), center, velocity, spins[0])
    path_b = Path3(
        random_rotation(int(seeds[1])),
        center + start * towards,
        velocity - travel * towards,
        spins[1],
    )
    return Moving(name, motion, outcome, index, a, b, path_a, path_b), across, reach


def _spin(rng: Any) -> Floats:
    axis = rng.normal(size=3)
    spin: Floats = axis / np.linalg.norm(axis) * rng.uniform(*SPINS)
    return spin


def _grazing(
    rng: Any, through: Moving, sideways: Floats, reach: float, collides: Callable[[Moving], bool]
) -> Moving | None:
    """Return a path some 1e-6 to 1e-3 of the size beside one that just touches."""
    low, high = 0.0, reach
    if not collides(through):
        return None
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (
            (middle, high) if collides(through.shifted(middle * sideways)) else (low, middle)
        )
    away = math.exp(rng.uniform(*np.log(GRAZES))) * (1 if through.index % 2 else -1)
    return replace(through.shifted((high + away * through.size) * sideways), offset=away)
