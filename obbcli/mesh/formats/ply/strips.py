"""Triangle strips of PLY, as Stanford's scans come: vertices in a row, -1 begins another strip."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.text import counted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.source import Source


def strip_triangles(
    source: Source, values: NDArray[Any], counts: NDArray[np.int64], vertex_count: int
) -> NDArray[np.int64]:
    """Return the triangles of all strips in their order, (F, 3).

    Each vertex but the first two of a strip makes a triangle with the two before it; every second
    one is turned over, so that all face alike. Triangles that repeat a vertex, which lead from one
    part of a strip to the next, stay: they have rows in the file.

    Args:
        source: the file, which is given a note.
        values: the lists of all rows, one after the other; -1, in unsigned types the largest
            value, parts strips.
        counts: how long each row's list is.
        vertex_count: how many vertices there are.

    Raises:
        MeshError: an index of no vertex.
    """
    indices = values.astype(np.int64)
    parts = indices == (np.iinfo(values.dtype).max if values.dtype.kind == "u" else -1)
    outside = np.flatnonzero(~parts & ((indices < 0) | (indices >= vertex_count)))
    if len(outside):
        row = int(np.searchsorted(np.cumsum(counts), outside[0], side="right"))
        raise source.error(
            f"uses vertex {indices[outside[0]]} of {vertex_count}",
            "indices start at 0, and -1 begins another strip",
            at=f"tristrips {row}",
        )
    # Where each strip begins: with a row, and after each mark.
    begins = np.zeros(len(indices) + 1, dtype=bool)
    begins[np.cumsum(counts) - counts] = True
    begins[1:] |= parts
    strip = np.cumsum(begins[:-1]) - 1
    first = np.flatnonzero(begins[:-1])
    step = np.arange(len(indices)) - first[strip]
    # Marks take part in no triangle, and a triangle lies in one strip.
    ends = np.flatnonzero(step >= 2)
    ends = ends[~parts[ends]]
    odd = step[ends] % 2 == 1
    triangles = np.stack([indices[ends - 2], indices[ends - 1], indices[ends]], axis=1)
    triangles[odd] = triangles[odd][:, [1, 0, 2]]
    strips = counted(len(np.unique(strip[ends])), "strip")
    source.note(f"{strips} taken as {counted(len(triangles), 'triangle')}")
    return triangles
