"""The kernels behind `solid`: points in closed surfaces against exact rays, and connected parts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes.solids import joined, turned_over
from meshes.surfaces import blob, sphere, torus
from movers.meshes import angle_bar, box, cube, octahedron, star, tetrahedron, tube
from oracles.mesh import posed
from oracles.solid import winding_by_angles, winding_number
from scenes.pairs import QUARTER_TURN_X, THIRD_TURN, random_rotation
from strategies.still import SCALES, examples

from obbcli import Mesh, ObbTree, Pose, kernels

if TYPE_CHECKING:
    from collections.abc import Callable

    Draw = Callable[..., Any]

CORNERS = st.tuples(*[st.integers(-3, 3)] * 3)
TETRAHEDRON = ((0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2))


def finish(query: kernels.ContainmentQuery) -> None:
    """Ask until the answer is known: slices end by the clock as well."""
    while not query.advance(2**62):
        pass


def inside(vertices: Any, faces: Any, point: Any, pose: Any = None, **options: Any) -> bool:
    """Return whether the kernels find a point inside a surface."""
    tree = ObbTree.build(Mesh(vertices, faces), **options)
    place = Pose() if pose is None else pose
    points = np.array([point], dtype=np.float64)
    query = kernels.ContainmentQuery(tree.kernel, place.kernel, points)
    finish(query)
    return query.inside is not None


@st.composite
def closed_soups(draw: Draw) -> Any:
    """Return tetrahedra on a small grid, turned either way: overlapping, flat, with equal edges."""
    corners = draw(st.lists(st.tuples(*[CORNERS] * 4), min_size=1, max_size=4))
    vertices = np.array(corners, dtype=np.float64).reshape(-1, 3)
    faces = np.array(TETRAHEDRON) + 4 * np.arange(len(corners))[:, None, None]
    return vertices, faces.reshape(-1, 3)


@examples(600)
@given(closed_soups(), CORNERS, SCALES)
def test_point_on_the_grid_is_inside_where_surfaces_wind_about_it(soup, point, exponent):
    # The ray passes through corners and along edges and faces of what stands above the point.
    vertices, faces = soup
    winding = winding_number(point, vertices, faces)
    scaled = np.ldexp(vertices, exponent)

    if winding is not None:
        found = inside(scaled, faces, np.ldexp(np.array(point, dtype=np.float64), exponent))

        assert found == (winding != 0)


@examples(300)
@given(closed_soups(), CORNERS, st.sampled_from([QUARTER_TURN_X, THIRD_TURN]), CORNERS)
def test_posed_surface_holds_the_same_points(soup, point, rotation, shift):
    vertices, faces = soup
    winding = winding_number(point, vertices, faces)

    if winding is not None:
        place = posed([point], rotation, shift)[0]
        pose = Pose(rotation, shift)

        assert inside(vertices, faces, place, pose) == (winding != 0)


@examples(800)
@given(
    st.data(),
    st.integers(0, 10**6),
    st.sampled_from([(0, 1), (1, 1), (1e6, 1), (1e13, 1), (1, 1e9)]),
)
def test_point_a_few_ulps_from_a_face_or_the_outline_is_decided_exactly(data, seed, sizes):
    random = np.random.default_rng(seed)
    vertices = random.normal(size=(4, 3)) + sizes[0]
    rotation = random_rotation(seed)
    shift = random.normal(size=3) * sizes[1]
    world = posed(vertices, rotation, shift)
    face = data.draw(st.sampled_from(TETRAHEDRON))
    on_edge = data.draw(st.booleans())
    weights = [*random.dirichlet((1, 1)), 0.0] if on_edge else random.dirichlet((1, 1, 1))
    point = np.array(weights) @ world[list(face)]
    if on_edge:
        # Far below the edge, or within: the ray passes by it.
        point[2] -= data.draw(st.sampled_from([0.0, 0.125, 4.0]))
    ulps = data.draw(st.tuples(*[st.integers(-3, 3)] * 3))
    point = point + np.array(ulps) * np.spacing(np.abs(point))
    winding = winding_number(point, world, TETRAHEDRON)

    if winding is not None:
        found = inside(vertices, TETRAHEDRON, point, Pose(rotation, shift))

        assert found == (winding != 0)


@pytest.mark.parametrize("options", [{}, {"leaf_size": 5}, {"max_depth": 0}, {"split": "center"}])
def test_boxes_rule_out_no_triangle_that_a_ray_meets(options):
    surface = blob(320, 5)
    rotation, shift = random_rotation(7), np.array([10.0, -20.0, 5.0])
    world = posed(surface.vertices, rotation, shift)
    tree = ObbTree.build(Mesh(surface.vertices, surface.faces), **options)
    points = np.random.default_rng(8).uniform(-1.4, 1.4, (60, 3)) + shift
    pose = Pose(rotation, shift)

    verdicts = []
    for point in points:
        query = kernels.ContainmentQuery(tree.kernel, pose.kernel, point[None])
        finish(query)
        verdicts.append(query.inside is not None)

    expected = [winding_number(point, world, surface.faces) != 0 for point in points]
    assert verdicts == expected
    assert 10 < sum(expected) < 50


@pytest.mark.parametrize(
    "mesh",
    [cube(), tetrahedron(), octahedron(), angle_bar(), star(), tube(1, 2, -1, 1),
     joined(cube(2), turned_over(cube(1))), joined(cube(2), cube(1.5))],
)  # fmt: skip
def test_rays_and_solid_angles_agree_on_winding_numbers(mesh):
    for point in np.random.default_rng(9).uniform(-2, 2, (10, 3)):
        winding = winding_number(point, *mesh)

        assert winding is not None
        assert abs(winding - winding_by_angles(point, *mesh)) < 1e-9
        assert inside(*mesh, point) == (winding != 0)


def test_oracle_knows_points_on_the_surface():
    assert winding_number((1, 0.5, 0.5), *cube()) is None
    assert winding_number((1, 1, 0.5), *cube()) is None
    assert winding_number((1, 1, 1), *cube()) is None
    assert winding_number((1, 2, 1), *cube()) == 0
    assert winding_number((0, 0, 0), *cube()) == 1
    assert winding_number((0, 0, 0), *turned_over(cube())) == -1


def test_first_point_inside_is_found():
    tree = ObbTree.build(Mesh(*cube()))
    points = np.array([[2.0, 0, 0], [0, 0, -1.5], [0, 0, 0.5], [0, 0, 0]])

    query = kernels.ContainmentQuery(tree.kernel, Pose().kernel, points)

    finish(query)
    assert query.inside == 2


def test_no_points_are_nowhere():
    tree = ObbTree.build(Mesh(*cube()))

    query = kernels.ContainmentQuery(tree.kernel, Pose().kernel, np.empty((0, 3)))

    assert query.advance(1)
    assert query.inside is None


@pytest.mark.parametrize("options", [{}, {"max_depth": 0}])
def test_one_pop_at_a_time_gives_the_same(options):
    surface = sphere(1280)
    tree = ObbTree.build(Mesh(surface.vertices, surface.faces), **options)
    points = np.array([[0.0, 0, -2], [0, 0, -0.5]])
    query = kernels.ContainmentQuery(tree.kernel, Pose().kernel, points)
    whole = kernels.ContainmentQuery(tree.kernel, Pose().kernel, points)

    steps = 1
    while not query.advance(1):
        steps += 1

    finish(whole)
    assert query.inside == whole.inside == 1
    assert query.counts() == whole.counts()
    assert query.counts()[3] == steps > 20


def test_points_far_outside_cost_one_box_each():
    surface = torus(5000, 0.25)
    tree = ObbTree.build(Mesh(surface.vertices, surface.faces))
    points = np.array([[5.0, 0, 0], [0, -5, 0], [0, 0, 5], [1e300, 0, 0], [0, 0, 1e300]])

    query = kernels.ContainmentQuery(tree.kernel, Pose().kernel, points)

    finish(query)
    assert query.counts() == (5, 0, 0, 5, 0)


@pytest.mark.parametrize("scale", [1e-300, 1e-12, 1.0, 1e12, 1e300])
def test_surfaces_of_any_size_hold_their_middle(scale):
    vertices, faces = cube(scale)

    assert inside(vertices, faces, (0, 0, 0))
    assert inside(vertices, faces, (0, 0, np.nextafter(-scale, 0)))
    assert not inside(vertices, faces, (0, 0, np.nextafter(-scale, -np.inf)))
    assert not inside(vertices, faces, (np.nextafter(scale, np.inf), 0, -scale))


def test_size_and_place_of_any_two_magnitudes_mix():
    tiny = box((1, 1, 1), (1 + 2**-52,) * 3)
    huge = cube(1e307)

    assert inside(*huge, (5e-324, 0, 0))
    assert not inside(*tiny, (1 + 2**-52, 1, 1 - 2**-53))
    assert inside(*cube(5e-324), (0, 0, 0))


def soup_parts(corners: list[list[int]]) -> list[int]:
    """Return the first triangle of each part, by merging sets."""
    parts: list[tuple[int, set[int]]] = []
    for row, corner in enumerate(corners):
        touched = [part for part in parts if part[1] & set(corner)]
        first = min([row, *(part[0] for part in touched)])
        merged = set(corner).union(*(part[1] for part in touched))
        parts = [part for part in parts if part not in touched] + [(first, merged)]
    return sorted(part[0] for part in parts)


@examples(300)
@given(st.lists(st.tuples(*[st.integers(0, 30)] * 3), min_size=1, max_size=20))
def test_parts_are_those_that_share_no_corner(corners):
    array = np.array(corners, dtype=np.int64)

    assert kernels.first_triangles_of_parts(array, 31).tolist() == soup_parts(array.tolist())


@pytest.mark.parametrize("bad", [-1, 4])
def test_parts_refuse_corners_out_of_range(bad):
    with pytest.raises(ValueError, match="a corner has no position"):
        kernels.first_triangles_of_parts(np.array([[0, 1, bad]]), 4)
