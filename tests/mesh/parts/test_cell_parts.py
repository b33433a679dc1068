"""Parts of cells joined to one surface: as each would be alone, one after the other."""

from __future__ import annotations

import numpy as np
from mesh_files.cell_files import CUBE

from obbcli.mesh.formats.cells.parts import CellPart, joined_surface
from obbcli.mesh.formats.cells.surface import Block, surface
from obbcli.mesh.source import Source


def source():
    return Source("a", "a", b"")


def test_parts_have_the_surface_that_each_has_alone():
    tetras = [Block("tetra", np.array([[0, 1, 2, 5]])), Block("tetra", np.array([[0, 2, 3, 7]]))]
    mixed = [
        Block("quad", np.array([[0, 1, 2, 3], [4, 5, 6, 7]]), np.array([1, 3])),
        Block("triangle", np.array([[0, 1, 4], [1, 2, 5]]), np.array([2, 0])),
        Block("hexahedron", np.arange(8).reshape(1, 8), np.array([4])),
    ]
    parts = [
        CellPart("a", CUBE, tetras),
        CellPart("b", CUBE + 5, mixed),
        CellPart("c", CUBE, tetras),
    ]

    points, triangles = joined_surface(source(), parts)

    alone = [surface(source(), part.points, part.blocks) + 8 * k for k, part in enumerate(parts)]
    np.testing.assert_array_equal(points, np.concatenate([CUBE, CUBE + 5, CUBE]))
    np.testing.assert_array_equal(triangles, np.concatenate(alone))


def test_notes_count_all_parts():
    told = source()
    part = CellPart("a", CUBE, [Block("tetra", np.array([[0, 1, 2, 5]]))])

    joined_surface(told, [part, part._replace(name="b")])

    assert told.notes == ["2 volume cells taken as their boundary"]


def test_parts_without_cells_leave_their_points():
    points, triangles = joined_surface(source(), [CellPart("a", CUBE, [])])

    assert len(points) == 8
    assert triangles.shape == (0, 3)
