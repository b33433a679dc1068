"""Files of finite elements that are refused, and what meshio does to a process."""

from __future__ import annotations

import re
import subprocess
import sys

import meshio
import numpy as np
import pytest
from cell_files import CUBE, VOLUME_KINDS, write

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh, load_mesh_bytes

ASCII_VTK = b"""# vtk DataFile Version 4.2
made by hand
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 double
0 0 0 1 0 0 1 1 0 0 1 0
CELLS 2 8
3 0 1 2
3 0 2 3
CELL_TYPES 2
5
5
"""


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (b"3 0 2 3", b"3 0 2 4", r"triangle 1 uses point 4 of 4"),
        (b"3 0 2 3", b"3 0 2 -1", r"triangle 1 uses point -1 of 4"),
        (b"1 1 0", b"1 nan 0", r"vertex 2: y is nan"),
        (b"1 1 0", b"1 inf 0", r"vertex 2: y is inf"),
        (b"POINTS 4", b"POINTS 4000000000", r":5: claims 4000000000 of something"),
        (b"POINTS 4", b"POINTS -4", r":5: claims -4"),
        (b"CELLS 2 8", b"CELLS 2 4000000000", r":7: claims 4000000000"),
        (b"CELL_TYPES 2", b"CELL_TYPES 1", r"claims 1 cells|cannot read"),
        (b"5\n5\n", b"5\n", r"claims 2 cells, but 1 could be read"),
        (b"5\n5\n", b"5\n16\n", r"meshio cannot read it|are not read"),
        (b"UNSTRUCTURED_GRID", b"POLYDATA", r"meshio cannot read it"),
        (b"1 1 0", b"1 x 0", r"meshio cannot read it"),
    ],
)
def test_cells_check_what_meshio_lets_through(old, new, fault):
    assert old in ASCII_VTK

    with pytest.raises(MeshError, match=fault):
        load_mesh_bytes(ASCII_VTK.replace(old, new, 1), ".vtk")


def test_cells_refuse_grids_too_large_to_be_meant():
    data = b"""# vtk DataFile Version 3.0
an image
ASCII
DATASET STRUCTURED_POINTS
DIMENSIONS 100000 100000 100000
ORIGIN 0 0 0
SPACING 1 1 1
"""

    with pytest.raises(MeshError, match=r":5: is a grid of 100000 x 100000 x 100000 points"):
        load_mesh_bytes(data, ".vtk")


