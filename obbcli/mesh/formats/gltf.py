"""glTF 2.0 and its binary form GLB, read by our own strict reader.

trimesh takes nodes in an order that depends on its stack (the last root first) and skips triangle
fans, sparse accessors and unknown compression without a word, so parts of a model go missing.
Only geometry is read: positions, indices and the nodes that place them.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.gltf_data import (
    Document,
    Json,
    NotAsExpectedError,
    list_in,
    numbers_in,
    split_glb,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.source import MeshArrays, Source

    Matrix = NDArray[np.float64]

_TRIANGLES, _STRIP, _FAN = 4, 5, 6
#: Compressed or instanced geometry is not decoded; leaving it out would leave out parts.
_UNREADABLE = frozenset(
    ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing")
)


def read_gltf(source: Source) -> MeshArrays:
    """Return vertices and triangles of the document's scene, nodes in the document's order.

    Nodes are taken depth first from the first root on, children in their order, and of each node's
    mesh the primitives in theirs; matrices are applied in double precision, and a mirrored node's
    triangles are turned over. Points and lines are left out. A document without scenes gives its
    meshes one after another, unplaced.

    Raises:
        MeshError: not JSON, lengths that do not fit, values out of place, compressed geometry.
    """
    text, chunk = split_glb(source)
    try:
        content = json.loads(text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as fault:
        raise source.error(f"is not glTF: {fault}", "export it again") from fault
    try:
        document = Document(source, content, chunk)
        used = document.items("extensionsUsed")
        unreadable = [x for x in used if isinstance(x, str) and x in _UNREADABLE]
        if unreadable:
            raise NotAsExpectedError("extensionsUsed", f"{unreadable[0]} is not read")
        return _joined(list(_placed(document)))
    except NotAsExpectedError as fault:
        raise source.error(fault.fault, "export it again", at=fault.place) from fault


def _refuse_constant(name: str) -> float:
    raise ValueError(f"{name} is no number of JSON")


def _joined(parts: list[MeshArrays]) -> MeshArrays:
    """Return all parts as one."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in parts)]).tolist()
    triangles = [part[1] + start for part, start in zip(parts, starts, strict=False)]
    none = np.zeros((0, 3))
    return (
        np.vstack([none, *(vertices for vertices, _ in parts)]),
        np.vstack([none.astype(np.int64), *triangles]),
    )


def _placed(document: Document) -> Iterator[MeshArrays]:
    """Yield the primitives of every node of the scene, placed."""
    if not document.items("scenes"):
        for mesh in range(len(document.items("meshes"))):
            yield from _primitives(document, mesh)
        return
    scene = document.item("scenes", document.content.get("scene", 0))
    # An explicit stack: documents may nest deeper than Python recurses.
    roots = list_in(scene, "nodes", "scene")
    pending: list[tuple[Any, Matrix | None]] = [(root, None) for root in reversed(roots)]
    met: set[Any] = set()
    while pending:
        index, outer = pending.pop()
        node = document.item("nodes", index)
        place = f"nodes[{index}]"
        if index in met:
            raise NotAsExpectedError(place, "is met twice; the nodes of a scene form a tree")
        met.add(index)
        matrix = _composed(outer, _local_matrix(node, place))
        pending += [(child, matrix) for child in reversed(list_in(node, "children", place))]
        if "mesh" in node:
            for vertices, triangles in _primitives(document, node["mesh"]):
                yield _transformed(vertices, triangles, matrix)


