"""What questions cost, in counts that are the same on every machine: no change may raise them.

`PYTHONPATH=tests python tests/whole/test_counts.py` prints the table of limits anew, each 10 %
above what is counted now. Where a change raises a count and is worth it, or lowers counts for good,
put the new table in place of the old one and say why in the commit.
"""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING

import pytest
from scenes import pairs as scenes

import obbcli
from obbcli import Body, Mesh, Motion, ObbTree, Pose, kernels

if TYPE_CHECKING:
    from collections.abc import Callable

    from obbcli.answers.counts import QueryStats

    Counts = tuple[int, int, int, int]

TRIANGLES = 4000
SLACK = 0.1
NAMES = ("boxes built", "box tests", "triangle tests", "pops")
# The most that each question may cost, in the order of NAMES.
LIMITS: dict[str, Counts] = {
    "collide far": (3, 2, 0, 0),
    "collide gap_1e-1": (31, 46, 0, 11),
    "collide gap_1e-3": (176, 402, 170, 120),
    "collide touching": (151, 318, 44, 84),
    "collide deep": (57, 52, 9, 15),
    "collide nested": (1056, 4842, 0, 1213),
    "collide sheets": (3419, 15373, 0, 3869),
    "triangle_pairs penetrating": (281, 789, 575, 263),
    "triangle_pairs deep": (2427, 8445, 6332, 2855),
    "triangle_pairs stacked": (1593, 6775, 10570, 2891),
    "distance gap_1e-1": (234, 792, 530, 307),
    "distance gap_1e-3": (207, 495, 293, 195),
    "distance nested": (8622, 54542, 125708, 29718),
    "distance sheets": (8908, 51944, 113901, 27291),
    "distance interlocked": (2156, 8704, 14238, 3069),
    "first_contact one moves": (295, 785, 611, 285),
    "first_contact one moves past": (169, 662, 11, 167),
    "first_contact one turns": (272, 1825, 125, 980),
    "first_contact both turn": (246, 1278, 56, 682),
    "first_contact turns inside": (6481, 150704, 0, 74940),
    "collide both turn": (75, 310, 0, 145),
    "first_contact gears turn freely": (1708, 54397, 14062, 43412),
}

REST = Motion()
# Towards A with a velocity that the pose classes' gaps allow to arrive, and past it.
ALONG, PAST = Motion((-1.5, 0.25, 0.125)), Motion((0.0, 3.0, 0.0))
TURNING, COUNTER = Motion(None, (0.25, 0.5, 2.0)), Motion((-1.5, 0.0, 0.0), (1.0, -1.0, 0.5))


def bodies(name: str, motion_a: Motion = REST, motion_b: Motion = REST) -> tuple[Body, Body]:
    """Return the bodies of a pose class, of trees that nobody asked before."""
    pair = scenes.POSE_CLASSES[name](TRIANGLES)
    a, b = (ObbTree.build(Mesh(s.vertices, s.faces)) for s in (pair.a, pair.b))
    return Body(a, motion=motion_a), Body(b, Pose(pair.rotation, pair.translation), motion_b)


def _of(stats: QueryStats) -> Counts:
    built = stats.nodes_built_a + stats.nodes_built_b
    return built, stats.box_tests, stats.triangle_tests, stats.pops


def _collide(name: str) -> Counts:
    return _of(obbcli.collide(*bodies(name)).stats)


def _distance(name: str) -> Counts:
    return _of(obbcli.distance(*bodies(name)).stats)


def _first_contact(name: str, motion_a: Motion, motion_b: Motion) -> Counts:
    return _of(obbcli.first_contact(*bodies(name, motion_a, motion_b), 1.0).stats)


def _collide_moving(name: str, motion_a: Motion, motion_b: Motion) -> Counts:
    return _of(obbcli.collide(*bodies(name, motion_a, motion_b), 1.0).stats)


def _gears() -> Counts:
    """Wheels that glide along each other, on two axes, and never touch."""
    wheels = "sample_meshes/gear.stl", "sample_meshes/pinion.stl"
    a, b = (
        Body(ObbTree.build(wheel), motion=Motion(None, (0, 0, spin)))
        for wheel, spin in zip(wheels, (3, -6), strict=True)
    )
    return _of(obbcli.first_contact(a, b, 0.2).stats)


def _all_pairs(name: str, threads: int = 1) -> Counts:
    a, b = bodies(name)
    trees = [body.shape for body in (a, b)]
    _, counts = kernels.triangle_pairs(a.placed, b.placed, 2**64 - 1, threads, 2**64 - 1)
    box_tests, triangle_tests, _, pops, _ = counts
    return sum(tree.node_count for tree in trees), box_tests, triangle_tests, pops


QUESTIONS: dict[str, Callable[[], Counts]] = {
    **{
        f"collide {name}": lambda name=name: _collide(name)
        for name in ("far", "gap_1e-1", "gap_1e-3", "touching", "deep", "nested", "sheets")
    },
    **{
        f"triangle_pairs {name}": lambda name=name: _all_pairs(name)
        for name in ("penetrating", "deep", "stacked")
    },
    **{
        f"distance {name}": lambda name=name: _distance(name)
        for name in ("gap_1e-1", "gap_1e-3", "nested", "sheets", "interlocked")
    },
    "first_contact one moves": lambda: _first_contact("gap_1e-1", REST, ALONG),
    "first_contact one moves past": lambda: _first_contact("gap_1e-2", REST, PAST),
    "first_contact one turns": lambda: _first_contact("gap_1e-2", TURNING, REST),
    "first_contact both turn": lambda: _first_contact("gap_1e-1", TURNING, COUNTER),
    "first_contact turns inside": lambda: _first_contact("nested", REST, TURNING),
    "collide both turn": lambda: _collide_moving("gap_1e-1", COUNTER, TURNING),
    "first_contact gears turn freely": _gears,
}


@pytest.mark.parametrize("question", QUESTIONS)
def test_question_costs_no_more_than_its_limits(question: str) -> None:
    found = dict(zip(NAMES, QUESTIONS[question](), strict=True))
    limits = dict(zip(NAMES, LIMITS[question], strict=True))

    over = [
        f"{question}: {found[name]} {name}, the limit is {limit}"
        for name, limit in limits.items()
        if found[name] > limit
    ]

    assert not over, "; ".join(over)


@pytest.mark.parametrize("name", ["penetrating", "deep", "stacked"])
def test_counts_of_triangle_pairs_do_not_depend_on_threads(name: str) -> None:
    alone = _all_pairs(name, 1)

    assert _all_pairs(name, 2) == _all_pairs(name, 5) == alone


if __name__ == "__main__":
    for question, ask in QUESTIONS.items():
        limits = ", ".join(str(math.ceil(count * (1 + SLACK))) for count in ask())
        sys.stdout.write(f'    "{question}": ({limits}),\n')
