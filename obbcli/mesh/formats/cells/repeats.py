"""Volume cells that a file holds twice: their faces would all be met twice, and hide the body."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.cells.types import CELLS
from obbcli.mesh.formats.text import counted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.source import Source

#: Odd constants by which numbers of nodes are spread over 64 bits (those of SplitMix64).
_SPREAD = (np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB))


def repeated_volumes(source: Source, cells: list[tuple[str, Any]]) -> list[NDArray[np.bool_]]:
    """Return which cells of each block have the corners of an earlier volume cell; notes tell it.

    Corners are compared as sets. Polyhedra, whose faces a file names itself, are left out.

    Args:
        source: the file, which is given the note.
        cells: kind and nodes of each block, in the file's order.
    """
    repeated = [np.zeros(len(nodes), dtype=bool) for _, nodes in cells]
    chosen, corners = [], []
    for number, (kind, nodes) in enumerate(cells):
        if kind in CELLS and CELLS[kind].is_volume and len(nodes):
            chosen.append(number)
            count = 1 + max(max(face.corners) for face in CELLS[kind].faces)
            corners.append(np.asarray(nodes)[:, :count])
    if not chosen:
        return repeated
    keys = np.concatenate([_keys(each) for each in corners])
    first, which = np.unique(keys, return_index=True, return_inverse=True)[1:]
    if len(first) == len(keys):
        return repeated
    blocks = np.repeat(np.arange(len(chosen)), [len(each) for each in corners])
    rows = np.concatenate([np.arange(len(each)) for each in corners])
    origin = first[which.reshape(-1)]
    total = 0
    for place in np.flatnonzero(origin != np.arange(len(keys))):
        before = corners[blocks[origin[place]]][rows[origin[place]]]
        if np.array_equal(np.sort(corners[blocks[place]][rows[place]]), np.sort(before)):
            repeated[chosen[blocks[place]]][rows[place]] = True
            total += 1
    if total:
        have = "repeats an earlier one and is" if total == 1 else "repeat earlier ones and are"
        source.note(f"{counted(total, 'volume cell')} {have} left out")
    return repeated


def _keys(corners: NDArray[Any]) -> NDArray[np.uint64]:
    """Return a number of each cell that depends on the set of its corners alone."""
    spread = corners.astype(np.int64).view(np.uint64) + np.uint64(0x9E3779B97F4A7C15)
    for factor, shift in zip(_SPREAD, (30, 27), strict=True):
        spread = (spread ^ (spread >> np.uint64(shift))) * factor
    spread ^= spread >> np.uint64(31)
    keys: NDArray[np.uint64] = spread.sum(axis=1, dtype=np.uint64)
    return keys
