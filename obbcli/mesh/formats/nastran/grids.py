"""GRIDs of a section of bulk data: numbers, and places in the basic coordinate system."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.nastran import cards as known
from obbcli.mesh.formats.nastran.numbers import real_numbers, whole_numbers
from obbcli.mesh.formats.nastran.systems import Definition, Grid, Systems

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.nastran.section import Section

#: Fields of a GRID: number, system, three coordinates.
_ID, _SYSTEM, _PLACE = 0, 1, slice(2, 5)


class Grids:
    """Holds the GRIDs of a section in the file's order.

    Args:
        numbers: identification numbers, (n,), distinct.
        places: basic coordinates, (n, 3).
    """

    def __init__(self, numbers: NDArray[np.int64], places: NDArray[np.float64]) -> None:
        self.places = places
        self._order = np.argsort(numbers, kind="stable")
        self._sorted = numbers[self._order]

    def rows(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the rows of some GRIDs in `places`, -1 where there is none of that number."""
        if not len(self._sorted):
            return np.full(numbers.shape, -1, dtype=np.int64)
        at = np.minimum(np.searchsorted(self._sorted, numbers), len(self._sorted) - 1)
        return np.where(self._sorted[at] == numbers, self._order[at], -1)


def read_grids(section: Section) -> Grids:
    """Return the GRIDs of a section, placed.

    Raises:
        MeshError: a number or coordinate that is none, one number twice at different places, a
            coordinate system that cannot be resolved.
    """
    deck, lines, cards = section
    if known.GRID not in cards:
        return Grids(np.zeros(0, dtype=np.int64), np.zeros((0, 3)))
    table = section.fields(known.GRID, 5)
    numbers = _numbers(section, known.GRID, table, _ID)
    systems = whole_numbers(table[:, _SYSTEM])
    section.refuse(known.GRID, table[:, _SYSTEM], systems < 0, "the number of a system")
    default = _default_system(section)
    if default:
        systems[np.char.strip(table[:, _SYSTEM]) == b""] = default
    places, wrong = real_numbers(table[:, _PLACE])
    for axis in range(3):
        section.refuse(known.GRID, table[:, 2 + axis], wrong[:, axis], "a coordinate")
    kept = _first_of_each(section, numbers, systems, places)
    lines_of = lines.numbers[cards[known.GRID].lines[kept]]
    numbers, systems, places = numbers[kept], systems[kept], places[kept]
    unplaced = Grids(numbers, places)
    resolved = Systems(deck, _definitions(section), partial(_grid, unplaced, systems))
    placed = places.copy()
    order = np.argsort(systems, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(systems[order])) + 1):
        system = int(systems[rows[0]])
        placed[rows] = resolved.placed(system, places[rows], int(lines_of[rows[0]]))
    return Grids(numbers, placed)


def _grid(grids: Grids, systems: NDArray[np.int64], number: int) -> Grid | None:
    row = int(grids.rows(np.array([number]))[0])
    return None if row < 0 else Grid(int(systems[row]), grids.places[row])


def _numbers(
    section: Section, name: bytes, table: NDArray[np.bytes_], field: int
) -> NDArray[np.int64]:
    """Return identification numbers, which must be above 0."""
    numbers = whole_numbers(table[:, field])
    section.refuse(name, table[:, field], numbers <= 0, "a number above 0")
    return numbers


