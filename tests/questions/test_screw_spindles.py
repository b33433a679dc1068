"""Bodies of revolution on a common screw: spindles, tips in holes, facets that meet on the axis."""

from __future__ import annotations

import math

import numpy as np
import pytest
from movers.screw_ways import AT_ONCE, ask
from movers.turned import spindle_and_housing, turned

from obbcli import Body, Mesh, Motion, Status, first_contact
from obbcli.questions.pair_question import PairQuestion

FULL_TURN = 2 * math.pi


@pytest.mark.parametrize("turns", [10.0, 1e6])
def test_spindle_turns_in_its_housing(turns):
    shaft, sleeve = (Mesh(*mesh) for mesh in spindle_and_housing(240, 0.1))
    spinning = Body(shaft, motion=Motion((0, 0, 0), (0, 0, FULL_TURN), (0, 0, 0)))

    answer = first_contact(sleeve, spinning, turns)

    assert answer.status is Status.SEPARATED
    assert 0 < answer.stats.image_tests < 1000


def test_spindle_slides_until_its_collar_meets_the_groove():
    shaft, sleeve = (Mesh(*mesh) for mesh in spindle_and_housing(240, 0.125))
    sliding = Body(shaft, motion=Motion((0, 0, 0.0625), (0, 0, FULL_TURN), (0, 0, 0)))

    answer = first_contact(sleeve, sliding, 3.0)

    assert answer.status is Status.CONTACT
    assert answer.time_bounds is not None
    low, high = answer.time_bounds
    assert high is not None
    assert low <= 2.0 <= high
    assert high - low < 1e-6
    assert answer.stats.pops < 200_000  # steps take more than a million


@pytest.mark.parametrize("steps", [12, 24])
def test_coarse_facets_gain_nothing_and_lose_nothing(steps):
    play = 9 * (1 / math.cos(math.pi / steps) - 1) + 0.05
    shaft, sleeve = (Mesh(*mesh) for mesh in spindle_and_housing(steps, play))
    spinning = Body(shaft, motion=Motion((0, 0, 0), (0, 0, FULL_TURN), (0, 0, 0)))
    pair = PairQuestion.of(sleeve, spinning, 3.0)

    assert ask(pair, AT_ONCE).status == "separated"


def test_tip_turns_in_a_centre_hole():
    """All facets meet on the axis, where they have no angle: their profiles tell them apart."""
    tip = Mesh(*turned([(0, 0), (5, 5), (5, 12), (0, 12)], 60))
    hole = Mesh(*turned([(0, -0.15), (5.1, 4.95), (9, 4.95)], 60))
    spinning = Body(tip, motion=Motion((0, 0, 0), (0, 0, FULL_TURN), (0, 0, 0)))

    found = ask(PairQuestion.of(hole, spinning, 1e3), AT_ONCE)

    assert found.status == "separated"
    assert 0 < found.counts.image_tests < 200


def test_facets_that_meet_on_the_axis_are_left_to_steps():
    """Each fan of a disc would meet each of the other at its own time: too many pairs to tell."""
    disc, dish = (Mesh(*turned([(0, z), (5, rim)], 48)) for z, rim in ((0, 0), (0.125, 0.25)))
    sinking = Body(disc, motion=Motion((0, 0, 0.0625), (0, 0, FULL_TURN), (0, 0, 0)))
    found = ask(PairQuestion.of(dish, sinking, 4.0), AT_ONCE)

    assert found.counts.image_tests == 0
    assert found.contact is not None
    assert found.contact.low <= 2.0 <= found.contact.high


def test_large_facet_among_small_ones_spoils_no_answer():
    """A node of both has a rectangle that fits neither."""
    shaft, sleeve = spindle_and_housing(120, 0.1)
    points, faces = shaft
    # A vane behind the shaft, a hundred times as large as its facets, which turns with it.
    vane = np.array([(5.0, 0.0, 8.0), (60.0, 0.0, 8.0), (60.0, 0.0, 90.0)])
    corners = np.arange(3) + len(points)
    winged = Mesh(np.concatenate([points, vane]), np.concatenate([faces, [corners]]))
    spinning = Body(winged, motion=Motion((0, 0, 0), (0, 0, FULL_TURN), (0, 0, 0)))

    found = ask(PairQuestion.of(Mesh(*sleeve), spinning, 1e4), AT_ONCE)

    assert found.status == "separated"
    assert 0 < found.counts.image_tests < 2000


@pytest.mark.parametrize("exponent", [-1000, -1060, 900])
def test_scale_changes_nothing(exponent):
    shaft, sleeve = spindle_and_housing(64, 0.125)
    bounds = []
    for power in (0, exponent):
        scale = 2.0**power
        a, b = (Mesh(points * scale, faces) for points, faces in (sleeve, shaft))
        motion = Motion((0, 0, 0.0625 * scale), (0, 0, FULL_TURN), (0, 0, 0))
        found = ask(PairQuestion.of(a, Body(b, motion=motion), 3.0), AT_ONCE)
        assert found.counts.image_tests > 0
        assert found.contact is not None
        bounds.append((found.contact.low, found.contact.high))

    assert bounds[0][0] <= 2.0 <= bounds[0][1]
    if exponent > -1060:  # where numbers lose digits, that is another question
        assert bounds[0] == bounds[1]
