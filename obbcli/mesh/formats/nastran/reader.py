"""Nastran's bulk data (MSC, Simcenter, Autodesk, MYSTRAN) and OptiStruct's, by a reader of our own.

meshio ignores coordinate systems, INCLUDE and superelements in silence and refuses most real
decks; pyNastran, which reads them, excludes NumPy 2. Definitions follow the programs' Quick
Reference Guides. Whatever makes, places or copies surface is taken or refused by its card's name:
`nastran_cards` holds the lists.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.cells.surface import Block, surface
from obbcli.mesh.formats.nastran.checks import check_continuations, check_names, tell_of
from obbcli.mesh.formats.nastran.deck import Deck
from obbcli.mesh.formats.nastran.elements import Elements, cell_blocks, read_elements
from obbcli.mesh.formats.nastran.grids import read_grids
from obbcli.mesh.formats.nastran.lines import Lines
from obbcli.mesh.formats.nastran.section import Section
from obbcli.mesh.formats.text import counted

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.nastran.lines import Cards
    from obbcli.mesh.source import MeshArrays, Source

#: Of a deck without surface, so many cards' names are shown.
_MOST_NAMES = 6


def read_nastran(source: Source) -> MeshArrays:
    """Return all GRIDs in basic coordinates, and the surface of the shells and solids.

    Superelements that the deck holds as parts of its own (`BEGIN SUPER=n`) stand where their GRIDs
    do, behind one another in the file's order.

    Raises:
        MeshError: a card that could make surface and is not read, a field that is no number, a
            GRID, system or included file that is missing, no shell or solid.
    """
    deck = Deck(source)
    points: list[NDArray[np.float64]] = []
    blocks: list[Block] = []
    cards, elements, before = [], [], 0
    for part in deck.sections:
        lines = Lines(deck, part)
        section = Section(deck, lines, lines.cards())
        check_continuations(deck, lines)
        check_names(deck, lines, section.cards)
        grids = read_grids(section)
        found = read_elements(section, grids)
        blocks += cell_blocks(section, found, before)
        points.append(grids.places)
        cards.append(section.cards)
        elements += found
        before += len(grids.places)
    if not blocks:
        raise _without_surface(source, cards)
    tell_of(deck, cards)
    _tell_offsets(source, elements)
    vertices = np.concatenate(points)
    return vertices, surface(source, vertices, blocks)


def _tell_offsets(source: Source, elements: list[Elements]) -> None:
    count = sum(part.offsets for part in elements)
    if count:
        off = "stands off its" if count == 1 else "stand off their"
        are = "it is" if count == 1 else "they are"
        source.note(f"{counted(count, 'shell')} {off} GRIDs (ZOFFS), at which {are} taken")


def _without_surface(source: Source, cards: list[Mapping[bytes, Cards]]) -> MeshError:
    names = sorted({name for group in cards for name in group})
    held = ", ".join(name.decode("latin-1") for name in names[:_MOST_NAMES])
    more = len(names) - _MOST_NAMES
    held += f" and {counted(more, 'more kind')}" if more > 0 else ""
    return source.error(
        f"has no surface, no shell and no solid element; its cards are {held or 'none at all'}",
        "a mesh is a surface of triangles",
    )
