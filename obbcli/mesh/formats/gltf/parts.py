"""The parts of a glTF document: what each node of its scene shows, by names and places."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.gltf.json import NotAsExpectedError
from obbcli.mesh.formats.gltf.nodes import Nodes, ShownNode, instances
from obbcli.mesh.formats.gltf.primitives import (
    Primitive,
    has_surface,
    primitives,
    weights_of,
)
from obbcli.mesh.formats.gltf.skins import joint_matrices, skinned
from obbcli.mesh.parts.placed import PlacedPart, UniquePaths, joined

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.formats.gltf.data import Document
    from obbcli.mesh.formats.gltf.json import Json
    from obbcli.mesh.source import MeshArrays

_NO_NUMBERS = np.zeros(0)


def parts_of(document: Document) -> Iterator[PlacedPart]:
    """Yield what every node of the scene shows; the decoded meshes are kept.

    Raises:
        NotAsExpectedError: values out of place; a part's own are found when it is decoded.
    """
    meshes = len(document.items("meshes"))
    decoded = _Decoded(document)
    if not document.items("scenes") and not document.items("nodes"):
        document.source.note("has no nodes: its meshes are taken where they were modelled")
        free = UniquePaths()
        for mesh in range(meshes):
            if has_surface(document, mesh):
                path = free.take(_name(document.item("meshes", mesh)))
                yield PlacedPart(path, mesh, partial(decoded.mesh, mesh, _NO_NUMBERS))
        return
    nodes = Nodes(document)
    paths = _NodePaths(document, nodes)
    shown = set()
    for node in nodes.shown():
        path = paths.of(node)
        if "mesh" not in node.item:
            continue
        shown.add(node.item["mesh"])
        yield from _shown(decoded, nodes, node, paths.instances(path))
    if len(shown) < meshes:
        left = meshes - len(shown)
        document.source.note(f"{left} of {meshes} meshes stand in no node of the scene")


def _shown(
    decoded: _Decoded, nodes: Nodes, node: ShownNode, paths: Iterator[str]
) -> Iterator[PlacedPart]:
    """Yield a node's mesh, once for each instance of it."""
    document, mesh = decoded.document, node.item["mesh"]
    weights = weights_of(document, node.item, f"nodes[{node.number}]")
    if not has_surface(document, mesh):
        return
    places = instances(document, node)
    if "skin" not in node.item:
        decode = partial(decoded.mesh, mesh, weights)
        for matrix in places:
            yield PlacedPart(next(paths), (mesh, *weights.tolist()), decode, matrix)
        return
    if len(places) != 1 or places[0] is not node.matrix:
        raise NotAsExpectedError(
            f"nodes[{node.number}]", "has a skin and instances, which glTF does not define together"
        )
    matrices = joint_matrices(document, nodes, node.item["skin"])
    decode = partial(decoded.skin, mesh, weights, matrices)
    yield PlacedPart(next(paths), ("skin", node.number), decode)


class _Decoded:
    """Decodes a document's meshes, each once.

    Args:
        document: whose meshes.
    """

    def __init__(self, document: Document) -> None:
        self.document = document
        self._primitives: dict[Any, list[Primitive]] = {}
        self._meshes: dict[Any, MeshArrays] = {}

    def mesh(self, mesh: Any, weights: NDArray[np.float64]) -> MeshArrays:
        """Return a mesh's vertices and triangles, morphed."""
        key = (mesh, *weights.tolist())
        if key not in self._meshes:
            found = self._of(mesh, weights)
            self._meshes[key] = self._one((part.vertices, part.triangles) for part in found)
        return self._meshes[key]

    def skin(
        self, mesh: Any, weights: NDArray[np.float64], matrices: NDArray[np.float64]
    ) -> MeshArrays:
        """Return a mesh's vertices and triangles, morphed, as its joints place them."""
        found = self._of(mesh, weights)
        return self._one((skinned(self.document, part, matrices), part.triangles) for part in found)

    def _of(self, mesh: Any, weights: NDArray[np.float64]) -> list[Primitive]:
        key = (mesh, *weights.tolist())
        if key not in self._primitives:
            self._primitives[key] = primitives(self.document, mesh, weights)
        return self._primitives[key]

    def _one(self, parts: Iterable[MeshArrays]) -> MeshArrays:
        listed = list(parts)
        return listed[0] if len(listed) == 1 else joined(listed, self.document.source, "meshes")


class _NodePaths:
    """Names the nodes of a scene, in the order in which they are shown.

    A path is the names from the root down. A group without a name adds none; a node that shows a
    mesh and has no name takes the mesh's.
    """

    def __init__(self, document: Document, nodes: Nodes) -> None:
        self._document = document
        self._nodes = nodes
        self._paths = UniquePaths()
        self._found: dict[int, str | None] = {}

    def of(self, node: ShownNode) -> str:
        """Return the path of a node whose parent was asked for before."""
        parent = self._nodes.parent(node.number)
        outer = None if parent is None else self._found[parent]
        name, shows = _name(node.item), "mesh" in node.item
        if not name and shows:
            name = _name(self._document.item("meshes", node.item["mesh"]))
        if name or shows:
            path = self._paths.take(name if outer is None else f"{outer}/{name}")
        self._found[node.number] = path if name else outer
        return path if name or shows else ""

    def instances(self, path: str) -> Iterator[str]:
        """Yield a path for each instance of a node: its own first."""
        yield path
        while True:
            yield self._paths.take(path)


def _name(item: Json) -> str:
    """Return an object's name, empty where it has none."""
    name = item.get("name")
    return name if isinstance(name, str) else ""
