"""Sweeps of solids: row by row what `first_contact` says of solids, and what is refused."""

from __future__ import annotations

import math
from dataclasses import fields

import numpy as np
import pytest
from meshes.surfaces import blob

from obbcli import Accuracy, Body, Mesh, MeshError, Motion, Pose, first_contact, sweep
from obbcli.answers.contact import Contact

SHELL = blob(300, 1)
OUTER = Mesh(SHELL.vertices, SHELL.faces).scaled(4.0)
INNER = Mesh(SHELL.vertices, SHELL.faces).scaled(0.25)
# Inside, across the surface, and outside.
PLACES = {"inside": (0.1, 0, 0), "touching": (3, 0, 0), "outside": (9, 0, 0)}


def moving(count):
    motions = np.random.default_rng(7).normal(size=(count, 9))
    motions[::3, 3:6] = 0.0
    motions[:, 0] -= 4.0
    return motions


def same(value, found):
    if value is None:
        none = np.isnan(found) if np.asarray(found).dtype.kind == "f" else found in ("", -1)
        return bool(np.all(none))
    wanted = getattr(value, "value", value)
    return np.array_equal(found, wanted)


def require_same(row, answer):
    """Compare a row with an answer, bit for bit, but for its counters."""
    low, high = answer.time_bounds or (None, None)
    assert same(low, row["time_lo"])
    assert same(high, row["time_hi"])
    for field in fields(Contact):
        if field.name != "time_bounds":
            assert same(getattr(answer, field.name), row[field.name]), field.name


@pytest.mark.parametrize(
    "accuracy",
    [
        None,
        Accuracy(clearance=0.1),
        Accuracy(method="sampled", steps=9),
        Accuracy(leaves="boxes", max_depth_a=3),
        Accuracy(max_iterations=1),
    ],
    ids=["exact", "clearance", "sampled", "coarse", "one pop"],
)
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("is_swapped", [False, True])
def test_rows_are_those_of_first_contact(accuracy, place, is_swapped):
    small = Body(INNER, Pose((0.3, 0, 0), PLACES[place]))
    a, b = (Body(OUTER), small) if is_swapped else (small, Body(OUTER))
    motions = moving(12)

    rows = sweep(a, b, motions, accuracy=accuracy, solid=True, threads=2)

    for row, numbers in zip(rows, motions, strict=True):
        motion = Motion(numbers[:3], numbers[3:6], numbers[6:])
        answer = first_contact(Body(a.shape, a.pose, motion), b, None, accuracy, solid=True)
        require_same(row, answer)
    # Coarse boxes may meet, and a pop may be too few to know.
    if place == "inside" and accuracy in (None, Accuracy(clearance=0.1)):
        assert set(rows["contained"]) == {"b" if is_swapped else "a"}
        assert set(rows["status"]) == {"overlap_at_start"}
    elif place == "outside":
        assert set(rows["contained"]) == {""}


def test_paths_are_asked_as_solids_where_they_begin():
    away = Motion.through([0, 1], [Pose(None, (9, 0, 0)), Pose(None, (20, 0, 0))])
    inside = Motion.through([0, 1], [Pose(None, (0.1, 0, 0)), Pose(None, (0.2, 0, 0))])

    rows = sweep(INNER, OUTER, [away, inside, Motion((0, 0, 1))], solid=True)

    assert rows["contained"].tolist() == ["", "a", "a"]
    assert rows["status"].tolist() == ["separated", "overlap_at_start", "overlap_at_start"]


def test_surfaces_are_asked_without_it():
    rows = sweep(INNER, OUTER, moving(3) * 1e-9)

    assert rows["status"].tolist() == ["separated"] * 3
    assert math.isnan(rows["time"][0])
    assert set(rows["contained"]) == {""}


def test_meshes_that_do_not_close_are_refused():
    open_ = Mesh(INNER.vertices, INNER.triangles[1:])

    with pytest.raises(MeshError, match="B: is not watertight: 3 edges"):
        sweep(OUTER, open_, moving(3), solid=True)
