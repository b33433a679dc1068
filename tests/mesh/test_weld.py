"""Welding: clusters by brute force in rational arithmetic, what is told and what is refused."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesh_files.cube_files import cube, obj

from obbcli import Mesh, MeshError, load_mesh

#: Multiples of 1/8: distances are compared without rounding.
STEPS = st.integers(-20, 20)
CORNERS = st.lists(st.tuples(STEPS, STEPS, STEPS), min_size=3, max_size=24)


def soup(corners):
    """Return a mesh whose triangles use all of its vertices, in order where they fit."""
    count = len(corners)
    rows = [[k, (k + 1) % count, (k + 2) % count] for k in range(count)]
    return Mesh(np.array(corners, float) / 8, rows)


def squared(p, q):
    return sum((Fraction(a) - Fraction(b)) ** 2 for a, b in zip(p, q, strict=True))


def clusters(points, distance):
    """Return the connected sets of rows within the distance, by joining pair by pair."""
    owner = list(range(len(points)))
    for a, p in enumerate(points):
        for b in range(a):
            if squared(p, points[b]) <= Fraction(distance) ** 2:
                new, old = sorted((owner[a], owner[b]))
                owner = [new if own == old else own for own in owner]
    return owner


def is_wide(points, owner, distance):
    return any(
        owner[a] == owner[b] and squared(points[a], points[b]) > Fraction(distance) ** 2
        for a in range(len(points))
        for b in range(a)
    )


def expect(mesh, distance):
    """Check a mesh and its welding against brute force; return whether it was refused."""
    points = mesh.vertices.tolist()
    owner = clusters(points, distance)
    if is_wide(points, owner, distance):
        with pytest.raises(MeshError, match="by steps, and they are"):
            mesh.welded(distance)
        return True
    found = mesh.welded(distance)
    assert found.vertices.tolist() == [points[own] for own in owner]
    assert found.triangles.tolist() == mesh.triangles.tolist()
    moved = [k for k, own in enumerate(owner) if points[own] != points[k]]
    far = max((float(squared(points[k], points[owner[k]])) for k in moved), default=0.0)
    count = {0: "no vertex", 1: "1 vertex"}.get(len(moved), f"{len(moved)} vertices")
    assert found.notes[-1].startswith(f"welded within {float(distance)!r}: {count} moved")
    if moved:
        assert float(found.notes[-1].split()[-1]) == pytest.approx(far**0.5, rel=1e-14)
    return False


@given(CORNERS, st.sampled_from([0.125, 0.25, 0.5, 1.5, 6.0]))
def test_clusters_are_those_of_brute_force(corners, distance):
    expect(soup(corners), distance)


@given(
    st.lists(st.tuples(*[st.integers(-3, 3)] * 3), min_size=3, max_size=12, unique=True),
    st.lists(st.tuples(*[st.integers(0, 1)] * 3), min_size=24, max_size=24),
    st.integers(-30, 30),
)
def test_clusters_far_apart_become_their_first_vertices(centres, shifts, exponent):
    # Shifts of up to sqrt(3) / 8 about places that are 1 apart.
    places = centres * 2
    corners = [
        [8 * c + s for c, s in zip(place, shift, strict=True)]
        for place, shift in zip(places, shifts, strict=False)
    ]
    mesh = soup(corners)
    scaled = Mesh(np.ldexp(mesh.vertices, exponent), mesh.triangles)

    assert not expect(scaled, np.ldexp(0.25, exponent))


def test_many_vertices_in_one_plane_are_welded():
    # A grid of 200 by 200 squares, each with vertices of its own that are off by 1e-9.
    rng = np.random.default_rng(5)
    x, y = np.meshgrid(np.arange(200.0), np.arange(200.0))
    low = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    exact = (low[:, None] + square).reshape(-1, 3)
    first = np.arange(0, len(exact), 4)[:, None]
    rows = np.concatenate([first + np.array(row) for row in ([0, 1, 2], [0, 2, 3])])

    found = Mesh(exact + rng.uniform(-1e-9, 1e-9, exact.shape), rows).welded(1e-8)

    assert len(np.unique(found.vertices, axis=0)) == 201 * 201
    assert np.abs(found.vertices - exact).max() <= 1e-9


def test_distance_itself_welds_and_less_does_not():
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.25], [1, 1, 0], [2, 0, 0]],
                [[0, 1, 2], [3, 4, 5]])  # fmt: skip

    assert mesh.welded(0.25).vertices[3].tolist() == [0, 0, 0]
    assert mesh.welded(np.nextafter(0.25, 0)).vertices[3].tolist() == [0, 0, 0.25]


def test_triangles_that_collapse_are_kept():
    mesh = Mesh([[0, 0, 0], [1e-9, 0, 0], [0, 1, 0], [1, 0, 0]], [[0, 1, 2], [0, 3, 2]])

    found = mesh.welded(1e-6)

    assert found.triangles.tolist() == [[0, 1, 2], [0, 3, 2]]
    assert (found.degenerate_count, found.bounds.tolist()) == (1, [[0, 0, 0], [1, 1, 0]])


def test_vertices_that_no_triangle_uses_take_no_part():
    mesh = Mesh([[0, 0, 0.1], [0, 0, 0], [1, 0, 0], [0, 1, 0]], [[1, 2, 3]])

    assert mesh.welded(0.5).vertices.tolist() == mesh.vertices.tolist()


def test_cubes_with_rounded_faces_close(tmp_path):
    (tmp_path / "c.obj").write_text(obj(cube()))
    whole = load_mesh(tmp_path / "c.obj")
    corners = whole.vertices[whole.triangles].reshape(-1, 3)
    noise = np.random.default_rng(2).uniform(-1e-13, 1e-13, corners.shape)
    cracked = Mesh(corners + noise, np.arange(len(corners)).reshape(-1, 3))

    assert not cracked.is_watertight
    assert cracked.welded(1e-12).is_watertight


@pytest.mark.parametrize("distance", [0, -1, float("nan"), float("inf"), None, "1", True])
def test_distances_that_are_none_are_refused(distance):
    with pytest.raises(MeshError, match=r"weld: is .* use a finite number above 0"):
        soup([[0, 0, 0], [1, 0, 0], [0, 1, 0]]).welded(distance)


def test_distance_beyond_the_triangles_is_refused_before_all_pairs_are_looked_at():
    points = np.random.default_rng(1).uniform(0, 1, (30_000, 3))
    mesh = Mesh(points, np.arange(30_000).reshape(-1, 3))

    with pytest.raises(MeshError, match=r"weld: is so large that .* pairs of vertices"):
        mesh.welded(0.9)


def test_largest_and_smallest_coordinates_are_welded():
    big = 1.7e308
    mesh = Mesh([[big, -big, 0], [0, 0, 5e-324], [0, 0, 1e-323], [1, 0, 0]], [[0, 1, 3], [1, 2, 0]])

    assert mesh.welded(1e-300).vertices[2].tolist() == [0, 0, 5e-324]
