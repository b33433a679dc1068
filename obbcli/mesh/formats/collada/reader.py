"""COLLADA, read by a reader of our own as its specification says (1.4.1).

trimesh, through pycollada, fans concave polygons, drops geometries beside empty elements and reads
no skins. Only what makes and places surface is read.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from obbcli.mesh.formats.collada.document import Document
from obbcli.mesh.formats.collada.primitives import decoded, surfaces
from obbcli.mesh.formats.collada.scene import Shown, shown_parts
from obbcli.mesh.formats.collada.transforms import affine
from obbcli.mesh.parts.placed import PlacedPart, joined, transformed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.formats.safe_xml import Element
    from obbcli.mesh.source import MeshArrays, Source


def read_collada(source: Source) -> MeshArrays:
    """Return vertices and triangles of the document's scene, turned to Z up.

    Nodes are taken depth first in the document's order, of each node its geometries before the
    nodes in it. Matrices are applied in double precision, and a mirrored node's triangles are
    turned over. Skins stand in their bind shape. Lines and splines have no surface.

    Raises:
        MeshError: no whole XML, another version, links that lead nowhere, counts that do not fit,
            indices out of range, what may make or place surface and is not read.
    """
    return joined((part.placed() for part in parts_collada(source)), source, "nodes")


def parts_collada(source: Source) -> Iterator[PlacedPart]:
    """Yield the parts of the scene: each geometry that a node shows, in `read_collada`'s order.

    Raises:
        MeshError: as `read_collada`; what is wrong with a part's own values, when it is decoded.
    """
    document = Document(source)
    meshes = _Decoded(document)
    if any(library.children for library in document.root.named("library_animations")):
        source.note("animations are not played")
    for shown in shown_parts(document):
        if meshes.has_surface(shown.geometry):
            key = (id(shown.geometry), id(shown.skin))
            yield PlacedPart(shown.path, key, partial(meshes.of, shown), shown.matrix)


class _Decoded:
    """Decodes the geometries of a document, each once."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._surfaces: dict[int, list[Element]] = {}
        self._arrays: dict[int, MeshArrays] = {}

    def has_surface(self, geometry: Element) -> bool:
        """Return whether a geometry holds more than lines."""
        if id(geometry) not in self._surfaces:
            self._surfaces[id(geometry)] = surfaces(self._document, geometry)
        return bool(self._surfaces[id(geometry)])

    def of(self, shown: Shown) -> MeshArrays:
        """Return vertices and triangles of what is shown, in its bind shape where it is a skin."""
        key = id(shown.geometry)
        if key not in self._arrays:
            self._arrays[key] = decoded(self._document, self._surfaces[key])
        vertices, triangles = self._arrays[key]
        bind = None if shown.skin is None else shown.skin.first("bind_shape_matrix")
        if bind is None:
            return vertices, triangles
        return transformed(vertices, affine(self._document.values, bind)), triangles
