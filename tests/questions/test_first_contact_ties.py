"""Translations after which thousands of pairs touch at once: few are looked at, and none missed."""

from __future__ import annotations

import numpy as np
import pytest
from meshes.hostile import HOSTILE
from meshes.surfaces import sheet
from scenes.pairs import PLATE_GAP, POSE_CLASSES

from obbcli import Body, FirstContact, Mesh, Motion, ObbTree, Pose, Status, first_contact

TRIANGLES = 5000
# To open all pairs that touch at once takes as many pops as the product of the triangles, or tens
# of thousands where each touches its neighbours alone.
FEW_POPS = 20_000
GAP, SPEED = 0.125, 0.25


def slanted(raised: int | None = None, by: float = 0.0) -> Mesh:
    """Return a flat sheet on a slope, one of its vertices moved by a little."""
    surface = sheet(TRIANGLES)
    vertices = surface.vertices.copy()
    vertices[:, 2] = 0.25 * vertices[:, 0] - 0.5 * vertices[:, 1]
    if raised is not None:
        vertices[raised, 2] += by
    return Mesh(vertices, surface.faces)


def fall(a: Mesh | ObbTree, b: Mesh | ObbTree) -> FirstContact:
    """Ask when b falls on a."""
    return first_contact(a, Body(b, Pose(translation=(0, 0, GAP)), Motion((0, 0, -SPEED))))


@pytest.mark.parametrize("name", ["coincident", "grids", "stacked grids"])
@pytest.mark.parametrize("aside", [0.0, 0.01])
def test_pairs_that_touch_at_once_are_not_looked_at_one_by_one(name, aside):
    pair = HOSTILE[name](TRIANGLES)
    mesh = Mesh(pair.a.vertices, pair.a.faces)
    mover = Body(mesh, Pose(translation=(aside, 0, GAP)), Motion((0, 0, -SPEED)))

    found = first_contact(mesh, mover)

    # The triangle that is there so often has a slope of a quarter along y alone.
    assert found.time_bounds == (GAP / SPEED, GAP / SPEED)
    assert found.status is Status.CONTACT
    assert found.stats.pops < FEW_POPS
    # Triangles are tested sixteen pairs at a time, until the planes are looked at.
    assert found.stats.triangle_tests < FEW_POPS // 10
    assert found.stats.exact_triangle_tests < 10


@pytest.mark.parametrize("vertex", [0, 77, 1300, 2600])
@pytest.mark.parametrize("by", [2.0**-54, 2.0**-40, 2.0**-20])
@pytest.mark.parametrize("of_b", [False, True])
def test_the_one_vertex_ahead_of_thousands_is_found(vertex, by, of_b):
    plain, odd = slanted(), slanted(vertex, -by if of_b else by)
    a, b = (plain, odd) if of_b else (odd, plain)
    # Of posed vertices, rounded: so little may be lost beside the gap.
    heights = (
        odd.vertices[vertex, 2] + (GAP if of_b else 0),
        plain.vertices[vertex, 2] + (0 if of_b else GAP),
    )
    expected = abs(heights[1] - heights[0]) / SPEED

    found = fall(a, b)

    assert found.time_bounds == (expected, expected)
    if expected < GAP / SPEED:
        row = found.triangle_b if of_b else found.triangle_a
        assert vertex in odd.triangles[row]


@pytest.mark.parametrize("by", [2.0**-54, 2.0**-20])
def test_a_vertex_behind_changes_nothing(by):
    found = fall(slanted(1300, -by), slanted())

    assert found.time_bounds == (GAP / SPEED, GAP / SPEED)


def test_ties_of_growing_trees_are_those_of_whole_ones():
    mesh = slanted()
    grown, whole = (
        fall(ObbTree.build(mesh, lazy=lazy), ObbTree.build(mesh, lazy=lazy))
        for lazy in (True, False)
    )

    assert grown.time_bounds == whole.time_bounds
    assert (grown.triangle_a, grown.triangle_b) == (whole.triangle_a, whole.triangle_b)
    assert grown.stats[:4] == whole.stats[:4]


@pytest.mark.parametrize("exponent", [-900, 900])
def test_ties_are_proven_in_any_unit(exponent):
    pair = HOSTILE["stacked grids"](TRIANGLES)
    unit = 2.0**exponent
    mesh = Mesh(unit * pair.a.vertices, pair.a.faces)
    mover = Body(mesh, Pose(translation=(0, 0, unit * GAP)), Motion((0, 0, -unit * SPEED)))

    found = first_contact(mesh, mover)

    assert found.time_bounds == (GAP / SPEED, GAP / SPEED)
    assert found.stats.pops < FEW_POPS


def test_bodies_that_meet_in_two_vertices_are_parted_across_their_motion():
    # Two fans of spikes, tip to tip: thousands of triangles share either tip.
    angle = np.linspace(0, 2 * np.pi, TRIANGLES + 1)
    rim = np.stack([np.cos(angle), np.sin(angle), np.full(angle.shape, -1.0)], axis=1)
    vertices = np.concatenate([np.zeros((1, 3)), rim])
    k = np.arange(TRIANGLES)
    faces = np.stack([np.zeros(TRIANGLES, dtype=int), 1 + k, 2 + k], axis=1)
    up, down = Mesh(vertices, faces), Mesh(-vertices, faces)

    found = fall(up, down)

    assert found.time_bounds == (GAP / SPEED, GAP / SPEED)
    assert found.stats.pops < FEW_POPS


@pytest.mark.parametrize("slide", [(0.5, 0.25), (-0.125, 0.5), (0.03125, 0.0)])
def test_plates_turned_anyhow_land_without_a_search_of_all_their_pairs(slide):
    # Rounding moves every vertex of the turned plate: no two are as early as each other.
    pair = POSE_CLASSES["plates"](10_000)
    a, b = (Mesh(surface.vertices, surface.faces) for surface in (pair.a, pair.b))
    velocity = np.array([*slide, -2 * PLATE_GAP])

    found = first_contact(a, Body(b, Pose(pair.rotation, pair.translation), Motion(velocity)))

    assert found.status is Status.CONTACT
    assert found.stats.pops < FEW_POPS // 20
