"""`overlap(regions=...)`: the parts of what both share as answers tell them."""

from __future__ import annotations

import numpy as np
import pytest
from meshes.solids import joined, shifted
from movers.meshes import box, cube

from obbcli import Accuracy, Body, Mesh, MotionError, Pose, overlap

TEETH = Mesh(*joined(*(box((2 * k, 0, 0), (2 * k + 1, 1, 1)) for k in range(3))))
PLATE = Mesh(*box((-1, -1, 0.75), (7, 2, 2)))


def test_regions_are_told_where_they_are_asked_for():
    answer = overlap(TEETH, PLATE, regions=0.5)

    assert overlap(TEETH, PLATE).regions is None
    assert answer.resolution == 0.5
    assert answer.unproven == 0
    assert len(answer.regions) == 3
    for region in answer.regions:
        (low, high), point = np.array(region.bounds), np.array(region.point)
        assert np.all((low < point) & (point < high))
        assert region.thickness[0] <= 0.25 <= region.thickness[1]
        assert region.triangle_a // 12 == int(point[0] // 2)
        assert np.allclose(high - low, (1, 1, 0.25), atol=1e-9)


def test_default_resolution_suits_the_bodies():
    answer = overlap(TEETH, PLATE, regions=True)

    # A fiftieth of the diagonal of the box that both have in common: 5 by 1 by 0.25.
    assert answer.resolution == pytest.approx(0.02 * np.linalg.norm([5, 1, 0.25]))
    assert len(answer.regions) == 3


@pytest.mark.parametrize("scale", [1e307, 1e-300, 2.0**-1040])
def test_default_resolution_suits_bodies_of_any_size(scale):
    first = Mesh(scale * np.asarray(cube(0.5)[0]), cube(0.5)[1])

    answer = overlap(first, Body(first, Pose(translation=[0.5 * scale, 0, 0])), regions=True)

    (region,) = answer.regions
    assert 0 < answer.resolution < scale
    assert region.thickness[0] <= 0.5 * scale <= region.thickness[1]


def test_swapped_bodies_have_the_same_regions():
    found, swapped = overlap(TEETH, PLATE, regions=0.4), overlap(PLATE, TEETH, regions=0.4)

    assert [(r.bounds, r.point, r.thickness, r.triangle_a) for r in found.regions] == [
        (r.bounds, r.point, r.thickness, r.triangle_b) for r in swapped.regions
    ]


def test_bodies_apart_and_flush_and_open_have_none():
    flush = Mesh(*shifted(cube(0.5), (1, 0, 0)))
    unit = Mesh(*cube(0.5))

    for other in (flush, Body(unit, Pose(translation=[5, 0, 0]))):
        answer = overlap(unit, other, regions=True)
        assert answer.regions == ()
    opened = Mesh(unit.vertices, unit.triangles[:-1])
    assert overlap(opened, unit, regions=True).regions is None


def test_limit_leaves_regions_unknown():
    answer = overlap(TEETH, PLATE, Accuracy(max_iterations=1), regions=0.01)

    assert answer.regions is None
    assert not answer.complete


@pytest.mark.parametrize("regions", [0.0, -1.0, float("nan"), "fine"])
def test_resolution_that_is_none_is_refused(regions):
    with pytest.raises(MotionError, match="regions"):
        overlap(TEETH, PLATE, regions=regions)
