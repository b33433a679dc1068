"""Shells and solids of a section of bulk data as blocks of cells, in the file's order."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.formats.nastran import cards as known
from obbcli.mesh.formats.nastran.numbers import real_numbers, whole_numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.nastran.grids import Grids
    from obbcli.mesh.formats.nastran.section import Section


class Elements(NamedTuple):
    """Holds the elements of one card's name.

    Args:
        name: of the card.
        numbers: identification numbers, (n,).
        lines: of the section, (n,).
        nodes: rows of the GRIDs in the order of `Element.nodes`, -1 for a middle node that is not
            there, (n, nodes).
        offsets: how many stand off their GRIDs.
    """

    name: bytes
    numbers: NDArray[np.int64]
    lines: NDArray[np.int64]
    nodes: NDArray[np.int64]
    offsets: int


def read_elements(section: Section, grids: Grids) -> list[Elements]:
    """Return the elements of a section that have surface.

    An element that repeats an earlier one, number and nodes, is taken once, as Nastran does.

    Raises:
        MeshError: a field that is no number, a corner that is missing, a GRID that is not there,
            one number for two elements.
    """
    found = [
        _read(section, grids, name, element)
        for name, element in known.ELEMENTS.items()
        if name in section.cards
    ]
    return _without_repeats(section, found)


def _read(section: Section, grids: Grids, name: bytes, element: known.Element) -> Elements:
    count = 1 + max(*element.nodes, element.offset or 0)
    table = _without_systems(section.fields(name, count))
    numbers = whole_numbers(table[:, 0])
    section.refuse(name, table[:, 0], numbers <= 0, "a number above 0")
    words = table[:, element.nodes]
    nodes = whole_numbers(words)
    for column in range(nodes.shape[1]):
        is_corner = column < element.corners
        wrong = nodes[:, column] <= 0 if is_corner else nodes[:, column] < 0
        what = f"the GRID of corner {column + 1}" if is_corner else "a GRID or nothing"
        section.refuse(name, words[:, column], wrong, what)
    rows = grids.rows(nodes)
    missing = (rows < 0) & (nodes > 0)
    if missing.any():
        card = int(np.argmax(missing.any(axis=1)))
        number = int(nodes[card][missing[card]][0])
        raise section.deck.error(
            section.line_of(name, card),
            f"{name.decode('ascii')} {numbers[card]} uses GRID {number}, which is not in the deck",
            "add the GRID, or the INCLUDE that holds it",
        )
    offsets = 0
    if element.offset is not None:
        values, wrong = real_numbers(table[:, element.offset])
        offsets = int((wrong | (values != 0)).sum())
    return Elements(name, numbers, section.cards[name].lines, rows, offsets)


def _without_systems(table: NDArray[np.bytes_]) -> NDArray[np.bytes_]:
    """Return fields without a material's system, which may follow the last GRID of a solid."""
    if table.dtype.itemsize < len(known.MATERIAL_SYSTEM):
        return table
    letters = table.view(np.uint8).reshape(*table.shape, -1)
    named = (letters == known.MATERIAL_SYSTEM[0]).any(axis=2)
    for row, field in np.argwhere(named).tolist():
        if table[row, field].strip() == known.MATERIAL_SYSTEM:
            table[row, field:] = b""
    return table


def _without_repeats(section: Section, found: list[Elements]) -> list[Elements]:
    """Return the elements without those that repeat an earlier one."""
    numbers = np.concatenate([part.numbers for part in found] or [np.zeros(0, dtype=np.int64)])
    if (numbers[1:] > numbers[:-1]).all() or len(np.unique(numbers)) == len(numbers):
        return found
    first, which, counts = np.unique(
        numbers, return_index=True, return_inverse=True, return_counts=True
    )[1:]
    kinds = np.repeat(np.arange(len(found)), [len(part.numbers) for part in found])
    rows = np.concatenate([np.arange(len(part.numbers)) for part in found])
    kept = np.ones(len(numbers), dtype=bool)
    for place in np.flatnonzero((counts[which] > 1) & (first[which] != np.arange(len(numbers)))):
        origin = first[which[place]]
        part, row = found[kinds[place]], rows[place]
        before, earlier = found[kinds[origin]], rows[origin]
        if part is not before or not np.array_equal(part.nodes[row], part.nodes[earlier]):
            other = section.deck.place(int(section.lines.numbers[before.lines[earlier]]))
            raise section.deck.error(
                int(section.lines.numbers[part.lines[row]]),
                f"element {part.numbers[row]} is another one than at {other}",
                "give each element a number of its own",
            )
        kept[place] = False
    return [
        part._replace(
            numbers=part.numbers[kept[kinds == kind]],
            lines=part.lines[kept[kinds == kind]],
            nodes=part.nodes[kept[kinds == kind]],
        )
        for kind, part in enumerate(found)
    ]


def cell_blocks(section: Section, found: list[Elements]) -> list[Block]:
    """Return elements as cells of VTK's types, which know their places in the deck.

    Args:
        section: whose elements they are.
        found: the elements of each name.
    """
    blocks = []
    for part in found:
        element = known.ELEMENTS[part.name]
        places = section.lines.numbers[part.lines]
        nodes = part.nodes
        for count in element.node_counts:
            # Cells of the fewest nodes that hold all theirs: the first count is of corners alone.
            fits = (nodes[:, count:] < 0).all(axis=1)
            if fits.any():
                kind = element.cell if count == element.corners else f"{element.cell}{count}"
                blocks.append(Block(kind, nodes[fits][:, :count], places[fits]))
                nodes, places = nodes[~fits], places[~fits]
    return blocks
