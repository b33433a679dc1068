"""ASCII Tecplot files: values by hand from the data format guide."""

from __future__ import annotations

import meshio
import numpy as np
import pytest
from mesh_files.abaqus_decks import area, volume
from mesh_files.cell_files import write

from obbcli.mesh import load_mesh, load_mesh_bytes

HEAD = 'TITLE = "a, b"\nVARIABLES = "X", "Y", "Z"\n'
TRIANGLES = """ZONE T="two", N=4, E=2, F=FEPOINT, ET=TRIANGLE
0 0 0
1 0 0
1 1 0
0 1 0.5
1 2 3
1 3 4
"""
ROWS = TRIANGLES.partition("\n")[2]


def tecplot(text, suffix=".dat"):
    return load_mesh_bytes(text.encode(), suffix)


def test_finite_elements_are_surface_in_the_files_order():
    mesh = tecplot(HEAD + TRIANGLES)

    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]]
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert mesh.notes == ()


BLOCK = "0 1 1 0\n0 0 1 1\n0 0 0 0.5\n1 2 3 1 3 4\n"


@pytest.mark.parametrize(
    "text",
    [
        (HEAD + TRIANGLES).replace("\n", "\r\n"),
        "# first\n\n" + HEAD.lower() + TRIANGLES.lower().replace("1 0 0\n", "1, 0,\t0  # here\n"),
        f"{HEAD}ZONE NODES=4 ELEMENTS=2 DATAPACKING=POINT ZONETYPE=FETRIANGLE\n" + ROWS,
        f'{HEAD}ZONE T = "#1, (a) = \\"b\\""\n N=4\n,E=2,\n F=FEPOINT,ET=TRIANGLE\n' + ROWS,
        f"{HEAD}ZONE N=4, E=2, ZONETYPE=FETRIANGLE\n" + ROWS,
        f"{HEAD}ZONE N=4, E=2, F=FEBLOCK, ET=TRIANGLE\n{BLOCK}",
        f"{HEAD}ZONE N=4, E=2, DATAPACKING=BLOCK, ZONETYPE=FETRIANGLE\n{BLOCK}".replace(
            "0 0 0 0.5", "3*0 .5D0"
        ),
        f"{HEAD}ZONE N=4, E=2, ZONETYPE=FETRIANGLE, DATAPACKING=BLOCK, DT=(SINGLE SINGLE\nDOUBLE)\n"
        f'AUXDATA a = "x = 1"\nAUXDATA b.c="2"\nC=RED STRANDID=1, SOLUTIONTIME=0.5\n{BLOCK}',
        'VARIABLES=X\n"Y [m]"\nZ,"p"\nZONE N=4, E=2, DATAPACKING=BLOCK, ZONETYPE=FETRIANGLE '
        + "VARLOCATION=([4]=CELLCENTERED)\n0 1 1 0 0 0 1 1 0 0 0 0.5 nan 7\n1 2 3 1 3 4\n",
        'VARIABLES=p "CoordinateZ" "CoordinateX" "coordinate_y"\n'
        "ZONE N=4, E=2, F=FEPOINT, ET=TRIANGLE\n"
        "9 0 0 0 9 0 1 0 9 0 1 1 9 .5 0 1\n1 2 3 1 3 4\n",
        f'{HEAD}TEXT X=1, Y=2, T="ZONE of mine"\nGEOMETRY X=0, T=LINE\n1\n2\n0 0\n1 1\n{TRIANGLES}'
        'CUSTOMLABELS "a", "b"\nDATASETAUXDATA c="d"\nVARAUXDATA 1 e="f"\n',
        f"{HEAD}{TRIANGLES}\n\n",
        f"{HEAD}{TRIANGLES}".replace(
            "E=2,", "E=2, FACENEIGHBORMODE=LOCALONETOONE,FACENEIGHBORCONNECTIONS=1,"
        )
        + "1 2 2\n",
    ],
    ids=str,
)
def test_the_same_mesh_may_be_written_in_many_ways(text):
    mesh, expected = tecplot(text), tecplot(HEAD + TRIANGLES)

    np.testing.assert_array_equal(mesh.vertices, expected.vertices)
    np.testing.assert_array_equal(mesh.triangles, expected.triangles)


@pytest.mark.parametrize("suffix", [".dat", ".tec", ".plt"])
def test_every_zone_is_read_with_points_of_its_own(suffix):
    moved = TRIANGLES.replace("0 0 0\n", "0 0 -3\n")

    mesh = tecplot(HEAD + TRIANGLES + moved, suffix)

    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]
    assert mesh.bounds.tolist() == [[0, 0, -3], [1, 1, 0.5]]


CUBE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"


