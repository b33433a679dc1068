"""Bodies of revolution about the z axis, and spindles in their housings made of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

Mesh = tuple[Any, Any]


def turned(profile: Any, steps: int) -> Mesh:
    """Return the surface that a line of (radius, height) sweeps, in so many facets to a turn."""
    angles = 2 * math.pi * np.arange(steps) / steps
    points = np.concatenate(
        [
            np.stack([r * np.cos(angles), r * np.sin(angles), np.full(steps, z)], axis=1)
            for r, z in profile
        ]
    )
    faces = []
    for k in range(len(profile) - 1):
        for i in range(steps):
            p, q = k * steps + i, k * steps + (i + 1) % steps
            faces += [(p, q, p + steps), (q, q + steps, p + steps)]
    return points, np.array(faces)


def spindle_and_housing(steps: int, play: float) -> tuple[Mesh, Mesh]:
    """Return a shaft with a collar that sits in the groove of a sleeve, `play` away all over."""
    shaft = [(0, -8), (5, -8), (5, -1), (9, -1), (9, 1), (5, 1), (5, 8), (0, 8)]
    sleeve = [
        (5 + play, -6),
        (5 + play, -1 - play),
        (9 + play, -1 - play),
        (9 + play, 1 + play),
        (5 + play, 1 + play),
        (5 + play, 6),
    ]
    return turned(shaft, steps), turned(sleeve, steps)
