"""Lists of contacts: each pair's own first contact, of bodies that approach, glide or turn."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from harness import OURS, Row, alternate
from scenes.pairs import POSE_CLASSES

import obbcli
from obbcli import Body, Mesh, Motion, ObbTree, Pose

if TYPE_CHECKING:
    from collections.abc import Iterator

    from scenes.pairs import Pair

TRIANGLES, QUICK_TRIANGLES = 10_000, 1_000
# By the pose class that bodies start from: how B moves, and how many contacts are asked for.
QUESTIONS: dict[str, tuple[str, Motion, int | None]] = {
    "approaching, first 10": ("gap_1e-1", Motion((-1.5, 0.25, 0.125)), 10),
    "approaching, all": ("gap_1e-1", Motion((-0.5, 0.08, 0.04)), None),
    "passing": ("gap_1e-2", Motion((0.0, 3.0, 0.0)), None),
    "meeting at the start, all": ("penetrating", Motion((0.01, 0.0, 0.0)), None),
    "turning, first 10": ("gap_1e-1", Motion((-1.5, 0.0, 0.0), (0.25, 0.5, 1.0)), 10),
}


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a question; the earliest contact of a list is the first contact."""
    for name, (scene, motion, limit) in QUESTIONS.items():
        pair = POSE_CLASSES[scene](QUICK_TRIANGLES if quick else TRIANGLES)
        bodies = _bodies(pair, motion)
        ask = partial(_listed, bodies, limit)
        found = ask()
        check(bodies, found)
        timings = alternate({OURS: ask}, 3 if quick else 9)
        yield Row("contacts", name, len(pair.a.faces), timings, {OURS: {"contacts": len(found)}})


def check(bodies: tuple[Body, Body], found: list[obbcli.Contact]) -> None:
    """Assert that contacts come in order of time, and that `first_contact` finds the earliest."""
    times = [one.time for one in found]
    assert times == sorted(times)
    first = obbcli.first_contact(*bodies)
    assert bool(found) == first.collides
    if found:
        assert first.time_bounds[0] <= found[0].time_bounds[1]
        assert found[0].time_bounds[0] <= first.time_bounds[1]


def _bodies(pair: Pair, motion: Motion) -> tuple[Body, Body]:
    trees = [ObbTree.build(Mesh(s.vertices, s.faces), lazy=False) for s in (pair.a, pair.b)]
    pose = Pose(rotation=pair.rotation, translation=pair.translation)
    return Body(trees[0]), Body(trees[1], pose, motion)


def _listed(bodies: tuple[Body, Body], limit: int | None) -> list[obbcli.Contact]:
    return list(obbcli.contacts(*bodies, limit=limit))