@pytest.mark.parametrize(
    ("kind", "cell", "held"),
    [
        ("TETRAHEDRON", "1 2 4 5", 1 / 6),
        ("BRICK", "1 2 3 4 5 6 7 8", 1),
        ("BRICK", "1 2 4 4 5 6 8 8", 1 / 2),
    ],
)
def test_volumes_give_their_boundary(kind, cell, held):
    mesh = tecplot(f"{HEAD}ZONE N=8, E=1, F=FEPOINT, ET={kind}\n{CUBE}{cell}\n")

    assert mesh.is_watertight
    assert volume(mesh) == pytest.approx(held)


def test_quadrilaterals_that_repeat_a_corner_are_triangles():
    mesh = tecplot(f"{HEAD}ZONE N=8, E=2, F=FEPOINT, ET=QUADRILATERAL\n{CUBE}1 2 3 3\n1 2 3 4\n")

    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3]]


def grid(shape, bend=0.0):
    """Return the points of an ordered zone, the first index running fastest."""
    k, j, i = np.meshgrid(*(np.arange(size) for size in shape[::-1]), indexing="ij")
    points = np.stack([i.ravel(), j.ravel(), k.ravel()], axis=1).astype(float)
    points[:, 2] += bend * points[:, 0] ** 2
    return points


@pytest.mark.parametrize("packing", ["POINT", "BLOCK"])
@pytest.mark.parametrize("shape", [(3, 4, 1), (1, 3, 2), (4, 1, 2)])
def test_ordered_zones_of_two_indices_are_grids(packing, shape):
    points = grid(shape)
    numbers = points if packing == "POINT" else points.T
    rows = "\n".join(" ".join(map(str, row)) for row in numbers.tolist())
    i, j, k = shape

    mesh = tecplot(f"{HEAD}ZONE I={i}, J={j}, K={k}, DATAPACKING={packing}\n{rows}\n")

    cells = np.prod([max(size - 1, 1) for size in shape])
    assert len(mesh.triangles) == 2 * cells
    assert area(mesh) == cells


@pytest.mark.parametrize("flipped", [False, True])
def test_ordered_zones_of_three_indices_are_their_six_sides(flipped):
    points = grid((3, 4, 2)) * ([1, 1, -1] if flipped else 1)
    rows = "\n".join(" ".join(map(str, row)) for row in points.tolist())

    mesh = tecplot(f"{HEAD}ZONE I=3, J=4, K=2, F=POINT\n{rows}\n")

    assert len(mesh.triangles) == 2 * 2 * (2 * 3 + 3 * 1 + 1 * 2)
    assert mesh.is_watertight
    assert volume(mesh) == pytest.approx(2 * 3 * 1)


def test_a_block_of_bricks_and_an_ordered_zone_have_the_same_surface():
    points = grid((4, 3, 3), bend=0.25)
    rows = "\n".join(" ".join(map(str, row)) for row in points.tolist())
    at = np.arange(36).reshape(3, 3, 4)
    corners = [at[:-1, :-1, :-1], at[:-1, :-1, 1:], at[:-1, 1:, 1:], at[:-1, 1:, :-1]]
    corners += [at[1:, :-1, :-1], at[1:, :-1, 1:], at[1:, 1:, 1:], at[1:, 1:, :-1]]
    cells = np.stack([corner.ravel() for corner in corners], axis=1) + 1
    bricks = "\n".join(" ".join(map(str, row)) for row in cells.tolist())

    ordered = tecplot(f"{HEAD}ZONE I=4, J=3, K=3, F=POINT\n{rows}\n")
    element = tecplot(f"{HEAD}ZONE N=36, E=12, F=FEPOINT, ET=BRICK\n{rows}\n{bricks}\n")

    assert len(ordered.triangles) == len(element.triangles)
    assert volume(ordered) == pytest.approx(volume(element))
    assert set(ordered.triangles.ravel()) == set(element.triangles.ravel())


def test_variables_and_connectivity_may_be_shared():
    first = (
        f'VARIABLES="X" "Y" "Z" "p"\nZONE N=4, E=2, DATAPACKING=BLOCK, ZONETYPE=FETRIANGLE\n{BLOCK}'
    )
    first = first.replace("\n1 2 3", "\n7 7 7 7\n1 2 3")
    second = (
        "ZONE N=4, E=2, DATAPACKING=BLOCK, ZONETYPE=FETRIANGLE, CONNECTIVITYSHAREZONE=1, "
        "VARSHARELIST=([1-2,4]=1)\n5 5 5 5\n"
    )
    third = "ZONE N=4, E=2, F=FEPOINT, ET=TRIANGLE, D=(1, 2, FECONNECT)\n6 0 6 0 6 0 6 0\n"

    mesh = tecplot(first + second + third)

    assert mesh.triangles.tolist() == [
        [a + k, b + k, c + k] for k in (0, 4, 8) for a, b, c in ((0, 1, 2), (0, 2, 3))
    ]
    assert mesh.vertices[:, 2].tolist() == [0, 0, 0, 0.5, *[5] * 4, *[6] * 4]
    np.testing.assert_array_equal(mesh.vertices[4:8, :2], mesh.vertices[:4, :2])


