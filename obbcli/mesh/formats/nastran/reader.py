"""Nastran's bulk data (MSC, Simcenter, Autodesk, MYSTRAN) and OptiStruct's, by a reader of our own.

meshio ignores coordinate systems, INCLUDE and superelements in silence and refuses most real
decks; pyNastran, which reads them, excludes NumPy 2. Definitions follow the programs' Quick
Reference Guides. Whatever makes, places or copies surface is taken or refused by its card's name:
`nastran_cards` holds the lists.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from obbcli.mesh.formats.cells.parts import CellPart, joined_surface
from obbcli.mesh.formats.nastran import cards as known
from obbcli.mesh.formats.nastran.checks import check_continuations, check_names, tell_of
from obbcli.mesh.formats.nastran.deck import MAIN, Deck
from obbcli.mesh.formats.nastran.elements import Elements, cell_blocks, read_elements
from obbcli.mesh.formats.nastran.grids import read_grids
from obbcli.mesh.formats.nastran.lines import Lines
from obbcli.mesh.formats.nastran.section import Section
from obbcli.mesh.formats.text import counted
from obbcli.mesh.parts.placed import PlacedPart, UniquePaths

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

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
    bodies = _bodies(source)
    parts, elements = [], []
    for body in bodies:
        part, found = body.cells()
        parts.append(part)
        elements += found
    _tell_offsets(source, elements)
    return joined_surface(source, parts)


def parts_nastran(source: Source) -> Iterator[PlacedPart]:
    """Yield the superelements of a deck; the GRIDs and elements of each are read when it is asked.

    Cards are found and looked at throughout, as one may place another superelement.

    Raises:
        MeshError: as `read_nastran`; what is wrong with a part's own fields, when it is decoded.
    """
    paths = UniquePaths()
    for body in _bodies(source):
        yield PlacedPart(paths.take(body.name), body.name, partial(_decoded, source, body))


def _decoded(source: Source, body: _Body) -> MeshArrays:
    part, elements = body.cells()
    _tell_offsets(source, elements)
    return joined_surface(source, [part])


class _Body(NamedTuple):
    """Holds a section of bulk data that has shells or solids.

    Args:
        name: `SUPER=n`, or "" where it is no superelement's.
        section: its lines and cards.
    """

    name: str
    section: Section

    def cells(self) -> tuple[CellPart, list[Elements]]:
        """Return its cells, and the elements that they are made of.

        Raises:
            MeshError: a field is none, a GRID or a system is missing; with the line.
        """
        grids = read_grids(self.section)
        found = read_elements(self.section, grids)
        return CellPart(self.name, grids.places, cell_blocks(self.section, found)), found


def _bodies(source: Source) -> list[_Body]:
    """Return what has surface, after a look at all cards; notes tell what they change."""
    deck = Deck(source)
    sections = []
    for part in deck.sections:
        lines = Lines(deck, part)
        section = Section(deck, lines, lines.cards())
        check_continuations(deck, lines)
        check_names(deck, lines, section.cards)
        sections.append(("" if part.name == MAIN else part.name, section))
    cards = [section.cards for _, section in sections]
    bodies = [_Body(*each) for each in sections if known.ELEMENTS.keys() & each[1].cards.keys()]
    if not bodies:
        raise _without_surface(source, cards)
    tell_of(deck, cards)
    return bodies


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
