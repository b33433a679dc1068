"""Wall time from two binary STL files to an answer: the command against scripts of users."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from harness import OURS, Row, alternate
from scenes.pairs import POSE_CLASSES

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

SIZES = {10_000: 9, 1_000_000: 3}
QUICK_SIZES = {10_000: 5, 100_000: 3}
CASES = ("gap_1e-2", "deep")

STL = "[('normal', '<f4', 3), ('corners', '<f4', (3, 3)), ('attribute', '<u2')]"
TRIMESH_FCL = """
import sys
import trimesh
manager = trimesh.collision.CollisionManager()
for path in sys.argv[1:]:
    manager.add_object(path, trimesh.load_mesh(path))
sys.exit(manager.in_collision_internal())
"""
NUMPY_COAL = f"""
import sys
import coal
import numpy as np
models = []
for path in sys.argv[1:]:
    corners = np.fromfile(path, np.dtype({STL}), offset=84)['corners'].reshape(-1, 3)
    model = coal.BVHModelOBB()
    model.beginModel(len(corners) // 3, len(corners))
    model.addVertices(corners.astype(float))
    model.addTriangles(np.arange(len(corners)).reshape(-1, 3))
    model.endModel()
    models.append(model)
rest = coal.Transform3s()
result = coal.CollisionResult()
sys.exit(coal.collide(models[0], rest, models[1], rest, coal.CollisionRequest(), result) > 0)
"""
PYVISTA = """
import sys
import pyvista
a, b = map(pyvista.read, sys.argv[1:])
sys.exit(a.collision(b, contact_mode=1)[1])
"""


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a size and case; every command's answer is checked by its exit code."""
    command = str(Path(sys.executable).with_name("obbtree"))
    python = sys.executable
    for triangles, rounds in (QUICK_SIZES if quick else SIZES).items():
        for case in CASES:
            pair = POSE_CLASSES[case](triangles)
            with tempfile.TemporaryDirectory() as folder:
                paths = [str(Path(folder, name)) for name in ("a.stl", "b.stl")]
                write_stl(paths[0], pair.a.vertices[pair.a.faces])
                write_stl(paths[1], pair.posed_b[pair.b.faces])
                commands = {
                    OURS: [command, "collide", "--exit-code", *paths],
                    "trimesh + python-fcl": [python, "-c", TRIMESH_FCL, *paths],
                    "numpy + coal": [python, "-c", NUMPY_COAL, *paths],
                    "pyvista": [python, "-c", PYVISTA, *paths],
                    "import numpy": [python, "-c", f"import numpy, sys; sys.exit({pair.touches})"],
                }
                calls = {
                    who: partial(answer, words, bool(pair.touches))
                    for who, words in commands.items()
                }
                timings = alternate(calls, rounds)
            floor = timings.pop("import numpy")
            notes = {"import numpy": {"ms": round(floor.median * 1e3, 1)}}
            yield Row("wall", case, len(pair.a.faces), timings, notes)


def answer(words: list[str], touches: bool) -> None:
    """Run a command and assert its answer: 1 for contact, 0 for none."""
    done = subprocess.run(words, capture_output=True, text=True, env=os.environ, check=False)
    assert done.returncode == int(touches), f"{words[:3]}: {done.stderr[-2000:]}"


def write_stl(path: str, corners: NDArray[np.float64]) -> None:
    """Write triangles (F, 3, 3) as a binary STL file, normals left to the reader."""
    records = np.zeros(
        len(corners),
        dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")],
    )
    records["corners"] = corners
    header = bytes(80) + np.uint32(len(corners)).tobytes()
    Path(path).write_bytes(header + records.tobytes())
