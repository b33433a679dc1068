"""Finite elements through meshio: boundaries of volumes, and what meshio lets through."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from mesh_files.cell_files import CUBE, HEXAHEDRON, POINTS, SURFACE_KINDS, VOLUME_KINDS, write

from obbcli.errors import MeshError
from obbcli.mesh import Mesh, load_mesh
from obbcli.mesh.formats.cells import surface as cell_surface
from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.source import Source


def surface(cells, points):
    """Return the triangles of cells, (kind, rows) each."""
    return cell_surface.surface(Source("x", "x", b""), points, [Block(*cell) for cell in cells])


def volume(mesh):
    """Return the signed volume within a closed surface: positive if it is turned outwards."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


@pytest.mark.parametrize(("name", "options"), SURFACE_KINDS)
def test_cells_load_triangles_in_the_files_order(tmp_path, name, options):
    sphere = trimesh.creation.icosphere(subdivisions=1)
    cells = [("triangle", np.array(sphere.faces))]
    path = write(tmp_path / name, cells, sphere.vertices, **options)

    mesh = load_mesh(path)

    np.testing.assert_array_equal(mesh.triangles, sphere.faces)
    np.testing.assert_allclose(mesh.vertices, sphere.vertices, atol=1e-12)


@pytest.mark.parametrize(("name", "options"), VOLUME_KINDS)
def test_cells_give_the_boundary_of_tetrahedra(tmp_path, name, options):
    cells = [("tetra", np.array([[0, 1, 2, 4], [1, 2, 4, 5]]))]
    path = write(tmp_path / name, cells, CUBE[[0, 1, 3, 2, 4, 7]], **options)
    twin = surface(cells, CUBE[[0, 1, 3, 2, 4, 7]])

    mesh = load_mesh(path)

    assert len(mesh.triangles) == 6
    assert {frozenset(row) for row in mesh.triangles.tolist()} == {
        frozenset(row) for row in twin.tolist()
    }


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        ([("tetra", [[0, 1, 3, 4]])], 1 / 6),
        ([("hexahedron", HEXAHEDRON)], 1.0),
        ([("wedge", [[0, 3, 1, 4, 7, 5]])], 0.5),
        ([("pyramid", [[4, 5, 6, 7, 8]])], 1 / 3),
        ([("hexahedron", HEXAHEDRON), ("pyramid", [[4, 5, 6, 7, 8]])], 4 / 3),
        ([("wedge", [[0, 3, 1, 4, 7, 5], [1, 3, 2, 5, 7, 6]])], 1.0),
    ],
)
def test_boundary_of_volume_cells_is_closed_and_turned_outwards(cells, expected):
    triangles = surface([(name, np.array(rows)) for name, rows in cells], POINTS)
    mesh = Mesh(POINTS, triangles)

    assert mesh.is_watertight
    assert volume(mesh) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("kind", "row"),
    [
        ("tetra", [0, 1, 3, 4]),
        ("tetra", [1, 0, 3, 4]),
        ("wedge", [0, 1, 3, 4, 5, 7]),
        ("wedge", [0, 3, 1, 4, 7, 5]),
        ("hexahedron", [4, 5, 6, 7, 0, 1, 2, 3]),
        ("pyramid", [7, 6, 5, 4, 8]),
    ],
)
@pytest.mark.parametrize("scale", [1.0, 1e-300, 1e300])
def test_boundary_faces_outwards_whichever_way_cells_are_numbered(kind, row, scale):
    triangles = surface([(kind, np.array([row]))], POINTS * scale)

    assert volume(Mesh(POINTS, triangles)) > 0


def test_boundary_puts_surface_cells_first_and_repeats_none_of_them():
    tetra = [("tetra", np.array([[0, 1, 3, 4]]))]
    alone = surface(tetra, POINTS)
    given = np.array([[4, 3, 1], [5, 6, 7]])

    both = surface([*tetra, ("triangle", given)], POINTS)

    assert both[:2].tolist() == given.tolist()
    assert both[2:].tolist() == [r for r in alone.tolist() if set(r) != {4, 3, 1}]


