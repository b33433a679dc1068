"""Images on a common screw where more is asked than a first contact: lists, scenes, legs, rows."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest
from movers.answers import as_body
from movers.on_screws import KINDS, random_on_screw

from obbcli import (
    Accuracy,
    Body,
    Motion,
    ObbTree,
    Pose,
    Scene,
    Status,
    collide,
    contacts,
    first_contact,
    kernels,
    sweep,
)
from obbcli.questions.border import moving_query
from obbcli.questions.pair_question import PairQuestion

if TYPE_CHECKING:
    from movers.on_screws import Kind

NEVER = 2**63
MOST_POPS = 30_000
FULL_TURN = 2 * math.pi
BOLT, NUT = "sample_meshes/bolt.ply", "sample_meshes/nut.obj"
UP = Motion((0, 0, 2), (0, 0, FULL_TURN), (0, 0, 0))
DOWN = Motion((0, 0, -2), (0, 0, -FULL_TURN), (0, 0, 0))

Listed = dict[tuple[int, int], kernels.Contact]


def listed(pair: PairQuestion, before: int) -> tuple[Listed, float, int]:
    """Return the contact of each pair of triangles, until when all are known, and image tests."""
    query = moving_query(pair, each_pair=True, box_tests_before_screw=before)
    found: Listed = {}
    last, is_done = 0.0, False
    while True:
        contact = query.take()
        if contact is not None:
            which = contact.triangle_a, contact.triangle_b
            assert which not in found
            assert contact.low >= last
            last = contact.low
            found[which] = contact
        elif is_done or query.counts()[3] >= MOST_POPS:
            return found, query.lower_bound, query.counts()[4]
        else:
            is_done = query.advance(MOST_POPS - query.counts()[3])


@pytest.mark.parametrize("before", [0, 30])
@pytest.mark.parametrize("kind", KINDS)
def test_lists_are_those_of_steps(kind: Kind, before: int):
    asked = 0
    for seed in range(2000, 2040 if kind in ("triangles", "copies") else 2008):
        question = random_on_screw(kind, seed)
        accuracy = Accuracy(clearance=question.clearance)
        pair = PairQuestion.of(
            as_body(question.a), as_body(question.b), question.duration, accuracy
        )
        steps, images = listed(pair, NEVER), listed(pair, before)
        asked += images[2] > 0
        for (one, known, _), (other, _, _) in ((steps, images), (images, steps)):
            for which, contact in other.items():
                is_near = contact.evidence is kernels.Evidence.WITHIN_TOLERANCE
                if is_near and contact.distance > question.clearance:
                    continue  # near, but not proven to touch
                same = one.get(which)
                assert same is not None or contact.high >= known, (seed, which)
                assert same is None or same.low <= contact.high, (seed, which)
    assert asked > 3


def test_contacts_of_a_nut_that_meets_the_head_come_in_order():
    found = list(contacts(BOLT, Body(NUT, motion=DOWN), 3.01, limit=40))

    assert len(found) == 40
    lows = [contact.time_bounds[0] for contact in found if contact.time_bounds]
    assert lows == sorted(lows)
    assert lows[0] <= 3.0
    assert lows[0] == pytest.approx(3.0, abs=1e-9)
    assert len({(contact.triangle_a, contact.triangle_b) for contact in found}) == 40


def test_collide_over_a_duration_goes_by_images():
    apart = collide(BOLT, Body(NUT, motion=UP), 5.0)
    meeting = collide(BOLT, Body(NUT, motion=DOWN), 3.5)

    assert (apart.status, meeting.status) == (Status.SEPARATED, Status.CONTACT)
    for answer in (apart, meeting):
        assert 0 < answer.stats.image_tests < 200_000
        assert answer.stats.pops < 100_000


def test_scenes_ask_about_each_pair_by_its_own_screw():
    """Two bolts stand side by side, each with a nut that turns up it; one is of another lead."""
    aside = Pose(translation=(100, 0, 0))
    jamming = Motion((0, 0, 2.5), (0, 0, FULL_TURN), (100, 0, 0))
    bodies = {
        "bolt": Body(BOLT),
        "nut": Body(NUT, motion=UP),
        "other bolt": Body(BOLT, aside),
        "other nut": Body(NUT, aside, jamming),
    }
    scene = Scene(bodies, duration=3.0)

    search = scene.first_contacts()
    found = list(search)

    assert [(one.body_a, one.body_b) for one in found] == [("other bolt", "other nut")]
    alone = first_contact(Body(BOLT, aside), Body(NUT, aside, jamming), 3.0)
    assert found[0].time == alone.time
    assert 0 < search.stats.image_tests < 400_000
    assert search.stats.pops < 400_000


def test_legs_of_a_path_ask_for_themselves():
    """Up the thread in legs of a third of a turn, three turns in all."""
    third = FULL_TURN / 3
    poses = []
    for k in range(10):
        c, s = math.cos(k * third), math.sin(k * third)
        poses.append((k / 3, Pose(((c, -s, 0), (s, c, 0), (0, 0, 1)), (0, 0, 2 * k / 3))))
    path = Motion.through([time for time, _ in poses], [pose for _, pose in poses])

    answer = first_contact(BOLT, Body(NUT, motion=path), 3.0)

    assert answer.status is Status.SEPARATED
    assert answer.stats.image_tests > 0
    assert answer.stats.pops < 500_000  # steps alone take a million a turn


def test_rows_of_a_sweep_are_single_questions():
    motions = [UP, DOWN, Motion((0, 0, 2.1), (0, 0, FULL_TURN), (0, 0, 0))]
    bolt, nut = ObbTree.build(BOLT), ObbTree.build(NUT)
    durations = [5.0, 3.5, 1.0]

    rows = sweep(bolt, nut, None, motions, durations)

    for row, motion, duration in zip(rows, motions, durations, strict=True):
        alone = first_contact(bolt, Body(nut, motion=motion), duration)
        assert row["status"] == alone.status.value
        assert row["image_tests"] == alone.stats.image_tests > 0
        assert row["pops"] == alone.stats.pops
        if alone.time_bounds is not None:
            assert (row["time_lo"], row["time_hi"]) == alone.time_bounds


def test_tree_files_are_asked_by_images(tmp_path):
    files = []
    for name in (BOLT, NUT):
        files.append(str(tmp_path / f"{name[-8:-4].strip('/')}.obbt"))
        ObbTree.build(name).save(files[-1])

    answer = first_contact(files[0], Body(files[1], motion=DOWN), 3.5)

    grown = first_contact(BOLT, Body(NUT, motion=DOWN), 3.5)
    assert answer.time_bounds == pytest.approx(grown.time_bounds, abs=1e-8)
    assert 0 < answer.stats.image_tests < 200_000
