"""`notes`: what Python is told of units and changes, and that it costs no pass over a surface."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from obbcli import Body, Mesh, MeshError, MotionError, ObbTree, Pose, notes
from obbcli.mesh import measure
from obbcli.questions.notes import unit_notes

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]

SIZES = "is one of them in another unit? See Mesh.in_unit, Mesh.scaled"


def solid(factor=1.0, unit=None, shift=0.0, told=()):
    return Mesh(CORNERS * factor + shift, FACES, unit=unit, notes=told)


def kinds(mesh, tmp_path):
    """Return a mesh as each kind of shape that is taken."""
    tree = ObbTree.build(mesh)
    tree.save(tmp_path / "t.obbt")
    return {
        "mesh": mesh,
        "lazy": ObbTree.build(mesh),
        "whole": ObbTree.build(mesh, lazy=False),
        "bytes": ObbTree.from_bytes(tree.to_bytes()),
        "opened": ObbTree.open(tmp_path / "t.obbt"),
        "path": tmp_path / "t.obbt",
        "body": Body(mesh, Pose(translation=[1e6, 0, 0])),
    }


KINDS = ("mesh", "lazy", "whole", "bytes", "opened", "path", "body")


@pytest.mark.parametrize("kind", KINDS)
def test_sizes_more_than_500_apart_are_told(tmp_path, kind):
    large = kinds(solid(1000.0), tmp_path)[kind]

    assert notes(large, solid()) == (f"A: is 1,000 times the size of B: {SIZES}",)
    assert notes(solid(), large) == (f"B: is 1,000 times the size of A: {SIZES}",)
    assert notes(solid(2.001), large) == ()


@pytest.mark.parametrize("kind", KINDS)
def test_a_unit_beside_none_is_told(tmp_path, kind):
    shape = kinds(solid(unit="m"), tmp_path)[kind]
    told = "states no unit of length, {} is in m: see Mesh.in_unit, Mesh.scaled"

    assert notes(shape, solid()) == (f"B: {told.format('A')}",)
    assert notes(solid(), shape) == (f"A: {told.format('B')}",)
    assert notes(shape, solid(unit="m")) == ()


@pytest.mark.parametrize("kind", KINDS)
def test_two_units_are_refused(tmp_path, kind):
    with pytest.raises(MeshError, match="A is in mm, B in m"):
        notes(kinds(solid(unit="mm"), tmp_path)[kind], solid(unit="m"))


@pytest.mark.parametrize("kind", KINDS)
def test_what_files_were_taken_with_is_told(tmp_path, kind):
    shape = kinds(solid(told=["was turned"]), tmp_path)[kind]

    assert notes(shape, solid()) == ("A: was turned",)
    assert notes(solid(), shape) == ("B: was turned",)


def test_what_is_no_shape_is_refused():
    with pytest.raises(MotionError, match="shape"):
        notes(solid(), 5)
    with pytest.raises(MeshError, match="no such file"):
        notes("lost.stl", solid())


@pytest.mark.parametrize("shift", [0.0, -3.0, 1e9])
@pytest.mark.parametrize("ratio", [1.0, 499.0, 501.0, 1e-3, 1e300])
def test_offsets_hide_no_size(shift, ratio):
    """Coordinates far from the origin tell little of a size; then it is measured."""
    a, b = solid(shift=shift), solid(ratio)
    wide = max(a.size, b.size) / min(a.size, b.size)

    assert bool(notes(ObbTree.build(a), ObbTree.build(b))) == (wide > 500)


def test_a_size_of_zero_is_no_mistake_of_units():
    point = Mesh([[1, 2, 3]] * 3, [[0, 1, 2]])

    assert notes(point, solid()) == notes(ObbTree.build(point), ObbTree.build(solid())) == ()


def test_trees_of_like_size_are_not_passed_over(monkeypatch):
    trees = ObbTree.build(solid()), ObbTree.build(solid(3.0))
    monkeypatch.setattr(measure, "bounds", lambda *_: pytest.fail("a pass over the surface"))

    assert unit_notes(trees, "") == ((), ())


points = st.tuples(*[st.floats(-1e308, 1e308)] * 3)


@given(st.lists(points, min_size=3, max_size=9), st.booleans())
def test_bounds_of_sizes_hold_them(vertices, is_lazy):
    rows = np.arange(len(vertices) // 3 * 3).reshape(-1, 3)
    mesh = Mesh(vertices, rows)

    low, high = ObbTree.build(mesh, lazy=is_lazy).size_bounds()

    size = Mesh(vertices, rows).size
    assert low <= size * (1 + 1e-12)
    assert size <= high * (1 + 1e-12)


def test_many_triangles_are_sampled():
    rng = np.random.default_rng(5)
    mesh = Mesh(rng.normal(size=(3000, 3)), np.arange(3000).reshape(-1, 3))

    low, high = ObbTree.build(mesh).size_bounds()

    assert 0.5 * mesh.size < low <= mesh.size <= high < 4 * mesh.size
