"""PLY, ASCII and binary of both byte orders, read by our own strict reader.

trimesh moves the second half of every quad to the end and loads negative or huge counts and bad
indices silently; meshio ends the process on a negative count and reserves what a header claims.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.ply_body import read_ascii, read_binary
from obbcli.mesh.formats.ply_header import Header, read_header
from obbcli.mesh.formats.polygons import triangulated

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.ply_body import Columns
    from obbcli.mesh.source import MeshArrays, Source

_INDEX_NAMES = ("vertex_indices", "vertex_index")


def read_ply(source: Source) -> MeshArrays:
    """Return vertices and triangles of a PLY file; polygons are cut in the file's order.

    Raises:
        MeshError: a bad header, counts that do not fit the body, a bad number or index.
    """
    header = read_header(source)
    tables = read_binary(source, header) if header.order else read_ascii(source, header)
    vertices = _vertices(source, tables)
    corners, counts = _faces(source, header, tables)
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
    return vertices, triangulated(source, vertices, corners, counts)


def _vertices(source: Source, tables: dict[str, Columns]) -> NDArray[np.float64]:
    """Return the coordinates, (V, 3)."""
    columns = tables.get("vertex", {})
    axes = [columns.get(axis) for axis in "xyz"]
    if any(axis is None or axis[1] is not None for axis in axes):
        raise source.error("has no element vertex with x, y and z", "it is no mesh")
    return np.stack([axis[0].astype(np.float64) for axis in axes if axis is not None], axis=1)


def _faces(
    source: Source, header: Header, tables: dict[str, Columns]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the corners of all faces and how many each has."""
    columns = tables.get("face", {})
    values, counts = next((columns[n] for n in _INDEX_NAMES if n in columns), (None, None))
    if values is None or counts is None:
        if any(element.name == "tristrips" for element in header.elements):
            raise source.error("holds triangle strips, not faces", "export it with faces")
        raise source.error("has no faces", "a mesh is a surface of triangles")
    if values.dtype.kind == "f":
        raise source.error("the faces' vertex indices are not of a whole type")
    return values.astype(np.int64), counts
