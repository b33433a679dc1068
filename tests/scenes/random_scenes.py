"""Scenes of random bodies, and what asking about all pairs one by one says of them."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from meshes.surfaces import blob

from obbcli import Accuracy, Body, Mesh, Motion, Pose, Scene, SceneBody, Status, first_contact

if TYPE_CHECKING:
    from numpy.random import Generator

MESHES = [Mesh(surface.vertices, surface.faces) for surface in (blob(40, seed=k) for k in range(3))]
CUBE = Mesh(
    [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)],
    [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ],
)  # fmt: skip


def random_motion(rng: Generator, pose: Pose, width: float, *, turns: float = 1.0) -> Motion:
    """Return a motion of any kind, about as fast as the scene is wide."""
    velocity, spin = rng.uniform(-width, width, 3), turns * rng.uniform(-4, 4, 3)
    kind = rng.integers(6)
    if kind == 0:
        return Motion()
    if kind == 1:
        return Motion(velocity)
    if kind == 2:
        return Motion(None, spin, pose.translation + rng.uniform(-3, 3, 3))
    if kind == 3:
        return Motion(velocity, 40 * spin)
    if kind == 4:
        return Motion(velocity, spin, pose.translation + rng.uniform(-3, 3, 3))
    times = np.cumsum(rng.uniform(0.05, 0.4, 4)) - rng.choice([0, 0.05])
    places = pose.translation + np.cumsum(rng.uniform(-0.3, 0.3, (4, 3)) * width, axis=0)
    angles = np.cumsum(rng.uniform(-0.8, 0.8, (4, 3)), axis=0)
    first = times[0] if times[0] > 1e-12 else 0.0
    poses = [Pose(angle, place) for angle, place in zip(angles, places, strict=True)]
    return Motion.through([first, *times[1:]], poses)


def random_scene(
    seed: int,
    count: int = 12,
    width: float = 8.0,
    accuracy: Accuracy | None = None,
    duration: float | None = 1.0,
    turns: float = 1.0,
) -> Scene:
    """Return a scene of bodies of a few meshes, some of them static, some in groups."""
    rng = np.random.default_rng(seed)
    bodies = []
    for k in range(count):
        pose = Pose(rng.uniform(-2, 2, 3), rng.uniform(-width, width, 3))
        motion = random_motion(rng, pose, width, turns=turns)
        group = rng.choice(["", "", "g", "h", "i"])
        static = motion.is_at_rest and bool(rng.integers(2))
        mesh = [*MESHES, CUBE][rng.integers(4)]
        if type(motion) is not Motion:
            pose = Pose()
        bodies.append(SceneBody(f"body {k}", Body(mesh, pose, motion), static, group or None))
    groups = {body.group for body in bodies}
    ignore: list[dict[str, list[str]]] = [{"bodies": ["body 1", "body 0"]}]
    ignore += [{"groups": ["g"]}] if "g" in groups else []
    ignore += [{"groups": ["h", "i"]}] if {"h", "i"} <= groups else []
    return Scene(bodies, ignore, duration, accuracy)


def asked(scene: Scene) -> list[tuple[int, int]]:
    """Return the pairs that a scene is about, by places."""
    said = [
        (tuple(entry.get("bodies", ())), tuple(entry.get("groups", ()))) for entry in scene.ignore
    ]
    found = []
    for i, j in combinations(range(len(scene.bodies)), 2):
        a, b = scene.bodies[i], scene.bodies[j]
        is_ignored = any(
            sorted(names) == sorted((a.name, b.name))
            or (groups and sorted({a.group or "", b.group or ""}) == sorted(set(groups)))
            for names, groups in said
        )
        if not is_ignored and not (a.static and b.static):
            found.append((i, j))
    return found


def one_by_one(scene: Scene, *, solid: bool = False) -> list[tuple[object, ...]]:
    """Return all that touches or is unresolved, in order, pair by pair; see `plain`."""
    answers = []
    for i, j in asked(scene):
        a, b = scene.bodies[i], scene.bodies[j]
        found = first_contact(a.body, b.body, scene.duration, scene.accuracy, solid)
        if found.status is not Status.SEPARATED:
            answers.append((found.time, i, j, plain(a.name, b.name, found)))
    return [answer[3] for answer in sorted(answers, key=lambda answer: answer[:3])]


def plain(body_a: str, body_b: str, contact: object) -> tuple[object, ...]:
    """Return a contact as something that is equal only to the same, bit for bit."""
    values = {name: value for name, value in vars(contact).items() if name != "stats"}
    return body_a, body_b, repr(values)
