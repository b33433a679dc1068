"""Skins of glTF at rest: vertices placed by the joints that hold them.

Source: glTF 2.0, 3.7.3. A vertex stands where the sum over its joints of weight times joint's world
matrix times inverse bind matrix takes it; the node that carries the mesh places nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.gltf.json import NotAsExpectedError, list_in
from obbcli.mesh.formats.gltf.nodes import Nodes, affine, composed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.gltf.data import Document
    from obbcli.mesh.formats.gltf.primitives import Attributes, Primitive

#: Weights in bytes add up to 1 within this; by more, the sum is told.
_ROUNDING = 1e-2


def joint_matrices(document: Document, nodes: Nodes, index: object) -> NDArray[np.float64]:
    """Return where a skin's joints take what is bound to them, (J, 4, 4).

    Raises:
        NotAsExpectedError: no joints, or inverse bind matrices that do not fit them.
    """
    skin = document.item("skins", index)
    place = f"skins[{index}]"
    joints = list_in(skin, "joints", place)
    if not joints:
        raise NotAsExpectedError(place, "has no joints")
    binds = np.tile(np.eye(4), (len(joints), 1, 1))
    if "inverseBindMatrices" in skin:
        rows = document.numbers(skin["inverseBindMatrices"], 16)
        if len(rows) < len(joints):
            fault = f"has {len(rows)} inverse bind matrices for {len(joints)} joints"
            raise NotAsExpectedError(place, fault)
        # A file holds matrices column by column.
        binds = affine(rows[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1), place)
    matrices = []
    for joint, bind in zip(joints, binds, strict=True):
        document.item("nodes", joint)
        matrices.append(composed(nodes.world(joint), bind))
    return np.array(matrices)


def skinned(
    document: Document, primitive: Primitive, matrices: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return a primitive's vertices as its joints place them, (V, 3).

    Weights are divided by their sum: files hold them rounded.

    Args:
        document: whose primitive; it is told that a skin was posed.
        primitive: with JOINTS_n and WEIGHTS_n, any number of sets.
        matrices: of the joints, (J, 4, 4).

    Raises:
        NotAsExpectedError: no joints, no such joint, weights that are negative or zero.
    """
    place, vertices = primitive.place, primitive.vertices
    joints, weights = _bindings(primitive.attributes, len(vertices), place)
    used = np.unique(primitive.triangles)
    if not np.isfinite(weights).all() or (weights < 0.0).any():
        raise NotAsExpectedError(place, "has joint weights that are negative or not finite")
    beyond = (joints >= len(matrices)) & (weights > 0.0)
    if beyond.any():
        row = int(np.flatnonzero(beyond.any(axis=1))[0])
        worst = int(joints[row][beyond[row]].max())
        fault = f"vertex {row} is held by joint {worst} of {len(matrices)}"
        raise NotAsExpectedError(place, fault)
    total = weights[:, 0].copy()
    for column in weights.T[1:]:
        total += column
    if (total[used] == 0.0).any():
        row = int(used[total[used] == 0.0][0])
        raise NotAsExpectedError(place, f"vertex {row} is held by no joint (all weights are 0)")
    off = float(np.abs(total[used] - 1.0).max()) if len(used) else 0.0
    if off > _ROUNDING:
        document.source.note(
            f"joint weights of {place} add up to 1 only within {off:.2g}; they were divided by "
            "their sum"
        )
    document.source.note("skins stand as their joints hold them at rest")
    total[total == 0.0] = 1.0
    return _blended(vertices, np.where(beyond, 0, joints), weights / total[:, None], matrices)


def _blended(
    vertices: NDArray[np.float64],
    joints: NDArray[np.int64],
    weights: NDArray[np.float64],
    matrices: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the weighted sums of what each joint makes of a vertex, joint after joint."""
    joints = np.where(joints < len(matrices), joints, 0)
    result = np.zeros_like(vertices)
    x, y, z = vertices.T
    with np.errstate(over="ignore", invalid="ignore"):
        for joint, weight in zip(joints.T, weights.T, strict=True):
            m = matrices[joint]
            for k in range(3):
                placed = ((m[:, k, 0] * x + m[:, k, 1] * y) + m[:, k, 2] * z) + m[:, k, 3]
                result[:, k] += np.where(weight > 0.0, weight * placed, 0.0)
    return result


def _bindings(
    attributes: Attributes, vertex_count: int, place: str
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return the joints and weights of all sets side by side, each (V, 4 S)."""
    joints, weights = [], []
    number = 0
    while number == 0 or f"JOINTS_{number}" in attributes or f"WEIGHTS_{number}" in attributes:
        held = attributes.raw(f"JOINTS_{number}", 4)
        shares = attributes.numbers(f"WEIGHTS_{number}", 4)
        if held.dtype.kind != "u":
            raise NotAsExpectedError(place, f"has JOINTS_{number} of no unsigned type")
        if len(held) != vertex_count or len(shares) != vertex_count:
            fault = f"has {len(held)} joints and {len(shares)} weights for {vertex_count} vertices"
            raise NotAsExpectedError(place, fault)
        joints.append(held.astype(np.int64))
        weights.append(shares)
        number += 1
    return np.hstack(joints), np.hstack(weights)
