"""The scenes are what they claim to be: by exact distances, winding numbers and counts of edges."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from meshes.surfaces import GRID, Surface, blob, box, sheet, sphere, torus
from oracles.mesh import mesh_distance_squared, mesh_pairs
from scenes.pairs import POSE_CLASSES, pairs

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

SMALL = 500
CLOSED: dict[str, Callable[[int], Surface]] = {
    "sphere": sphere,
    "blob": blob,
    "torus": lambda triangles: torus(triangles, 0.4375),
    "box": box,
}
SURFACES = CLOSED | {"sheet": lambda triangles: sheet(triangles, 0.125)}


def edge_counts(faces: NDArray[np.int64]) -> dict[tuple[int, int], int]:
    """Return how often each directed edge occurs."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    found, counts = np.unique(edges, axis=0, return_counts=True)
    return {(int(i), int(j)): int(n) for (i, j), n in zip(found, counts, strict=True)}


def winding_number(point: NDArray[np.float64], corners: NDArray[np.float64]) -> float:
    """Return how often the surface `corners` (F, 3, 3) turns about `point` (solid angle / 4 pi)."""
    a, b, c = (corners - point).transpose(1, 0, 2)
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    volume = (a * np.cross(b, c)).sum(axis=1)
    dots = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
    return float(np.arctan2(volume, dots).sum() / (2 * np.pi))


@pytest.mark.parametrize("triangles", [1_000, 10_000, 100_000])
@pytest.mark.parametrize("name", SURFACES)
def test_surface_has_about_the_triangles_asked_for(name: str, triangles: int) -> None:
    surface = SURFACES[name](triangles)

    assert len(surface.faces) == pytest.approx(triangles, rel=0.05)
    assert np.array_equal(np.unique(surface.faces), np.arange(len(surface.vertices)))


@pytest.mark.parametrize("name", SURFACES)
def test_surface_has_no_degenerate_triangle(name: str) -> None:
    surface = SURFACES[name](1_000)
    a, b, c = surface.vertices[surface.faces].transpose(1, 0, 2)

    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2

    assert areas.min() > areas.mean() / 100


@pytest.mark.parametrize("name", CLOSED)
def test_closed_surface_has_each_edge_once_each_way(name: str) -> None:
    counts = edge_counts(CLOSED[name](1_000).faces)

    assert set(counts.values()) == {1}
    assert all((j, i) in counts for i, j in counts)


@pytest.mark.parametrize(
    ("name", "volume"),
    [
        ("sphere", 4 / 3 * np.pi),
        ("torus", 2 * np.pi**2 * 0.4375**2),
        ("box", 1.0),
    ],
)
def test_closed_surface_encloses_its_volume_from_outside(name: str, volume: float) -> None:
    surface = CLOSED[name](10_000)

    a, b, c = surface.vertices[surface.faces].transpose(1, 0, 2)

    assert (a * np.cross(b, c)).sum() / 6 == pytest.approx(volume, rel=0.01)


def test_blob_is_bumpy_and_encloses_its_centre_once() -> None:
    surface = blob(1_000, 1)

    radii = np.linalg.norm(surface.vertices, axis=1)

    assert radii.max() / radii.min() > 1.5
    assert winding_number(np.zeros(3), surface.vertices[surface.faces]) == pytest.approx(1)


@pytest.mark.parametrize("name", SURFACES)
def test_coordinates_lie_on_the_grid(name: str) -> None:
    multiples = SURFACES[name](1_000).vertices / GRID

    assert np.array_equal(multiples, np.round(multiples))


@pytest.mark.parametrize("name", POSE_CLASSES)
def test_pair_touches_as_claimed_by_exact_test(name: str) -> None:
    pair = POSE_CLASSES[name](SMALL)

    found = mesh_pairs(pair.a.vertices, pair.a.faces, pair.posed_b, pair.b.faces)

    assert pair.name == name
    if pair.touches is not None:
        assert bool(found) == pair.touches


@pytest.mark.parametrize(
    "name", [name for name, make in POSE_CLASSES.items() if make(SMALL).distance]
)
def test_pair_is_as_far_apart_as_claimed(name: str) -> None:
    pair = POSE_CLASSES[name](SMALL)
    assert pair.distance is not None

    square, _ = mesh_distance_squared(pair.a.vertices, pair.a.faces, pair.posed_b, pair.b.faces)

    low, high = pair.distance
    assert low <= float(square) ** 0.5 <= high


def test_random_pairs_have_both_answers() -> None:
    answers = {
        bool(mesh_pairs(pair.a.vertices, pair.a.faces, pair.posed_b, pair.b.faces))
        for pair in pairs(SMALL)
        if pair.touches is None
    }

    assert answers == {True, False}


@pytest.mark.parametrize("name", ["penetrating", "deep"])
def test_overlapping_pair_has_vertices_on_both_sides(name: str) -> None:
    pair = POSE_CLASSES[name](100_000)
    corners_b = pair.posed_b[pair.b.faces]
    nearest = np.argmin(np.linalg.norm(pair.a.vertices - pair.translation, axis=1))
    farthest = np.argmax(np.linalg.norm(pair.a.vertices - pair.translation, axis=1))

    # A connected surface with points inside and outside of a closed one crosses it.
    assert winding_number(pair.a.vertices[nearest], corners_b) == pytest.approx(1)
    assert winding_number(pair.a.vertices[farthest], corners_b) == pytest.approx(0, abs=1e-9)


def test_touching_pair_shares_a_vertex_exactly() -> None:
    pair = POSE_CLASSES["touching"](1_000)

    shared = {tuple(p) for p in pair.a.vertices} & {tuple(p) for p in pair.posed_b}

    assert len(shared) == 1


def test_nested_pair_is_one_inside_the_other() -> None:
    pair = POSE_CLASSES["nested"](1_000)

    inside = winding_number(pair.posed_b[0], pair.a.vertices[pair.a.faces])

    assert inside == pytest.approx(1)


def test_interlocked_rings_are_linked() -> None:
    pair = POSE_CLASSES["interlocked"](1_000)
    around = round((len(pair.b.faces) / 4) ** 0.5)
    centres = pair.posed_b.reshape(-1, around, 3).mean(axis=1)
    following = np.roll(centres, -1, axis=0)
    crosses = np.sign(centres[:, 2] + 1e-9) != np.sign(following[:, 2] + 1e-9)

    # The centre line of b passes once through the disk that the centre line of a bounds.
    radii = np.linalg.norm((centres + following)[crosses, :2] / 2, axis=1)

    assert np.count_nonzero(radii < 1) == 1
