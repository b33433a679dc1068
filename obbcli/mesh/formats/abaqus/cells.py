"""The cells of an Abaqus part: numbers of nodes turned into rows of points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.cells.parts import CellPart
from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.formats.text import counted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.abaqus.scope import Elements, Scope
    from obbcli.mesh.source import Source


def cells_of(source: Source, scopes: list[Scope]) -> CellPart:
    """Return the cells of scopes that share their numbers: a part, and what an instance adds.

    Notes what is defined more than once, and elements that stand for a body of revolution.

    Raises:
        MeshError: an element uses a node that is not defined; with the line.
    """
    none = np.zeros(0, dtype=np.int64)
    numbers = np.concatenate([none, *(each for scope in scopes for each in scope.numbers)])
    places = np.concatenate(
        [np.zeros((0, 3)), *(each for scope in scopes for each in scope.places)]
    )
    last = _last(numbers)
    if len(last) < len(numbers):
        _note_nodes(source, numbers, places, last)
        numbers, places = numbers[last], places[last]
    elements = [each for scope in scopes for each in scope.elements]
    kept = _kept(source, elements)
    order = np.argsort(numbers, kind="stable")
    ordered = numbers[order]
    blocks = []
    for block, rows in zip(elements, kept, strict=True):
        if block.shape.is_axisymmetric:
            source.note("axisymmetric elements taken as the flat section that they are, not turned")
        cell = block.shape.cell
        if cell is not None and rows.any():
            blocks.append(Block(cell, _points_of(_rows(block, rows), order, ordered)))
    return CellPart(scopes[0].name, places, blocks)


def _last(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the rows of each number's last occurrence, in order."""
    _, first = np.unique(numbers[::-1], return_index=True)
    return np.sort(len(numbers) - 1 - first)


def _note_nodes(
    source: Source,
    numbers: NDArray[np.int64],
    places: NDArray[np.float64],
    last: NDArray[np.int64],
) -> None:
    """Note nodes whose definitions differ."""
    order = last[np.argsort(numbers[last])]
    final = places[order[np.searchsorted(numbers[order], numbers)]]
    moved = len(np.unique(numbers[(final != places).any(axis=1)]))
    if moved:
        source.note(f"{counted(moved, 'node')} defined more than once taken where defined last")


def _kept(source: Source, elements: list[Elements]) -> list[NDArray[np.bool_]]:
    """Return which elements of each block no later element takes the place of."""
    if not elements:
        return []
    numbers = np.concatenate([block.numbers for block in elements])
    kept = numbers < 0
    kept[_last(numbers)] = True
    if not kept.all():
        count = counted(int((~kept).sum()), "element")
        source.note(f"{count} left out: defined again later, and the last definition counts")
    return np.split(kept, np.cumsum([len(block.numbers) for block in elements])[:-1])


def _rows(block: Elements, rows: NDArray[np.bool_]) -> Elements:
    if rows.all():
        return block
    columns = (block.numbers[rows], block.nodes[rows], block.lines[rows])
    return block._replace(numbers=columns[0], nodes=columns[1], lines=columns[2])


def _points_of(
    block: Elements, order: NDArray[np.int64], ordered: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return the rows of elements' nodes.

    Args:
        block: the elements.
        order: (V,), rows of the nodes in the order of their numbers.
        ordered: (V,), the numbers in this order.
    """
    at = np.searchsorted(ordered, block.nodes)
    there = at < len(ordered)
    there[there] = ordered[at[there]] == block.nodes[there]
    if not there.all():
        row = int(np.argmin(there.all(axis=1)))
        node = int(block.nodes[row][~there[row]][0])
        raise block.section.source.error(
            f"element {block.numbers[row]} uses node {node}, which is not defined",
            "write the node, or remove the element",
            at=str(int(block.lines[row])),
        )
    result: NDArray[np.int64] = order[at]
    return result
