"""Polygons as triangles: n - 2 a polygon, within it, with its area and outline, in file order."""

from __future__ import annotations

import math
import subprocess
import sys
from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats.polygons import triangulated
from obbcli.mesh.source import Source

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
#: Outlines that a fan about the first corner leaves.
CONCAVE = {
    "dart": [(2, 0), (4, 4), (2, 1), (0, 4)],
    "dart from its reflex corner": [(2, 1), (0, 4), (2, 0), (4, 4)],
    "L": [(0, 2), (0, 0), (3, 0), (3, 1), (1, 1), (1, 2)],
    "comb": [(0, 0), (7, 0), (7, 4), (6, 4), (6, 1), (4, 1), (4, 4), (3, 4), (3, 1), (0, 1)],
    "L with corners on its sides": [
        *((0, 0), (1, 0), (2, 0), (3, 0), (3, 1), (2, 1), (1, 1), (1, 2), (1, 3)),
        *((0, 3), (0, 2), (0, 1)),
    ],
    "dart with a corner twice": [(2, 0), (4, 4), (2, 1), (2, 1), (0, 4)],
    "a slit as wide as nothing": [(0, 0), (4, 0), (4, 4), (2, 4), (2, 1), (2, 4), (0, 4)],
}


def cut(*outlines, lift=lambda x, y: (x, y, 0.0)):
    """Return vertices, triangles and notes of polygons, each with vertices of its own."""
    vertices = np.array([lift(*corner) for outline in outlines for corner in outline], dtype=float)
    source = Source("x", "x", b"")
    counts = np.array([len(outline) for outline in outlines])
    triangles = triangulated(source, vertices, np.arange(len(vertices)), counts)
    return vertices, triangles, source.notes


def shoelace(outline):
    """Return twice the signed area, without rounding."""
    exact = [(Fraction(x), Fraction(y)) for x, y in outline]
    following = exact[1:] + exact[:1]
    return sum(a * d - b * c for (a, b), (c, d) in zip(exact, following, strict=True))


def doubled_areas(vertices, triangles):
    return [shoelace([vertices[corner][:2] for corner in row]) for row in triangles]


def outline_of(triangles):
    """Return the directed sides that no other triangle runs through the other way."""
    sides = Counter((row[k], row[(k + 1) % 3]) for row in triangles.tolist() for k in range(3))
    return Counter({(a, b): n for (a, b), n in sides.items() if n > sides[b, a]})


def require_within(outline, vertices, triangles):
    """Hold a cut against its polygon: the count, the outline, and no area beside or twice."""
    areas = doubled_areas(vertices, triangles)
    wanted = shoelace(outline)
    ring = range(len(outline))

    assert len(triangles) == len(outline) - 2
    assert outline_of(triangles) == Counter((k, (k + 1) % len(outline)) for k in ring)
    assert sum(areas) == wanted
    assert all(area * wanted >= 0 for area in areas)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("start", [0, 1, 2, 3])
@pytest.mark.parametrize("name", CONCAVE)
def test_concave_polygons_are_cut_within_themselves(name, start, turned):
    outline = CONCAVE[name][start:] + CONCAVE[name][:start]
    outline = outline[::-1] if turned else outline

    vertices, triangles, notes = cut(outline)

    require_within(outline, vertices, triangles)
    told = [f"1 concave polygon cut within itself into {len(outline) - 2} triangles"]
    # A repeated place may hide the reflex corner; the fan is kept where it stays within.
    assert notes == told or (len(set(outline)) < len(outline) and notes == [])


LIFTS = {
    "x": lambda x, y: (5.0, x, y),
    "-x": lambda x, y: (5.0, y, x),
    "y": lambda x, y: (y, 5.0, x),
    "-y": lambda x, y: (x, 5.0, y),
    "slanted": lambda x, y: (x, y, 2 * x - 3 * y),
    "tiny": lambda x, y: (x * 1e-300, y * 1e-300, 0),
    "huge": lambda x, y: (x * 1e300, y * 1e300, 0),
}


@pytest.mark.parametrize("side", LIFTS)
@pytest.mark.parametrize("name", CONCAVE)
def test_concave_polygons_are_cut_in_any_plane_and_keep_their_side(name, side):
    vertices, triangles, _ = cut(CONCAVE[name], lift=LIFTS[side])

    plain = np.array([(x, y, 0.0) for x, y in CONCAVE[name]])
    require_within(CONCAVE[name], plain, triangles)
    assert len(vertices) == len(CONCAVE[name])


@st.composite
def stars(draw):
    """Draw an outline that goes once around a point, its corners at any distance."""
    count = draw(st.integers(4, 30))
    radii = draw(st.lists(st.integers(1, 1000), min_size=count, max_size=count))
    angles = [2 * math.pi * (k + 0.5 * (r % 7) / 7) / count for k, r in enumerate(radii)]
    rays = zip(radii, angles, strict=True)
    return [(r * math.cos(angle), r * math.sin(angle)) for r, angle in rays]


