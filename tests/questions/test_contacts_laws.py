"""`obbcli.contacts`: laws that its lists obey, boxes in them, and work that is not done."""

from __future__ import annotations

from itertools import islice, pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from movers.answers import as_body, assert_coherent
from movers.flyby import flyby
from movers.meshes import box, cube, star
from oracles.screw import Mover

import obbcli
from obbcli import Accuracy, Body, Contact, Mesh, Motion, ObbTree, Status
from obbcli.answers.counts import Counts
from obbcli.questions.contacts import search_contacts
from obbcli.questions.pair_question import PairQuestion
from obbcli.questions.search import Search

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
MANY = 10**7


def by_pair(a: Body, b: Body, duration: float | None = None, **accuracy: Any) -> dict[Any, Contact]:
    """Return contacts by their triangles; fails where a pair comes twice or out of order."""
    found = list(obbcli.contacts(a, b, duration, Accuracy(**accuracy)))
    times = [contact.time for contact in found]
    assert times == sorted(times)
    pairs = {(contact.triangle_a, contact.triangle_b): contact for contact in found}
    assert len(pairs) == len(found)
    return pairs


def assert_same(one: dict[Any, Contact], two: dict[Any, Contact], *, exactly: bool) -> None:
    """Fail unless two lists hold the same pairs at the same times."""
    assert one.keys() == two.keys()
    for pair, contact in one.items():
        (low, high), (least, most) = contact.time_bounds, two[pair].time_bounds
        if exactly:
            assert (low, high) == (least, most)
        assert low <= most
        assert least <= high


TURNING = pytest.mark.parametrize("turning", [False, True], ids=["going", "turning"])


@TURNING
@pytest.mark.parametrize("seed", range(6))
def test_swapped_bodies_have_the_same_contacts(seed: int, turning: bool) -> None:
    a, b = (as_body(mover) for mover in flyby(seed, speed=2, about_middle=True, turning=turning))

    forth = by_pair(a, b)
    back = {(i, j): contact for (j, i), contact in by_pair(b, a).items()}

    assert len(forth) > 10
    assert_same(forth, back, exactly=not turning)


@TURNING
@pytest.mark.parametrize("seed", range(6))
def test_order_of_triangles_changes_ids_alone(seed: int, turning: bool) -> None:
    rng = np.random.default_rng(100 + seed)
    a, b = (as_body(mover) for mover in flyby(seed, speed=2, about_middle=True, turning=turning))
    orders = [rng.permutation(len(body.shape.triangles)) for body in (a, b)]
    mixed = [
        Body(Mesh(body.shape.vertices, body.shape.triangles[order]), body.pose, body.motion)
        for body, order in zip((a, b), orders, strict=True)
    ]

    found = {(orders[0][i], orders[1][j]): contact for (i, j), contact in by_pair(*mixed).items()}

    assert_same(by_pair(a, b), found, exactly=not turning)


@pytest.mark.parametrize("turns", [3, 40])
def test_pair_that_meets_in_every_turn_is_told_once(turns: int) -> None:
    # A blade turns about z once a second and sweeps through a post beside its axis.
    blade = Mesh(*box((0.25, -0.0625, -0.5), (2.0, 0.0625, 0.5)))
    post = Mesh(*box((1.0, 1.0, -1.0), (1.25, 1.25, 1.0)))
    fan = Body(blade, motion=Motion(angular_velocity=(0, 0, 2 * np.pi), pivot=(0, 0, 0)))

    once = by_pair(fan, post, 1.0, time_tolerance=1e-9)
    often = by_pair(fan, post, float(turns), time_tolerance=1e-9)

    assert len(once) > 10
    assert max(contact.time for contact in often.values()) < 1
    assert_same(once, often, exactly=False)


@TURNING
def test_larger_clearance_delays_no_contact(turning: bool) -> None:
    a, b = (as_body(mover) for mover in flyby(1, speed=2, about_middle=True, turning=turning))
    lists = [by_pair(a, b, clearance=clearance) for clearance in (0.0, 0.0625, 0.25)]

    assert len(lists[0]) < len(lists[2])
    for far, near in pairwise(lists):
        for pair, contact in far.items():
            assert near[pair].time <= contact.time_bounds[1]


def test_meshing_teeth_meet_pair_by_pair_and_each_contact_is_one() -> None:
    gears = []
    for name, spin, place in (("gear", 3.0, 0.0), ("pinion", -5.9, 54.0)):
        mesh = obbcli.load_mesh(SAMPLES / f"{name}.stl")
        gears.append(
            Mover(mesh.vertices, mesh.triangles, spin=(0, 0, spin), pivot=(place, 0.0, 0.0))
        )
    a, b = (as_body(gear) for gear in gears)

    found = list(islice(obbcli.contacts(a, b, 2.0), 60))

    assert [contact.time for contact in found] == sorted(contact.time for contact in found)
    assert len({(contact.triangle_a, contact.triangle_b) for contact in found}) == 60
    assert len({round(contact.time, 6) for contact in found}) > 5
    for contact in found[::4]:
        assert contact.time_bounds[1] - contact.time <= 2.0000001e-9
        assert_coherent(contact, *gears, 2.0)


