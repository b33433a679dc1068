"""Two solids at one pose, what is said of their overlap, and how depths are held to truths."""

from __future__ import annotations

from typing import Any

import numpy as np
from movers.meshes import box

import obbcli
from obbcli import Body, Mesh, Pose

UNIT = box((0, 0, 0), (1, 1, 1))
TURN = Pose(rotation=[0.3, -0.2, 0.9], translation=[0.5, 2.0, -1.0])
DEPTHS = ("thickness", "protrusion_a", "protrusion_b")


def overlap(a: Any, b: Any, pose: Pose | None = None, **asked: Any) -> obbcli.Overlap:
    """Return what is said of two meshes, both at one pose."""
    bodies = [Body(Mesh(*mesh), pose or Pose()) for mesh in (a, b)]
    return obbcli.overlap(*bodies, **asked)


def refined(mesh: Any, times: int) -> Any:
    """Return a mesh with every triangle cut into four, so many times."""
    vertices, faces = (np.asarray(part) for part in mesh)
    for _ in range(times):
        corners = vertices[faces]
        p, q, r = (corners[:, i] for i in range(3))
        pq, qr, rp = (p + q) / 2, (q + r) / 2, (r + p) / 2
        pieces = [p, pq, rp, pq, q, qr, rp, qr, r, pq, qr, rp]
        vertices = np.stack(pieces, axis=1).reshape(-1, 3)
        faces = np.arange(len(vertices)).reshape(-1, 3)
    return vertices, faces


def assert_depths(found: obbcli.Overlap, *truths: float, rel: float = 0.01) -> None:
    """Fail unless each bracket holds its truth, to roundings of posed vertices, and is narrow."""
    for name, truth in zip(DEPTHS, truths, strict=True):
        low, high = getattr(found, name).bounds
        room = 1e-12 * max(found.band.slack * 1e9, 1.0)
        assert low - room <= truth <= high + room, (name, low, high)
        assert high - low <= rel * high + 2 * found.band.slack, (name, low, high)


def assert_volume(found: obbcli.Overlap, truth: float, room: float = 1e-9) -> None:
    low, high = found.volume.bounds
    assert low - room <= truth <= high + room
    assert high - low <= 1e-6 * max(truth, 1.0)
