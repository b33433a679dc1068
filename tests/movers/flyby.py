"""Two convex solids that fly at each other, for lists of contacts; each follows from its seed."""

from __future__ import annotations

import numpy as np
from movers.meshes import cube, octahedron
from oracles.screw import Mover
from scenes.pairs import random_rotation


def flyby(
    seed: int, *, turning: bool, speed: float = 1.0, about_middle: bool = False
) -> tuple[Mover, Mover]:
    """Return a cube at rest and an octahedron that comes from a random side.

    Args:
        seed: what all follows from.
        turning: whether both turn.
        speed: 1: it arrives at the cube's middle by the end of a second.
        about_middle: whether it turns about its own middle, and not about the cube's.
    """
    rng = np.random.default_rng(seed)
    way = rng.normal(size=3)
    way *= 4 / np.linalg.norm(way)
    spins = rng.normal(size=(2, 3)) if turning else np.zeros((2, 3))
    a = Mover(*cube(), rotation=random_rotation(rng), spin=spins[0])
    b = Mover(
        *octahedron(),
        rotation=random_rotation(rng),
        translation=way,
        velocity=-speed * way,
        spin=spins[1],
        pivot=way if about_middle else np.zeros(3),
    )
    return a, b
