"""`obbcli.contacts` where faces land on faces: exactly the pairs of the patch."""

from __future__ import annotations

import math
from itertools import takewhile
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from movers.meshes import box
from oracles.plane import figures_gap, figures_meet

import obbcli
from obbcli import Accuracy, Body, Contact, Mesh, Motion, Pose, Status

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

CUBE = Mesh(*box((0, 0, 0), (1, 1, 1)))
CENTER = np.array([0.5, 0.5])
# The cube hangs so high above the plate, sinks by 1 a second, and is shifted by so much.
HEIGHT, SHIFT = 0.5, (0.15625, -0.09375)
HANGING = Pose(translation=(*SHIFT, HEIGHT))


def plate(cells: int) -> Mesh:
    """Return a square at z = 0 from -1 to 2, two triangles a cell."""
    line = -1 + 3 * np.arange(cells + 1) / cells
    x, y = (grid.ravel() for grid in np.meshgrid(line, line, indexing="ij"))
    corner = np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)
    a, b = corner.ravel(), corner.ravel() + cells + 1
    triangles = np.concatenate(([a, b, b + 1], [a, b + 1, a + 1]), axis=1).T
    return Mesh(np.stack((x, y, 0 * x), axis=1), triangles)


def feet(turn: float) -> list[Any]:
    """Return what of each triangle of the cube stands on the plate, turned about its middle."""
    c, s = math.cos(turn), math.sin(turn)
    down = CUBE.vertices[:, :2] - CENTER
    down = down @ np.array([[c, s], [-s, c]]) if turn else down
    down += CENTER + SHIFT
    return [[down[i] for i in triangle if CUBE.vertices[i, 2] == 0] for triangle in CUBE.triangles]


def pairs_where(
    test: Callable[[Any, Any], bool], floor: Mesh, turn: float = 0
) -> set[tuple[int, int]]:
    squares = floor.vertices[floor.triangles][:, :, :2]
    return {
        (i, j)
        for i, foot in enumerate(feet(turn))
        for j, square in enumerate(squares)
        if foot and test(foot, square)
    }


def patch_of(found: Iterator[Contact]) -> list[Contact]:
    """Return those whose bracket overlaps that of the first."""
    first = next(found)
    assert first.time_bounds is not None
    end = first.time_bounds[1]
    assert end is not None
    return [first, *takewhile(lambda contact: contact.time <= end, found)]


def ids(found: Iterator[Contact] | list[Contact]) -> list[tuple[int | None, int | None]]:
    return [(contact.triangle_a, contact.triangle_b) for contact in found]


@pytest.mark.parametrize("cells", [1, 3, 8])
def test_landing_face_meets_the_pairs_under_it_and_no_others(cells: int) -> None:
    floor = plate(cells)
    falling = Body(CUBE, HANGING, Motion((0, 0, -1)))

    patch = patch_of(obbcli.contacts(falling, floor))

    expected = pairs_where(figures_meet, floor)
    assert ids(patch) == sorted(expected)
    assert len(expected) > 2 * cells
    assert {contact.time_bounds for contact in patch} == {(HEIGHT, HEIGHT)}
    assert {contact.evidence for contact in patch} == {"intersecting"}


@pytest.mark.parametrize("spin", [0.75, -2.5, 40.0])
def test_turning_face_lands_on_the_pairs_under_it(spin: float) -> None:
    floor = plate(5)
    pivot = (*(CENTER + SHIFT), 1.0)
    falling = Body(CUBE, HANGING, Motion((0, 0, -1), (0, 0, spin), pivot))
    turn = spin * HEIGHT
    # No pair is so close to the border of the patch that rounding could tell otherwise.
    assert not pairs_where(lambda p, q: abs(figures_gap(p, q)) < 1e-6, floor, turn)

    patch = patch_of(obbcli.contacts(falling, floor))

    assert set(ids(patch)) == pairs_where(figures_meet, floor, turn)
    assert len(patch) == len(set(ids(patch)))
    for contact in patch:
        assert contact.time_bounds is not None
        low, high = contact.time_bounds
        assert high is not None
        assert low - 1e-12 <= HEIGHT <= high + 1e-12
        assert high - low <= 1.0000001e-9


def test_patch_along_a_path_is_that_of_the_fall() -> None:
    floor = plate(5)
    poses = [Pose(translation=(*SHIFT, HEIGHT - t)) for t in (0.0, 0.25, 0.4375, 0.75)]
    falling = Body(CUBE, motion=Motion.through([0, 0.25, 0.4375, 0.75], poses))

    patch = patch_of(obbcli.contacts(falling, floor))

    assert set(ids(patch)) == pairs_where(figures_meet, floor)
    assert all(abs(contact.time - HEIGHT) <= 1e-9 for contact in patch)


def test_clearance_brings_the_patch_forward_and_widens_it() -> None:
    floor = plate(5)
    falling = Body(CUBE, HANGING, Motion((0, 0, -1)))
    clearance = 0.125

    found = list(obbcli.contacts(falling, floor, accuracy=Accuracy(clearance=clearance)))

    first = [contact for contact in found if contact.time <= HEIGHT - clearance]
    assert set(ids(first)) == pairs_where(figures_meet, floor)
    for contact in first:
        assert contact.evidence == "within_tolerance"
        assert contact.distance == pytest.approx(clearance, abs=1e-9)
        assert contact.time == pytest.approx(HEIGHT - clearance, abs=1e-9)


def test_contacts_at_start_come_before_those_of_the_motion() -> None:
    floor = plate(4)
    standing = Body(CUBE, Pose(translation=(*SHIFT, 0)), Motion((0.25, 0, 0)))

    found = list(obbcli.contacts(standing, floor))

    at_start = pairs_where(figures_meet, floor)
    assert ids(found)[: len(at_start)] == sorted(at_start)
    assert all(c.status is Status.OVERLAP_AT_START for c in found[: len(at_start)])
    assert len(found) > len(at_start)
    assert all(c.status is Status.CONTACT and c.time > 0 for c in found[len(at_start) :])
    # The cube slides on: its foot comes to more of the plate when its right side gets there.
    right = SHIFT[0] + 1
    edges = {x for x in -1 + 3 * np.arange(5) / 4 if right < x <= right + 0.25}
    assert {round(contact.time, 9) for contact in found[len(at_start) :]} >= {
        (x - right) / 0.25 for x in edges
    }
