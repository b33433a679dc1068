"""The nodes of a glTF document: which a scene shows, and where in the world each stands."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.gltf.extensions import INSTANCING, VISIBILITY
from obbcli.mesh.formats.gltf.json import (
    NotAsExpectedError,
    extension_of,
    is_count,
    list_in,
    numbers_in,
    words_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.formats.gltf.data import Document
    from obbcli.mesh.formats.gltf.json import Json

    #: (4, 4), which applies to columns; None stands for the identity.
    Matrix = NDArray[np.float64] | None

_PLACEMENT = ("translation", "rotation", "scale")
_LAST_ROW = [0.0, 0.0, 0.0, 1.0]
#: Last rows are rounded to float32, or to a few digits of a text.
_ROUNDING = 1e-3
#: By how much a quaternion's length may be off 1: bytes hold one to within 0.8 %.
_QUATERNION_ROUNDING = 0.02


class ShownNode(NamedTuple):
    """Holds a node of the scene and the matrix from its own coordinates to the world's."""

    number: int
    item: Json
    matrix: Matrix


class Nodes:
    """Finds the nodes that a document shows, and their places.

    Args:
        document: whose nodes.

    Raises:
        NotAsExpectedError: from every method, and where a node has two parents.
    """

    def __init__(self, document: Document) -> None:
        self._document = document
        self._parents: dict[int, int] = {}
        for index in range(len(document.items("nodes"))):
            place = f"nodes[{index}]"
            for child in list_in(document.item("nodes", index), "children", place):
                self._add_child(index, child)
        self._worlds: dict[int, Matrix] = {}

    def _add_child(self, parent: int, child: object) -> None:
        self._document.item("nodes", child)
        assert isinstance(child, int)
        if child in self._parents:
            raise NotAsExpectedError(
                f"nodes[{child}]",
                f"is met twice, as child of nodes[{self._parents[child]}] and of nodes[{parent}]; "
                "the nodes of a scene form a tree",
            )
        self._parents[child] = parent

    def shown(self) -> Iterator[ShownNode]:
        """Yield the nodes of the default scene: depth first, in the document's order.

        Without scenes all nodes that are no child of another are roots.
        """
        roots = self._roots()
        # An explicit stack: documents may nest deeper than Python recurses.
        pending: list[int] = list(reversed(roots))
        met: set[int] = set()
        while pending:
            index = pending.pop()
            node = self._document.item("nodes", index)
            if index in met:
                raise NotAsExpectedError(
                    f"nodes[{index}]", "is met twice; the nodes of a scene form a tree"
                )
            met.add(index)
            shown = extension_of(node, (VISIBILITY,), f"nodes[{index}]")
            if shown is not None and shown[1].get("visible") is False:
                self._document.source.note("nodes that are marked as not visible are taken as well")
            pending += reversed(list_in(node, "children", f"nodes[{index}]"))
            yield ShownNode(index, node, self.world(index))

    def parent(self, index: int) -> int | None:
        """Return the node that a node is a child of, None for a root."""
        return self._parents.get(index)

    def _roots(self) -> list[int]:
        """Return the roots of the scene that counts."""
        document = self._document
        scenes = document.items("scenes")
        if not scenes:
            free = [i for i in range(len(document.items("nodes"))) if i not in self._parents]
            document.source.note("has no scenes: all root nodes are taken")
            return free
        number = document.content.get("scene", 0)
        scene = document.item("scenes", number)
        if len(scenes) > 1:
            document.source.note(f"scene {number} of {len(scenes)} is taken (counted from 0)")
        roots = list_in(scene, "nodes", f"scenes[{number}]")
        for root in roots:
            document.item("nodes", root)
            if root in self._parents:
                parent = self._parents[root]
                raise NotAsExpectedError(
                    f"nodes[{root}]",
                    f"is met twice, as a root of scenes[{number}] and as child of nodes[{parent}]",
                )
        return roots

    def world(self, index: object) -> Matrix:
        """Return the matrix from a node's own coordinates to the world's."""
        chain: list[int] = []
        climbed: set[int] = set()
        if not is_count(index):
            raise NotAsExpectedError("nodes", f"has no item {words_of(index)}")
        at: int | None = index
        while at is not None and at not in self._worlds:
            if at in climbed:
                raise NotAsExpectedError(f"nodes[{at}]", "is met twice: it is above itself")
            climbed.add(at)
            chain.append(at)
            at = self._parents.get(at)
        outer = None if at is None else self._worlds[at]
        for at in reversed(chain):
            outer = composed(outer, local_matrix(self._document.item("nodes", at), f"nodes[{at}]"))
            self._worlds[at] = outer
        return outer


