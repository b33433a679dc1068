"""PLY, ASCII and binary of both byte orders, read by our own strict reader.

trimesh moves the second half of every quad to the end and loads negative or huge counts and bad
indices silently; meshio ends the process on a negative count and reserves what a header claims.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.ply.body import read_ascii, read_binary
from obbcli.mesh.formats.ply.header import read_header
from obbcli.mesh.formats.ply.strips import strip_triangles
from obbcli.mesh.formats.polygons import triangulated

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.ply.body import Columns
    from obbcli.mesh.formats.ply.header import Element, Header
    from obbcli.mesh.source import MeshArrays, Source

_SURFACE = ("face", "tristrips")
_INDEX_NAMES = ("vertex_indices", "vertex_index")
#: They list vertices, and have no surface.
_WITHOUT_SURFACE = frozenset(("vertex", "edge", "edges", "line", "lines", "point", "points"))


def read_ply(source: Source) -> MeshArrays:
    """Return vertices and triangles of a PLY file, faces and strips in the file's order.

    Polygons are cut as `triangulated` says, strips become the triangles that they stand for.

    Raises:
        MeshError: a bad header, counts that do not fit the body, a bad number or index, an element
            that may be surface and is not read.
    """
    header = read_header(source)
    tables = read_binary(source, header) if header.order else read_ascii(source, header)
    vertices = _vertices(source, tables)
    rows = [
        _surface_of(source, element, tables[element.name], vertices)
        for element in header.elements
        if element.name not in _WITHOUT_SURFACE
    ]
    found = [part for part in rows if part is not None]
    if not found:
        raise source.error(_no_faces(header), "a mesh is a surface of triangles")
    return vertices, found[0] if len(found) == 1 else np.vstack(found)


def _surface_of(
    source: Source, element: Element, columns: Columns, vertices: NDArray[np.float64]
) -> NDArray[np.int64] | None:
    """Return the triangles of one element, None where it is none of surface."""
    values, counts = next((columns[n] for n in _INDEX_NAMES if n in columns), (None, None))
    if values is None or counts is None:
        if element.name not in _SURFACE and element.count and _lists_whole_numbers(element):
            source.note(f"element {element.name[:40]} is not known and was passed over")
        return None
    place = element.name
    if place not in _SURFACE:
        raise source.error(
            f"element {place[:40]} lists vertices, and is not read", "export it with faces"
        )
    if values.dtype.kind == "f":
        raise source.error(f"the vertex indices of element {place} are not of a whole type")
    if place == "tristrips":
        return strip_triangles(source, values, counts, len(vertices))
    corners = values.astype(np.int64)
    short = np.flatnonzero(counts < 3)
    if len(short):
        raise source.error(
            f"has {counts[short[0]]} vertices, at least 3 wanted", at=f"face {short[0]}"
        )
    outside = np.flatnonzero((corners < 0) | (corners >= len(vertices)))
    if len(outside):
        face = int(np.searchsorted(np.cumsum(counts), outside[0], side="right"))
        raise source.error(
            f"uses vertex {corners[outside[0]]} of {len(vertices)}",
            "indices start at 0",
            at=f"face {face}",
        )
    return triangulated(source, vertices, corners, counts)


def _lists_whole_numbers(element: Element) -> bool:
    """Return whether an element has lists that may be of vertices; those of bytes hold words."""
    return any(
        p.count_kind is not None and p.kind.kind in "iu" and p.kind.itemsize > 1
        for p in element.properties
    )


def _no_faces(header: Header) -> str:
    """Return what is wrong with a file without surface."""
    for element in header.elements:
        if element.name in _SURFACE and element.count:
            return f"has no faces: element {element.name} has no list {_INDEX_NAMES[0]}"
    return "has no faces"


def _vertices(source: Source, tables: dict[str, Columns]) -> NDArray[np.float64]:
    """Return the coordinates, (V, 3)."""
    columns = tables.get("vertex", {})
    axes = [columns.get(axis) for axis in "xyz"]
    if any(axis is None or axis[1] is not None for axis in axes):
        raise source.error("has no element vertex with x, y and z", "it is no mesh")
    return np.stack([axis[0].astype(np.float64) for axis in axes if axis is not None], axis=1)
