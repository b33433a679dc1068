"""VTK as a library: asked quietly, for its reading modules alone, or not at all."""

from __future__ import annotations

import contextlib
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from obbcli.errors import MeshError
from obbcli.mesh import load_mesh

with contextlib.suppress(ImportError):  # of VTK, which need not be there
    from mesh_files import vtk_files

pytestmark = pytest.mark.needs("vtk")

NAMES = (
    *("grid", "voxels", "surface", "strips", "image", "moved image", "flat image"),
    *("rectilinear", "structured", "flat structured"),
)


@pytest.fixture
def _without_vtk(monkeypatch):
    """Hides VTK, as where it is not installed."""
    for name in [name for name in sys.modules if name.startswith("vtkmodules")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "vtkmodules", None)


@pytest.mark.usefixtures("_without_vtk")
@pytest.mark.parametrize("name", NAMES)
def test_without_vtk_the_refusal_names_it(name, tmp_path, request):
    request.getfixturevalue("monkeypatch").undo()
    paths = [vtk_files.write_xml(tmp_path, vtk_files.DATA_SETS[name](), "ascii", "none")]
    paths.append(vtk_files.write_legacy(tmp_path / "a.vtk", vtk_files.DATA_SETS[name](), False, 42))
    request.getfixturevalue("monkeypatch").setattr(
        "obbcli.mesh.formats.vtk.reader.has_vtk", lambda: False
    )

    for path in paths:
        if name in ("grid", "voxels"):
            continue
        with pytest.raises(MeshError, match=r"needs VTK.*; install it: pip install vtk"):
            load_mesh(path)


@pytest.mark.usefixtures("_without_vtk")
def test_vtk_that_cannot_be_imported_is_not_there():
    from obbcli.mesh.formats.vtk.modules import has_vtk

    assert not has_vtk()


def test_vtk_is_asked_for_its_reading_modules_alone(tmp_path):
    path = vtk_files.write_xml(tmp_path, vtk_files.DATA_SETS["grid"](), "ascii", "none")
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
    from obbcli.mesh.formats.vtk import modules

    path = vtk_files.write_legacy(tmp_path / "a.vtk", vtk_files.DATA_SETS["grid"](), False, 42)
    cut = path.read_bytes()[:150]

    with pytest.raises(MeshError, match=r"VTK cannot read it whole: .*; export it again") as caught:
        modules.legacy_data_set(vtk_library_source(cut), cut)

    assert capfd.readouterr() == ("", "")
    assert not re.search(r"\.cxx|0x", str(caught.value))


def vtk_library_source(data):
    from obbcli.mesh.source import Source

    return Source("x", "x", data, Path("x"))


def test_a_plain_grid_is_the_same_mesh_without_vtk(tmp_path, monkeypatch):
    paths = [vtk_files.write_legacy(tmp_path / f"{v}{b}.vtk", vtk_files.DATA_SETS["grid"](), b, v)
             for b in (False, True) for v in (42, 51)]  # fmt: skip
    paths.append(vtk_files.write_xml(tmp_path, vtk_files.DATA_SETS["grid"](), "appended", "zlib"))
    through_vtk = [load_mesh(path) for path in paths]
    monkeypatch.setattr("obbcli.mesh.formats.vtk.reader.has_vtk", lambda: False)

    for path, mesh in zip(paths, through_vtk, strict=True):
        other = load_mesh(path)

        assert np.array_equal(other.vertices, mesh.vertices)
        assert other.triangles.tolist() == mesh.triangles.tolist()
        assert other.notes == mesh.notes