@TURNING
@pytest.mark.parametrize("depth", [0, 1, 2])
def test_each_pair_of_boxes_is_one_contact(depth: int, turning: bool) -> None:
    a, b = (as_body(mover) for mover in flyby(2, speed=2, about_middle=True, turning=turning))
    exact = by_pair(a, b)

    found = list(obbcli.contacts(a, b, accuracy=Accuracy(max_depth_a=depth, max_depth_b=depth)))

    assert 1 <= len(found) <= 4**depth
    times = [contact.time for contact in found]
    assert times == sorted(times)
    assert times[0] <= min(contact.time_bounds[1] for contact in exact.values())
    for contact in found:
        assert (contact.approximate, contact.evidence, contact.feature) == (True, "boxes", "box")
        assert (contact.triangle_a, contact.triangle_b, contact.distance) == (None, None, None)
        assert contact.time_bounds == (contact.time, None)
        assert contact.error_bound > 0


def test_leaves_of_several_triangles_meet_as_boxes_where_asked() -> None:
    a, b = flyby(3, speed=2, about_middle=True, turning=True)
    trees = [ObbTree.build(Mesh(m.vertices, m.faces), leaf_size=3) for m in (a, b)]
    bodies = [
        Body(tree, as_body(mover).pose, as_body(mover).motion)
        for tree, mover in zip(trees, (a, b), strict=True)
    ]
    leaves_a, leaves_b = (sum(level.leaf_count for level in tree.levels) for tree in trees)

    coarse = list(obbcli.contacts(*bodies, accuracy=Accuracy(leaves="boxes")))

    assert leaves_a < 12
    assert leaves_b < 8
    assert 1 < len(coarse) <= leaves_a * leaves_b
    assert all(contact.approximate for contact in coarse)
    assert_same(by_pair(*bodies), by_pair(as_body(a), as_body(b)), exactly=False)


@pytest.mark.parametrize("gap", [0.0, -0.25])
def test_pairs_at_start_come_first_whatever_turns(gap: float) -> None:
    a = Mover(*cube(), spin=(0.25, 0, 0.5))
    b = Mover(*cube(), translation=(2 + gap, 0.5, 0.25), velocity=(-0.5, 0, 0.25))
    bodies = as_body(a), as_body(b)
    at_start = obbcli.triangle_pairs(*bodies).tolist()

    found = list(obbcli.contacts(*bodies))

    first = found[: len(at_start)]
    assert [[contact.triangle_a, contact.triangle_b] for contact in first] == at_start
    assert {contact.time_bounds for contact in first} == {(0, 0)}
    assert {contact.status for contact in first} == {Status.OVERLAP_AT_START}
    assert len(found) > len(first)
    assert {contact.status for contact in found[len(first) :]} == {Status.CONTACT}


def spinning_stars() -> tuple[Body, Body]:
    a = Mover(*star(), spin=(0.5, 0.25, 1.0))
    b = Mover(*star(), translation=(5, 0.25, 0), velocity=(-5, 0, 0), pivot=(5, 0.25, 0))
    return as_body(a), as_body(b)


def test_nothing_is_done_for_contacts_that_nobody_asks_for() -> None:
    whole, part = Search(MANY), Search(MANY)
    every = list(search_contacts(PairQuestion.of(*spinning_stars()), whole))

    found = search_contacts(PairQuestion.of(*spinning_stars()), part)
    assert part.counts == Counts()
    first = next(found)
    pops = part.counts[3]

    assert first == every[0]
    assert 0 < pops < whole.counts[3] / 4
    assert part.counts[3] == pops


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_search_ends_where_later_contacts_are_of_no_interest(share: float) -> None:
    whole = Search(MANY)
    every = list(search_contacts(PairQuestion.of(*spinning_stars()), whole))
    end = every[round(share * (len(every) - 1))].time
    part = Search(MANY, end=end)

    found = list(search_contacts(PairQuestion.of(*spinning_stars()), part))

    assert found == [contact for contact in every if contact.time <= end]
    assert part.counts[3] < whole.counts[3]


def test_search_tells_how_far_it_has_come() -> None:
    told: list[float] = []
    search = Search(MANY, progress=told.append)

    found = list(search_contacts(PairQuestion.of(*spinning_stars()), search))

    assert told == sorted(told)
    assert told[0] == 0
    assert found[0].time <= told[-1] <= 1
