"""The distance that closes a surface: cracks of known width, and surfaces that none closes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesh_files.cube_files import CUBE_FACES, cube

from obbcli import Mesh, MeshError, collide, first_contact
from obbcli.mesh.closing import closing_distance

CUBE = np.array(cube((1, 1, 1)))[np.array(CUBE_FACES)]


def soup(corners):
    corners = np.asarray(corners, float)
    return Mesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def cracked(width):
    """Return a cube of which the first triangle's first corner is off by `width` along x."""
    corners = CUBE.copy()
    corners[0, 0, 0] += width
    return soup(corners)


@given(st.floats(2.0**-50, 2.0**-21))
def test_crack_of_one_corner_is_closed_by_its_width_and_by_no_less(width):
    mesh = cracked(width)
    gap = float(np.abs(mesh.vertices - CUBE.reshape(-1, 3)).max())

    found = closing_distance(mesh)

    assert gap <= found <= 1.1 * gap
    assert mesh.welded(found).is_watertight
    assert not mesh.welded(np.nextafter(gap, 0)).is_watertight


@given(st.integers(0, 2**32 - 1), st.integers(-40, -22), st.integers(-30, 30))
def test_noise_on_all_corners_is_closed_whatever_the_size(seed, width, size):
    noise = np.random.default_rng(seed).uniform(-(2.0**width), 2.0**width, CUBE.shape)
    mesh = soup(np.ldexp(CUBE + noise, size))

    found = closing_distance(mesh)

    assert found <= 1e-6 * mesh.size
    assert mesh.welded(found).is_watertight


def test_gaps_of_two_widths_are_closed_by_the_wider():
    corners = CUBE.copy()
    corners[0, 0, 0] += 1e-9
    corners[7, 1, 1] += 1e-12

    assert closing_distance(soup(corners)) == pytest.approx(1e-9, rel=0.1)


def test_corner_at_three_places_in_a_row_needs_the_distance_between_the_outer_two():
    # Nearest gaps of 1e-9 join all three by steps; only the whole width is one cluster.
    corners = CUBE.copy()
    rows = np.argwhere((CUBE[0, 0] == CUBE).all(axis=2))
    for step, (row, corner) in enumerate(rows):
        corners[row, corner, 0] += step * 1e-9
    width = (len(rows) - 1) * 1e-9

    assert len(rows) >= 3
    assert closing_distance(soup(corners)) == pytest.approx(width, rel=0.1)


@pytest.mark.parametrize(
    "mesh",
    [
        cracked(1e-5),
        soup(CUBE[1:]),
        soup(np.concatenate([CUBE[:1, ::-1], CUBE[1:]])),
        soup([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]),
        soup([[[0, 0, 0], [0, 0, 0], [0, 1, 0]]]),
    ],
    ids=["wide crack", "hole", "turned over", "single", "collapsed"],
)
def test_surfaces_that_no_small_distance_closes(mesh):
    assert closing_distance(mesh) is None
    with pytest.raises(MeshError, match="mend the mesh, or ask about surfaces"):
        collide(mesh, soup(CUBE), solid=True)


def test_refusal_names_the_distance_and_that_distance_is_right():
    inner = soup(1.25 + CUBE / 4)
    mesh = cracked(2.0**-40)

    with pytest.raises(MeshError, match=r"B: is not watertight: .*; weld it with --weld 9.1e-13,"):
        first_contact(inner, mesh, solid=True)
    assert first_contact(inner, mesh.welded(9.1e-13), solid=True).contained == "a"


def test_refusal_of_a_scaled_mesh_says_that_welding_comes_first():
    wanted = r"weld it before it is scaled: vertices within 9.1e-10 as scaled"
    with pytest.raises(MeshError, match=wanted):
        collide(soup(CUBE), cracked(2.0**-40).scaled(1000), solid=True)