def _first_of_each(
    section: Section,
    numbers: NDArray[np.int64],
    systems: NDArray[np.int64],
    places: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Return the rows of distinct GRIDs: one that repeats an earlier one in all is taken once."""
    if (numbers[1:] > numbers[:-1]).all() or len(np.unique(numbers)) == len(numbers):
        return np.arange(len(numbers))
    first, which = np.unique(numbers, return_index=True, return_inverse=True)[1:]
    origin = first[which]
    other = (systems != systems[origin]) | (places != places[origin]).any(axis=1)
    if other.any():
        row = int(np.argmax(other))
        place = section.deck.place(section.line_of(known.GRID, int(origin[row])))
        raise section.deck.error(
            section.line_of(known.GRID, row),
            f"GRID {numbers[row]} stands elsewhere than at {place}",
            "give each GRID a number of its own",
        )
    return np.sort(first)


def _default_system(section: Section) -> int:
    """Return the system of GRIDs that name none."""
    if known.GRID_DEFAULTS not in section.cards:
        return 0
    table = section.fields(known.GRID_DEFAULTS, 2)
    systems = whole_numbers(table[:, _SYSTEM])
    words = table[:, _SYSTEM]
    section.refuse(known.GRID_DEFAULTS, words, systems < 0, "the number of a system")
    if len(set(systems.tolist())) > 1:
        line = section.line_of(known.GRID_DEFAULTS, 1)
        raise section.deck.error(line, "a second GRDSET names another system", "keep one")
    return int(systems[0])


def _definitions(section: Section) -> dict[int, Definition]:
    """Return the coordinate systems of a section by their numbers."""
    found: dict[int, Definition] = {}
    for name in (*known.BY_GRIDS, *known.BY_POINTS, *known.OTHER_SYSTEMS):
        if name not in section.cards:
            continue
        read = _by_grids if name in known.BY_GRIDS else _by_points
        for number, definition in (
            _others(section, name) if name in known.OTHER_SYSTEMS else read(section, name)
        ):
            before = found.setdefault(number, definition)
            if not _alike(before, definition):
                place = section.deck.place(before.line)
                raise section.deck.error(
                    definition.line,
                    f"coordinate system {number} is another one than at {place}",
                    "give each system a number of its own",
                )
    return found


def _alike(a: Definition, b: Definition) -> bool:
    same = (a.kind, a.reference, a.grids) == (b.kind, b.reference, b.grids)
    if a.points is None or b.points is None:
        return same and a.points is b.points
    return same and np.array_equal(a.points, b.points)


def _by_grids(section: Section, name: bytes) -> list[tuple[int, Definition]]:
    """Return the one or two systems that each card defines by three GRIDs."""
    table = section.fields(name, 8)
    values = whole_numbers(table)
    found = []
    for card, row in enumerate(values.tolist()):
        line = section.line_of(name, card)
        for first in (0, 4) if table[card, 4].strip() else (0,):
            number, *grids = row[first : first + 4]
            if number <= 0 or min(grids) <= 0:
                raise section.deck.error(
                    line,
                    f"{name.decode('ascii')} needs a number above 0 and three GRIDs",
                    "correct the card",
                )
            found.append((number, Definition(line, known.BY_GRIDS[name], grids=tuple(grids))))
    return found


def _by_points(section: Section, name: bytes) -> list[tuple[int, Definition]]:
    """Return the systems that cards define by three points of another system."""
    table = section.fields(name, 11)
    numbers = _numbers(section, name, table, 0)
    references = whole_numbers(table[:, 1])
    section.refuse(name, table[:, 1], references < 0, "the number of a system")
    points, wrong = real_numbers(table[:, 2:])
    for field in range(9):
        section.refuse(name, table[:, 2 + field], wrong[:, field], "a coordinate")
    return [
        (
            number,
            Definition(
                section.line_of(name, card),
                known.BY_POINTS[name],
                reference,
                points[card].reshape(3, 3),
            ),
        )
        for card, (number, reference) in enumerate(
            zip(numbers.tolist(), references.tolist(), strict=True)
        )
    ]


def _others(section: Section, name: bytes) -> list[tuple[int, Definition]]:
    """Return the systems of kinds that are not read, in which no GRID may stand."""
    numbers = whole_numbers(section.fields(name, 1)[:, 0])
    return [
        (number, Definition(section.line_of(name, card), ""))
        for card, number in enumerate(numbers.tolist())
    ]