@given(stars())
def test_stars_are_cut_within_themselves(outline):
    vertices, triangles, _ = cut(outline)
    areas = doubled_areas(vertices, triangles)

    assert len(triangles) == len(outline) - 2
    ring = range(len(outline))
    assert outline_of(triangles) == Counter((k, (k + 1) % len(outline)) for k in ring)
    assert sum(map(abs, areas)) == pytest.approx(abs(shoelace(outline)), rel=1e-9)


@given(st.integers(3, 40), st.integers(0, 39), st.booleans())
def test_convex_polygons_are_fans_about_their_first_corner(count, start, turned):
    angles = [2 * math.pi * (k + start % count) / count for k in range(count)]
    outline = [(math.cos(angle), math.sin(angle)) for angle in angles]

    _, triangles, notes = cut(outline[::-1] if turned else outline)

    assert triangles.tolist() == [[0, k, k + 1] for k in range(1, count - 1)]
    assert notes == []


def test_polygons_keep_their_order_among_convex_and_concave_ones():
    outlines = [SQUARE, CONCAVE["L"], [(0, 0), (1, 0), (0, 1)], CONCAVE["dart"], SQUARE]
    ends = np.cumsum([len(outline) for outline in outlines])

    _, triangles, notes = cut(*outlines)

    of_rows = np.searchsorted(ends, triangles[:, 0], side="right").tolist()
    assert of_rows == [0, 0, 1, 1, 1, 1, 2, 3, 3, 4, 4]
    assert notes == ["2 concave polygons cut within themselves into 6 triangles"]


@pytest.mark.parametrize(
    "outline",
    [
        [(0, 0), (2, 2), (2, 0), (0, 2)],
        [(math.cos(k * 4 * math.pi / 5), math.sin(k * 4 * math.pi / 5)) for k in range(5)],
        [(0, 0), (4, 0), (4, 4), (1, -1), (0, 4)],
    ],
    ids=["bow tie", "pentagram", "crossed"],
)
def test_outlines_that_cross_themselves_are_told_and_keep_their_count(outline):
    _, triangles, notes = cut(outline)

    assert len(triangles) == len(outline) - 2
    assert set(triangles.ravel().tolist()) == set(range(len(outline)))
    told = "1 polygon cut as well as can be: the outline crosses itself or holds nothing"
    assert notes == [told]


@pytest.mark.parametrize("outline", [[(0, 0), (1, 0), (2, 0), (3, 0)], [(1, 1)] * 5])
def test_outlines_without_area_are_fans(outline):
    _, triangles, notes = cut(outline)

    assert triangles.tolist() == [[0, k, k + 1] for k in range(1, len(outline) - 1)]
    assert notes == []


def test_polygons_that_are_not_flat_are_told_with_how_far():
    # The plane in the middle of a square with two opposite corners raised by 0.2 lies at 0.1.
    corners = iter([0.0, 0.2, 0.0, 0.2] * 2)

    _, _, notes = cut(SQUARE, SQUARE, lift=lambda x, y: (x, y, next(corners)))

    assert notes == ["2 polygons are not flat: corners up to 0.1 off plane"]


def test_rounding_of_coordinates_is_no_warp():
    turn = np.float32([0.6, 0.8])

    _, _, notes = cut(SQUARE, lift=lambda x, y: (x, np.float32(turn[0] * y), turn[1] * y))

    assert notes == []


def test_values_that_are_no_numbers_are_left_to_the_mesh():
    _, triangles, _ = cut([(0, 0), (1, 0), (math.nan, 1), (0, math.inf)])

    assert triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


READERS = {
    ".obj": b"v 2 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4\n",
    ".off": b"OFF\n4 1 0\n2 0 0\n4 4 0\n2 1 0\n0 4 0\n4 0 1 2 3\n",
    ".ply": b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    b"property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
    b"2 0 0\n4 4 0\n2 1 0\n0 4 0\n4 0 1 2 3\n",
    ".vtk": b"# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
    b"2 0 0 4 4 0 2 1 0 0 4 0\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n9\n",
}


@pytest.mark.parametrize("suffix", READERS)
def test_readers_cut_concave_polygons_and_tell_it(suffix):
    # The dart from its tip: a fan would have the rows 0 1 2 and 0 2 3, which it is as well, so
    # that the first corner is moved on by one.
    data = READERS[suffix]
    moved = {".obj": (b"f 1 2 3 4", b"f 2 3 4 1")}.get(suffix, (b"4 0 1 2 3", b"4 1 2 3 0"))

    mesh = load_mesh_bytes(data.replace(*moved), suffix)

    require_within(CONCAVE["dart"], mesh.vertices, mesh.triangles)
    assert mesh.notes == ("1 concave polygon cut within itself into 2 triangles",)


def test_ear_clipping_is_imported_for_concave_polygons_alone():
    code = (
        "import sys\nfrom obbcli.mesh import load_mesh_bytes\n"
        "load_mesh_bytes(b'v 0 0 0\\nv 1 0 0\\nv 1 1 0\\nv 0 1 0\\nf 1 2 3 4\\n', '.obj')\n"
        "sys.exit('mapbox_earcut' in sys.modules)\n"
    )

    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
