"""Abaqus and CalculiX decks (.inp), read by our own reader.

meshio and its forks leave out instances and their places, local systems, blocks of nodes after the
first and what follows a comment. Each keyword is read, passed over, or refused with its line.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from obbcli.mesh.formats.abaqus.model import Model
from obbcli.mesh.formats.abaqus.sections import Deck
from obbcli.mesh.formats.cells.parts import joined_surface, surfaces
from obbcli.mesh.formats.text import counted
from obbcli.mesh.parts.placed import PlacedPart, UniquePaths, joined, placed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.formats.abaqus.model import Body
    from obbcli.mesh.source import MeshArrays, Source


def read_abaqus(source: Source) -> MeshArrays:
    """Return the surface of a deck: every instance where it stands, or the parts of a flat deck.

    Surface elements as they stand; then the faces that one solid element alone has. Shells,
    membranes and rigid elements are their reference surfaces, without thickness. Copies have the
    triangles of one another.

    Raises:
        MeshError: a keyword, parameter or element type that is not read, a damaged line, a node
            that is not defined, no surface; with the line.
    """
    model, bodies = _bodies(source)
    shapes = {body.key: body for body in bodies}
    cells = {key: body.cells(source) for key, body in shapes.items()}
    if not any(part.blocks for part in cells.values()):
        raise _without_surface(source, model)
    if len(shapes) == len(bodies) and all(body.matrix is None for body in bodies):
        return joined_surface(source, list(cells.values()))
    found = dict(zip(cells, surfaces(source, list(cells.values())), strict=True))
    return joined((placed(found[body.key], body.matrix) for body in bodies), source, "instances")


def parts_abaqus(source: Source) -> Iterator[PlacedPart]:
    """Yield the instances of a deck, or its parts where none is placed, in `read_abaqus`'s order.

    Keywords are looked at throughout; nodes and elements are read when a part is decoded.

    Raises:
        MeshError: as `read_abaqus`; what is wrong with a part's own lines, when it is decoded.
    """
    model, bodies = _bodies(source)
    if not bodies:
        raise _without_surface(source, model)
    paths = UniquePaths()
    decoded = _Decoded(source)
    for body in bodies:
        yield PlacedPart(paths.take(body.name), body.key, partial(decoded.of, body), body.matrix)


class _Decoded:
    """Decodes the bodies of a deck; copies are decoded once."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._arrays: dict[tuple[int, ...], MeshArrays] = {}

    def of(self, body: Body) -> MeshArrays:
        """Return vertices and triangles of a body in its own coordinates."""
        if body.key not in self._arrays:
            self._arrays[body.key] = joined_surface(self._source, [body.cells(self._source)])
        return self._arrays[body.key]


def _bodies(source: Source) -> tuple[Model, list[Body]]:
    """Return what a deck holds, after a look at all keywords; notes tell which files it names."""
    model = Model()
    deck = Deck(source)
    for section in deck.sections():
        model.take(deck, section)
    if deck.names:
        names = ", ".join(list(deck.names)[:5])
        source.note(f"{counted(len(deck.names), 'file')} that the deck names read with it: {names}")
    return model, model.bodies(source)


def _without_surface(source: Source, model: Model) -> Exception:
    fault = f"has no surface: {counted(model.element_count, 'element')}, none with a face"
    return source.error(fault, "a mesh is a surface: shells, or solids with their boundary")
