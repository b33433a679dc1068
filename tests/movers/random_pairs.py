"""Random pairs of small moving meshes, about half of which meet; each follows from its seed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from movers.meshes import angle_bar, cube, octahedron, star, tetrahedron
from oracles.screw import Mover
from scenes.pairs import random_rotation

if TYPE_CHECKING:
    from movers.meshes import Mesh

Kind = Literal["translating", "one_turning", "both_turning"]
KINDS: tuple[Kind, ...] = ("translating", "one_turning", "both_turning")
SHAPES = (cube, tetrahedron, octahedron, angle_bar, star)
# How far the centres pass each other, as a share of the sum of the radii: about half of all meet.
PASSING = 0.3, 1.5


def random_pair(kind: Kind, seed: int, duration: float = 1.0) -> tuple[Mover, Mover]:
    """Return two meshes that are apart at 0 and pass at some distance during [0, duration]."""
    random = np.random.default_rng((KINDS.index(kind), seed))
    one, two = (SHAPES[i]() for i in random.integers(len(SHAPES), size=2))
    radii = [float(np.linalg.norm(mesh[0], axis=1).max()) for mesh in (one, two)]
    heading = _direction(random)
    start = heading * (sum(radii) + random.uniform(0.01, 1.0))
    aside = np.cross(heading, _direction(random))
    aside *= random.uniform(*PASSING) * sum(radii) / np.linalg.norm(aside)
    way = (aside - start) * random.uniform(1.0, 1.6) / duration
    share = random.uniform(-0.5, 0.5)
    spins = [_direction(random) * random.uniform(0.3, 6.0) / duration for _ in range(2)]
    if kind == "translating":
        spins = [np.zeros(3)] * 2
    elif kind == "one_turning":
        spins[int(random.integers(2))] = np.zeros(3)
    a = _mover(one, random, np.zeros(3), share * way, spins[0])
    b = _mover(two, random, start, (1 + share) * way, spins[1])
    return a, b


def _mover(mesh: Mesh, random: Any, place: Any, velocity: Any, spin: Any) -> Mover:
    rotation = random_rotation(int(random.integers(2**31)))
    pivot = place + random.choice([0.0, 0.5]) * _direction(random)
    return Mover(*mesh, rotation, place, velocity, spin, pivot)


def _direction(random: Any) -> Any:
    vector = random.normal(size=3)
    return vector / np.linalg.norm(vector)
