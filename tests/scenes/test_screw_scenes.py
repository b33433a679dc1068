from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from movers.meshes import tetrahedron
from oracles.rigid import rigid_point
from oracles.screw import Mover, screw_first_contact
from scenes.planes import plane_time
from scenes.screw import ScrewScene, all_scenes

SCENES = list(all_scenes())
# Above, the search's pieces of time are too many.
MOST_TURNS = 200.0


def test_names_are_unique() -> None:
    assert len({scene.name for scene in SCENES}) == len(SCENES)


@pytest.mark.parametrize(
    "scene", [one for one in SCENES if one.turns < MOST_TURNS], ids=lambda scene: str(scene.name)
)
def test_scene_ends_as_it_claims(scene: ScrewScene) -> None:
    found = screw_first_contact(scene.a, scene.b, scene.duration)

    if scene.instant and found.status == "undecided":
        assert found.lo is not None
        assert float(found.lo) == pytest.approx(float(scene.time), rel=1e-14)
        return
    assert found.status == scene.status
    assert (scene.time is None) == (found.lo is None)
    if found.lo is not None and found.hi is not None:
        assert found.lo <= Fraction(*scene.time.as_integer_ratio()) <= found.hi


def test_plane_time_agrees_with_dense_sampling() -> None:
    random = np.random.default_rng(0)
    hits = 0
    for _ in range(24):
        duration = float(random.choice([1, 7]))
        spin, pivot, normal = random.normal(size=(3, 3))
        velocity = random.normal(size=3) * random.choice([0.02, 1])
        body = Mover(*tetrahedron(), velocity=velocity, spin=3 * spin, pivot=pivot)
        level = (body.vertices @ normal).max() + random.exponential()

        time = plane_time(body, normal, level, duration)

        times = np.linspace(0, duration, 30)
        above = [highest(body, normal, t) >= level for t in times]
        free = times if time is None else times[times < time]
        assert not any(above[: len(free)])
        if time is not None:
            hits += 1
            assert highest(body, normal, time) >= level - 1e-12
    assert 6 < hits < 24


def highest(body: Mover, normal: np.ndarray, time: float) -> float:
    motion = body.velocity, body.spin, body.pivot
    points = (rigid_point(point, *motion, time, digits=20) for point in body.start)
    return max(float(sum(x * n for x, n in zip(p, normal.tolist(), strict=True))) for p in points)
