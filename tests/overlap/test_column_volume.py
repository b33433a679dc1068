"""The kernel behind `volume`: what two solids have in common, by columns, against exact sums."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes.solids import joined, shifted, turned_over
from meshes.surfaces import geodesic
from movers.meshes import box, cube, octahedron, star, tetrahedron, tube
from oracles.volume import shared_volume, signed_volume
from scenes.pairs import QUARTER_TURN_X, THIRD_TURN, random_rotation
from strategies.still import examples

from obbcli import Mesh, ObbTree, Pose, kernels

if TYPE_CHECKING:
    from collections.abc import Callable

    Draw = Callable[..., Any]

SOLIDS = {"cube": cube, "octahedron": octahedron, "star": star, "tetrahedron": tetrahedron}


class Found(NamedTuple):
    """What a query said when it was done."""

    low: float
    high: float
    centroid: Any
    error: Any


def query_of(a: Any, b: Any, poses: Any = None, **options: Any) -> kernels.ColumnVolume:
    """Return the question about two meshes, not yet begun."""
    trees = [ObbTree.build(Mesh(*mesh), **options) for mesh in (a, b)]
    first, second = (Pose(), Pose()) if poses is None else poses
    return kernels.ColumnVolume(trees[0].kernel, first.kernel, trees[1].kernel, second.kernel)


def volume(a: Any, b: Any, poses: Any = None, steps: int = 2**40, **options: Any) -> Found:
    """Return the volume that two meshes have in common."""
    query = query_of(a, b, poses, **options)
    while not query.advance(steps):
        pass
    return Found(*query.bounds, query.centroid, query.error)


def holds(bracket: Any, truth: Any, width: float) -> bool:
    """Return whether a bracket holds a rational number and is no wider than that."""
    low, high = bracket[:2]
    return Fraction(low) <= Fraction(truth) <= Fraction(high) and high - low <= width


@pytest.mark.parametrize("corner", range(8))
def test_boxes_that_share_a_corner(corner):
    low = np.array([0.75 if corner >> k & 1 else -0.625 for k in range(3)])

    found = volume(box((0, 0, 0), (1, 1, 1)), box(low, low + 1))

    assert holds(found, math.prod(0.25 if x > 0 else 0.375 for x in low), 1e-12)
    assert math.dist(found.centroid, [0.875 if x > 0 else 0.1875 for x in low]) <= found.error
    assert found.error <= 1e-10


@pytest.mark.parametrize("thickness", [2.0**-10, 2.0**-30, 2.0**-43])
def test_slab_of_any_thickness_keeps_its_digits(thickness):
    low, high = box((0, 0, 0), (128, 128, 1)), box((0, 0, 1 - thickness), (128, 128, 2))

    assert holds(volume(low, high), 2**14 * thickness, 1e-9 * 2**14 * thickness)


@pytest.mark.parametrize("axis", range(3))
def test_flush_faces_have_no_volume(axis):
    unit = box((0, 0, 0), (1, 1, 1))

    assert volume(unit, shifted(unit, np.eye(3)[axis])) == (0.0, 0.0, None, None)


@pytest.mark.parametrize("name", SOLIDS)
def test_solid_shares_all_of_it_with_itself(name):
    mesh = SOLIDS[name]()
    truth = abs(signed_volume(mesh))

    assert holds(volume(mesh, mesh), truth, 1e-10 * truth)


@pytest.mark.parametrize("turned", [(True, False), (False, True), (True, True)])
def test_solid_turned_inward_counts_as_turned_outward(turned):
    a, b = cube(), shifted(octahedron(), (0.5, 0.25, 0))
    truth = shared_volume(a, b)

    meshes = [turned_over(m) if over else m for m, over in zip((a, b), turned, strict=True)]

    assert holds(volume(*meshes), truth, 1e-10)


def test_hollow_takes_its_volume_away():
    block = joined(cube(2.0), turned_over(cube(1.0)))

    assert holds(volume(block, box((0, 0, 0), (4, 4, 4))), 7, 1e-10)
    assert volume(block, cube(0.5)).high <= 1e-10


def test_several_parts_add_up():
    parts = joined(cube(0.5), shifted(cube(0.5), (2, 0, 0)), shifted(cube(0.5), (4, 0, 0)))

    assert holds(volume(parts, box((0, -1, -1), (4, 1, 1))), 2, 1e-10)


def test_part_that_winds_twice_counts_twice():
    doubled = joined(cube(1.0), shifted(cube(1.0), (1, 0, 0)))

    assert holds(volume(doubled, cube(4.0)), 16, 1e-9)


def test_pin_in_its_hole_of_equal_facets_has_no_volume():
    hole = tube(1.0, 2.0, 0.0, 1.0)
    pin = box((-1, -1, 0.25), (1, 1, 3))

    assert volume(hole, pin).high <= 1e-10
    assert holds(volume(hole, box((-1.5, -1, 0.25), (1, 1, 3))), 0.75, 1e-10)


@pytest.mark.parametrize("seed", range(4))
def test_places_far_from_the_origin_keep_what_their_doubles_have(seed):
    offset = np.array([1e6, -3e6, 2e6]) + np.random.default_rng(seed).random(3)
    a, b = shifted(cube(0.5), offset), shifted(octahedron(), offset + 0.3)

    assert holds(volume(a, b), shared_volume(a, b), 1e-10)


@st.composite
def lattice_solids(draw: Draw) -> Any:
    """Return a box or a tetrahedron on a small grid, faces often in the planes of others."""
    low = draw(st.tuples(*[st.integers(-2, 1)] * 3))
    if draw(st.booleans()):
        return box(low, [x + draw(st.integers(1, 3)) for x in low])
    corners = np.array(draw(st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=4, max_size=4)))
    return corners.astype(float), np.array([(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)])


@examples(150)
@given(lattice_solids(), lattice_solids(), st.sampled_from([-300, -3, 0, 40, 300]))
def test_solids_on_a_grid_agree_with_exact_sums(a, b, exponent):
    truth = abs(shared_volume(a, b))

    scaled = [(np.ldexp(vertices, exponent), faces) for vertices, faces in (a, b)]
    found = volume(*scaled)

    unit = math.ldexp(1.0, 3 * exponent)
    assert holds(found, truth * Fraction(2) ** (3 * exponent), 1e-9 * unit)


@pytest.mark.parametrize("exponent", [-400, 400])
def test_volume_beyond_the_doubles_is_still_bounded(exponent):
    unit = np.ldexp(cube()[0], exponent), cube()[1]

    low, high, _, _ = volume(unit, unit)

    assert (low == 0 and 0 < high < 1e-300) if exponent < 0 else (low > 1e300 and high == math.inf)


@examples(60)
@given(lattice_solids(), lattice_solids(), st.integers(0, 10**6))
def test_posed_solids_agree_with_exact_sums_of_their_rounded_vertices(a, b, seed):
    rng = np.random.default_rng(seed)
    poses = [Pose(random_rotation(seed + k), rng.normal(size=3)) for k in range(2)]
    placed = [(pose.apply(np.asarray(m[0])), m[1]) for pose, m in zip(poses, (a, b), strict=True)]

    found = volume(a, b, poses)

    assert holds(found, abs(shared_volume(*placed)), 1e-9)


@examples(60)
@given(lattice_solids(), lattice_solids(), st.integers(0, 10**6))
def test_three_axes_and_both_orders(a, b, seed):
    poses = [Pose(random_rotation(seed), [0.5, 0, 0]), Pose(random_rotation(seed + 1), [0, 0.1, 0])]
    turns = (np.eye(3), THIRD_TURN, np.asarray(THIRD_TURN) @ THIRD_TURN, QUARTER_TURN_X)

    found = [
        volume(a, b, [Pose(turn @ p.rotation, turn @ p.translation) for p in poses])
        for turn in turns
    ]

    assert max(f.low for f in found) <= min(f.high for f in found)
    assert volume(b, a, poses[::-1]) == found[0]


def test_bits_depend_on_neither_slices_nor_trees():
    vertices, faces = geodesic(320)
    a, b = (vertices, faces), (vertices * 0.9 + 0.3, faces)
    poses = [Pose(random_rotation(1), [0, 0, 0.1]), Pose()]

    found = volume(a, b, poses)

    assert volume(a, b, poses, steps=1) == found
    for options in ({"lazy": True}, {"lazy": False}, {"leaf_size": 5}, {"leaf_size": 1000}):
        assert volume(a, b, poses, **options) == found
    assert found.low > 0


def test_bounds_hold_at_every_moment():
    vertices, faces = geodesic(320)
    query = query_of((vertices, faces), (vertices + 0.5, faces))
    whole = volume((vertices, faces), (vertices + 0.5, faces))

    seen = [query.bounds]
    while not query.advance(7):
        assert query.centroid is None
        seen.append(query.bounds)

    assert len(seen) > 3
    assert all(low <= whole.low and whole.high <= high for low, high in seen)
    assert query.bounds == whole[:2]


def test_coordinates_that_leave_the_doubles_are_refused():
    huge = (np.asarray(cube()[0]) * 1e308, cube()[1])

    with pytest.raises(ValueError, match="range of double"):
        query_of(huge, huge, [Pose(QUARTER_TURN_X, [1e308, 0, 0]), Pose()])


def test_threads_that_share_growing_trees_find_the_same():
    vertices, faces = geodesic(1280)
    pose = Pose(random_rotation(5), [0.3, 0.1, 0])
    whole = volume((vertices, faces), (vertices, faces), [Pose(), pose], lazy=False)

    for _ in range(5):
        trees = [ObbTree.build(Mesh(vertices, faces), lazy=True) for _ in range(2)]

        def ask(_: int, trees: Any = trees) -> Any:
            bodies = trees[0].kernel, Pose().kernel, trees[1].kernel, pose.kernel
            query = kernels.ColumnVolume(*bodies)
            while not query.advance(50):
                pass
            return query.bounds

        with ThreadPoolExecutor(4) as pool:
            assert set(pool.map(ask, range(4))) == {whole[:2]}


def test_lazy_tree_opens_only_what_the_window_needs():
    vertices, faces = geodesic(20_480)
    tree = ObbTree.build(Mesh(vertices, faces), lazy=True)
    other = ObbTree.build(Mesh(*cube(0.5)))
    place = Pose(translation=[1.3, 0, 0])

    query = kernels.ColumnVolume(tree.kernel, Pose().kernel, other.kernel, place.kernel)
    while not query.advance(2**40):
        pass

    assert query.bounds[0] > 0
    assert tree.node_count < 0.5 * 20_479
