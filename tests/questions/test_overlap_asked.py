"""What is asked of an overlap: decisions, limits, solids that overlap themselves, scales."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from asking.overlaps import TURN, UNIT, assert_depths, overlap, refined
from meshes.solids import joined, shifted
from movers.meshes import box

from obbcli import Accuracy


def test_point_of_the_thickness_is_that_deep() -> None:
    found = overlap(UNIT, box((0.25, -1, 0.25), (0.5, 4, 0.5)))

    x, _, z = found.thickness.point
    radius = found.thickness.bounds[0] / 2
    assert min(x - 0.25, 0.5 - x, z - 0.25, 0.5 - z) >= radius * (1 - 1e-12)


@pytest.mark.parametrize(
    ("limit", "deeper", "by"),
    [
        (0.02, True, "thickness"),
        (0.05, False, None),
        (0.2, False, None),
    ],
)
def test_deeper_than_asks_no_values(limit, deeper, by) -> None:
    walls = box((0, 0, 0), (3, 0.2, 2.5)), box((2.95, 0, 0), (6, 0.2, 2.5))

    found = overlap(*walls, deeper_than=limit)

    assert (found.deeper, found.by) == (deeper, by)
    assert found.relation == "overlapping"
    assert found.volume is None


def test_deeper_than_is_told_by_a_protrusion_where_the_overlap_is_thin() -> None:
    bar, sheet = box((-0.5, -0.5, -2), (0.5, 0.5, 2)), box((-5, -5, 0), (5, 5, 0.05))

    assert overlap(bar, sheet, deeper_than=0.2).by == "protrusion_b"
    assert overlap(sheet, bar, deeper_than=0.2).by == "protrusion_a"
    assert overlap(bar, sheet, deeper_than=0.6).deeper is False


def test_bodies_apart_are_not_deeper() -> None:
    assert overlap(UNIT, shifted(UNIT, (3, 0, 0)), deeper_than=0.0).deeper is False


def test_limits_leave_brackets_that_hold_and_narrow() -> None:
    a, b = refined(UNIT, 1), shifted(refined(UNIT, 1), (0.6, 0.55, 0.5))
    widths = []
    for limit in (30, 300, 3000, 1_000_000):
        found = overlap(a, b, TURN, accuracy=Accuracy(max_iterations=limit), tolerance=1e-4)
        if found.thickness is None or found.thickness.bounds[1] is None:
            assert not found.complete
            continue
        low, high = found.thickness.bounds
        assert low <= 0.4 + 1e-12
        assert high >= 0.4 - 1e-12
        widths.append(high - low)
    assert found.complete
    assert all(after <= before for before, after in pairwise(widths))


def test_solid_that_overlaps_itself_has_lower_ends_and_a_reason() -> None:
    double = joined(UNIT, shifted(UNIT, (0.75, 0, 0)))
    block = box((-1, -1, -1), (3, 2, 2))

    found = overlap(double, block)

    assert found.relation == "contained"
    assert found.thickness.bounds[1] is None
    assert 0.5 < found.thickness.bounds[0] <= 1.0
    assert found.reason.startswith("A overlaps itself")
    low, high = found.volume.bounds
    assert low <= 1.75 <= high


def test_solid_that_overlaps_itself_out_of_reach_has_all_ends() -> None:
    double = joined(box((-3, 0, 0), (0, 1, 1)), box((-4, 0, 0), (-2.5, 1, 1)))

    found = overlap(double, box((-0.5, 0, 0), (1, 1, 1)))

    assert found.relation == "overlapping"
    assert_depths(found, 0.5, 0.5, 0.5)
    assert found.reason is None


def test_protrusion_alone_is_open_where_a_surface_within_hides_it() -> None:
    """B's face at -0.5 is 0.5 deep in A, and 0.25 away from A's face at -0.75, inside A."""
    double = joined(box((-1, 0, 0), (0, 1, 1)), box((-1.75, 0, 0), (-0.75, 1, 1)))

    found = overlap(double, box((-0.5, 0, 0), (1, 1, 1)))

    assert found.relation == "overlapping"
    assert found.thickness.bounds[1] == pytest.approx(0.5, rel=0.02)
    assert found.protrusion_b.bounds[1] is None
    assert found.reason.startswith("A overlaps itself")


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_tiny_and_huge_bodies_are_as_deep_in_their_unit(scale) -> None:
    a, b = UNIT, shifted(UNIT, (0.7, 0, 0))
    scaled = [(np.asarray(vertices) * scale, faces) for vertices, faces in (a, b)]

    found = overlap(*scaled)

    assert found.relation == "overlapping"
    low, high = found.thickness.bounds
    assert low <= 0.3 * scale * (1 + 1e-12)
    assert high >= 0.3 * scale * (1 - 1e-12)
    assert high - low <= 0.01 * high


def test_bodies_far_from_the_origin_are_judged_by_their_coordinates() -> None:
    far = shifted(UNIT, (1e9, 0, 0)), shifted(UNIT, (1e9 + 1 - 2e-7, 0, 0))

    found = overlap(*far)

    assert found.relation == "touching"
    assert overlap(*far, touch=(0, 0)).relation == "overlapping"
