"""Every mesh format that a reader of our own reads, against the libraries that read it too.

Files have rows in an order of their own and every tenth face is a quadrilateral where the format
has them, as that is where readers differ: `rows` tells whether a library gives the triangles that
the file lists, in its order, to the bit.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from format_files import FILES, faces_of, triangles_of
from harness import OURS, Row, alternate

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

SIZES = {100_000: 3, 1_000_000: 1}
QUICK_SIZES = {20_000: 3}
MOST_SECONDS = 60

#: How each reads `path` into vertices `v` and triangles `t`.
OBBTREE = (
    "from obbcli.mesh import load_mesh; m = load_mesh(path, hashed=False); "
    "v, t = m.vertices, m.triangles"
)
TRIMESH = "import trimesh; m = trimesh.load_mesh(path, process=False); v, t = m.vertices, m.faces"
SCENE = (
    "import trimesh; m = trimesh.load_scene(path, process=False).to_mesh(); "
    "v, t = m.vertices, m.faces"
)
MESHIO = """
import meshio, numpy as np
m = meshio.read(path)
v, t = m.points, []
for block in m.cells:
    rows = np.asarray(block.data)
    t += [rows[:, [0, k, k + 1]] for k in range(1, rows.shape[1] - 1)]
t = np.concatenate(t)
"""
VTK = """
import vtkmodules.all as vtk
from vtkmodules.util.numpy_support import vtk_to_numpy
reader = getattr(vtk, f"vtk{path[-3:].upper()}Reader")()
getattr(reader, "MergingOff", int)()
reader.SetFileName(path)
cut = vtk.vtkTriangleFilter()
cut.SetInputConnection(reader.GetOutputPort())
cut.Update()
v = vtk_to_numpy(cut.GetOutput().GetPoints().GetData())
t = vtk_to_numpy(cut.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
"""
SURFACES = {"trimesh": TRIMESH, "meshio": MESHIO, "vtk": VTK}
LIBRARIES = {
    **{key: SURFACES for key in FILES if key.startswith(("STL", "OBJ", "PLY"))},
    **{key: {"trimesh": TRIMESH, "meshio": MESHIO} for key in FILES if key.startswith("OFF")},
    "GLB": {"trimesh": SCENE},
    "3MF": {"trimesh": SCENE},
    "COLLADA": {"trimesh": SCENE},
    **{key: {"meshio": MESHIO} for key in ("Gmsh", "Medit", "Abaqus", "Nastran", "SU2", "UCD")},
}
#: What trimesh needs besides for a format.
BESIDES = {"3MF": "lxml", "COLLADA": "collada"}
PEAK = '\nwords = open("/proc/self/status").read().split(); print(words[words.index("VmHWM:") + 1])'


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a format and size: seconds to read a file, peak memory, and whose rows differ."""
    for count, rounds in (QUICK_SIZES if quick else SIZES).items():
        for name, libraries in LIBRARIES.items():
            with tempfile.TemporaryDirectory() as folder:
                faces = faces_of(count, with_quads=FILES[name].has_quads)
                path = FILES[name].write(Path(folder), faces)
                readers = {OURS: OBBTREE}
                for who, code in libraries.items():
                    if find_spec(who) and find_spec(BESIDES.get(name, who)):
                        readers[who] = code
                yield _row(name, str(path), triangles_of(faces), readers, rounds)


def _row(
    name: str, path: str, truth: NDArray[np.float64], readers: Mapping[str, str], rounds: int
) -> Row:
    notes: dict[str, dict[str, object]] = {}
    calls = {}
    for who, code in readers.items():
        notes[who] = {"rows": _verdict(code, path, truth)}
        if notes[who]["rows"] != "refused":
            notes[who]["peak MB"] = _peak_megabytes(code, path)
            calls[who] = partial(_read, code, path)
    assert notes[OURS]["rows"] == "same", f"{name}: {notes[OURS]}"
    return Row("formats", name, len(truth), alternate(calls, rounds), notes)


def _read(code: str, path: str) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    found: dict[str, object] = {"path": path}
    exec(code, found)
    return found["v"], found["t"]  # type: ignore[return-value]


def _verdict(code: str, path: str, truth: NDArray[np.float64]) -> str:
    """Return how what is read compares with the triangles (F, 3, 3) of a file, in its order."""
    try:
        vertices, triangles = _read(code, path)
    except (Exception, SystemExit):  # noqa: BLE001 - libraries raise what they like
        return "refused"
    found = np.asarray(vertices)[triangles]
    if len(found) != len(truth):
        return f"{len(found)} of {len(truth)}"
    if found.dtype == np.float64 and np.array_equal(found, truth):
        return "same"
    if np.allclose(found, truth, rtol=1e-6, atol=1e-6):
        return "rounded"
    return "other rows"


def _peak_megabytes(code: str, path: str) -> int:
    """Return the most memory that a process of its own holds while it reads a file."""
    words = [sys.executable, "-W", "ignore", "-c", f"path = {path!r}\n{code}{PEAK}"]
    done = subprocess.run(words, capture_output=True, text=True, check=True, timeout=MOST_SECONDS)
    return int(done.stdout.split()[-1]) // 1024
