"""Boxes that stand for what they hold, under motion: proofs stay proofs, and bounds hold.

Held to the certified answer about the triangles, which other tests hold to truth, and to how far
apart the surfaces are when boxes are said to meet.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest
from meshes.nasty import soup
from movers.answers import as_body, ask, bounds
from movers.meshes import cube
from movers.random_pairs import KINDS, Kind, random_pair
from oracles.gaps import gap_at
from scenes.screw import X, Z

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, ObbTree, Status

if TYPE_CHECKING:
    from collections.abc import Iterator

    from oracles.screw import Mover

    from obbcli import FirstContact

DEPTHS = (0, 1, 2, 3, 5, None)
COARSE = [
    Accuracy(max_depth_a=a, max_depth_b=b)
    for a, b in product(DEPTHS, DEPTHS)
    if (a, b) != (None, None)
]
COARSE += [Accuracy(leaves="boxes"), Accuracy(leaves="boxes", max_depth_b=2)]
SHAPES = ("solids", "soups", "strips")


class Case(NamedTuple):
    """Two moving surfaces, their bodies over trees, and the answer about their triangles."""

    a: Mover
    b: Mover
    bodies: tuple[Body, Body]
    truth: FirstContact


def cases(kind: Kind, shape: str, clearance: float = 0.0) -> Iterator[Case]:
    for seed in range(12):
        a, b = random_pair(kind, 7000 + seed)
        if shape != "solids":
            flat = (1.0, 1.0, 1.0) if shape == "soups" else (1.0, 1e-2, 1e-4)
            a, b = (
                replace(body, vertices=0.5 * points * flat, faces=faces)
                for body, (points, faces) in ((a, soup(12, seed)), (b, soup(9, 40 + seed)))
            )
            # Middle to middle: thin as they are, they would pass each other.
            b = replace(b, velocity=a.velocity - (b.translation - a.translation) / 0.6)
        one, two = (
            replace(
                as_body(body),
                shape=ObbTree.build(Mesh(body.vertices, body.faces), leaf_size=1 + (seed + k) % 3),
            )
            for k, body in enumerate((a, b))
        )
        yield Case(a, b, (one, two), ask(a, b, 1.0, clearance=clearance))


@pytest.mark.parametrize("clearance", [0.0, 0.125])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("kind", KINDS)
def test_coarse_answers_of_moving_bodies_hold(kind: Kind, shape: str, clearance: float) -> None:
    seen = set()
    for case in cases(kind, shape, clearance):
        gaps: dict[float, float] = {}
        for coarse in COARSE:
            accuracy = replace(coarse, clearance=clearance)

            answer = obbcli.first_contact(*case.bodies, 1.0, accuracy)

            seen.add((answer.status, answer.approximate))
            if answer.status is Status.SEPARATED:
                assert case.truth.status is Status.SEPARATED
                assert (answer.approximate, answer.error_bound) == (False, 0.0)
            elif answer.approximate:
                assert_met_by_boxes(answer, case, gaps)
            else:
                assert answer.status is case.truth.status
                assert bounds(answer)[0] <= bounds(case.truth)[1]
    assert (Status.CONTACT, True) in seen
    assert len(seen) >= 2


def assert_met_by_boxes(answer: FirstContact, case: Case, gaps: dict[float, float]) -> None:
    assert (answer.evidence, answer.feature) == ("boxes", "box")
    assert (answer.triangle_a, answer.triangle_b, answer.distance) == (None, None, None)
    assert answer.time_bounds is not None
    lo, hi = answer.time_bounds
    assert hi is None
    assert answer.time == lo
    assert 0 <= lo <= 1
    if case.truth.status is not Status.SEPARATED:
        assert lo <= bounds(case.truth)[1]
    if lo not in gaps:
        gaps[lo] = gap_at(case.a, case.b, lo)
    assert gaps[lo] <= answer.error_bound * (1 + 1e-12)
    if answer.status is Status.CONTACT:
        assert answer.point is not None
        for normal in (answer.normal, answer.normal_a, answer.normal_b):
            assert normal is not None
            assert np.linalg.norm(normal) == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_coarse_yes_or_no_is_that_of_the_coarse_first_contact(kind: Kind) -> None:
    for case in cases(kind, "solids"):
        for accuracy in COARSE:
            answer = obbcli.first_contact(*case.bodies, 1.0, accuracy)

            verdict = obbcli.collide(*case.bodies, 1.0, accuracy)

            assert verdict.status is answer.status
            if verdict.approximate:
                assert verdict.witness is None
                assert answer.time is not None
                assert gap_at(case.a, case.b, answer.time) <= verdict.error_bound * (1 + 1e-12)
            elif verdict.collides:
                assert case.truth.status is answer.status


@pytest.mark.parametrize("depth", [0, 1])
@pytest.mark.parametrize("spin", [0 * Z, 2.0 * X], ids=["straight", "turning about the way"])
def test_boxes_that_are_the_bodies_meet_when_these_do(spin: Any, depth: int) -> None:
    # Roots fitted to cubes are the cubes; faces meet flat, so that the time is that of the gap.
    a = Body(ObbTree.build(Mesh(*cube()), "axis-aligned"), motion=Motion(2.0 * X, spin))
    b = Body(ObbTree.build(Mesh(cube()[0] + 3.0 * X, cube()[1]), "axis-aligned"))
    accuracy = Accuracy(max_depth_a=depth, max_depth_b=depth)

    answer = obbcli.first_contact(a, b, 1.0, accuracy)

    assert answer.evidence == "boxes"
    assert answer.time == pytest.approx(0.5, abs=1e-6)
    assert answer.time is not None
    assert answer.time <= 0.5
    assert answer.normal == pytest.approx(X, abs=1e-6)