def instances(document: Document, node: ShownNode) -> list[Matrix]:
    """Return the matrices that place a node's mesh: one, or those of EXT_mesh_gpu_instancing.

    Raises:
        NotAsExpectedError: instance attributes of another kind, or of several lengths.
    """
    place = f"nodes[{node.number}]"
    found = extension_of(node.item, (INSTANCING,), place)
    if found is None:
        return [node.matrix]
    place = f"{place}.extensions.{INSTANCING}"
    attributes = found[1].get("attributes")
    if not isinstance(attributes, dict) or not attributes:
        raise NotAsExpectedError(place, "has no attributes")
    widths = {"TRANSLATION": 3, "ROTATION": 4, "SCALE": 3}
    rows = {
        name: document.numbers(attributes[name], width)
        for name, width in widths.items()
        if name in attributes
    }
    counts = {len(values) for values in rows.values()}
    if len(counts) != 1:
        raise NotAsExpectedError(place, "places no instances, or not as many by each attribute")
    keys = {"TRANSLATION": "translation", "ROTATION": "rotation", "SCALE": "scale"}
    matrices = []
    for row in range(counts.pop()):
        item: Json = {keys[name]: values[row].tolist() for name, values in rows.items()}
        matrices.append(composed(node.matrix, local_matrix(item, f"{place}, instance {row}")))
    return matrices


def local_matrix(node: Json, place: str) -> Matrix:
    """Return the matrix (4, 4) of a node's own placement, None where it has none.

    Raises:
        NotAsExpectedError: numbers that are none, a projection, a rotation that is no unit
            quaternion, or both a matrix and its parts.
    """
    if "matrix" in node:
        if any(key in node for key in _PLACEMENT):
            raise NotAsExpectedError(place, "has both a matrix and its parts, expected one of them")
        identity = np.eye(4).reshape(-1).tolist()
        return affine(numbers_in(node, "matrix", place, identity).reshape(4, 4).T, place)
    if not any(key in node for key in _PLACEMENT):
        return None
    matrix = np.eye(4)
    x, y, z, w = numbers_in(node, "rotation", place, [0.0, 0.0, 0.0, 1.0]).tolist()
    square = x * x + y * y + z * z + w * w
    if square == 0.0:
        raise NotAsExpectedError(f"{place}.rotation", "is zero, expected a unit quaternion")
    if abs(square**0.5 - 1.0) > _QUATERNION_ROUNDING:
        raise NotAsExpectedError(
            f"{place}.rotation", f"has length {square**0.5:.6g}, expected a unit quaternion"
        )
    s = 2.0 / square
    matrix[:3, :3] = [
        [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
    ]
    matrix[:3, :3] *= numbers_in(node, "scale", place, [1.0, 1.0, 1.0])
    matrix[:3, 3] = numbers_in(node, "translation", place, [0.0, 0.0, 0.0])
    return matrix


def affine(matrix: NDArray[np.float64], place: str) -> NDArray[np.float64]:
    """Return a matrix whose last row is 0 0 0 1, or refuse it: glTF knows no projections."""
    if not (np.abs(matrix[..., 3, :] - _LAST_ROW) <= _ROUNDING).all():
        raise NotAsExpectedError(place, "has a matrix whose last row is not 0 0 0 1")
    result = np.array(matrix)
    result[..., 3, :] = _LAST_ROW
    return result


def composed(outer: Matrix, inner: Matrix) -> Matrix:
    """Return the matrix that applies `inner`, then `outer`."""
    if outer is None or inner is None:
        return inner if outer is None else outer
    # Term by term: a matrix product of the platform's library may round otherwise elsewhere.
    with np.errstate(over="ignore", invalid="ignore"):
        terms = outer[:, :, np.newaxis] * inner[np.newaxis, :, :]
        return np.asarray(((terms[:, 0] + terms[:, 1]) + terms[:, 2]) + terms[:, 3])
