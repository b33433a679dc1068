"""VTK files of every kind of data set, against values by hand and VTK's own cells."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

vtk_files = pytest.importorskip("vtk_files", reason="needs the package vtk", exc_type=ImportError)

CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
TWO_CUBES = [*CUBE, (2, 0, 0), (2, 1, 0), (2, 0, 1), (2, 1, 1)]
TETRA_FACES = [[0, 2, 1], [0, 1, 4], [1, 2, 4], [2, 0, 4]]
DATA_SETS = {
    "grid": lambda: vtk_files.grid(
        TWO_CUBES,
        [
            *((12, list(range(8))), (3, [0, 6]), (12, [1, 8, 9, 2, 5, 10, 11, 6])),
            *((5, [0, 1, 6]), (1, [3]), (9, [0, 3, 7, 4]), (7, [8, 9, 11, 10])),
        ],
    ),
    "voxels": lambda: vtk_files.grid(
        TWO_CUBES, [(11, [0, 1, 3, 2, 4, 5, 7, 6]), (8, [8, 9, 10, 11])]
    ),
    "surface": lambda: vtk_files.poly_data(CUBE, [[0, 1, 2, 3], [4, 5, 6]], lines=[[0, 6]]),
    "strips": lambda: vtk_files.poly_data(CUBE, strips=[[0, 1, 3, 2, 7, 6]]),
    "image": lambda: vtk_files.image((3, 4, 2)),
    "moved image": lambda: vtk_files.image((3, 2, 2), (5, -3, 1)),
    "flat image": lambda: vtk_files.image((3, 1, 4)),
    "rectilinear": lambda: vtk_files.rectilinear([0, 1, 4], [2, 3], [-1, 0, 0.5]),
    "structured": lambda: vtk_files.structured((4, 3, 2)),
    "flat structured": lambda: vtk_files.structured((4, 3, 1)),
}
#: VTK gives a strip no faces: its triangles are held by hand.
OF_FACES = [name for name in DATA_SETS if name != "strips"]


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


@pytest.mark.parametrize(("binary", "version"), vtk_files.LEGACY)
@pytest.mark.parametrize("name", OF_FACES)
def test_legacy_files_give_the_faces_that_vtk_has(name, binary, version, tmp_path):
    data_set = DATA_SETS[name]()

    mesh = load_mesh(vtk_files.write_legacy(tmp_path / "a.vtk", data_set, binary, version))

    require_same_faces(mesh, data_set)


@pytest.mark.parametrize(("mode", "compressor"), vtk_files.XML)
@pytest.mark.parametrize("name", OF_FACES)
def test_xml_files_give_the_faces_that_vtk_has(name, mode, compressor, tmp_path):
    data_set = DATA_SETS[name]()

    mesh = load_mesh(vtk_files.write_xml(tmp_path, data_set, mode, compressor))

    require_same_faces(mesh, data_set)


@pytest.mark.parametrize(("mode", "compressor"), vtk_files.XML)
def test_legacy_and_xml_files_are_the_same_mesh(mode, compressor, tmp_path):
    for make in DATA_SETS.values():
        legacy = load_mesh(vtk_files.write_legacy(tmp_path / "a.vtk", make(), True, 51))
        xml = load_mesh(vtk_files.write_xml(tmp_path, make(), mode, compressor))

        assert np.array_equal(legacy.vertices, xml.vertices)
        assert np.array_equal(legacy.triangles, xml.triangles)
        assert legacy.notes == xml.notes


def test_strips_are_triangles_turned_alike(tmp_path):
    data_set = DATA_SETS["strips"]()

    mesh = load_mesh(vtk_files.write_legacy(tmp_path / "a.vtk", data_set, False, 42))

    assert mesh.triangles.tolist() == [[0, 1, 3], [3, 1, 2], [3, 2, 7], [7, 2, 6]]
    assert mesh.notes == ("1 triangle strip taken as 4 triangles",)


@pytest.mark.parametrize("name", ["image", "moved image", "rectilinear", "structured", "grid"])
def test_boundaries_of_volumes_close_and_face_outwards(name, tmp_path):
    data_set = DATA_SETS[name]() if name != "grid" else vtk_files.grid(CUBE, [(12, [*range(8)])])

    mesh = load_mesh(vtk_files.write_legacy(tmp_path / "a.vtk", data_set, True, 51))

    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    assert mesh.is_watertight
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0
    assert mesh.notes[0].endswith("taken as their boundary") or name == "grid"


def test_images_stand_where_origin_spacing_and_extent_put_them(tmp_path):
    path = vtk_files.write_xml(tmp_path, DATA_SETS["moved image"](), "ascii", "none")

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
    data_set.SetPoints(vtk_files.points_of(CUBE))
    stream = [4, *(number for face in TETRA_FACES for number in (3, *face))]
    data_set.InsertNextCell(42, vtk_files.ids_of(stream))

    mesh = load_mesh(vtk_files.write_xml(tmp_path, data_set, "ascii", "none"))

    assert sorted(mesh.triangles.tolist()) == sorted(TETRA_FACES)
    assert mesh.notes == ("1 volume cell taken as its boundary",)


def test_ghost_cells_are_left_out_and_told(tmp_path):
    data_set = DATA_SETS["grid"]()
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
    data_set = DATA_SETS["grid"]()
    for data in (data_set.GetPointData(), data_set.GetCellData(), data_set.GetFieldData()):
        values = vtk_files.numpy_to_vtk(np.arange(12.0 if data is not None else 1), deep=True)
        values.SetName("result")
        data.AddArray(values)
    plain = load_mesh(vtk_files.write_legacy(tmp_path / "b.vtk", DATA_SETS["grid"](), True, 51))
    data_set.GetCellData().GetArray("result").SetNumberOfTuples(7)

    for path in (
        vtk_files.write_xml(tmp_path, data_set, "appended", "zlib"),
        vtk_files.write_legacy(tmp_path / "a.vtk", data_set, True, 51),
        vtk_files.write_legacy(tmp_path / "c.vtk", data_set, False, 42),
    ):
        assert load_mesh(path).triangles.tolist() == plain.triangles.tolist()


@pytest.fixture
def _without_vtk(monkeypatch):
    """Hides VTK, as where it is not installed."""
    for name in [name for name in sys.modules if name.startswith("vtkmodules")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "vtkmodules", None)


@pytest.mark.usefixtures("_without_vtk")
@pytest.mark.parametrize("name", DATA_SETS)
def test_without_vtk_the_refusal_names_it(name, tmp_path, request):
    request.getfixturevalue("monkeypatch").undo()
    paths = [vtk_files.write_xml(tmp_path, DATA_SETS[name](), "ascii", "none")]
    paths.append(vtk_files.write_legacy(tmp_path / "a.vtk", DATA_SETS[name](), False, 42))
    request.getfixturevalue("monkeypatch").setattr("obbcli.mesh.formats.vtk.has_vtk", lambda: False)

    for path in paths:
        if name in ("grid", "voxels"):
            continue
        with pytest.raises(MeshError, match=r"needs VTK.*; install it: pip install vtk"):
            load_mesh(path)


@pytest.mark.usefixtures("_without_vtk")
def test_vtk_that_cannot_be_imported_is_not_there():
    from obbcli.mesh.formats.vtk_library import has_vtk

    assert not has_vtk()


def test_vtk_is_asked_for_its_reading_modules_alone(tmp_path):
    path = vtk_files.write_xml(tmp_path, DATA_SETS["grid"](), "ascii", "none")
    code = (
        f"import sys\nfrom obbcli.mesh import load_mesh\nload_mesh({str(path)!r})\n"
        "print(*sorted(name for name in sys.modules if name.startswith('vtkmodules.vtk')))\n"
        "print(open('/proc/self/maps').read())\n"
    )

    child = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    names = child.stdout.splitlines()[0].split()
    assert not [name for name in names if re.search("Rendering|OpenGL|Interaction|Web", name)]
    assert not re.search("libGL|libX11|OpenGL", child.stdout)


def test_complaints_of_vtk_are_one_error_and_nothing_else(tmp_path, capfd, monkeypatch):
    from obbcli.mesh.formats import vtk_library

    path = vtk_files.write_legacy(tmp_path / "a.vtk", DATA_SETS["grid"](), False, 42)
    cut = path.read_bytes()[:150]

    with pytest.raises(MeshError, match=r"VTK cannot read it whole: .*; export it again") as caught:
        vtk_library.legacy_data_set(vtk_library_source(cut), cut)

    assert capfd.readouterr() == ("", "")
    assert not re.search(r"\.cxx|0x", str(caught.value))


def vtk_library_source(data):
    from obbcli.mesh.source import Source

    return Source("x", "x", data, Path("x"))
