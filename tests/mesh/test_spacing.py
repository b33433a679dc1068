"""How far apart coordinates are: told by their digits, and kept where they are scaled."""

from __future__ import annotations

import numpy as np
import pytest

from obbcli import Mesh, ObbTree
from obbcli.mesh.spacing import spacing_of

ANGLES = np.linspace(0.1, 6.0, 40)


def fan(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return triangles over points on a circle; every point is used."""
    count = len(points)
    rows = [(0, k, k + 1) for k in range(1, count - 1)]
    return np.asarray(points, dtype=np.float64), np.array(rows, dtype=np.int32)


def circle(radius: float = 25.0) -> np.ndarray:
    return np.stack((np.cos(ANGLES), np.sin(ANGLES), np.sin(3 * ANGLES)), axis=1) * radius


def test_single_precision_is_told_by_its_numbers() -> None:
    points = circle().astype(np.float32)

    found = spacing_of(*fan(points))

    assert found == (np.spacing(np.abs(points).max()), "float32")


def test_doubles_are_told_by_their_numbers() -> None:
    points = circle()

    assert spacing_of(*fan(points)) == (np.spacing(np.abs(points).max()), "float64")


@pytest.mark.parametrize("decimals", [3, 4, 6, 9])
def test_fixed_decimals_of_a_text_are_found(decimals: int) -> None:
    points = np.array([[float(f"{x:.{decimals}f}") for x in row] for row in circle()])

    value, digits = spacing_of(*fan(points))

    assert digits == "decimal"
    assert value == pytest.approx(10.0**-decimals, rel=1e-12)


@pytest.mark.parametrize("digits", [6, 7, 10])
def test_significant_digits_of_a_text_are_found(digits: int) -> None:
    points = np.array([[float(f"{x:.{digits}g}") for x in row] for row in circle()])

    value, kind = spacing_of(*fan(points))

    assert kind == "decimal"
    assert value == pytest.approx(10.0 ** (2 - digits), rel=1e-12)


def test_few_lengths_that_somebody_chose_are_no_rounded_text() -> None:
    points = np.array([[0, 0, 0], [10.1, 0, 0], [0, 10.99999, 0], [0.3, 0.2, 0.7]])

    assert spacing_of(*fan(points))[1] == "float64"


def test_many_lengths_of_few_digits_are_no_rounded_text() -> None:
    """A designed part: lengths to a tenth, many of them, that somebody chose."""
    points = np.array([[float(f"{100 + k / 10:.1f}"), k / 5, 16.1] for k in range(60)])

    assert spacing_of(*fan(points))[1] == "float64"


@pytest.mark.parametrize("scale", [1e-300, 1e-20, 1e20, 1e300])
def test_extreme_coordinates_are_told_without_a_warning(scale: float) -> None:
    points = circle(scale)

    assert spacing_of(*fan(points)) == (np.spacing(np.abs(points).max()), "float64")


def test_scaled_coordinates_keep_the_spacing_of_the_file() -> None:
    mesh = Mesh(*fan(circle().astype(np.float32)))
    own = mesh.coordinate_spacing.value

    scaled = mesh.scaled(1e-3)
    converted = mesh.stated("m").in_unit("mm")

    assert scaled.coordinate_spacing == (own * 1e-3, "scaled")
    assert converted.coordinate_spacing == (own * 1e3, "scaled")
    assert scaled.scaled(1e3).coordinate_spacing.value == own * 1e-3 * 1e3


def test_tree_file_keeps_the_spacing(tmp_path) -> None:
    mesh = Mesh(*fan(circle().astype(np.float32))).scaled(1e-3)
    path = tmp_path / "fan.obbt"
    ObbTree.build(mesh).save(path)

    read = ObbTree.open(path).mesh

    assert read.coordinate_spacing == mesh.coordinate_spacing
