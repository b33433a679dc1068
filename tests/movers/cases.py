"""Bodies of the cases in `data/cases` as movers."""

from __future__ import annotations

from typing import Any

import numpy as np
from oracles.screw import Mover
from scenes import cases


def rigid_mover(record: dict[str, Any]) -> Mover:
    """Return a body of the rigid cases."""
    mesh = cases.rigid_meshes()[record["mesh"]]
    vertices = np.array(mesh["vertices"], dtype=np.float64) * record["scale"]
    pose = np.array(record["R"], dtype=np.float64), record["t"]
    return Mover(vertices, np.array(mesh["faces"]), *pose, record["V"], record["W"], record["K"])


def foreign_mover(record: dict[str, Any]) -> Mover:
    """Return a body of the third-party cases."""
    pose = np.array(record["rotation0"]), record["translation0"]
    motion = record["linear_velocity"], record["angular_velocity"], record["rotation_centre_world"]
    return Mover(np.array(record["vertices"]), np.array(record["faces"]), *pose, *motion)
