"""glTF 2.0 and its binary form GLB, read by our own strict reader as the specification says.

trimesh takes nodes in an order that depends on its stack (the last root first) and skips triangle
fans, skins, morph weights and required extensions without a word. Only what makes and places
surface is read: positions, indices, morph targets, skins and the nodes that place them.
"""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.gltf_buffers import split_glb
from obbcli.mesh.formats.gltf_data import Document
from obbcli.mesh.formats.gltf_extensions import check_extensions
from obbcli.mesh.formats.gltf_json import NotAsExpectedError, words_of
from obbcli.mesh.formats.gltf_nodes import Nodes, ShownNode, instances, mirrors, transformed
from obbcli.mesh.formats.gltf_primitives import Primitive, primitives, weights_of
from obbcli.mesh.formats.gltf_skins import joint_matrices, skinned

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.formats.gltf_json import Json
    from obbcli.mesh.source import MeshArrays, Source

#: Instances multiply what a file holds: they may fill this share of the machine's memory.
_SHARE = 4
_NO_NUMBERS = np.zeros(0)


def read_gltf(source: Source) -> MeshArrays:
    """Return vertices and triangles of the document's scene, nodes in the document's order.

    Nodes are taken depth first from the first root on, children in their order, of each node's
    mesh the primitives in theirs, of instances one after the other. Matrices are applied in double
    precision, and a mirrored node's triangles are turned over. Morph targets stand at their default
    weights, skins as their joints hold them at rest. Points and lines have no surface. A document
    without scenes shows all its root nodes, one without nodes its meshes, unplaced.

    Raises:
        MeshError: not JSON, another version, lengths that do not fit, values out of place, a
            required extension that is not read, compressed geometry whose package is missing.
    """
    text, chunk = split_glb(source)
    content = _parsed(source, text)
    try:
        _check_version(content)
        document = Document(source, content, chunk)
        check_extensions(document)
        if document.items("animations"):
            source.note("animations are not played")
        return _joined(_parts(document))
    except NotAsExpectedError as fault:
        raise source.error(fault.fault, fault.remedy, at=fault.place) from fault


def _parsed(source: Source, text: bytes) -> Json:
    """Return the document, its errors in our words."""
    try:
        content = json.loads(text, parse_constant=_refuse_constant)
    except json.JSONDecodeError as fault:
        at = f"line {fault.lineno}, column {fault.colno}"
        raise source.error(f"is not glTF: no JSON at {at}", "export it again") from fault
    except UnicodeDecodeError as fault:
        raise source.error("is not glTF: its text is no UTF-8", "export it again") from fault
    except RecursionError as fault:
        raise source.error("is not glTF: its JSON nests too deep", "export it again") from fault
    except ValueError as fault:
        raise source.error(
            "is not glTF: it holds a number that JSON does not know", "export it again"
        ) from fault
    if not isinstance(content, dict) or not isinstance(content.get("asset") or {}, dict):
        raise source.error("is missing; this is no glTF document", "export it again", at="asset")
    return content


def _refuse_constant(name: str) -> float:
    raise ValueError(name)


def _check_version(content: Json) -> None:
    """Refuse other versions by name: glTF 1.0 is another format."""
    old = isinstance(content.get("meshes"), dict) or isinstance(content.get("scenes"), dict)
    asset = content.get("asset")
    if asset is None and not old:
        raise NotAsExpectedError("asset", "is missing; this is no glTF document")
    version = (asset or {}).get("version", "1.0" if old else "2.0")
    least = (asset or {}).get("minVersion", "2.0")
    number = str(version).partition(".")[0]
    if old or number != "2":
        shown = "1.0" if old else words_of(version).strip("'")
        raise NotAsExpectedError(
            "asset.version", f"is glTF {shown}, only 2.0 is read", "convert it to glTF 2.0"
        )
    if least != "2.0":
        fault = f"needs a reader of glTF {words_of(least)}, this one reads 2.0"
        raise NotAsExpectedError("asset.minVersion", fault, "export it as glTF 2.0")


def _parts(document: Document) -> Iterator[MeshArrays]:
    """Yield the primitives of every node of the scene, placed."""
    nodes = Nodes(document)
    meshes = len(document.items("meshes"))
    if not document.items("scenes") and not document.items("nodes"):
        document.source.note("has no nodes: its meshes are taken where they were modelled")
        for mesh in range(meshes):
            for part in primitives(document, mesh, _NO_NUMBERS):
                yield part.vertices, part.triangles
        return
    known: dict[Any, list[Primitive]] = {}
    placed = set()
    for node in nodes.shown():
        if "mesh" not in node.item:
            continue
        weights = weights_of(document, node.item, f"nodes[{node.number}]")
        mesh = node.item["mesh"]
        placed.add(mesh)
        key = (mesh, *weights.tolist())
        if key not in known:
            known[key] = primitives(document, mesh, weights)
        yield from _placed(document, nodes, node, known[key])
    if len(placed) < meshes:
        left = meshes - len(placed)
        document.source.note(f"{left} of {meshes} meshes stand in no node of the scene")


def _placed(
    document: Document, nodes: Nodes, node: ShownNode, parts: list[Primitive]
) -> Iterator[MeshArrays]:
    """Yield the primitives of a node's mesh, once for each instance of it."""
    places = instances(document, node)
    if "skin" not in node.item:
        for matrix in places:
            for part in parts:
                turned = part.triangles[:, ::-1] if mirrors(matrix) else part.triangles
                yield transformed(part.vertices, matrix), turned
        return
    if len(places) != 1 or places[0] is not node.matrix:
        raise NotAsExpectedError(
            f"nodes[{node.number}]", "has a skin and instances, which glTF does not define together"
        )
    matrices = joint_matrices(document, nodes, node.item["skin"])
    for part in parts:
        yield skinned(document, part, matrices), part.triangles


def _joined(parts: Iterator[MeshArrays]) -> MeshArrays:
    """Return all parts as one."""
    room = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // _SHARE
    vertices: list[NDArray[np.float64]] = [np.zeros((0, 3))]
    triangles: list[NDArray[Any]] = [np.zeros((0, 3), dtype=np.int64)]
    start = 0
    for points, rows in parts:
        vertices.append(points)
        triangles.append(rows + start)
        start += len(points)
        room -= 2 * (points.nbytes + rows.nbytes)
        if room < 0:
            raise NotAsExpectedError(
                "nodes", "place more than a quarter of this machine's memory", "split the model"
            )
    return np.vstack(vertices), np.vstack(triangles)
