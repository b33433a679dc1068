"""Files of finite elements that are refused, and what meshio does to a process."""

from __future__ import annotations

import re
import subprocess
import sys

import meshio
import numpy as np
import pytest
from mesh_files.cell_files import CUBE, VOLUME_KINDS, write

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


FLAC3D = b"""* made by hand
G 1 0 0 0
G 2 1 0 0
G 3 1 1 0
G 4 0 1 0
F T3 1 1 2 3
F T3 2 1 3 4
"""


@pytest.fixture(
    params=[pytest.param(True, id="vtk", marks=pytest.mark.needs("vtk")), False], ids=str
)
def _through_either(request, monkeypatch):
    """Reads VTK files through VTK, and as if it were not installed."""
    if not request.param:
        monkeypatch.setattr("obbcli.mesh.formats.vtk.reader.has_vtk", lambda: False)


@pytest.mark.usefixtures("_through_either")
@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (b"3 0 2 3", b"3 0 2 4", r"triangle 1 uses point 4 of 4"),
        (b"3 0 2 3", b"3 0 2 -1", r"triangle 1 uses point -1 of 4"),
        (b"1 1 0", b"1 nan 0", r"vertex 2: y is nan|cannot read it whole"),
        (b"1 1 0", b"1 inf 0", r"vertex 2: y is inf|cannot read it whole"),
        (b"POINTS 4", b"POINTS 4000000000", r":5: claims 4000000000 of something"),
        (b"POINTS 4", b"POINTS -4", r":5: claims -4"),
        (b"CELLS 2 8", b"CELLS 2 4000000000", r":7: claims 4000000000"),
        (b"CELLS 2 8", b"CELLS 3 8", r":7: CELLS claims 3 cells of 8 numbers, which do not fit"),
        (b"3 0 2 3", b"9 0 2 3", r":7: CELLS claims 2 cells of 8 numbers, which do not fit"),
        (b"3 0 2 3", b"-1 0 2 3", r":7: CELLS claims 2 cells of 8 numbers, which do not fit"),
        (b"CELL_TYPES 2", b"CELL_TYPES 1", r":10: 1 numbers are claimed, and 2 follow"),
        (b"5\n5\n", b"5\n", r":10: 2 numbers are claimed, and 1 follow"),
        (b"5\n5\n", b"5\n41\n", r"41|cannot read it"),
        (b"UNSTRUCTURED_GRID", b"POLYDATA", r":7: 'cells' is nothing that POLYDATA has"),
        (b"UNSTRUCTURED_GRID", b"MULTIBLOCK", r":4: DATASET MULTIBLOCK is not read"),
        (b"CELL_TYPES", b"FACES 1 3\nCELL_TYPES", r":10: 'faces' is nothing that UNSTRUCTURED"),
        (
            b"1 1 0",
            b"1 x 0",
            r":5: 12 numbers are claimed, and (7 follow|words stand among them)",
        ),
        (b"1 1 0", b"1 1x 0", r":5: 12 numbers are claimed, and words stand among them"),
        (b"ASCII", b"TEXT", r":3: found 'text', expected ASCII or BINARY"),
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

    with pytest.raises(MeshError, match=r":5: (claims|is a grid of) 100000"):
        load_mesh_bytes(data, ".vtk")


@pytest.mark.parametrize(
    ("suffix", "data"),
    [
        (".vol", b"mesh3d\ndimension\n3\npoints\n4000000000\n0 0 0\n"),
    ],
)
def test_cells_refuse_counts_above_the_files_size(suffix, data):
    with pytest.raises(MeshError, match="claims 4000000000 of something, but the file has"):
        load_mesh_bytes(data, suffix)


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

    monkeypatch.setattr("meshio.flac3d.read", failing)
    with pytest.raises(MeshError, match="meshio cannot read it: it is not what a file") as caught:
        load_mesh_bytes(FLAC3D, ".f3grid")

    assert caught.value.__cause__ is fault
    assert not re.search(r"words of|Error|deep|odd", str(caught.value))


def test_cells_let_an_interrupt_pass(monkeypatch):
    def interrupted(path):
        raise KeyboardInterrupt

    monkeypatch.setattr("meshio.flac3d.read", interrupted)
    with pytest.raises(KeyboardInterrupt):
        load_mesh_bytes(FLAC3D, ".f3grid")


def test_cells_name_a_package_that_is_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio.flac3d", None)

    with pytest.raises(
        MeshError, match=r"needs the package meshio\.flac3d, which is not installed"
    ):
        load_mesh_bytes(FLAC3D, ".f3grid")


def test_cells_refuse_a_file_that_changes_meanwhile(tmp_path, monkeypatch):
    path = tmp_path / "a.f3grid"
    path.write_bytes(FLAC3D)
    read = meshio.flac3d.read

    def changing(name):
        path.write_bytes(FLAC3D.replace(b"1 1 0", b"2 2 0"))
        return read(name)

    monkeypatch.setattr("meshio.flac3d.read", changing)
    with pytest.raises(MeshError, match="changed while it was read"):
        load_mesh(path)


def test_cells_leave_the_memory_limit_and_the_libraries_as_they_were():
    code = (
        "import resource; before = resource.getrlimit(resource.RLIMIT_AS)\n"
        "from obbcli.mesh import load_mesh_bytes\n"
        f"load_mesh_bytes({FLAC3D!r}, '.f3grid')\n"
        "import meshio.flac3d._flac3d, meshio._files\n"
        "assert resource.getrlimit(resource.RLIMIT_AS) == before\n"
        "assert 'open' not in vars(meshio.flac3d._flac3d)\n"
    )

    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)

    assert (result.returncode, result.stderr) == (0, "")


def test_cells_let_the_library_open_no_other_file(tmp_path, monkeypatch):
    (tmp_path / "secret.f3grid").write_bytes(FLAC3D)
    (tmp_path / "part.f3grid").write_bytes(FLAC3D)
    read = meshio.flac3d.read
    monkeypatch.setattr("meshio.flac3d.read", lambda _path: read(tmp_path / "secret.f3grid"))

    with pytest.raises(
        MeshError, match=r"names another file, '.*secret\.f3grid'; copy that into it"
    ):
        load_mesh(tmp_path / "part.f3grid")


def test_cells_of_entities_that_multiply_end_soon():
    entities = [b'<!ENTITY e0 "aaaaaaaaaaaaaaaa">']
    entities += [b'<!ENTITY e%d "%s">' % (k, b"&e%d;" % (k - 1) * 10) for k in range(1, 12)]
    data = b"<!DOCTYPE x [%s]><VTKFile>&e11;</VTKFile>" % b"".join(entities)

    with pytest.raises(MeshError, match="declares a document type; remove the <!DOCTYPE"):
        load_mesh_bytes(data, ".vtu")
