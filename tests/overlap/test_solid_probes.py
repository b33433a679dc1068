"""What one surface answers about points, boxes and cells, against exact rational arithmetic."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from oracles.distance import point_triangle_distance_squared
from oracles.exact import Box
from oracles.mesh import posed
from oracles.solid import winding_number
from oracles.still import triangle_box_separation
from overlap.solids import SOLIDS, hard_points
from scenes.pairs import random_rotation

from obbcli import Mesh, ObbTree, Pose, kernels

PLACES = {
    "here": (np.eye(3), np.zeros(3)),
    "turned": (random_rotation(3), np.array([0.3, -0.2, 0.7])),
    "far": (random_rotation(5), np.array([3e5, 1e6, -2e6])),
}
UNITS = (0, -40, 300, -1060)
EVERYTHING = 10**6


class Probed:
    """A solid of the kernels, and the same as plain arrays of the world and of the frame."""

    def __init__(self, name: str, place: str, exponent: int = 0, **options: Any) -> None:
        vertices, self.faces = SOLIDS[name]
        vertices = np.ldexp(np.asarray(vertices, dtype=np.float64), exponent)
        rotation, shift = PLACES[place][0], np.ldexp(PLACES[place][1], exponent)
        self.vertices = vertices if place == "here" else posed(vertices, rotation, shift)
        pose = Pose() if place == "here" else Pose(rotation, shift)
        self.tree = ObbTree.build(Mesh(vertices, self.faces), **options)
        self.probe = kernels.SolidProbe(self.tree.kernel, pose.kernel)
        self.origin, self.exponent = np.array(self.probe.frame[0]), self.probe.frame[1]
        self.triangles = self.vertices[self.faces]
        self.framed = [[self.exactly_framed(corner) for corner in t] for t in self.triangles]

    def exactly_framed(self, world: Any) -> list[Fraction]:
        """Return a point of the world in the frame, without rounding."""
        unit = Fraction(2) ** -self.exponent
        return [
            Fraction(x) * unit - Fraction(o)
            for x, o in zip(world.tolist(), self.origin.tolist(), strict=True)
        ]

    def framed_doubles(self) -> Any:
        return np.array([[[float(x) for x in c] for c in t] for t in self.framed])

    def world(self, place: Any) -> Any:
        return np.ldexp(np.asarray(place) + self.origin, self.exponent)

    def least_square(self, point: Any) -> Fraction:
        exact = [Fraction(x) for x in np.asarray(point).tolist()]
        return min(point_triangle_distance_squared(exact, t) for t in self.framed)


def random_of(*words: Any) -> np.random.Generator:
    return np.random.default_rng(list(" ".join(map(str, words)).encode()))


def shorter(name: str) -> int:
    return 3 if len(SOLIDS[name][1]) > 40 else 8


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", SOLIDS)
def test_nearest_triangle_has_proven_and_tight_bounds(name: str, place: str) -> None:
    solid = Probed(name, place)
    random = random_of(name, place)

    for point in hard_points(solid.framed_doubles(), random, shorter(name)):
        slack = float(random.choice([0, 1e-3, 0.1]))
        low, high, triangle, foot = solid.probe.nearest(tuple(point), slack, 0.0)
        exact = solid.least_square(point)

        assert Fraction(low) ** 2 <= exact <= Fraction(high) ** 2
        # A needle 1e-9 thick has no direction that is known well enough to tell it from a line.
        assert low >= high * (1 - slack) - (1e-8 if name == "needle" else 1e-13)
        reached = [Fraction(x) for x in point.tolist()]
        of_it = point_triangle_distance_squared(reached, solid.framed[triangle])
        assert of_it <= Fraction(high) ** 2
        assert np.linalg.norm(np.array(foot) - point) <= high + 1e-15


@pytest.mark.parametrize("exponent", UNITS)
def test_unit_changes_no_bound_in_the_frame(exponent: int) -> None:
    one, other = Probed("bar", "turned"), Probed("bar", "turned", exponent)

    for point in hard_points(one.framed_doubles(), random_of(exponent), 20):
        if exponent > -1000:
            found = other.probe.nearest(tuple(point), 0.0, 0.0)
            assert found == one.probe.nearest(tuple(point), 0.0, 0.0)
        else:  # subnormal coordinates have lost their last digits
            low, high, *_ = other.probe.nearest(tuple(point), 0.0, 0.0)
            assert Fraction(low) ** 2 <= other.least_square(point) <= Fraction(high) ** 2


def test_search_ends_where_the_surface_is_near_enough() -> None:
    solid = Probed("ball", "here")

    low, high, *_ = solid.probe.nearest((0.0, 0.0, 0.0), 0.0, 10.0)

    assert (low, solid.probe.nearest((0.0, 0.0, 0.0), 0.0, 0.1)[0] > 0) == (0, True)
    assert solid.least_square(np.zeros(3)) <= Fraction(high) ** 2


@pytest.mark.parametrize("leaf_size", [1, 3, 64])
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", SOLIDS)
def test_winding_number_is_exact(name: str, place: str, leaf_size: int) -> None:
    solid = Probed(name, place, leaf_size=leaf_size)
    on_grid = np.unique(solid.vertices, axis=0)[:3]
    points = hard_points(solid.triangles, random_of(name, place, leaf_size), shorter(name))

    for point in np.concatenate([points, on_grid, 0.5 * (on_grid[:1] + on_grid[1:])]):
        wanted = winding_number(point, solid.vertices, solid.faces)

        assert solid.probe.winding(tuple(point)) == wanted


def boxes(solid: Probed, random: np.random.Generator, count: int) -> Any:
    """Yield boxes of any size and shape near a solid: centre, axes, half extents."""
    for point in hard_points(solid.framed_doubles(), random, count):
        axes = np.eye(3) if random.random() < 0.3 else random_rotation(int(random.integers(2**31)))
        yield point, axes, 0.7 * 10.0 ** random.uniform(-9, 0, 3)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", SOLIDS)
def test_triangles_in_a_box_miss_none(name: str, place: str) -> None:
    solid = Probed(name, place)
    random = random_of(name, place)
    near = Fraction(2) ** -30

    for center, axes, half in boxes(solid, random, shorter(name)):
        rows = [tuple(row) for row in (center, *axes, half)]
        is_all, found = solid.probe.triangles_in_box(rows, 0.0, EVERYTHING)
        gaps = [triangle_box_separation(t, Box(center, axes, half)) for t in solid.framed]
        assert is_all
        assert len(set(found)) == len(found)
        assert {k for k, gap in enumerate(gaps) if gap <= 0} <= set(found)
        assert set(found) <= {k for k, gap in enumerate(gaps) if gap <= near}

        is_all, some = solid.probe.triangles_in_box(rows, 0.0, len(found) // 2)
        assert is_all == (not found)
        assert set(some) <= set(found)


def cells(solid: Probed, random: np.random.Generator, count: int) -> Any:
    """Yield the corners of small boxes near a solid, within reach of it."""
    signs = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, -1).T
    for center, axes, half in boxes(solid, random, count):
        yield center, axes, center + (signs * half) @ axes


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", SOLIDS)
def test_escape_row_bounds_the_depth_of_every_point_of_its_cell(name: str, place: str) -> None:
    solid = Probed(name, place)
    random = random_of(name, place, "rows")
    rows = 0

    for _, axes, corners in cells(solid, random, 2 * shorter(name)):
        normal = random.normal(size=3)
        if random.random() < 0.7:
            a, b, c = solid.framed_doubles()[random.integers(len(solid.faces))]
            normal = np.cross(b - a, c - a) * random.choice([-1, 1])
        effort = (float(random.choice([0, 0.01])), int(random.choice([1, 8, 400])), 2.0)
        row = solid.probe.escape_row(corners, tuple(normal), tuple(axes[0]), effort)
        if row is None:
            continue
        rows += 1
        up, height = np.array(row[0]), row[1]
        weights = np.concatenate([np.eye(8), random.dirichlet(np.full(8, 0.3), 6)])
        for point in weights @ corners:
            world = solid.world(point)
            if not winding_number(world, solid.vertices, solid.faces):
                continue
            exact = [Fraction(x) for x in solid.exactly_framed(world)]
            reach = Fraction(height) - sum(
                Fraction(u) * x for u, x in zip(up.tolist(), exact, strict=True)
            )
            square = min(point_triangle_distance_squared(exact, t) for t in solid.framed)
            # The point of the world is not the one of the cell to the last digit.
            assert reach + Fraction(float(np.abs(solid.origin).max())) * Fraction(2) ** -50 >= 0
            assert square <= (reach + Fraction(2) ** -50) ** 2
    assert rows > 0 or name == "needle"
