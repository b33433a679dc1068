"""Meshes that are no solids: refused wherever they are, with the edge at fault."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes.solids import joined, shifted, turned_over
from movers.meshes import cube
from strategies.still import examples

import obbcli
from obbcli import Body, Mesh, MeshError, ObbTree, Pose
from obbcli.mesh import topology

VERTICES, FACES = cube()
FACES = FACES.tolist()
CUBE = Mesh(*cube())
OPEN = Mesh(VERTICES, FACES[1:], source="open.stl")


def refusal(a: Any, b: Any, **question: Any) -> MeshError:
    """Return the error of both functions, which is one."""
    with pytest.raises(MeshError) as raised:
        obbcli.first_contact(a, b, solid=True, **question)
    with pytest.raises(MeshError) as again:
        obbcli.collide(a, b, solid=True, **question)
    assert str(again.value) == str(raised.value)
    return raised.value


def test_open_mesh_is_refused_with_an_edge_and_a_remedy():
    error = refusal(OPEN, CUBE)

    assert error.where == "A (open.stl)"
    assert error.fault == (
        "is not watertight: 3 edges do not join two triangles turned alike, such as that from "
        "(-1.0, -1.0, -1.0) to (1.0, 1.0, -1.0) of triangle 0, which has no other triangle"
    )
    assert error.remedy == "mend the mesh, or ask about surfaces, without solid"


def test_triangle_turned_over_is_refused_as_such():
    error = refusal(CUBE, Mesh(VERTICES, [*FACES[:-1], FACES[-1][::-1]]))

    assert error.where == "B"
    assert "whose other triangle is turned over" in error.fault


def test_edge_of_many_triangles_is_refused_as_such():
    neighbours = Mesh(*joined(cube(), shifted(cube(), (2, 2, 0))))

    error = refusal(neighbours, CUBE)

    assert "1 edge does not join two triangles" in error.fault
    assert "which has 4 triangles" in error.fault


def test_mesh_of_collapsed_triangles_is_refused():
    assert "all its triangles are collapsed" in refusal(CUBE, Mesh(VERTICES, [[0, 0, 1]])).fault


@pytest.mark.parametrize("shift", [0.0, 1.0, 2.0, 100.0])
def test_refusal_depends_on_no_pose(shift):
    assert refusal(Body(OPEN, Pose(translation=(shift, 0, 0))), CUBE).where == "A (open.stl)"


def test_tree_over_an_open_mesh_is_refused(tmp_path):
    ObbTree.build(OPEN).save(tmp_path / "tree.obbt")

    assert "of triangle 0" in refusal(CUBE, tmp_path / "tree.obbt").fault


def test_open_mesh_is_asked_about_as_a_surface_without_solid():
    assert not obbcli.collide(Body(OPEN, Pose(translation=(9, 0, 0))), CUBE).collides


def test_mesh_turned_inside_out_is_a_solid():
    inside_out = Mesh(*turned_over(cube(2.0)))

    assert obbcli.collide(CUBE, inside_out, solid=True).contained == "a"


def seams(faces: list[tuple[int, int, int]]) -> tuple[int, list[tuple[int, int, int, int]]]:
    """Return how many edges are at fault, and triangle, corner, along, against of their places."""
    whole = [(row, face) for row, face in enumerate(faces) if len(set(face)) == 3]
    runs = [(face[k], face[(k + 1) % 3], row, k) for row, face in whole for k in range(3)]
    counts = Counter((start, end) for start, end, _, _ in runs)
    bad = [
        (row, k, counts[start, end], counts[end, start])
        for start, end, row, k in runs
        if (counts[start, end], counts[end, start]) != (1, 1)
    ]
    edges = {frozenset(edge) for edge in counts if (counts[edge], counts[edge[::-1]]) != (1, 1)}
    return len(edges), bad


@examples(500)
@given(st.lists(st.tuples(*[st.integers(0, 4)] * 3), min_size=1, max_size=8))
def test_bad_seams_are_counted_and_the_first_is_named(faces):
    corners = np.array(faces, dtype=np.int64)

    found = topology.bad_seams(corners)

    count, places = seams(faces)
    assert found == ((count, places[0]) if places else None)
    if any(len(set(face)) == 3 for face in faces):
        assert (found is None) == topology.is_watertight(corners)
