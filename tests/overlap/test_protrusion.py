"""How deep one surface reaches into another solid: closed forms, definitions and laws."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.solids import joined, shifted, turned_over
from meshes.surfaces import sphere
from movers.meshes import box
from oracles.distance import point_triangle_distance_squared
from oracles.solid import winding_number
from overlap.asking import protrusion, protrusion_query, solid
from overlap.random_pairs import many, placed_pair
from scenes.pairs import random_rotation

if TYPE_CHECKING:
    from overlap.asking import Solid

TURN = random_rotation(11)
SHIFT = np.array([0.5, -3.0, 2.0])
UNIT = box((0, 0, 0), (1, 1, 1))
BLOCK = box((0, 0, 0), (4, 4, 4))
HOLLOW = joined(BLOCK, turned_over(box((1, 1, 1), (3, 3, 3))))


# A, B, how deep A's surface reaches into B, and B's into A; None where rounding may tell from 0.
CLOSED_FORMS = {
    "boxes": (UNIT, box((0.7, 0.2, 0.3), (1.7, 0.8, 0.9)), 0.3, 0.3),
    "plate": (box((0, 0, 0), (50, 50, 5)), box((0, 0, 4.9), (50, 50, 9)), 0.1, 0.1),
    "fine plates": (
        many(500, (0, 0, 0), (50, 50, 5)),
        many(700, (0, 0, 4.9), (50, 50, 9)),
        0.1,
        0.1,
    ),
    "bar through a sheet": (
        box((0, 0, -3), (1, 1, 3)),
        box((-5, -5, 0), (5, 5, 0.05)),
        0.025,
        0.5,
    ),
    "beam in a block": (
        many(800, (1, 1, 2.5), (2, 2, 6)),
        many(500, (0, 0, 0), (4, 4, 4)),
        1.5,
        0.5,
    ),
    "flush": (UNIT, box((1, 0, 0), (2, 1, 1)), None, None),
    "same": (UNIT, UNIT, None, None),
    "same, cut otherwise": (many(300, (0, 0, 0), (1, 1, 1)), UNIT, None, None),
    "half": (UNIT, box((0, 0, 0), (1, 1, 0.5)), None, 0.5),
    "inside": (box((1, 1.5, 1), (2, 2, 2)), BLOCK, 2.0, 0),
    "in a hollow": (box((1.5, 1.5, 1.5), (2, 2, 2)), HOLLOW, 0, 0),
    "fills a hollow": (box((1, 1, 1), (3, 3, 3)), HOLLOW, None, None),
    "too large for a hollow": (box((0.5, 1, 1), (3, 3, 3)), HOLLOW, 0.5, 0.5),
    "apart": (UNIT, box((3, 3, 3), (4, 4, 4)), 0, 0),
    "edges touch": (UNIT, box((1, 1, 0), (2, 2, 1)), None, None),
    "inward turned": (turned_over(UNIT), box((0.7, 0.2, 0.3), (1.7, 0.8, 0.9)), 0.3, 0.3),
    "two parts": (
        UNIT,
        joined(box((0.9, 0, 0), (2, 1, 1)), box((-1, 0.2, 0.2), (0.2, 0.6, 0.6))),
        0.2,
        0.2,
    ),
}


@pytest.mark.parametrize("place", ["here", "turned"])
@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_bounds_hold_the_closed_form(name: str, place: str) -> None:
    mesh_a, mesh_b, *wanted = CLOSED_FORMS[name]
    pose = (None, (0.0, 0.0, 0.0)) if place == "here" else (TURN, SHIFT)
    a, b = solid(mesh_a, *pose), solid(mesh_b, *pose)
    size = max(a.size, b.size)

    for (x, y), depth in zip([(a, b), (b, a)], wanted, strict=True):
        found = protrusion(x, y)
        low, high = found.bounds
        if depth is None:
            assert 0 <= low <= 1e-14 * size
            assert low <= high <= 1e-9 * size
        else:
            assert low <= depth + 1e-14 * size
            assert high >= depth - 1e-14 * size
            assert high - low <= max(0.0101 * high, 1e-9 * size)
            assert (found.point is None) == (found.triangle_a is None) == (depth == 0)


def exact_square(point: Any, b: Solid) -> Fraction:
    return min(point_triangle_distance_squared(point, t) for t in b.triangles)


def points_on(a: Solid, random: np.random.Generator, count: int) -> Any:
    """Return points of a surface, corners and middles of edges among them, to rounding."""
    weights = np.concatenate([np.eye(3), random.dirichlet(np.full(3, 0.7), count), [[0.5, 0.5, 0]]])
    chosen = a.triangles[random.permutation(len(a.faces))[:count]]
    return np.einsum("wk,tkd->twd", weights, chosen).reshape(-1, 3)


@pytest.mark.parametrize("inside_only", [True, False])
@pytest.mark.parametrize("seed", range(40))
def test_no_point_of_the_surface_is_deeper_than_the_bound(seed: int, inside_only: bool) -> None:
    a, b = placed_pair(seed)
    low, high = (found := protrusion(a, b, inside_only=inside_only)).bounds
    rounding = 1e-13 * max(a.size, b.size)

    for point in points_on(a, np.random.default_rng(seed), 6):
        square = exact_square(point, b)
        if square > high * high and (not inside_only or winding_number(point, b.vertices, b.faces)):
            assert square <= Fraction(high + rounding) ** 2
    if found.point is not None:
        assert exact_square(found.point, b) >= Fraction(low) ** 2
        assert exact_square(found.point, a) <= Fraction(rounding) ** 2
        touched = b.triangles[found.triangle_b]
        assert point_triangle_distance_squared(found.point, touched) <= Fraction(high * 1.1) ** 2
        on_a = point_triangle_distance_squared(found.point, a.triangles[found.triangle_a])
        assert on_a <= Fraction(rounding) ** 2
        assert not inside_only or winding_number(found.point, b.vertices, b.faces) != 0


@pytest.mark.parametrize("inside_only", [True, False])
@pytest.mark.parametrize("seed", range(40))
def test_decision_agrees_with_the_value(seed: int, inside_only: bool) -> None:
    a, b = placed_pair(seed)
    floor = 1e-9 * max(a.size, b.size)
    low, high = protrusion(a, b, tolerance=1e-3, inside_only=inside_only).bounds

    for wanted in (0.0, 0.5 * low, 0.9 * low, 1.1 * high, 2 * high):
        found = protrusion(a, b, deeper_than=wanted, inside_only=inside_only)
        assert found.deeper is not None
        if found.deeper:
            assert wanted < found.bounds[0] <= high
        else:
            assert low <= found.bounds[1] <= wanted + floor * (1 + 1e-15)


def said(query: Any) -> Any:
    return (query.bounds, query.point, query.triangle_a, query.triangle_b, query.cells)


@pytest.mark.parametrize("seed", range(0, 40, 5))
def test_slices_change_nothing_and_bounds_only_narrow(seed: int) -> None:
    a, b = placed_pair(seed)
    query = protrusion_query(a, b)
    before = (0.0, np.inf)

    while not query.advance(1):
        low, high = query.bounds
        assert before[0] <= low <= high <= before[1]
        before = low, high

    assert said(query) == said(protrusion(a, b))
    for limit in (0, 1, 2, 8, 32):
        limited = protrusion(a, b, max_cells=limit)
        assert limited.cells <= limit
        assert limited.bounds[0] <= query.bounds[1]
        assert limited.bounds[1] >= query.bounds[0]


@pytest.mark.parametrize("exponent", [-900, -30, 7, 500])
@pytest.mark.parametrize("seed", [2, 7, 21])
def test_unit_changes_no_digit(seed: int, exponent: int) -> None:
    a, b = placed_pair(seed)
    one = protrusion(a, b)
    scale = 2.0**exponent
    scaled_bodies = []
    for body in (a, b):
        mesh = np.ldexp(body.tree.mesh.vertices, exponent), body.faces
        scaled_bodies.append((mesh, body.pose))
    solids = [
        solid(mesh, pose.rotation, np.ldexp(pose.translation, exponent))
        for mesh, pose in scaled_bodies
    ]

    other = protrusion(*solids, floor=1e-9 * max(a.size, b.size) * scale)

    assert other.bounds == (one.bounds[0] * scale, one.bounds[1] * scale)
    assert said(other)[2:] == said(one)[2:]


@pytest.mark.parametrize("seed", range(12))
def test_frames_and_tessellations_agree(seed: int) -> None:
    random = np.random.default_rng(seed)
    low = random.uniform(0, 1, 3)
    high = low + random.uniform(0.1, 1, 3)
    brackets = []
    for count in (12, 100, 900):
        for turn in (None, random_rotation(seed)):
            a = solid(many(count, (0, 0, 0), (1, 1, 1)), turn)
            b = solid(many(count, low, high), turn)
            brackets.append(protrusion(a, b).bounds)

    assert max(low for low, _ in brackets) <= min(high for _, high in brackets) + 1e-13


def test_far_from_the_origin_the_same_is_said() -> None:
    far = np.array([1e6, -3e6, 2e6])
    meshes = UNIT, box((0.75, 0.25, 0.25), (1.75, 0.75, 0.75))

    found = protrusion(*[solid(shifted(mesh, far)) for mesh in meshes])
    here = protrusion(*[solid(mesh) for mesh in meshes])

    assert found.bounds == pytest.approx(here.bounds, rel=0.02)
    assert found.bounds[0] <= 0.25 <= found.bounds[1]


HAUSDORFF = {
    "same, cut otherwise": (many(700, (0, 0, 0), (1, 1, 1)), many(60, (0, 0, 0), (1, 1, 1)), 0.0),
    "half": (UNIT, box((0, 0, 0), (1, 1, 0.5)), 0.5),
    "apart": (UNIT, box((3, 0, 0), (4, 1, 1)), 3.0),
    "inside": (box((1, 1, 1), (2, 2, 2)), BLOCK, 2.0),
    "moved": (UNIT, shifted(UNIT, (1e-3, 0, 0)), 1e-3),
    "turned over": (UNIT, turned_over(UNIT), 0.0),
}


@pytest.mark.parametrize("place", ["here", "turned"])
@pytest.mark.parametrize("name", HAUSDORFF)
def test_one_sided_distance_of_surfaces(name: str, place: str) -> None:
    mesh_a, mesh_b, wanted = HAUSDORFF[name]
    pose = (None, (0.0, 0.0, 0.0)) if place == "here" else (TURN, SHIFT)
    a, b = solid(mesh_a, *pose), solid(mesh_b, *pose)

    found = protrusion(a, b, inside_only=False)

    low, high = found.bounds
    assert low <= wanted + 1e-13
    assert high >= wanted - 1e-13
    assert high - low <= max(0.0101 * high, 1e-9 * max(a.size, b.size))


def test_sphere_in_sphere_is_as_deep_as_its_corners() -> None:
    small, large = sphere(320, 1.0), sphere(5120, 2.0)
    a, b = solid((small.vertices, small.faces)), solid((large.vertices, large.faces))

    low, high = protrusion(a, b).bounds

    # Planes of triangles are between 0.93 and 1 from the centre, and between 1.99 and 2.
    assert low <= 2 - 0.93
    assert high >= 1.99 - 1.0
    assert high <= 2 - 0.93 + 0.02
