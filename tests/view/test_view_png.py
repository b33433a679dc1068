"""Painted pictures: pixels against projections, brute force and closed forms of their own."""

from __future__ import annotations

import zlib
from pathlib import Path

import numpy as np
import pytest
from claims.png_files import pixels_of

from obbcli import Mesh, ObbTree
from obbcli.view.boxes import boxes_of_level, tree_picture
from obbcli.view.marks import point_mark
from obbcli.view.paint import paint
from obbcli.view.picture import Lines, Picture, Surface, seen_from
from obbcli.view.png import encode, png_bytes
from obbcli.view.raster import Nearest, segment_fragments, triangle_fragments

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
RED, GREEN, BLUE, WHITE = (200, 30, 30), (30, 180, 30), (30, 30, 200), (255, 255, 255)
ABOVE = (0.0, 0.0, 1.0)


def square(low, high, z, color, **attributes):
    """Return a square across z, from (low, low) to (high, high)."""
    corners = [(low, low, z), (high, low, z), (high, high, z), (low, high, z)]
    return Surface(
        name="square",
        vertices=np.array(corners, float),
        triangles=np.array([(0, 1, 2), (0, 2, 3)]),
        color=color,
        **attributes,
    )


def seen(*parts, size=(100, 100), direction=ABOVE, focus=(0, 0, 0), **options):
    """Return the pixels of parts from above: x to the right, y up."""
    picture = Picture(title="", parts=parts, focus=np.array(focus, float))
    return paint(seen_from(picture, direction), size, **options).astype(int)


def hue(pixel):
    """Return which of red, green and blue leads, or none."""
    order = np.sort(pixel)
    return -1 if order[2] - order[1] < 25 else int(np.argmax(pixel))


def test_png_holds_the_pixels():
    pixels = np.random.default_rng(1).integers(0, 256, (37, 53, 3), dtype=np.uint8)
    pixels[10:20] = np.arange(53, dtype=np.uint8)[:, None]

    np.testing.assert_array_equal(pixels_of(encode(pixels)), pixels)


def test_png_of_smooth_shades_is_small():
    ramp = np.broadcast_to(np.arange(256, dtype=np.uint8)[None, :, None], (256, 256, 3))

    assert len(encode(np.ascontiguousarray(ramp))) < len(zlib.compress(ramp.tobytes(), 9)) / 2


def test_picture_has_the_size_asked_for_and_a_margin():
    pixels = seen(square(-1, 1, 0, RED), size=(120, 80))

    rows = np.flatnonzero((pixels != 255).any(axis=(1, 2)))
    columns = np.flatnonzero((pixels != 255).any(axis=(0, 2)))
    assert pixels.shape == (80, 120, 3)
    # 4 percent of the height are free above and below, and the square stands in the middle.
    assert (rows[0], rows[-1]) == (3, 76)
    assert (columns[0], columns[-1]) == (23, 96)


def test_what_is_nearer_hides_what_is_behind_in_any_order():
    back, front = square(-1, 1, 0, RED), square(-0.5, 0.5, 1, BLUE)

    for parts in ((back, front), (front, back)):
        pixels = seen(*parts)
        assert hue(pixels[50, 50]) == hue(pixels[32, 32]) == 2
        assert hue(pixels[15, 15]) == hue(pixels[85, 85]) == 0
    assert hue(seen(back, front, direction=(0, 0, -1))[50, 50]) == 0


def test_crossing_surfaces_hide_each_other_where_they_cross():
    tilted = Surface(
        name="tilted",
        vertices=np.array([(-1, -1, -1), (1, -1, 1), (1, 1, 1), (-1, 1, -1)], float),
        triangles=np.array([(0, 1, 2), (0, 2, 3)]),
        color=BLUE,
    )

    pixels = seen(square(-1, 1, 0, RED), tilted)

    assert hue(pixels[50, 30]) == 0
    assert hue(pixels[50, 70]) == 2


def test_ghost_tints_what_is_behind_it_and_is_hidden_by_what_is_before():
    ghost = square(-1, 1, 1, GREEN, opacity=0.5)
    alone = seen(square(-1, 1, 1, GREEN))[50, 50]
    behind = seen(square(-1, 1, 0, RED))[50, 50]

    over = seen(square(-1, 1, 0, RED), ghost)[50, 50]
    under = seen(square(-1, 1, 2, RED), ghost)[50, 50]
    free = seen(square(-1, 1, 0, RED), square(-3, 3, 1, GREEN, opacity=0.5))[15, 15]

    assert np.abs(over - (alone + behind) / 2).max() <= 1
    assert np.abs(under - behind).max() == 0
    assert np.abs(free - (alone + 255) / 2).max() <= 1


def test_ghosts_are_laid_over_each_other_from_behind():
    parts = [square(-1, 1, z, c, opacity=0.5) for z, c in ((1, GREEN), (2, RED), (3, BLUE))]
    lit = [seen(square(-1, 1, 0, part.color))[50, 50] for part in parts]

    for order in ((0, 1, 2), (2, 0, 1)):
        pixel = seen(square(-2, 2, 0, WHITE), *(parts[k] for k in order))[50, 50]
        white = seen(square(-2, 2, 0, WHITE))[50, 50]
        expected = white / 8 + lit[0] / 8 + lit[1] / 4 + lit[2] / 2
        assert np.abs(pixel - expected).max() <= 1


def test_ghost_shows_its_nearest_faces_and_boxes_show_all():
    def stack(**attributes):
        low, high = square(-1, 1, 1, GREEN), square(-1, 1, 2, GREEN)
        return Surface(
            name="stack",
            vertices=np.concatenate([low.vertices, high.vertices]),
            triangles=np.concatenate([low.triangles, 4 + high.triangles]),
            color=GREEN,
            opacity=0.5,
            **attributes,
        )

    ground = square(-2, 2, 0, WHITE)
    once = seen(ground, stack())[50, 50]
    twice = seen(ground, stack(is_layered=True))[50, 50]
    from_below = seen(stack(is_layered=True), ground, direction=(0, 0, -1))[50, 50]

    assert once[0] - twice[0] > 20
    assert hue(from_below) == -1


