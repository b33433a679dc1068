"""What must hold between answers to related questions, whatever the answers are."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from movers.answers import as_body, ask, bounds
from movers.random_pairs import KINDS, Kind, random_pair
from scenes.pairs import random_rotation

import obbcli
from obbcli import FirstContact, Status

if TYPE_CHECKING:
    from oracles.screw import Mover

SEEDS = range(500, 530)
GRID = 2.0**-20
FAR = np.array([64.0, -1024.0, 0.25])
DRIFT = np.array([4.0, -16.0, 0.5])
Pair = tuple["Mover", "Mover"]


def on_grid(kind: Kind, seed: int) -> Pair:
    """Return a random pair that dyadic shifts and mirrors do not round."""
    a, b = (
        replace(
            body,
            vertices=np.round(body.start / GRID) * GRID,
            rotation=np.eye(3),
            translation=np.zeros(3),
            velocity=np.round(np.asarray(body.velocity) / GRID) * GRID,
            pivot=np.round(np.asarray(body.pivot) / GRID) * GRID,
        )
        for body in random_pair(kind, seed)
    )
    return a, b


def mapped(pair: Pair, **changes: Any) -> Pair:
    """Return the pair with fields replaced by functions of themselves."""
    a, b = (
        replace(body, **{name: change(getattr(body, name)) for name, change in changes.items()})
        for body in pair
    )
    return a, b


def assert_same_answer(one: FirstContact, two: FirstContact) -> None:
    """Fail unless two answers can both be true of one question."""
    assert one.status is two.status
    if one.status is not Status.SEPARATED and {one.evidence, two.evidence} == {"intersecting"}:
        (lo, hi), (first, last) = bounds(one), bounds(two)
        assert lo <= last
        assert first <= hi


laws = pytest.mark.parametrize("kind", KINDS)


@laws
def test_swapping_the_bodies_swaps_the_answer(kind: Kind) -> None:
    for seed in SEEDS:
        a, b = random_pair(kind, seed)

        one, two = ask(a, b, 1.0), ask(b, a, 1.0)

        assert_same_answer(one, two)
        if one.status is Status.CONTACT and one.triangle_a == two.triangle_b:
            assert one.normal is not None
            assert one.normal == pytest.approx(-np.asarray(two.normal), abs=1e-6)


@laws
def test_dyadic_shift_of_the_world_changes_next_to_nothing(kind: Kind) -> None:
    for seed in SEEDS:
        pair = on_grid(kind, seed)

        moved = mapped(pair, translation=lambda s: s + FAR, pivot=lambda k: k + FAR)

        one, two = ask(*pair, 1.0), ask(*moved, 1.0)
        assert_same_answer(one, two)
        if one.status is Status.CONTACT:
            # Boxes, which lie on no grid, round at the other place.
            assert abs(bounds(one)[0] - bounds(two)[0]) <= (0 if kind == "translating" else 1e-12)


@laws
@pytest.mark.parametrize("power", [-200, -3, 5, 300])
def test_scaling_lengths_by_a_power_of_two_changes_no_bit_of_the_times(
    kind: Kind, power: int
) -> None:
    k = 2.0**power
    for seed in SEEDS:
        pair = random_pair(kind, seed)

        large = mapped(
            pair,
            vertices=lambda p: p * k,
            translation=lambda s: s * k,
            velocity=lambda v: v * k,
            pivot=lambda p: p * k,
        )

        one, two = ask(*pair, 1.0), ask(*large, 1.0)
        assert (one.status, one.time_bounds) == (two.status, two.time_bounds), seed


@laws
@pytest.mark.parametrize("power", [-30, -1, 3, 40])
def test_scaling_time_by_a_power_of_two_scales_the_times(kind: Kind, power: int) -> None:
    k = 2.0**power
    for seed in SEEDS:
        pair = random_pair(kind, seed)

        slow = mapped(pair, velocity=lambda v: v / k, spin=lambda w: w / k)

        one, two = ask(*pair, 1.0), ask(*slow, k)
        assert one.status is two.status, seed
        if one.status is Status.CONTACT:
            assert [time * Fraction(k) for time in bounds(one)] == list(bounds(two)), seed


@laws
def test_mirror_image_has_the_same_answer(kind: Kind) -> None:
    mirror, turn = np.array([-1.0, 1.0, 1.0]), np.array([1.0, -1.0, -1.0])
    for seed in SEEDS:
        pair = on_grid(kind, seed)

        image = mapped(
            pair,
            vertices=lambda p: p * mirror,
            velocity=lambda v: v * mirror,
            pivot=lambda k: k * mirror,
            spin=lambda w: w * turn,
        )

        assert_same_answer(ask(*pair, 1.0), ask(*image, 1.0))


@laws
def test_turned_world_has_the_same_answer(kind: Kind) -> None:
    # A third of a turn about (1, 1, 1): nothing rounds.
    def turned(v: Any) -> Any:
        return np.roll(v, 1, axis=-1)

    for seed in SEEDS:
        pair = on_grid(kind, seed)

        image = mapped(pair, vertices=turned, velocity=turned, pivot=turned, spin=turned)

        assert_same_answer(ask(*pair, 1.0), ask(*image, 1.0))


@laws
def test_world_seen_from_elsewhere_has_the_same_answer(kind: Kind) -> None:
    met = 0
    for seed in SEEDS:
        pair = random_pair(kind, seed)
        turn, shift = random_rotation(seed), np.array([0.75, -3.0, 1.5])

        image = mapped(
            pair,
            rotation=lambda q, turn=turn: turn @ q,
            translation=lambda s, turn=turn, shift=shift: turn @ s + shift,
            pivot=lambda k, turn=turn, shift=shift: turn @ k + shift,
            velocity=lambda v, turn=turn: turn @ v,
            spin=lambda w, turn=turn: turn @ w,
        )

        one, two = ask(*pair, 1.0), ask(*image, 1.0)
        assert one.status is two.status, seed
        if one.status is Status.CONTACT:
            met += 1
            assert abs(bounds(one)[0] - bounds(two)[0]) <= 1e-9
            assert one.normal is not None
            assert two.point == pytest.approx(turn @ np.asarray(one.point) + shift, abs=1e-6)
    assert met > 2


@laws
def test_common_velocity_changes_nothing(kind: Kind) -> None:
    for seed in SEEDS:
        pair = on_grid(kind, seed)

        both = mapped(pair, velocity=lambda v: v + DRIFT)

        assert_same_answer(ask(*pair, 1.0), ask(*both, 1.0))


@laws
def test_order_of_triangles_changes_names_alone(kind: Kind) -> None:
    for seed in SEEDS:
        a, b = random_pair(kind, seed)
        order = np.random.default_rng(seed).permutation(len(a.faces))

        one, two = ask(a, b, 1.0), ask(replace(a, faces=a.faces[order]), b, 1.0)

        assert_same_answer(one, two)


@laws
def test_splitting_triangles_changes_nothing(kind: Kind) -> None:
    for seed in SEEDS:
        a, b = on_grid(kind, seed)

        one, two = ask(a, b, 1.0), ask(a, split(b), 1.0)

        assert_same_answer(one, two)


def split(body: Mover) -> Mover:
    """Return the body with each face cut at the middle of one side, exactly."""
    points, faces = list(body.vertices), []
    for i, j, k in body.faces:
        points.append((body.vertices[i] + body.vertices[j]) / 2)
        faces += [(i, len(points) - 1, k), (len(points) - 1, j, k)]
    return replace(body, vertices=np.array(points), faces=np.array(faces))


@laws
def test_longer_duration_keeps_an_earlier_contact(kind: Kind) -> None:
    for seed in SEEDS:
        a, b = random_pair(kind, seed)

        one, two = ask(a, b, 1.0), ask(a, b, 3.0)

        if one.status is Status.CONTACT:
            assert_same_answer(one, two)
        elif two.status is Status.CONTACT:
            assert bounds(two)[1] > 1


@laws
def test_duration_before_the_contact_is_free_of_it(kind: Kind) -> None:
    for seed in SEEDS:
        a, b = random_pair(kind, seed)
        whole = ask(a, b, 1.0)
        if whole.status is Status.CONTACT:
            lo, hi = bounds(whole)

            before, after = ask(a, b, float(lo) * (1 - 1e-7)), ask(a, b, float(hi))

            assert before.status is Status.SEPARATED
            assert after.status is Status.CONTACT


@laws
def test_collide_agrees_with_first_contact(kind: Kind) -> None:
    seen = set()
    for seed in range(9000, 9700):
        a, b = random_pair(kind, seed)
        if seed % 7 == 0:
            b = replace(b, translation=a.translation + 0.4 * (b.translation - a.translation))
        duration = (1.0, 0.25, 4.0)[seed % 3]

        answer, verdict = ask(a, b, duration), obbcli.collide(as_body(a), as_body(b), duration)

        seen.add(answer.status)
        assert verdict.status is answer.status, seed
        assert verdict.collides == (answer.status is not Status.SEPARATED)
        assert (verdict.witness is None) == (answer.status is Status.SEPARATED)
    assert seen == {Status.SEPARATED, Status.CONTACT, Status.OVERLAP_AT_START}


def test_bodies_at_rest_are_asked_like_collide() -> None:
    for seed in SEEDS:
        a, b = random_pair("translating", seed)
        rest = {"velocity": (0, 0, 0), "spin": (0, 0, 0)}
        for shift in (np.zeros(3), np.subtract(a.translation, b.translation) + 0.5):
            still = replace(a, **rest), replace(b, translation=b.translation + shift, **rest)

            answer, verdict = ask(*still, 1.0), obbcli.collide(*map(as_body, still))

            assert answer.status is verdict.status