def test_cell_centred_and_passive_variables_take_no_place_of_points():
    text = (
        'VARIABLES="X" "Y" "Z" "a" "b" "c"\nZONE N=4, E=2, DATAPACKING=BLOCK, ZONETYPE=FETRIANGLE, '
        "VARLOCATION=([4,6]=CELLCENTERED, [1-3]=NODAL), PASSIVEVARLIST=[5]\n"
    )

    mesh = tecplot(text + BLOCK.replace("\n1 2 3", "\n8 8\n9 9\n1 2 3"))

    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_zones_without_surface_are_passed_over_and_told():
    line = "ZONE N=2, E=1, F=FEPOINT, ET=LINESEG\n0 0 0\n9 9 9\n1 2\n"
    curve = 'ZONE T="curve", I=2, F=POINT\n8 8 8\n7 7 7\n'

    empty = "ZONE N=0, E=0, F=FEPOINT, ET=TRIANGLE\nZONE I=0, J=0, K=1, F=POINT\n"

    mesh = tecplot(HEAD + line + curve + "ZONE\n1 1 1\n2 2 2\n" + empty + TRIANGLES)

    assert len(mesh.triangles) == 2
    assert mesh.notes == ("5 zones of points or lines passed over: no surface",)


def test_flat_files_lie_at_height_zero_and_say_so():
    text = 'VARIABLES = "X", "Y", "P"\nZONE N=4, E=1, F=FEPOINT, ET=QUADRILATERAL\n'

    mesh = tecplot(text + "0 0 5\n2 0 5\n2 1 5\n0 1 5\n1 2 3 4\n")

    assert mesh.bounds.tolist() == [[0, 0, 0], [2, 1, 0]]
    assert mesh.notes == ("no variable is Z: taken at z = 0",)


def test_the_same_mesh_at_several_times_is_taken_once():
    times = [TRIANGLES.replace("N=4", f"STRANDID=3, SOLUTIONTIME={t}, N=4") for t in (0, 1, 2)]

    mesh = tecplot(HEAD + "".join(times))

    assert len(mesh.triangles) == 2
    assert mesh.notes == ("2 zones of other solution times with the same mesh taken once",)


@pytest.mark.parametrize("name", ["a.dat", "a.tec"])
@pytest.mark.parametrize("kind", ["triangle", "quad", "tetra", "hexahedron"])
def test_files_that_meshio_writes_are_read_as_it_reads_them(tmp_path, name, kind):
    count = {"triangle": 3, "quad": 4, "tetra": 4, "hexahedron": 8}[kind]
    rows = [0, 1, 3, 4] if kind == "tetra" else list(range(count))
    path = write(tmp_path / name, [(kind, np.array([rows]))])

    mesh, other = load_mesh(path), meshio.read(path)

    np.testing.assert_array_equal(mesh.vertices, other.points)
    np.testing.assert_array_equal(other.cells[0].data[:, :count], [rows])
    assert set(mesh.triangles.ravel().tolist()) == set(rows)


@pytest.mark.needs("vtk")
def test_zones_are_those_that_vtk_reads(tmp_path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
    from vtkmodules.vtkIOGeometry import vtkTecplotReader

    rows = "\n".join(" ".join(map(str, row)) for row in grid((3, 4, 2), bend=0.25).tolist())
    cell = "1 2 3 4 5 6 7 8"
    path = tmp_path / "a.tec"
    path.write_text(
        f"{HEAD}{TRIANGLES}ZONE N=8, E=1, F=FEPOINT, ET=BRICK\n{CUBE}{cell}\n"
        f"ZONE I=3, J=4, K=2, F=POINT\n{rows}\n"
    )
    reader = vtkTecplotReader()
    reader.SetFileName(str(path))
    reader.Update()
    zones = [reader.GetOutput().GetBlock(at) for at in range(3)]
    outsides = []
    for zone in zones:
        outside = vtkGeometryFilter()
        outside.SetInputData(zone)
        outside.Update()
        outsides.append(outside.GetOutput())

    mesh = load_mesh(path)

    points = np.concatenate([vtk_to_numpy(zone.GetPoints().GetData()) for zone in zones])
    np.testing.assert_allclose(mesh.vertices, points, rtol=1e-6)
    counts = [
        sum(each.GetCell(at).GetNumberOfPoints() - 2 for at in range(each.GetNumberOfCells()))
        for each in outsides
    ]
    ends = np.cumsum([zone.GetNumberOfPoints() for zone in zones])
    found = np.bincount(np.searchsorted(ends, mesh.triangles[:, 0], side="right"))
    assert found.tolist() == counts
