"""Random pairs of bodies that move on a common screw, or nearly so; each follows from its seed."""

from __future__ import annotations

import math
from typing import Any, Literal, NamedTuple

import numpy as np
from oracles.screw import Mover
from scenes.pairs import random_rotation

Kind = Literal["triangles", "copies", "threads", "blobs"]
KINDS: tuple[Kind, ...] = ("triangles", "copies", "threads", "blobs")
Meshes = tuple[tuple[Any, Any], tuple[Any, Any]]


class OnScrew(NamedTuple):
    """Two movers and what is asked of them.

    Attributes:
        a, b: the movers.
        duration: s.
        clearance: mesh units.
    """

    a: Mover
    b: Mover
    duration: float
    clearance: float


def random_on_screw(kind: Kind, seed: int) -> OnScrew:
    """Return a pair on one screw: who turns, where pivots are, and how they drift varies."""
    random = np.random.default_rng((KINDS.index(kind), seed))
    turns = 2 * math.pi * 10.0 ** random.uniform(-3, 1.4)
    lead = random.choice([0.0, 1.0, -1.0]) * 10.0 ** random.uniform(-3, 1.5)
    pitch = lead / (2 * math.pi)
    clearance = random.choice([0.0, 0.0, 0.0, 10.0 ** random.uniform(-6, -1)])
    # About the z axis; all is turned and shifted afterwards.
    meshes = _MAKERS[kind](random, turns, pitch)
    return _placed(random, meshes, turns, pitch, clearance)


def _placed(random: Any, meshes: Meshes, turns: float, pitch: float, clearance: float) -> OnScrew:
    """Return meshes about the z axis, on a screw about an axis anywhere, in any unit."""
    duration = 2.0 ** int(random.integers(-3, 4)) * random.choice([1.0, 0.7])
    spin, slide = turns / duration, pitch * turns / duration
    way = random.integers(5)
    share = float(random.choice([-1.0, 0.25, 0.5, 2.0])) if way == 2 else float(way == 1)
    # A turns by `share` of the whole the other way round, B by what is left.
    spins = -share * spin, (1 - share) * spin
    slides = -share * slide, (1 - share) * slide
    drift = random.normal(size=3) * (random.integers(3) == 0)
    drift[2] = 0
    is_plain = random.integers(3) == 0
    rotation = np.eye(3) if is_plain else random_rotation(int(random.integers(2**31)))
    far = float(random.choice([0.0, 0.0, 1.0, 100.0]))
    origin = random.normal(size=3) * far
    scale = 1.0 if is_plain else float(2.0 ** random.integers(-7, 8))
    axis = rotation @ np.array([0.0, 0.0, 1.0])
    movers = []
    for (points, faces), own, along in zip(meshes, spins, slides, strict=True):
        vertices = (points @ rotation.T + origin) * scale
        pivot = (origin + axis * float(random.choice([0.0, random.normal()]))) * scale
        velocity = (axis * along + rotation @ drift) * scale
        movers.append(Mover(vertices, faces, np.eye(3), np.zeros(3), velocity, axis * own, pivot))
    return OnScrew(movers[0], movers[1], duration, clearance * scale)


def _triangles(random: Any, turns: float, pitch: float) -> Meshes:
    """Return a few triangles each: of any shape, across the axis, radial, needles, points."""
    return _soup(random), _soup(random)


