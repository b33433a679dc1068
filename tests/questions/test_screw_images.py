"""Bodies on a common screw, told apart by images of their triangles: the answers of steps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from movers.answers import as_body
from movers.on_screws import KINDS, random_on_screw
from movers.screw_ways import AT_ONCE, NEVER, ask, is_apart_at_start
from oracles.screw_sampling import sampled_overlap

import obbcli
from obbcli import Accuracy, Body, Motion, ObbTree, Pose, Status, first_contact
from obbcli.questions.border import moving_query
from obbcli.questions.pair_question import PairQuestion

if TYPE_CHECKING:
    from movers.on_screws import Kind

    from obbcli import FirstContact

FULL_TURN = 2 * math.pi
BOLT, NUT = "sample_meshes/bolt.ply", "sample_meshes/nut.obj"
# What steps take for one turn of the nut: three million pairs of boxes, and a million pops.
FEW = 200_000


@pytest.mark.parametrize("start", range(0, 200, 50))
@pytest.mark.parametrize("kind", KINDS)
def test_images_say_what_steps_say(kind: Kind, start: int):
    asked = 0
    for seed in range(start, start + 50):
        question = random_on_screw(kind, seed)
        accuracy = Accuracy(clearance=question.clearance)
        pair = PairQuestion.of(
            as_body(question.a), as_body(question.b), question.duration, accuracy
        )
        if not is_apart_at_start(pair):
            continue
        images, steps = ask(pair, AT_ONCE), ask(pair, NEVER)
        asked += images.counts.image_tests > 0
        assert steps.counts.image_tests == 0
        for one, other in ((images, steps), (steps, images)):
            if other.is_proven(question.clearance):
                assert other.contact is not None
                assert one.low <= other.contact.high, (kind, seed)
        if "unresolved" not in (images.status, steps.status):
            assert images.status == steps.status, (kind, seed)
    assert asked > 10


@pytest.mark.parametrize("kind", ["triangles", "copies"])
def test_nothing_meets_before_images_say(kind: Kind):
    checked = 0
    for seed in range(1000, 1040):
        question = random_on_screw(kind, seed)
        pair = PairQuestion.of(as_body(question.a), as_body(question.b), question.duration)
        if not is_apart_at_start(pair):
            continue
        found = ask(pair, AT_ONCE)
        if found.counts.image_tests == 0 or found.low == 0:
            continue
        times = np.linspace(0, found.low, 60, endpoint=False)
        assert sampled_overlap(question.a, question.b, question.duration, times) is None, seed
        checked += 1
    assert checked > 8


def nut_on_bolt(turns: float, lead: float = 2.0, **accuracy: Any) -> FirstContact:
    """Turn the sample nut up its bolt (of lead 2), a turn a second; down for negative turns."""
    way = math.copysign(1.0, turns)
    motion = Motion((0, 0, lead * way), (0, 0, FULL_TURN * way), (0, 0, 0))
    return first_contact(BOLT, Body(NUT, motion=motion), abs(turns), Accuracy(**accuracy))


@pytest.mark.parametrize("turns", [1.0, 5.0, 1e6, 1e12])
def test_nut_turns_up_its_thread(turns):
    answer = nut_on_bolt(turns)

    assert answer.status is Status.SEPARATED
    assert 0 < answer.stats.image_tests < FEW


def test_images_leave_little_to_boxes_and_triangles():
    motion = Motion((0, 0, 2), (0, 0, FULL_TURN), (0, 0, 0))
    found = ask(PairQuestion.of(BOLT, Body(NUT, motion=motion), 5.0), AT_ONCE)

    assert found.status == "separated"
    assert found.counts.box_tests == 0
    assert found.counts.triangle_tests < 10
    assert 0 < found.counts.image_tests < FEW


def test_nut_turns_down_to_the_head():
    answer = nut_on_bolt(-3.5)

    assert answer.status is Status.CONTACT
    assert answer.time_bounds is not None
    low, high = answer.time_bounds
    assert high is not None
    assert low <= 3.0 <= high
    assert high - low < 1e-8
    assert 0 < answer.stats.image_tests < FEW
    assert answer.stats.pops < 100_000


def test_a_little_short_of_the_head_it_is_apart():
    assert nut_on_bolt(-2.9999).status is Status.SEPARATED


@pytest.mark.parametrize(
    ("lead", "turns", "time"), [(2.1, 1.0, 0.95021053), (1.9, 1.2, 0.94982158)]
)
def test_nut_of_nearly_the_lead_jams(lead, turns, time):
    """The times are those of steps alone, which take three million box tests for them."""
    answer = nut_on_bolt(turns, lead)

    assert answer.status is Status.CONTACT
    assert answer.time == pytest.approx(time, abs=2e-8)
    assert answer.stats.pops < FEW


@pytest.mark.parametrize("lead", [4.0, 0.0, -2.0])
def test_nut_of_another_lead_jams_when_steps_say(lead):
    motion = Motion((0, 0, lead), (0, 0, FULL_TURN), (0, 0, 0))
    pair = PairQuestion.of(BOLT, Body(NUT, motion=motion), 1.2)
    images = ask(pair, AT_ONCE)
    query = moving_query(pair, box_tests_before_screw=NEVER)
    while not query.advance(10**6):
        pass
    steps = query.contact()

    assert images.contact is not None
    assert steps is not None
    assert images.contact.low <= steps.high
    assert steps.low <= images.contact.high


@pytest.mark.parametrize("clearance", [0.01, 0.05])
def test_clearance_less_than_the_play_is_kept(clearance):
    answer = nut_on_bolt(5.0, clearance=clearance)

    assert answer.status is Status.SEPARATED
    assert answer.stats.image_tests > 0


def test_clearance_more_than_the_play_is_a_contact():
    answer = nut_on_bolt(1.0, clearance=0.0825)

    assert answer.status in (Status.CONTACT, Status.OVERLAP_AT_START)


def test_distance_tolerance_ends_it_as_without_images():
    # The nut is 0.082 off its bolt: whoever is content with that has a contact, by any way.
    answer = nut_on_bolt(1.0, distance_tolerance=0.09)

    assert answer.status is Status.CONTACT
    assert answer.distance is not None
    assert answer.distance <= 0.09


def placed_nut(bolt: Motion, nut: Motion, pose: Pose | None = None) -> FirstContact:
    at = Pose() if pose is None else pose
    return first_contact(Body(BOLT, at, bolt), Body(NUT, at, nut), 3.0)


UP = (0.0, 0.0, 2.0), (0.0, 0.0, FULL_TURN), (0.0, 0.0, 0.0)
STILL = (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("bolt", "nut"),
    [
        (Motion((0, 0, -2), (0, 0, -FULL_TURN), (0, 0, 0)), Motion()),
        (Motion((0, 0, -1), (0, 0, -FULL_TURN / 2)), Motion((0, 0, 1), (0, 0, FULL_TURN / 2))),
        (Motion((3, 4, 0), STILL), Motion((3, 4, 2), (0, 0, FULL_TURN), (0, 0, 7))),
        (Motion(), Motion((1e-4, 0, 2), (0, 0, FULL_TURN), (0, 0, 0))),
        (Motion(), Motion((0, 0, 2), (1e-5, 0, FULL_TURN), (0, 0, 0))),
    ],
    ids=["bolt turns", "both turn", "both drift", "slow drift", "tilted"],
)
def test_whoever_turns_and_nearly_on_the_screw(bolt, nut):
    pivoted = (Motion(*m.velocities, (0, 0, 0)) if m.is_turning else m for m in (bolt, nut))
    # Pivots that were given stay as they are: only those of no pivot turn about the bolt's axis.
    answer = placed_nut(*pivoted)

    assert answer.status is Status.SEPARATED
    assert 0 < answer.stats.image_tests < FEW


@pytest.mark.parametrize(
    "nut",
    [
        Motion((1.0, 0, 2), (0, 0, FULL_TURN), (0, 0, 0)),
        Motion((0, 0, 2), (0.5, 0, FULL_TURN), (0, 0, 0)),
        Motion((0, 0, 2), (0, 0, 0.0003), (0, 0, 0)),
        Motion((0, 0, 2)),
    ],
    ids=["drifts across", "tumbles", "hardly turns", "slides"],
)
def test_other_motions_go_by_steps(nut):
    answer = first_contact(BOLT, Body(NUT, motion=nut), 0.5)

    assert answer.status is Status.CONTACT
    assert answer.stats.image_tests == 0


@pytest.mark.parametrize(("drift", "by_images"), [(0.0125, True), (0.05, False)])
def test_slack_at_its_limit_parts_the_ways(drift, by_images):
    """Images bear drift up to 2^-10 of the nut, whose half extents add up to 30 or so."""
    motion = Motion((drift, 0, 2), (0, 0, FULL_TURN), (0, 0, 0))
    found = ask(PairQuestion.of(BOLT, Body(NUT, motion=motion), 1.0), AT_ONCE)

    assert (found.counts.image_tests > 0) is by_images
    assert found.status == ("separated" if by_images else "unresolved")  # steps take more pops


@pytest.mark.parametrize("far", [1e3, 1e6, 1e9])
def test_far_pivots_change_nothing(far):
    at = Pose(translation=(far, -far, far / 2))
    pivot = (far, -far, far / 2)
    up = Motion((0, 0, 2), (0, 0, FULL_TURN), pivot)

    answer = placed_nut(Motion(), up, at)

    # At 1e9 vertices are rounded by 1e-7, at most, which the play bears.
    assert answer.status is Status.SEPARATED
    assert 0 < answer.stats.image_tests < FEW


def test_answers_follow_from_the_question_alone(tmp_path):
    """Slices, trees that grow, whole trees and tree files: the same bits, and the same counts."""
    motion = Motion((0, 0, -2), (0, 0, -FULL_TURN), (0, 0, 0))
    files = []
    for name in (BOLT, NUT):
        files.append(tmp_path / f"{name[-8:-4]}.obbt")
        ObbTree.build(name).save(files[-1])
    answers = []
    for bolt, nut in ((BOLT, NUT), (ObbTree.build(BOLT), ObbTree.build(NUT)), files):
        query = obbcli.Query(bolt, Body(nut, motion=motion), 3.5)
        answer = query.advance(1000)
        while answer.status is Status.UNRESOLVED:
            answer = query.advance(1000)
        answers.append((answer.time_bounds, answer.triangle_a, answer.triangle_b))
        assert answer.stats.image_tests > 0

    low, high = answers[0][0]
    assert low <= 3.0 <= high
    for bounds, _, _ in answers[1:]:
        assert bounds[0] <= high
        assert low <= bounds[1]


def test_lower_bound_never_falls():
    motion = Motion((0, 0, -2), (0, 0, -FULL_TURN), (0, 0, 0))
    query = obbcli.Query(BOLT, Body(NUT, motion=motion), 3.5)
    bounds = [0.0]
    while query.advance(500).status is Status.UNRESOLVED:
        assert query.lower_bound >= bounds[-1]
        bounds.append(query.lower_bound)

    assert len(bounds) > 20
