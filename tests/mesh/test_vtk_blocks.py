"""VTK's index of blocks, whose files lie at or below its folder."""

from __future__ import annotations

import contextlib

import pytest

from obbcli import load_parts
from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

with contextlib.suppress(ImportError):  # of VTK, which need not be there
    from mesh_files import vtk_files

pytestmark = pytest.mark.needs("vtk")

INDEX = """<VTKFile type="vtkMultiBlockDataSet" version="1.0">
<vtkMultiBlockDataSet><Block index="0" name="all">
<DataSet index="0" name="first" file="parts/a.vtu"/><DataSet index="1"/>
<Piece index="2"><DataSet index="0" file="parts/a.vtp"/></Piece>
</Block><DataSet index="1" name="again" file="parts/a.vtu"/></vtkMultiBlockDataSet></VTKFile>
"""


@pytest.fixture
def index(tmp_path):
    """Return an index of a cube's grid, a surface of 3 triangles, and the grid again."""
    (tmp_path / "parts").mkdir()
    cube = vtk_files.grid(vtk_files.CUBE, [(12, [*range(8)])])
    vtk_files.write_xml(tmp_path / "parts", cube, "ascii", "none")
    vtk_files.write_xml(tmp_path / "parts", vtk_files.DATA_SETS["surface"](), "ascii", "none")
    (tmp_path / "a.vtm").write_text(INDEX)
    return tmp_path / "a.vtm"


def test_blocks_of_an_index_are_all_read_in_its_order(index):
    mesh = load_mesh(index)

    assert len(mesh.triangles) == 12 + 3 + 12
    assert len(mesh.vertices) == 3 * 8
    assert mesh.triangles[12:15].tolist() == [[8, 9, 10], [8, 10, 11], [12, 13, 14]]
    assert mesh.notes == (
        "a.vtu: 1 volume cell taken as its boundary",
        "3 blocks taken as one surface",
    )


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (
            "parts/a.vtp",
            "../a.vtp",
            r":4: names '\.\./a\.vtp', which is not at or below its folder",
        ),
        ("parts/a.vtp", "/etc/passwd", r":4: names '/etc/passwd', which is not at or below"),
        ("parts/a.vtp", "parts/../../a.vtp", r"which is not at or below its folder"),
        ("parts/a.vtp", "parts\\..\\..\\a.vtp", r"which is not at or below its folder"),
        ("parts/a.vtp", "file:a.vtp", r"which is not at or below its folder"),
        ("parts/a.vtp", "http://x.org/a.vtp", r"which is not at or below its folder"),
        (
            "parts/a.vtp",
            "parts/b.vtp",
            r":4: names 'parts/b\.vtp', which cannot be read: No",
        ),
        ("parts/a.vtp", "a.vtm", r"a\.vtm:1: holds a 'vtkMultiBlockDataSet', which is not read"),
        (
            '<Piece index="2">',
            '<Mesh/><Piece index="2">',
            r":4: <Mesh> is nothing that <Bl",
        ),
        ("</VTKFile>", "", r":6: is no whole XML: no element found; it was cut short"),
        ("<VTKFile", "<!DOCTYPE x><VTKFile", r"declares a document type"),
    ],
)
def test_an_index_names_files_at_or_below_its_folder_alone(old, new, fault, index):
    index.write_text(INDEX.replace(old, new, 1))

    with pytest.raises(MeshError, match=fault):
        load_mesh(index)


def test_an_index_from_a_stream_names_no_files():
    with pytest.raises(MeshError, match=r":3: names the file 'parts/a\.vtu'; name the index"):
        load_mesh_bytes(INDEX.encode(), ".vtm")


def test_blocks_of_an_index_are_parts_by_the_names_above_them(index):
    assembly = load_parts(index)

    assert [part.path for part in assembly] == ["all/first", "all/2/0", "again"]
    assert [len(part.mesh.triangles) for part in assembly] == [12, 3, 12]
    assert assembly.parts[0].mesh is assembly.parts[2].mesh
    assert len(load_mesh(f"{index}#all").triangles) == 15


def test_selected_blocks_are_told_as_those_of_the_whole_file_are(index):
    cells = "a.vtu: 1 volume cell taken as its boundary"

    assert load_mesh(f"{index}#**").notes == load_mesh(index).notes
    assert load_mesh(f"{index}#all").notes == (cells, "2 blocks taken as one surface")
    assert load_mesh(f"{index}#again").notes == (cells,)
    assert load_mesh(f"{index}#all/2").notes == ()


def test_blocks_without_triangles_are_not_counted(index):
    (index.parent / "parts" / "a.vtp").write_text(
        '<VTKFile type="PolyData" version="1.0"><PolyData><Piece NumberOfPoints="0" '
        'NumberOfPolys="0"><Points><DataArray type="Float64" NumberOfComponents="3" '
        'format="ascii"/></Points></Piece></PolyData></VTKFile>'
    )

    assert load_mesh(index).notes[-1] == "2 blocks taken as one surface"
    assert load_mesh(f"{index}#**").notes == load_mesh(index).notes
    assert load_mesh(f"{index}#all").notes == load_mesh(f"{index}#again").notes


def test_other_files_are_one_part(index):
    assembly = load_parts(index.parent / "parts" / "a.vtu")

    assert [(part.path, len(part.mesh.triangles)) for part in assembly] == [("", 12)]