def _soup(random: Any) -> tuple[Any, Any]:
    count = int(random.integers(1, 7))
    size = 10.0 ** random.uniform(-1.5, 0.3)
    points = random.normal(size=(count, 1, 3)) + size * random.normal(size=(count, 3, 3))
    for corners in points:
        shape = random.integers(8)
        if shape == 0:  # one plane with the axis
            corners[:, 1] = corners[:, 0] * random.normal()
        elif shape == 1:  # a needle
            corners[2] = corners[0] + (corners[1] - corners[0]) * random.uniform()
            corners[2] += random.normal(size=3) * 10.0 ** random.uniform(-12, -2)
        elif shape == 2:  # a corner on the axis
            corners[0, :2] = 0
        elif shape == 3:  # a segment, or a point
            corners[random.integers(3)] = corners[random.integers(3)]
        elif shape == 4:  # across the axis
            corners[:, 2] = corners[0, 2]
        elif shape == 5:  # near the axis
            corners[:, :2] *= 10.0 ** random.uniform(-6, -1)
    return points.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def _copies(random: Any, turns: float, pitch: float) -> Meshes:
    """Return a body, and itself a part of the screw back, moved by a little."""
    points, faces = _soup(random)
    back = -turns * random.uniform(0.05, 1.0)
    off = random.choice([0.0, 10.0 ** random.uniform(-12, -2)])
    return (points, faces), (_screwed(points, back, pitch) + off * random.normal(size=3), faces)


def _screwed(points: Any, angle: float, pitch: float) -> Any:
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return points @ turn.T + [0.0, 0.0, pitch * angle]


def _threads(random: Any, turns: float, pitch: float) -> Meshes:
    """Return two threads, one around the other, of the screw's lead or nearly."""
    lead = 2 * math.pi * pitch * random.choice([1.0, 1.0, 1.01, 0.9, -1.0]) or 0.3
    lead = math.copysign(min(max(abs(lead), 0.05), 2.0), lead)
    gap = 10.0 ** random.uniform(-3, -0.7)
    steps = int(random.integers(8, 24))
    depth = random.uniform(0.1, 0.4)
    inner = thread(lead, 1.0, depth, steps, random.uniform(0.6, 2.0))
    outer = thread(lead, 1.0 + gap, depth, steps, random.uniform(0.6, 2.0))
    points, faces = outer
    along = _screwed(points, random.uniform(0, 2 * math.pi), lead / (2 * math.pi))
    return inner, (along, faces)


def thread(lead: float, radius: float, depth: float, steps: int, turns: float) -> tuple[Any, Any]:
    """Return the strip of a thread: crests and roots along a helix, `steps` to a turn."""
    count = int(steps * turns) + 1
    angles = 2 * math.pi * np.arange(count) / steps
    rows = []
    for k, share in enumerate((0.0, 0.25, 0.5, 0.75, 1.0)):
        r = radius + (depth if k in (1, 2) else 0.0)
        height = lead * (angles / (2 * math.pi) + share)
        rows.append(np.stack([r * np.cos(angles), r * np.sin(angles), height], axis=1))
    points = np.concatenate(rows)
    faces = []
    for k in range(4):
        for i in range(count - 1):
            p, q = k * count + i, (k + 1) * count + i
            faces += [(p, p + 1, q), (p + 1, q + 1, q)]
    return points, np.array(faces)


def _blobs(random: Any, turns: float, pitch: float) -> Meshes:
    """Return two bumpy closed bodies, side by side or one in the other."""
    place = random.normal(size=3) * random.choice([0.0, 0.5, 1.5])
    return _blob(random, 1.0, np.zeros(3)), _blob(random, random.uniform(0.2, 3.0), place)


def _blob(random: Any, size: float, place: Any) -> tuple[Any, Any]:
    around, up = int(random.integers(5, 14)), int(random.integers(3, 9))
    points, faces = [], []
    bumps = random.uniform(0, 0.3)
    for i in range(up + 1):
        for j in range(around):
            a, b = math.pi * i / up, 2 * math.pi * j / around
            r = size * (1 + bumps * random.uniform())
            points.append(
                [r * math.sin(a) * math.cos(b), r * math.sin(a) * math.sin(b), r * math.cos(a)]
            )
    for i in range(up):
        for j in range(around):
            p, q = i * around + j, i * around + (j + 1) % around
            faces += [(p, q, p + around), (q, q + around, p + around)]
    return np.array(points) + place, np.array(faces)


_MAKERS: dict[Kind, Any] = {
    "triangles": _triangles,
    "copies": _copies,
    "threads": _threads,
    "blobs": _blobs,
}
