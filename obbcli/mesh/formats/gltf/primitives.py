"""The primitives of a glTF mesh as triangles: every mode, compressed ones, morphed ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from obbcli.mesh.formats.gltf.compressed import DRACO, decoded_draco
from obbcli.mesh.formats.gltf.json import (
    NotAsExpectedError,
    extension_of,
    is_count,
    list_in,
    numbers_in,
    object_in,
    words_of,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.gltf.compressed import DracoMesh
    from obbcli.mesh.formats.gltf.data import Document
    from obbcli.mesh.formats.gltf.json import Json

_TRIANGLES, _STRIP, _FAN = 4, 5, 6
#: Points, lines, line loops and line strips have no surface.
_WITHOUT_SURFACE = (0, 1, 2, 3)


class Primitive(NamedTuple):
    """Holds a primitive with triangles.

    Args:
        place: as errors call it.
        vertices: float64 (V, 3), in the mesh's own coordinates, morphed by its default weights.
        triangles: int64 (F, 3).
        attributes: gives the other values of the vertices.
    """

    place: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    attributes: Attributes


class Attributes:
    """Gives the attributes of a primitive's vertices, from accessors or out of a Draco buffer.

    Args:
        document: whose primitive.
        accessors: accessor indices by names of attributes.
        draco: the unpacked buffer and Draco's ids by names of attributes, or None.
        place: of the primitive.

    Raises:
        NotAsExpectedError: from every method.
    """

    def __init__(
        self,
        document: Document,
        accessors: Json,
        draco: tuple[DracoMesh, Json] | None,
        place: str,
    ) -> None:
        self._document = document
        self._accessors = accessors
        self._draco = draco
        self._place = place

    def __contains__(self, name: str) -> bool:
        return name in self._accessors

    def raw(self, name: str, width: int) -> NDArray[Any]:
        """Return the values as they are stored, (V, width)."""
        if name not in self._accessors:
            raise NotAsExpectedError(self._place, f"has no {name}")
        index = self._accessors[name]
        if self._draco is None or name not in self._draco[1]:
            return self._document.accessor(index, width)
        mesh, ids = self._draco
        count, dtype = self._document.form(index, width)
        key = ids[name]
        values = mesh.attributes.get(key) if is_count(key) else None
        if values is None or values.shape != (count, width):
            raise NotAsExpectedError(
                self._place, f"holds compressed {name} that is not what its accessor says"
            )
        if dtype.kind == "f":
            return values.astype(dtype)
        # DracoPy gives what is stored as whole numbers as floats that hold them exactly.
        limits = np.iinfo(dtype)
        if not ((values >= limits.min) & (values <= limits.max)).all():
            raise NotAsExpectedError(self._place, f"holds compressed {name} beyond its type")
        if name == "POSITION" and self._document.is_normalized(index):
            # Draco's own buffers do not say so, and trimesh takes them for lengths as they are.
            self._document.source.note(
                f"whole numbers in the Draco buffer of {self._place} are scaled to -1 to 1, as "
                "their accessor says (normalized)"
            )
        return values.astype(dtype)

    def numbers(self, name: str, width: int) -> NDArray[np.float64]:
        """Return the values as numbers, those of normalised integers scaled back."""
        return self._document.scaled(self._accessors.get(name), self.raw(name, width))


def primitives(document: Document, index: object, weights: NDArray[np.float64]) -> list[Primitive]:
    """Return the primitives of a mesh that have a surface, in the document's order.

    Args:
        document: whose mesh.
        index: of the mesh.
        weights: of its morph targets; empty where none are given.

    Raises:
        NotAsExpectedError: values out of place, with the primitive.
    """
    return [
        _primitive(document, item, weights, place) for place, item in _surfaces(document, index)
    ]


def has_surface(document: Document, index: object) -> bool:
    """Return whether any primitive of a mesh has a surface; none is decoded.

    Raises:
        NotAsExpectedError: a primitive is none.
    """
    return bool(_surfaces(document, index))


def _surfaces(document: Document, index: object) -> list[tuple[str, Json]]:
    """Return the primitives of a mesh that have a surface, with their places."""
    mesh = document.item("meshes", index)
    found = []
    for number, item in enumerate(list_in(mesh, "primitives", f"meshes[{index}]")):
        place = f"meshes[{index}].primitives[{number}]"
        if not isinstance(item, dict):
            raise NotAsExpectedError(place, "is no object")
        mode = item.get("mode", _TRIANGLES)
        if not is_count(mode) or mode > _FAN:
            raise NotAsExpectedError(place, f"has the unknown mode {words_of(mode)}")
        if mode not in _WITHOUT_SURFACE:
            found.append((place, item))
    return found


def _primitive(
    document: Document, item: Json, weights: NDArray[np.float64], place: str
) -> Primitive:
    """Return one primitive."""
    accessors = object_in(item, "attributes", place)
    draco = _draco_of(document, item, place)
    attributes = Attributes(document, accessors, draco, place)
    if "POSITION" not in accessors:
        raise NotAsExpectedError(place, "has no POSITION")
    vertices = attributes.numbers("POSITION", 3)
    vertices = _morphed(document, item, vertices, weights, place)
    triangles = draco[0].triangles if draco else _indexed(document, item, len(vertices), place)
    outside = np.flatnonzero((triangles >= len(vertices)).any(axis=1))
    if len(outside):
        worst = int(triangles[outside[0]].max())
        raise NotAsExpectedError(
            place, f"triangle {outside[0]} uses vertex {worst} of {len(vertices)}"
        )
    return Primitive(place, vertices, triangles, attributes)


def _draco_of(document: Document, item: Json, place: str) -> tuple[DracoMesh, Json] | None:
    """Return the unpacked Draco buffer and its ids; None where the primitive can do without.

    Where plain accessors stand beside it and nothing requires the extension, they count, so that no
    answer depends on which packages are there.
    """
    found = extension_of(item, (DRACO,), place)
    if found is None:
        return None
    accessor = document.item("accessors", item.get("attributes", {}).get("POSITION"))
    if not document.is_required(DRACO) and "bufferView" in accessor:
        return None
    place = f"{place}.extensions.{DRACO}"
    ids = object_in(found[1], "attributes", place)
    if "POSITION" not in ids:
        raise NotAsExpectedError(place, "has no POSITION")
    data = document.bytes_of_view(found[1].get("bufferView"))
    mesh = decoded_draco(document.source, data, place)
    if item.get("mode", _TRIANGLES) == _FAN or "indices" not in item:
        return mesh, ids
    count, _ = document.form(item["indices"], 1)
    if item.get("mode", _TRIANGLES) == _TRIANGLES and count != 3 * len(mesh.triangles):
        fault = f"holds {len(mesh.triangles)} triangles, but its accessor has {count} indices"
        raise NotAsExpectedError(place, fault)
    return mesh, ids


def _morphed(
    document: Document,
    item: Json,
    vertices: NDArray[np.float64],
    weights: NDArray[np.float64],
    place: str,
) -> NDArray[np.float64]:
    """Return positions plus those of the morph targets times their weights, in order.

    Source: glTF 2.0, 3.7.2.2.
    """
    targets = list_in(item, "targets", place)
    if len(weights) and len(weights) != len(targets):
        fault = f"has {len(targets)} morph targets, but {len(weights)} weights"
        raise NotAsExpectedError(place, fault)
    for number, weight in enumerate(weights.tolist()):
        here = f"{place}.targets[{number}]"
        target = targets[number]
        if not isinstance(target, dict):
            raise NotAsExpectedError(here, "is no object")
        if weight == 0.0 or "POSITION" not in target:
            continue
        shifts = document.numbers(target["POSITION"], 3)
        if len(shifts) != len(vertices):
            fault = f"moves {len(shifts)} vertices of {len(vertices)}"
            raise NotAsExpectedError(here, fault)
        with np.errstate(over="ignore", invalid="ignore"):
            vertices = vertices + weight * shifts
        document.source.note("morph targets stand at their default weights")
    return vertices


def weights_of(document: Document, node: Json, place: str) -> NDArray[np.float64]:
    """Return the weights of the morph targets of a node's mesh; the node's own count first."""
    mesh = document.item("meshes", node.get("mesh"))
    if "weights" in node:
        return numbers_in(node, "weights", place, [], any_length=True)
    return numbers_in(mesh, "weights", f"meshes[{node.get('mesh')}]", [], any_length=True)


def _indexed(document: Document, item: Json, vertex_count: int, place: str) -> NDArray[np.int64]:
    """Return the triangles that a primitive's indices list; without them, all vertices in order."""
    if "indices" in item:
        indices = document.accessor(item["indices"], 1).reshape(-1)
        if indices.dtype.kind != "u":
            raise NotAsExpectedError(place, "has indices of no unsigned type")
    else:
        indices = np.arange(vertex_count)
    mode = item.get("mode", _TRIANGLES)
    if mode != _TRIANGLES:
        document.source.note("triangle strips and fans are taken as triangles")
    return _triangles(indices.astype(np.int64), mode, place)


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
