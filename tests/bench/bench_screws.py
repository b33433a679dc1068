"""Bodies that glide along each other: on one screw, told apart by images, and on two axes."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from harness import OURS, Row, alternate
from movers.turned import spindle_and_housing

import obbcli
from obbcli import Body, Mesh, Motion, ObbTree, Status

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ROUNDS, QUICK_ROUNDS = 9, 3
TURN = 2 * math.pi
FACETS, PLAY = 684, 0.1  # to a turn: 16,416 triangles in all
REST = Motion()


class Gliding(NamedTuple):
    """A question, and what its answer must be.

    Attributes:
        shapes: what makes the trees, anew for each question: what they grow is part of the cost.
        motions: of A and B.
        duration: s.
        contact: s; when they touch. None: never.
        by_images: whether the bodies move on a common screw.
    """

    shapes: Callable[[], tuple[ObbTree, ObbTree]]
    motions: tuple[Motion, Motion]
    duration: float
    contact: float | None
    by_images: bool


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a question; a call makes trees that grow, and asks."""
    for case, question in questions().items():
        found = answer(question)
        timings = alternate({OURS: partial(answer, question)}, QUICK_ROUNDS if quick else ROUNDS)
        counts = {
            "box tests": found.stats.box_tests,
            "image tests": found.stats.image_tests,
            "triangle tests": found.stats.triangle_tests,
        }
        triangles = sum(tree.triangle_count for tree in question.shapes())
        yield Row("screws", case, triangles, timings, {OURS: counts})


def questions() -> dict[str, Gliding]:
    """Return the questions by what they are about."""
    bolt, nut, gear, pinion = (
        obbcli.load_mesh(f"sample_meshes/{name}")
        for name in ("bolt.ply", "nut.obj", "gear.stl", "pinion.stl")
    )
    shaft, sleeve = (Mesh(*mesh) for mesh in spindle_and_housing(FACETS, PLAY))

    def trees(a: Mesh, b: Mesh) -> Callable[[], tuple[ObbTree, ObbTree]]:
        return lambda: (ObbTree.build(a), ObbTree.build(b))

    up, down, spin = (
        Motion((0, 0, lead), (0, 0, math.copysign(TURN, way)), (0, 0, 0))
        for lead, way in ((2, 1), (-2, -1), (0, 1))
    )
    wheels = Motion(None, (0, 0, 3)), Motion(None, (0, 0, -6))
    threads, spindle = trees(bolt, nut), trees(sleeve, shaft)
    return {
        "nut 5 turns up": Gliding(threads, (REST, up), 5.0, None, True),
        "nut 3 turns down to the head": Gliding(threads, (REST, down), 3.5, 3.0, True),
        "spindle a million turns": Gliding(spindle, (REST, spin), 1e6, None, True),
        "gears 2 s on two axes": Gliding(trees(gear, pinion), wheels, 2.0, None, False),
    }


def answer(question: Gliding) -> obbcli.FirstContact:
    """Ask a question and assert its answer."""
    a, b = question.shapes()
    moving_a, moving_b = question.motions
    found = obbcli.first_contact(
        Body(a, motion=moving_a), Body(b, motion=moving_b), question.duration
    )
    assert (found.stats.image_tests > 0) is question.by_images
    if question.contact is None:
        assert found.status is Status.SEPARATED
    else:
        assert found.time_bounds is not None
        low, high = found.time_bounds
        assert high is not None
        assert low <= question.contact <= high
    return found
