"""Parts of cells, each with points of its own, as one surface; shared by readers of such formats.

Parts share no points, so that each has the boundary that it would have alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.cells.surface import Block, surface

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from obbcli.mesh.source import MeshArrays, Source


class CellPart(NamedTuple):
    """Holds the cells of a part, an instance or a zone.

    Args:
        name: as the file has it; "" without one.
        points: float64 (V, 3).
        blocks: its cells, whose nodes are rows of `points`.
    """

    name: str
    points: NDArray[np.float64]
    blocks: list[Block]


def joined_surface(source: Source, parts: Sequence[CellPart]) -> MeshArrays:
    """Return the surfaces of all parts, one part after the other; notes count all parts.

    Raises:
        MeshError: as in `surface`.
    """
    points, triangles, _ = _surface_by_part(source, parts)
    return points, triangles


def surfaces(source: Source, parts: Sequence[CellPart]) -> list[MeshArrays]:
    """Return the surface of each part, as it has it alone; notes count all parts.

    Raises:
        MeshError: as in `surface`.
    """
    _, triangles, ends = _surface_by_part(source, parts)
    found: list[MeshArrays] = []
    first = row = 0
    for part, end in zip(parts, ends.tolist(), strict=True):
        found.append((part.points, triangles[row:end] - first))
        first, row = first + len(part.points), end
    return found


def _surface_by_part(
    source: Source, parts: Sequence[CellPart]
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Return points and triangles of all parts in order, and where each part's triangles end."""
    points = np.concatenate([np.zeros((0, 3)), *(part.points for part in parts)])
    ends = np.cumsum([len(part.points) for part in parts])
    # A block a kind: blocks cost more than cells where a file has thousands of them.
    kinds: dict[str, list[tuple[NDArray[np.int64], NDArray[np.int64]]]] = {}
    cells = 0
    for part, end in zip(parts, ends.tolist(), strict=True):
        here, first = cells, end - len(part.points)
        for block in part.blocks:
            places = np.arange(cells - here, cells - here + len(block.nodes))
            places = (places if block.places is None else block.places) + here
            kinds.setdefault(block.kind, []).append((block.nodes + first, places))
            cells += len(block.nodes)
    blocks = []
    for kind, each in kinds.items():
        nodes, place = zip(*each, strict=True)
        blocks.append(Block(kind, np.concatenate(nodes), np.concatenate(place)))
    # One call, so that notes count all parts; it lists the flat cells of all of them first.
    triangles = surface(source, points, blocks)
    part_of = np.searchsorted(ends, triangles[:, 0], side="right")
    triangles = triangles[np.argsort(part_of, kind="stable")]
    return points, triangles, np.cumsum(np.bincount(part_of, minlength=len(parts)))
