"""Units of length: exact ratios by rational arithmetic, what is stated, what is kept."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from obbcli import Mesh, MeshError, ObbTree, collide

#: By definition: an inch is 25.4 mm, a foot 12 inches.
METRES = {
    "m": Fraction(1),
    "cm": Fraction(1, 100),
    "mm": Fraction(1, 1000),
    "um": Fraction(1, 10**6),
    "in": Fraction(254, 10**4),
    "ft": Fraction(3048, 10**4),
}
WORDS = st.sampled_from(sorted(METRES))
LENGTHS = st.floats(2.0**-60, 2.0**60)


def mesh(*numbers, **more):
    return Mesh([numbers[:3], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], **more)


@given(WORDS, WORDS, LENGTHS)
def test_coordinates_in_another_unit_are_rounded_as_the_rule_says(own, unit, length):
    found = float(mesh(length, 0, 0, unit=own).in_unit(unit).vertices[0, 0])

    ratio = METRES[own] / METRES[unit]
    exact = Fraction(length) * ratio
    r = Fraction(float(max(ratio, 1 / ratio)))
    assert found == float(Fraction(length) * r if ratio >= 1 else Fraction(length) / r)
    # One rounding where the ratio is a double, two at most elsewhere.
    is_exact = r == max(ratio, 1 / ratio)
    assert abs(Fraction(found) - exact) <= exact * Fraction(1 if is_exact else 2, 2**53) * 2
    assert not is_exact or found == float(exact)


@given(st.integers(-40, 40), st.lists(LENGTHS, min_size=3, max_size=3))
def test_scales_by_powers_of_two_keep_every_bit(exponent, numbers):
    there = mesh(*numbers).scaled(2.0**exponent)

    assert there.vertices.tolist() == np.ldexp(mesh(*numbers).vertices, exponent).tolist()
    assert there.scaled(2.0**-exponent).vertices.tolist() == mesh(*numbers).vertices.tolist()


def test_mesh_of_no_unit_is_taken_to_be_in_the_one_that_is_asked_for():
    found = mesh(1, 2, 3).in_unit("mm")

    assert (found.unit, found.notes) == ("mm", ())
    assert found.vertices.tolist() == mesh(1, 2, 3).vertices.tolist()
    assert mesh(1, 2, 3).unit is None


def test_scaling_is_told_and_keeps_the_rest():
    plain = mesh(1, 2, 3, source="a.glb", sha256="0" * 64, notes=["plain"], unit="m")

    found, by_scale = plain.in_unit("mm"), plain.scaled(3)

    assert found.notes == ("plain", "from m to mm: coordinates times 1000")
    assert (found.source, found.sha256, found.unit) == ("a.glb", "0" * 64, "mm")
    assert (by_scale.notes, by_scale.unit) == (("plain", "coordinates times 3.0"), None)
    assert mesh(1, 2, 3, unit="mm").in_unit("m").notes == (
        "from mm to m: coordinates divided by 1000",
    )


@pytest.mark.parametrize("factor", [0, -1, float("inf"), float("nan"), "2", True, None])
def test_scales_that_are_none_are_refused(factor):
    with pytest.raises(MeshError, match="scale"):
        mesh(1, 2, 3).scaled(factor)


def test_units_that_are_none_and_coordinates_beyond_doubles_are_refused():
    with pytest.raises(MeshError, match="unit: is 'inch'; use one of m, cm, mm, um, in, ft"):
        mesh(1, 2, 3).in_unit("inch")
    with pytest.raises(MeshError, match="is 'ells'"):
        mesh(1, 2, 3, unit="ells").in_unit("m")
    with pytest.raises(MeshError, match="x is inf"):
        mesh(1e308, 2, 3, unit="m").in_unit("mm")


def test_trees_and_their_files_keep_the_unit():
    tree = ObbTree.build(mesh(1, 2, 3, unit="in"))

    found = ObbTree.from_bytes(tree.to_bytes())

    assert (tree.unit, found.unit, found.mesh.unit) == ("in", "in", "in")
    assert b'"unit"' not in ObbTree.build(mesh(1, 2, 3)).to_bytes()


def test_shapes_of_two_units_are_refused():
    a, b = mesh(1, 2, 3, unit="m"), mesh(1, 2, 3, unit="mm")

    with pytest.raises(MeshError, match="unit: A is in m, B in mm; bring both to one: --unit U"):
        collide(a, b)
    assert collide(a, b.in_unit("m")).status
    assert collide(a, mesh(1, 2, 3)).collides
