"""The touch band: from the coordinates' own spacing, their placement and both sags."""

from __future__ import annotations

import numpy as np
import pytest
from movers.meshes import box

import obbcli
from obbcli import Body, Mesh, Pose

UNIT = box((0, 0, 0), (1, 1, 1))
FAR = box((3, 0, 0), (4, 1, 1))
SIZE = 3**0.5


def band(a, b, **asked):
    return obbcli.overlap(a, b, **asked).band


def inexact(mesh):
    """Return a mesh with coordinates that no single precision holds."""
    return mesh[0] + np.pi * 1e-3, mesh[1]


def test_doubles_have_the_floor_of_the_size() -> None:
    found = band(Mesh(*inexact(UNIT)), Mesh(*inexact(FAR)))

    assert found.gap == found.overlap == pytest.approx(1e-9 * SIZE)
    assert found.slack == pytest.approx(1e-9 * SIZE)
    assert found.reason == "1e-9 of the size of the pair"


def test_coarser_file_decides() -> None:
    single = Mesh(inexact(FAR)[0].astype(np.float32), FAR[1])

    found = band(Mesh(*inexact(UNIT)), single)

    assert found.gap == found.overlap == 4 * np.spacing(np.float32(4))
    assert found.reason == "4 spacings of the coordinates of B (float32)"


def test_scale_of_a_file_scales_its_spacing() -> None:
    single = Mesh(inexact(FAR)[0].astype(np.float32), FAR[1]).scaled(0.3)

    found = band(single, Mesh(*inexact(UNIT)))

    assert found.gap == pytest.approx(4 * 0.3 * np.spacing(np.float32(4)))
    assert found.reason == "4 spacings of the coordinates of A (scaled)"


def test_far_placement_is_a_spacing_too() -> None:
    away = Pose(translation=[2.0**33, 0, 0])

    found = band(Body(Mesh(*inexact(UNIT)), away), Body(Mesh(*inexact(FAR)), away))

    assert found.gap == 4 * 2.0**-19
    assert found.reason == "4 spacings of the coordinates of A (float64, placed)"


def test_sags_are_added() -> None:
    a = Mesh(*inexact(UNIT), sag=0.01)
    b = Mesh(*inexact(FAR), sag=0.002)

    found = band(a, b)

    assert found.gap == pytest.approx(1e-9 * SIZE + 0.012)
    assert found.reason.endswith(", plus the sag of A, plus the sag of B")
    assert band(b, a).gap == found.gap


def test_band_asked_for_is_taken_as_it_is() -> None:
    found = band(Mesh(*UNIT), Mesh(*FAR), touch=(0.25, 0.0))

    assert (found.gap, found.overlap, found.reason) == (0.25, 0.0, "asked for")
