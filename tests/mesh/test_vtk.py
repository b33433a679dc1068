"""VTK files of every kind of data set, against values by hand and VTK's own cells."""

from __future__ import annotations

import contextlib
from collections import Counter

import numpy as np
import pytest

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

with contextlib.suppress(ImportError):  # of VTK, which need not be there
    from mesh_files import vtk_files

pytestmark = pytest.mark.needs("vtk")

#: Ways to write a legacy file and an XML file.
LEGACY = [(binary, version) for binary in (False, True) for version in (42, 51)]
XML = [
    *(("ascii", "none"), ("binary", "none"), ("binary", "zlib")),
    *(("appended", "none"), ("appended", "zlib"), ("appended raw", "zlib"), ("appended", "lzma")),
]

NAMES = (
    *("grid", "voxels", "surface", "strips", "image", "moved image", "flat image"),
    *("rectilinear", "structured", "flat structured"),
)
TETRA_FACES = [[0, 2, 1], [0, 1, 4], [1, 2, 4], [2, 0, 4]]
#: VTK gives a strip no faces: its triangles are held by hand.
OF_FACES = [name for name in NAMES if name != "strips"]


def test_every_data_set_is_named():
    assert set(NAMES) == set(vtk_files.DATA_SETS)


def faces_of(mesh, data_set):
    """Return our triangles' corners by place, joined to VTK's faces where two are one of its."""
    wanted = vtk_files.faces_by_vtk(data_set)
    places = mesh.vertices.round(vtk_files.DIGITS) + 0.0
    found = Counter()
    for row in mesh.triangles.tolist():
        corners = {tuple(places[k].tolist()) for k in row}
        home = [face for face in wanted if corners <= set(face)]
        assert home, corners
        found.update(home[:1])
    return wanted, found


def require_same_faces(mesh, data_set):
    """Hold a mesh against VTK's faces: each of n corners is n - 2 of its triangles, no other."""
    wanted, found = faces_of(mesh, data_set)

    assert sum(found.values()) == sum(n * (len(face) - 2) for face, n in wanted.items())
    assert set(found) == set(wanted)


@pytest.mark.parametrize(("binary", "version"), LEGACY)
@pytest.mark.parametrize("name", OF_FACES)
def test_legacy_files_give_the_faces_that_vtk_has(name, binary, version, tmp_path):
    data_set = vtk_files.DATA_SETS[name]()

    mesh = load_mesh(vtk_files.write_legacy(tmp_path / "a.vtk", data_set, binary, version))

    require_same_faces(mesh, data_set)


@pytest.mark.parametrize(("mode", "compressor"), XML)
@pytest.mark.parametrize("name", OF_FACES)
def test_xml_files_give_the_faces_that_vtk_has(name, mode, compressor, tmp_path):
    data_set = vtk_files.DATA_SETS[name]()

    mesh = load_mesh(vtk_files.write_xml(tmp_path, data_set, mode, compressor))

    require_same_faces(mesh, data_set)


@pytest.mark.parametrize(("mode", "compressor"), XML)
def test_legacy_and_xml_files_are_the_same_mesh(mode, compressor, tmp_path):
    for make in vtk_files.DATA_SETS.values():
        legacy = load_mesh(vtk_files.write_legacy(tmp_path / "a.vtk", make(), True, 51))
        xml = load_mesh(vtk_files.write_xml(tmp_path, make(), mode, compressor))

        assert np.array_equal(legacy.vertices, xml.vertices)
        assert np.array_equal(legacy.triangles, xml.triangles)
        assert legacy.notes == xml.notes


def test_strips_are_triangles_turned_alike(tmp_path):
    data_set = vtk_files.DATA_SETS["strips"]()

    mesh = load_mesh(vtk_files.write_legacy(tmp_path / "a.vtk", data_set, False, 42))

    assert mesh.triangles.tolist() == [[0, 1, 3], [3, 1, 2], [3, 2, 7], [7, 2, 6]]
    assert mesh.notes == ("1 triangle strip taken as 4 triangles",)


@pytest.mark.parametrize("name", ["image", "moved image", "rectilinear", "structured", "grid"])
def test_boundaries_of_volumes_close_and_face_outwards(name, tmp_path):
    data_set = (
        vtk_files.DATA_SETS[name]()
        if name != "grid"
        else vtk_files.grid(vtk_files.CUBE, [(12, [*range(8)])])
    )

    mesh = load_mesh(vtk_files.write_legacy(tmp_path / "a.vtk", data_set, True, 51))

    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    assert mesh.is_watertight
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0
    assert mesh.notes[0].endswith("taken as their boundary") or name == "grid"