def _primitives(
    document: Document, index: object
) -> Iterator[tuple[NDArray[np.float64], NDArray[np.int64]]]:
    """Yield the triangles of each primitive of a mesh."""
    mesh = document.item("meshes", index)
    for number, primitive in enumerate(list_in(mesh, "primitives", f"meshes[{index}]")):
        place = f"meshes[{index}].primitives[{number}]"
        if not isinstance(primitive, dict):
            raise NotAsExpectedError(place, "is no object")
        mode = primitive.get("mode", _TRIANGLES)
        if mode not in (_TRIANGLES, _STRIP, _FAN):
            continue
        attributes = primitive.get("attributes")
        if not isinstance(attributes, dict) or "POSITION" not in attributes:
            raise NotAsExpectedError(place, "has no POSITION")
        vertices = _positions(document, attributes["POSITION"])
        if "indices" in primitive:
            indices = document.accessor(primitive["indices"], 1).reshape(-1)
            if indices.dtype.kind != "u":
                raise NotAsExpectedError(place, "has indices of no unsigned type")
        else:
            indices = np.arange(len(vertices))
        triangles = _triangles(indices.astype(np.int64), mode, place)
        outside = np.flatnonzero((triangles >= len(vertices)).any(axis=1))
        if len(outside):
            worst = int(triangles[outside[0]].max())
            raise NotAsExpectedError(
                place, f"triangle {outside[0]} uses vertex {worst} of {len(vertices)}"
            )
        yield vertices, triangles


def _positions(document: Document, index: object) -> NDArray[np.float64]:
    """Return positions, those stored as normalised integers scaled back."""
    values = document.accessor(index, 3)
    vertices = values.astype(np.float64)
    if document.item("accessors", index).get("normalized") and values.dtype.kind in "iu":
        vertices = np.maximum(vertices / np.iinfo(values.dtype).max, -1.0)
    return vertices


def _triangles(indices: NDArray[np.int64], mode: int, place: str) -> NDArray[np.int64]:
    """Return a list, strip or fan of triangles as rows of three."""
    if mode == _TRIANGLES:
        if len(indices) % 3:
            raise NotAsExpectedError(place, f"has {len(indices)} indices, not three a triangle")
        return indices.reshape(-1, 3)
    count = max(0, len(indices) - 2)
    step = np.arange(count)
    if mode == _STRIP:
        odd = step % 2
        return np.stack([indices[step], indices[step + 1 + odd], indices[step + 2 - odd]], axis=1)
    first = indices[np.zeros(count, dtype=np.int64)]
    return np.stack([indices[step + 1], indices[step + 2], first], axis=1)


def _local_matrix(node: Json, place: str) -> Matrix | None:
    """Return a node's matrix (4, 4), None where it has none."""
    if "matrix" in node:
        identity = np.eye(4).reshape(-1).tolist()
        return np.asarray(numbers_in(node, "matrix", place, identity).reshape(4, 4).T)
    if not {"translation", "rotation", "scale"} & node.keys():
        return None
    matrix = np.eye(4)
    x, y, z, w = numbers_in(node, "rotation", place, [0.0, 0.0, 0.0, 1.0]).tolist()
    square = x * x + y * y + z * z + w * w
    if square == 0.0:
        raise NotAsExpectedError(f"{place}.rotation", "is zero, expected a unit quaternion")
    s = 2.0 / square
    matrix[:3, :3] = [
        [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
    ]
    matrix[:3, :3] *= numbers_in(node, "scale", place, [1.0, 1.0, 1.0])
    matrix[:3, 3] = numbers_in(node, "translation", place, [0.0, 0.0, 0.0])
    return matrix


def _composed(outer: Matrix | None, inner: Matrix | None) -> Matrix | None:
    """Return the matrix that applies `inner`, then `outer`; None stands for the identity."""
    if outer is None or inner is None:
        return inner if outer is None else outer
    # Term by term: a matrix product of the platform's library may round otherwise elsewhere.
    with np.errstate(over="ignore", invalid="ignore"):
        terms = outer[:, :, np.newaxis] * inner[np.newaxis, :, :]
        return np.asarray(((terms[:, 0] + terms[:, 1]) + terms[:, 2]) + terms[:, 3])


def _transformed(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64], matrix: Matrix | None
) -> MeshArrays:
    """Return a part placed by its matrix."""
    if matrix is None:
        return vertices, triangles
    m = matrix[:3, :3]
    with np.errstate(over="ignore", invalid="ignore"):
        x, y, z = vertices.T
        rows = [((m[k, 0] * x + m[k, 1] * y) + m[k, 2] * z) + matrix[k, 3] for k in range(3)]
        mirrored = float(m[0] @ np.cross(m[1], m[2])) < 0
    return np.stack(rows, axis=1), triangles[:, ::-1] if mirrored else triangles