def test_mark_shows_through_what_is_before_it():
    ball = point_mark(np.zeros(3), 10.0)
    wall = square(-1, 1, 1, BLUE)

    free, hidden = seen(square(-1, 1, -1, BLUE), ball), seen(wall, ball)

    assert hue(free[50, 50]) == hue(hidden[50, 50]) == 0
    assert hue(hidden[30, 30]) == 2
    assert np.abs(free[50, 50] - hidden[50, 50]).max() > 20


def test_edges_of_the_picture_stand_where_they_project():
    ends = np.array([(-1, -1, 1), (1, 1, 1)], float)
    line = Lines(name="line", vertices=ends, segments=np.array([(0, 1)]), color=(0, 0, 0))

    pixels = seen(square(-1, 1, 0, WHITE), line)

    dark = np.argwhere(pixels.sum(axis=2) < 300)
    assert len(dark) > 80
    # y goes up and rows go down: the diagonal is that of row + column = 99.
    assert np.abs(dark.sum(axis=1) - 99).max() <= 2


def test_zoom_comes_closer_to_the_focus():
    board = [square(-1, 1, 0, RED), square(0.7, 0.8, 1, BLUE)]

    wide, close = seen(*board), seen(*board, focus=(0.75, 0.75, 0), zoom=8.0)

    assert hue(wide[50, 50]) == 0
    assert (close[34:66, 34:66] == close[50, 50]).all()
    assert hue(close[50, 50]) == 2


@pytest.mark.parametrize("exponent", [-1000, 0, 900])
def test_units_change_no_pixel(exponent):
    mesh = ObbTree.build(SAMPLES / "chain_link_a.off").mesh
    scaled = Mesh(np.ldexp(mesh.vertices, exponent), mesh.triangles)
    pictures = [
        tree_picture(tree, boxes_of_level(tree, 3), "")
        for tree in (ObbTree.build(mesh), ObbTree.build(scaled))
    ]

    one, other = (paint(picture, (160, 120)) for picture in pictures)

    np.testing.assert_array_equal(one, other)


def test_flat_and_pointlike_things_can_be_painted():
    point = Surface(
        name="point", vertices=np.zeros((3, 3)), triangles=np.array([[0, 1, 2]]), color=RED
    )

    assert (seen(point, size=(20, 20)) == 255).all()
    assert (seen(square(-1, 1, 0, RED), size=(20, 20), direction=(1, 0, 0)) == 255).all()


def brute_force(corners, size):
    """Return the nearest triangle of each pixel, -1 for none, and by how much it is nearest."""
    x, y = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    depths = np.full((len(corners), *x.shape), -np.inf)
    margins = np.full(x.shape, np.inf)
    for k, (a, b, c) in enumerate(corners):
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        weights = []
        for p, q in ((b, c), (c, a), (a, b)):
            side = (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])
            weights.append(side / area)
            margins = np.minimum(margins, np.abs(side) / np.hypot(*(q - p)[:2]))
        inside = np.min(weights, axis=0) >= 0
        depths[k][inside] = sum(w * p[2] for w, p in zip(weights, (a, b, c), strict=True))[inside]
    order = np.sort(depths, axis=0)
    with np.errstate(invalid="ignore"):
        gap = np.where(np.isfinite(order[-2]), order[-1] - order[-2], np.inf)
    nearest = np.where(np.isfinite(order[-1]), depths.argmax(axis=0), -1)
    return nearest, np.minimum(margins, gap / 100)


@pytest.mark.parametrize("seed", range(6))
def test_pixels_show_the_nearest_triangle_of_all(seed):
    rng = np.random.default_rng(seed)
    size = (60, 44)
    corners = rng.uniform((-20, -20, 100), (80, 64, 9000), (40, 3, 3))
    if seed >= 4:  # slivers
        corners[:, 2] = corners[:, 1] + rng.normal(scale=0.4, size=(40, 3))
    nearest = Nearest(size)

    for fragments in triangle_fragments(corners, size):
        nearest.add(fragments, fragments.owners + 1)

    expected, margin = brute_force(corners, size)
    sure = margin > 1e-6 if seed >= 4 else margin > 0.02
    assert sure.mean() > 0.5
    np.testing.assert_array_equal((nearest.ids - 1)[sure], expected[sure])


def test_segment_covers_the_pixels_along_it():
    ends = np.array([[(-50.0, 10.2, 5.0), (150.0, 10.2, 5.0)], [(300.0, 0.0, 5.0)] * 2])

    found = list(segment_fragments(ends, (40, 30), 1))

    pixels = np.unique(np.concatenate([fragments.pixels for fragments in found]))
    np.testing.assert_array_equal(pixels, 10 * 40 + np.arange(40))
    assert {int(owner) for fragments in found for owner in fragments.owners} == {0}


def test_picture_of_a_tree_shows_mesh_and_boxes():
    tree = ObbTree.build(SAMPLES / "nut.obj")
    picture = tree_picture(tree, boxes_of_level(tree, 3), "")

    data = png_bytes(picture, (160, 120))

    pixels = pixels_of(data)
    tinted = [hue(pixel) for pixel in pixels.reshape(-1, 3)]
    leading = int(np.argmax(picture.parts[1].color))
    assert pixels.shape == (120, 160, 3)
    assert tinted.count(leading) > 3000
    assert (pixels == 255).all(axis=2).mean() > 0.2
