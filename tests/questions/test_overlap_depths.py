"""Relations and depths of solids that touch or overlap, against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from asking.overlaps import DEPTHS, TURN, UNIT, assert_depths, assert_volume, overlap, refined
from meshes.solids import joined, shifted, turned_over
from movers.meshes import box, disc
from scenes.pairs import random_rotation


@pytest.mark.parametrize("pose", [None, TURN])
@pytest.mark.parametrize("times", [0, 2])
def test_beam_in_a_block_is_as_deep_at_any_tessellation(times, pose) -> None:
    beam = refined(box((-0.5, -0.5, -3), (0.5, 0.5, 1.5)), times)
    block = refined(box((-5, -5, 0), (5, 5, 5)), times)

    found = overlap(beam, block, pose)

    assert found.relation == "overlapping"
    assert_depths(found, 1.0, 1.5, 0.5)
    assert_volume(found, 1.5)


@pytest.mark.parametrize("pose", [None, TURN])
def test_slab_sunk_by_a_tenth_is_a_tenth_deep(pose) -> None:
    a, b = box((0, 0, 0), (100, 100, 10)), box((0, 0, 9.9), (100, 100, 20))

    found = overlap(a, b, pose)

    assert found.relation == "overlapping"
    assert_depths(found, 0.1, 0.1, 0.1)
    assert_volume(found, 1000.0, 1e-6)


def test_aligned_walls_overlap_although_no_vertex_is_inside() -> None:
    found = overlap(box((0, 0, 0), (3, 0.2, 2.5)), box((2.95, 0, 0), (6, 0.2, 2.5)))

    assert found.relation == "overlapping"
    assert_depths(found, 0.05, 0.05, 0.05)
    assert_volume(found, 0.025)


def test_bar_through_thin_sheet_is_no_touch_although_the_sheet_is_thin() -> None:
    sheet = box((-5, -5, 0), (5, 5, 0.05))
    bar = box((-0.5, -0.5, -2), (0.5, 0.5, 2))

    found = overlap(bar, sheet, touch=(0.1, 0.1))

    assert found.relation == "overlapping"
    assert_depths(found, 0.05, 0.025, 0.5)
    assert overlap(bar, sheet, touch=(0.6, 0.6)).relation == "touching"


@pytest.mark.parametrize("pose", [None, TURN])
def test_flush_faces_touch_and_have_no_depth(pose) -> None:
    found = overlap(UNIT, box((1, 0.25, 0.25), (2, 3, 3)), pose)

    assert found.relation == "touching"
    assert found.distance.bounds == (0, 0) or found.distance.bounds[0] <= found.band.gap
    for name in DEPTHS:
        assert getattr(found, name).bounds[1] <= found.band.overlap + found.band.slack
    assert not found.overlaps


@pytest.mark.parametrize("seed", range(40))
def test_flush_boxes_stored_in_single_precision_touch(seed) -> None:
    random = np.random.default_rng(seed)
    turn = random_rotation(seed)
    place = random.uniform(-50, 50, 3)
    x, y, z = random.uniform(1, 20, 3)
    a, b = box((0, 0, 0), (x, y, z)), box((x, -y / 3, z / 4), (2 * x, 2 * y, 2 * z))
    stored = [
        ((np.asarray(vertices) @ turn.T + place).astype(np.float32), faces)
        for vertices, faces in (a, b)
    ]

    found = overlap(*stored)

    assert found.relation == "touching"
    assert found.band.reason.endswith("(float32)")


def test_identical_solids_are_a_duplicate_and_as_thick_as_they_are() -> None:
    found = overlap(UNIT, UNIT, TURN)

    assert found.relation == "duplicate"
    assert_depths(found, 1.0, 0.0, 0.0)
    assert_volume(found, 1.0)


def test_same_solid_in_other_triangles_is_a_duplicate() -> None:
    assert overlap(UNIT, refined(UNIT, 2)).relation == "duplicate"
    assert overlap(refined(UNIT, 1), UNIT, TURN).relation == "duplicate"


def test_half_of_a_box_is_contained_in_it() -> None:
    whole, half = box((0, 0, 0), (2, 1, 1)), UNIT

    found, swapped = overlap(half, whole), overlap(whole, half)

    assert (found.relation, found.contained) == ("contained", "a")
    assert (swapped.relation, swapped.contained) == ("contained", "b")
    assert_depths(found, 1.0, 0.5, 0.0)
    assert_volume(found, 1.0)


def test_box_inside_a_box_is_contained_with_its_depths() -> None:
    found = overlap(UNIT, box((-1, -1, -1), (3, 3, 3)))

    assert (found.relation, found.contained) == ("contained", "a")
    assert_depths(found, 1.0, 2.0, 0.0)
    assert found.distance.bounds[0] <= 1 <= found.distance.bounds[1]


def test_body_that_sticks_out_of_one_that_it_lies_in_is_not_contained() -> None:
    inside = joined(shifted(UNIT, (1, 1, 1)), shifted(UNIT, (9, 9, 9)))

    found = overlap(inside, box((0, 1, 0), (4, 4, 4)))

    assert (found.relation, found.contained) == ("overlapping", None)


def test_plug_in_a_hollow_touches_its_walls() -> None:
    hollow = joined(box((-1, -1, -1), (2, 2, 2)), turned_over(UNIT))

    found = overlap(UNIT, hollow)

    assert found.relation == "touching"


def test_inward_turned_solid_is_as_deep_as_one_turned_outwards() -> None:
    a, b = UNIT, box((0.7, 0, 0), (2, 1, 1))

    for one, other in ((turned_over(a), b), (a, turned_over(b)), (turned_over(a), turned_over(b))):
        found = overlap(one, other)
        assert found.relation == "overlapping"
        assert_depths(found, 0.3, 0.3, 0.3)
        assert_volume(found, 0.3)


def washer(facets: int, inner: float, outer: float, low: float, high: float) -> Any:
    """Return a ring about z: four rings of corners, inner and outer, below and above."""
    angle = np.arange(facets) * (2 * np.pi / facets)
    circle = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    rings = [(inner, low), (outer, low), (outer, high), (inner, high)]
    vertices = np.concatenate([np.column_stack((r * circle, np.full(facets, z))) for r, z in rings])
    here, there = np.arange(facets), np.roll(np.arange(facets), -1)
    faces = []
    for k in range(4):
        i, j = k * facets, (k + 1) % 4 * facets
        faces += [(i + p, i + q, j + q) for p, q in zip(here, there, strict=True)]
        faces += [(i + p, j + q, j + p) for p, q in zip(here, there, strict=True)]
    return vertices, np.array(faces)


def pin_in_hole(pin_facets: int, hole_facets: int, pin_radius: float = 5.0) -> Any:
    pin = disc(pin_facets, pin_radius, -10.0, 10.0)
    plate = washer(hole_facets, 5.0, 12.0, -2.0, 2.0)
    return pin, plate


def test_pin_in_a_hole_of_its_radius_touches_by_its_chords() -> None:
    pin, plate = pin_in_hole(32, 48)
    chord = 5.0 * (1 - np.cos(np.pi / 48))

    found = overlap(pin, plate, touch=(0.011, 0.011))

    assert found.relation == "touching"
    assert_depths(found, 0.01068, chord, 0.010654)
    assert overlap(pin, plate).relation == "overlapping"


def test_pin_and_hole_of_the_same_facets_touch() -> None:
    assert overlap(*pin_in_hole(32, 32)).relation == "touching"


@pytest.mark.parametrize("pose", [None, TURN])
def test_swapped_bodies_have_the_same_bits(pose) -> None:
    pairs = [
        (UNIT, shifted(UNIT, (0.4, 0.3, 0.2))),
        (UNIT, box((0.25, -1, 0.25), (0.5, 4, 0.5))),
        pin_in_hole(12, 18),
        (refined(UNIT, 1), shifted(UNIT, (0.4, 0.3, 0.2))),
    ]
    for a, b in pairs:
        found, other = overlap(a, b, pose), overlap(b, a, pose)
        assert found.relation == other.relation
        assert found.thickness.bounds == other.thickness.bounds
        assert found.thickness.point == other.thickness.point
        assert found.thickness.triangle_a == other.thickness.triangle_b
        assert found.protrusion_a.bounds == other.protrusion_b.bounds
        assert found.protrusion_b.point == other.protrusion_a.point
        assert found.volume == other.volume
        assert found.band == other.band or "coordinates" in found.band.reason