def test_boundary_keeps_quads_as_two_neighbouring_triangles_and_polygons_as_fans():
    quads = [
        ("quad", np.array([[0, 1, 2, 3], [4, 5, 6, 7]])),
        ("polygon", np.array([[0, 1, 2, 3, 4]])),
    ]

    assert surface(quads, POINTS).tolist() == [
        [0, 1, 2],
        [0, 2, 3],
        [4, 5, 6],
        [4, 6, 7],
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
    ]


def test_boundary_takes_a_quad_with_a_repeated_corner_for_a_triangle():
    assert surface([("quad", np.array([[0, 1, 2, 2]]))], POINTS).tolist() == [[0, 1, 2]]


def test_boundary_of_polyhedra_is_what_one_cell_alone_has():
    cube = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    roof = [[4, 7, 6, 5], [4, 5, 8], [5, 6, 8], [6, 7, 8], [7, 4, 8]]

    mesh = Mesh(POINTS, surface([("polyhedron", [cube]), ("polyhedron", [roof])], POINTS))

    assert len(mesh.triangles) == 10 + 4
    assert mesh.is_watertight
    assert volume(mesh) == pytest.approx(4 / 3)


def test_boundary_of_a_collapsed_hexahedron_meets_its_neighbour():
    wedge = [0, 1, 2, 2, 4, 5, 6, 6]  # a hexahedron whose fourth edge fell into its third
    other = [0, 2, 3, 4, 6, 7]

    cells = [("hexahedron", np.array([wedge])), ("wedge", np.array([other]))]
    mesh = Mesh(POINTS, surface(cells, POINTS))

    assert mesh.is_watertight
    assert volume(mesh) == pytest.approx(1.0)


def test_boundary_ignores_points_and_lines_and_refuses_unknown_cells():
    thin = [("vertex", np.array([[0]])), ("line3", np.array([[0, 1, 2]]))]

    assert len(surface(thin, POINTS)) == 0
    with pytest.raises(MeshError, match="x: cells of type hexa_wedge are not read; convert them"):
        surface([("hexa_wedge", np.array([[0] * 12]))], POINTS)
    with pytest.raises(MeshError, match="cells of type tetra with 5 nodes are not read"):
        surface([("tetra", np.array([[0, 1, 2, 3, 4]]))], POINTS)


@pytest.mark.parametrize("bad", [-1, 9])
@pytest.mark.parametrize("kind", ["triangle", "tetra", "polygon", "polyhedron"])
def test_boundary_refuses_points_that_are_not_there(kind, bad):
    rows = {"triangle": [[0, 1, bad]], "tetra": [[0, 1, 3, bad]], "polygon": [[0, 1, 2, 3, bad]]}
    cells = rows.get(kind, [[[0, 1, 2], [0, 1, bad]]])

    with pytest.raises(MeshError, match=f"{kind}.* uses point {bad} of 9"):
        surface([(kind, cells)], POINTS)


def test_boundary_keeps_the_order_of_the_file_among_blocks():
    triangles = Block("triangle", np.array([[0, 1, 2], [4, 5, 6]]), np.array([3, 0]))
    quads = Block("quad", np.array([[0, 1, 5, 4], [1, 2, 6, 5]]), np.array([1, 2]))

    found = cell_surface.surface(Source("x", "x", b""), POINTS, [triangles, quads])

    quad_rows = [[0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5]]
    assert found.tolist() == [[4, 5, 6], *quad_rows, [0, 1, 2]]


def test_cells_lay_flat_meshes_at_zero(tmp_path):
    path = write(tmp_path / "flat.mesh", [("triangle", [[0, 1, 2]])], CUBE[:, :2])

    assert load_mesh(path).vertices[:, 2].tolist() == [0.0] * 8