@pytest.mark.parametrize(
    ("suffix", "data"),
    [
        (".msh", b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4000000000 1 4000000000\n"),
        (".msh", b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4000000000\n1 0 0 0\n$EndNodes\n"),
        (".vtu", b"<VTKFile><Piece NumberOfPoints='4000000000' NumberOfCells='1'/></VTKFile>"),
        (".mesh", b"MeshVersionFormatted 2\nDimension 3\nVertices\n4000000000\n0 0 0 0\n"),
        (".vol", b"mesh3d\ndimension\n3\npoints\n4000000000\n0 0 0\n"),
    ],
)
def test_cells_refuse_counts_above_the_files_size(suffix, data):
    with pytest.raises(MeshError, match="claims 4000000000 of something, but the file has"):
        load_mesh_bytes(data, suffix)


def test_cells_refuse_gmsh_tags_that_would_take_all_memory():
    data = (
        b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n2 1 0 3\n"
        b"1\n2\n4000000000000\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
        b"$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 4000000000000\n$EndElements\n"
    )

    with pytest.raises(MeshError, match="out of memory"):
        load_mesh_bytes(data, ".msh")


@pytest.mark.parametrize(("name", "options"), VOLUME_KINDS)
def test_cells_end_on_truncated_files_with_an_error_or_a_whole_surface(tmp_path, name, options):
    cells = [("tetra", np.array([[0, 1, 2, 4], [1, 2, 4, 5]]))]
    path = write(tmp_path / name, cells, CUBE[[0, 1, 3, 2, 4, 7]], **options)
    data = path.read_bytes()
    whole = load_mesh(path).triangles.tolist()

    for size in range(1, len(data), max(1, len(data) // 40)):
        try:
            mesh = load_mesh_bytes(data[:size], path.suffix)
        except MeshError:
            continue
        # Text without an end mark may lose whole records, here the second cell of two.
        assert mesh.triangles.tolist() == whole or (path.suffix in (".inp", ".bdf", ".f3grid"))


def test_cells_leak_no_words_of_the_library(capfd):
    with pytest.raises(MeshError):
        load_mesh_bytes(b"$MeshFormat\n9.9 0 8\n$EndMeshFormat\n", ".msh")
    with pytest.raises(MeshError):
        load_mesh_bytes(b"mesh3d\ndimension\n3\npoints\n2\n0 0 0\n", ".vol")

    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("fault", [SystemExit(1), RecursionError("too deep"), RuntimeError("odd")])
def test_cells_turn_every_exception_of_a_reader_into_a_mesh_error(monkeypatch, fault):
    def failing(path):
        sys.stdout.write("words of the library")
        raise fault

    monkeypatch.setattr("meshio.vtk.read", failing)
    with pytest.raises(MeshError, match="meshio cannot read it: it is not what a file") as caught:
        load_mesh_bytes(ASCII_VTK, ".vtk")

    assert caught.value.__cause__ is fault
    assert not re.search(r"words of|Error|deep|odd", str(caught.value))


def test_cells_let_an_interrupt_pass(monkeypatch):
    def interrupted(path):
        raise KeyboardInterrupt

    monkeypatch.setattr("meshio.vtk.read", interrupted)
    with pytest.raises(KeyboardInterrupt):
        load_mesh_bytes(ASCII_VTK, ".vtk")


def test_cells_name_a_package_that_is_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio.vtk", None)

    with pytest.raises(MeshError, match=r"needs the package meshio\.vtk, which is not installed"):
        load_mesh_bytes(ASCII_VTK, ".vtk")


def test_cells_refuse_a_file_that_changes_meanwhile(tmp_path, monkeypatch):
    path = tmp_path / "a.vtk"
    path.write_bytes(ASCII_VTK)
    read = meshio.vtk.read

    def changing(name):
        path.write_bytes(ASCII_VTK.replace(b"1 1 0", b"2 2 0"))
        return read(name)

    monkeypatch.setattr("meshio.vtk.read", changing)
    with pytest.raises(MeshError, match="changed while it was read"):
        load_mesh(path)


def test_cells_leave_the_memory_limit_and_the_libraries_as_they_were():
    code = (
        "import resource; before = resource.getrlimit(resource.RLIMIT_AS)\n"
        "from obbcli.mesh import load_mesh_bytes\n"
        f"load_mesh_bytes({ASCII_VTK!r}, '.vtk')\n"
        "import meshio.vtk._main, meshio._files\n"
        "assert resource.getrlimit(resource.RLIMIT_AS) == before\n"
        "assert 'open' not in vars(meshio.vtk._main)\n"
    )

    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)

    assert (result.returncode, result.stderr) == (0, "")


@pytest.mark.parametrize(
    ("suffix", "data"),
    [
        (".vtk", ASCII_VTK.replace(b"POINTS 4", b"POINTS " + b"1" * 5000)),
        (".vtk", ASCII_VTK.replace(b"CELLS 2", b"DIMENSIONS 1 1 " + b"1" * 5000)),
        (".vtu", b'<VTKFile><Piece NumberOfPoints="%s"/></VTKFile>' % (b"1" * 5000)),
        (".msh", b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + b"1" * 5000),
    ],
)
def test_cells_refuse_counts_too_long_to_be_read(suffix, data):
    with pytest.raises(MeshError, match="claims a count of 5000 digits"):
        load_mesh_bytes(data, suffix)


def test_cells_let_the_library_open_no_other_file(tmp_path, monkeypatch):
    (tmp_path / "secret.vtk").write_bytes(ASCII_VTK)
    (tmp_path / "part.vtk").write_bytes(ASCII_VTK)
    read = meshio.vtk.read
    monkeypatch.setattr("meshio.vtk.read", lambda _path: read(tmp_path / "secret.vtk"))

    with pytest.raises(MeshError, match=r"names another file, '.*secret\.vtk'; copy that into it"):
        load_mesh(tmp_path / "part.vtk")


def test_cells_of_entities_that_multiply_end_soon():
    entities = [b'<!ENTITY e0 "aaaaaaaaaaaaaaaa">']
    entities += [b'<!ENTITY e%d "%s">' % (k, b"&e%d;" % (k - 1) * 10) for k in range(1, 12)]
    data = b"<!DOCTYPE x [%s]><VTKFile>&e11;</VTKFile>" % b"".join(entities)

    with pytest.raises(MeshError, match="meshio cannot read it"):
        load_mesh_bytes(data, ".vtu")
