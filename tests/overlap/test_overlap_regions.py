"""The kernel behind `regions`: the parts of what two solids share, against voxels on a lattice."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes.solids import joined, shifted, turned_over
from meshes.surfaces import geodesic
from movers.meshes import box, cube, tube
from oracles.solid import winding_number
from scenes.pairs import random_rotation
from strategies.still import examples

from obbcli import Mesh, ObbTree, Pose, kernels

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Draw = Callable[..., Any]
    Voxel = tuple[int, int, int]


def query_of(a: Any, b: Any, resolution: float, pose: Pose | None = None, **options: Any) -> Any:
    """Return the question about two meshes, both placed by a pose, not yet begun."""
    trees = [ObbTree.build(Mesh(*mesh)) for mesh in (a, b)]
    place = (pose or Pose()).kernel
    first, second = trees[0].kernel, trees[1].kernel
    return kernels.OverlapRegions(first, place, second, place, resolution=resolution, **options)


def regions(*asked: Any, steps: int = 2**40, **options: Any) -> Any:
    """Return the question about two meshes when it is done."""
    query = query_of(*asked, **options)
    while not query.advance(steps):
        pass
    return query


def test_one_box_in_the_corner_of_another():
    query = regions(box((0, 0, 0), (1, 1, 1)), box((0.5, 0.25, 0.75), (2, 2, 2)), 0.2)

    ((low, high, point, thickness, _, _),) = query.regions
    assert np.allclose([low, high], [(0.5, 0.25, 0.75), (1, 1, 1)], atol=1e-9)
    assert thickness[0] <= 0.25 <= thickness[1] <= 0.25 * 1.02
    assert np.all((np.array(low) < point) & (point < np.array(high)))
    assert query.unproven == 0
    assert query.is_complete


@pytest.mark.parametrize("seed", range(3))
def test_teeth_are_told_apart_at_any_angle(seed):
    teeth = joined(*(box((2 * k, 0, 0), (2 * k + 1, 1, 1)) for k in range(4)))
    plate = box((-1, -1, 0.875), (9, 2, 2))
    pose = Pose(random_rotation(seed), [1, 2, 3])

    query = regions(teeth, plate, 0.25, pose)

    assert len(query.regions) == 4
    assert query.unproven == 0
    for _, _, point, (least, most), row, _ in query.regions:
        assert least <= 0.125 <= most
        back = np.linalg.solve(pose.rotation, np.array(point) - pose.translation)
        assert row // 12 == int(back[0] // 2)


def test_parts_nearer_than_the_resolution_may_be_one():
    teeth = joined(box((0, 0, 0), (1, 1, 1)), box((1.0625, 0, 0), (2, 1, 1)))
    plate = box((-1, -1, 0.875), (9, 2, 2))

    assert len(regions(teeth, plate, 4.0).regions) in (1, 2)
    assert len(regions(teeth, plate, 0.03).regions) == 2


def test_solids_that_only_touch_have_no_region():
    for other in (box((1, 0, 0), (2, 1, 1)), box((1, 1, 1), (2, 2, 2))):
        query = regions(box((0, 0, 0), (1, 1, 1)), other, 0.25)
        assert query.regions == []
        assert query.is_complete


def test_solids_apart_have_no_region_and_cost_nothing():
    query = regions(cube(), shifted(cube(), (5, 0, 0)), 0.25)

    assert query.regions == []
    assert query.unproven == query.cells == 0


def test_pin_in_its_hole_of_equal_facets_has_no_region():
    query = regions(tube(1.0, 2.0, 0.0, 1.0), box((-1, -1, 0.25), (1, 1, 3)), 0.25)

    assert query.regions == []


def test_solid_in_another_is_one_region():
    ((low, high, point, thickness, _, _),) = regions(cube(2.0), cube(0.5), 0.25).regions

    assert np.allclose([low, high], [(-0.5,) * 3, (0.5,) * 3], atol=1e-9)
    assert thickness[0] <= 1 <= thickness[1]
    assert np.abs(point).max() < 0.5


def test_ring_that_a_bar_passes_twice():
    ring, bar = tube(1.0, 2.0, -1.0, 1.0), box((-3, -0.25, -0.25), (3, 0.25, 0.25))

    query = regions(ring, bar, 0.2)

    assert len(query.regions) == 2
    assert [thickness[0] <= 0.5 <= thickness[1] for *_, thickness, _, _ in query.regions] == [
        True
    ] * 2


BLOCKS = st.lists(
    st.tuples(*[st.tuples(st.integers(0, 4), st.integers(1, 3))] * 3), min_size=1, max_size=4
)


def voxels(blocks: Any) -> set[Voxel]:
    """Return the unit voxels of a union of blocks."""
    return {
        (x, y, z)
        for (x0, dx), (y0, dy), (z0, dz) in blocks
        for x in range(x0, x0 + dx)
        for y in range(y0, y0 + dy)
        for z in range(z0, z0 + dz)
    }


def apart(blocks: Any) -> Any:
    """Return those blocks that share no voxel with one before: their union is a simple solid."""
    taken: set[Voxel] = set()
    kept = []
    for block in blocks:
        if not taken & voxels([block]):
            taken |= voxels([block])
            kept.append(block)
    return kept


def solid_of(blocks: Any) -> Any:
    """Return blocks as one mesh of several parts."""
    return joined(*(box([p for p, _ in b], [p + d for p, d in b]) for b in blocks))


def components(cells: set[Voxel], *, by_corners: bool) -> Iterator[set[Voxel]]:
    """Yield the parts of a set of voxels that hang together by faces, or by corners too."""
    steps = [
        (i, j, k)
        for i in (-1, 0, 1)
        for j in (-1, 0, 1)
        for k in (-1, 0, 1)
        if (by_corners or abs(i) + abs(j) + abs(k) == 1)
    ]
    left = set(cells)
    while left:
        part, waiting = set(), [left.pop()]
        while waiting:
            x, y, z = waiting.pop()
            part.add((x, y, z))
            near = {(x + i, y + j, z + k) for i, j, k in steps} & left
            left -= near
            waiting.extend(near)
        yield part


@examples(40)
@given(BLOCKS, BLOCKS)
def test_blocks_on_a_lattice_have_the_regions_that_voxels_have(blocks_a, blocks_b):
    blocks_a, blocks_b = apart(blocks_a), apart(blocks_b)
    a, b = solid_of(blocks_a), solid_of(blocks_b)
    shared = voxels(blocks_a) & voxels(blocks_b)

    query = regions(a, b, 0.4, tolerance=0.3)

    # Parts that touch in an edge or a corner may count as one or as two.
    fewest = list(components(shared, by_corners=True))
    most = list(components(shared, by_corners=False))
    assert query.is_complete
    assert len(fewest) <= len(query.regions) <= len(most)
    for low, high, point, (least, most_thick), _, _ in query.regions:
        assert 0 < least <= most_thick
        assert all(winding_number(point, *mesh) for mesh in (a, b))
        assert tuple(int(x // 1) for x in point) in shared
        corners = np.array([low, high])
        assert np.all((corners[0] < point) & (point < corners[1]))
    for part in fewest:
        held = [
            all(
                low[k] <= min(v[k] for v in part) and max(v[k] for v in part) + 1 <= high[k]
                for k in range(3)
            )
            for low, high, *_ in query.regions
        ]
        assert any(held) or len(query.regions) > len(fewest)


def test_hollow_parts_what_a_bar_fills():
    shell = joined(cube(2.0), turned_over(cube(1.0)))

    assert len(regions(shell, box((-3, -0.5, -0.5), (3, 0.5, 0.5)), 0.3).regions) == 2


def test_slices_make_no_difference():
    vertices, faces = geodesic(320)
    asked = (vertices, faces), (vertices + np.array([1.2, 0.3, 0.1]), faces), 0.2

    assert regions(*asked, steps=1).regions == regions(*asked).regions
    assert len(regions(*asked).regions) == 1


def test_limit_leaves_larger_boxes_that_still_hold_all():
    a, b = box((0, 0, 0), (1, 1, 1)), box((0.5, 0.25, 0.75), (2, 2, 2))

    query = regions(a, b, 1e-3, Pose(random_rotation(2), [0, 0, 0]), max_cells=40)

    assert not query.is_complete
    assert len(query.regions) == 1
    ((low, high, *_),) = query.regions
    truth = Pose(random_rotation(2), [0, 0, 0]).apply(
        np.array(np.meshgrid([0.5, 1], [0.25, 1], [0.75, 1])).reshape(3, -1).T
    )
    assert np.all((low <= truth.min(axis=0)) & (truth.max(axis=0) <= high))


@pytest.mark.parametrize("resolution", [0.0, -1.0, float("nan"), float("inf")])
def test_resolution_that_is_none_is_refused(resolution):
    with pytest.raises(ValueError, match="positive"):
        query_of(cube(), cube(), resolution)