def test_images_stand_where_origin_spacing_and_extent_put_them(tmp_path):
    path = vtk_files.write_xml(tmp_path, vtk_files.DATA_SETS["moved image"](), "ascii", "none")

    mesh = load_mesh(path)

    # Origin 1 -2 0.5, spacing 0.5 0.25 2, points 5 to 7, -3 to -2, 1 to 2.
    assert mesh.bounds.tolist() == [[3.5, -2.75, 2.5], [4.5, -2.5, 4.5]]
    assert len(mesh.vertices) == 12


def test_images_are_turned_by_their_direction(tmp_path):
    data_set = vtk_files.image((2, 3, 2))
    data_set.SetDirectionMatrix(0, -1, 0, 1, 0, 0, 0, 0, 1)

    mesh = load_mesh(vtk_files.write_xml(tmp_path, data_set, "ascii", "none"))

    # x runs along the negative second axis: origin plus -(0.25 * 2) and 0.5.
    assert mesh.bounds.tolist() == [[0.5, -2.0, 0.5], [1.0, -1.5, 2.5]]
    assert mesh.is_watertight


def test_pieces_are_all_read():
    piece = (
        '<Piece NumberOfPoints="3" NumberOfCells="1"><Points><DataArray type="Float64" '
        'NumberOfComponents="3" format="ascii">{0} 0 0 {1} 0 0 {0} 1 0</DataArray></Points><Cells>'
        '<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray>'
        '<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray>'
        '<DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells></Piece>'
    )
    head = '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">'
    text = f"{head}<UnstructuredGrid>{piece.format(0, 1)}{piece.format(10, 11)}"
    data = f"{text}</UnstructuredGrid></VTKFile>".encode()

    mesh = load_mesh_bytes(data, ".vtu")

    assert mesh.triangles.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert mesh.bounds.tolist() == [[0, 0, 0], [11, 1, 0]]


def test_polyhedra_are_cells_of_their_faces(tmp_path):
    data_set = vtk_files.vtkUnstructuredGrid()
    data_set.SetPoints(vtk_files.points_of(vtk_files.CUBE))
    stream = [4, *(number for face in TETRA_FACES for number in (3, *face))]
    data_set.InsertNextCell(42, vtk_files.ids_of(stream))

    mesh = load_mesh(vtk_files.write_xml(tmp_path, data_set, "ascii", "none"))

    assert sorted(mesh.triangles.tolist()) == sorted(TETRA_FACES)
    assert mesh.notes == ("1 volume cell taken as its boundary",)


def test_ghost_cells_are_left_out_and_told(tmp_path):
    data_set = vtk_files.DATA_SETS["grid"]()
    marks = vtk_files.numpy_to_vtk(np.array([0, 0, 1, 0, 0, 0, 32], np.uint8), deep=True)
    marks.SetName("vtkGhostType")
    data_set.GetCellData().AddArray(marks)

    for path in (
        vtk_files.write_xml(tmp_path, data_set, "appended", "zlib"),
        vtk_files.write_legacy(tmp_path / "a.vtk", data_set, True, 51),
    ):
        mesh = load_mesh(path)

        # One cube without the side that a quad covers, the quad and a triangle.
        assert len(mesh.triangles) == 10 + 2 + 1
        assert mesh.bounds.tolist() == [[0, 0, 0], [1, 1, 1]]
        told = "2 cells left out that vtkGhostType marks as copied or hidden"
        assert told in mesh.notes


@pytest.mark.parametrize("kind", [41, 61, 69, 72, 76, 80])
def test_cells_that_are_not_known_are_refused_by_name(kind, tmp_path):
    nodes = {69: 15, 72: 27}.get(kind, 8)
    data_set = vtk_files.grid(np.random.default_rng(1).random((27, 3)), [(kind, [*range(nodes)])])
    path = vtk_files.write_xml(tmp_path, data_set, "ascii", "none")

    with pytest.raises(MeshError, match=rf"of type .*{kind}.* with {nodes} nodes are not read"):
        load_mesh(path)


def test_results_at_points_and_cells_are_passed_over(tmp_path):
    data_set = vtk_files.DATA_SETS["grid"]()
    for data in (data_set.GetPointData(), data_set.GetCellData(), data_set.GetFieldData()):
        values = vtk_files.numpy_to_vtk(np.arange(12.0 if data is not None else 1), deep=True)
        values.SetName("result")
        data.AddArray(values)
    plain = load_mesh(
        vtk_files.write_legacy(tmp_path / "b.vtk", vtk_files.DATA_SETS["grid"](), True, 51)
    )
    data_set.GetCellData().GetArray("result").SetNumberOfTuples(7)

    for path in (
        vtk_files.write_xml(tmp_path, data_set, "appended", "zlib"),
        vtk_files.write_legacy(tmp_path / "a.vtk", data_set, True, 51),
        vtk_files.write_legacy(tmp_path / "c.vtk", data_set, False, 42),
    ):
        assert load_mesh(path).triangles.tolist() == plain.triangles.tolist()
