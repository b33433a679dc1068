"""Coordinate systems of Nastran: rectangular, cylindrical, spherical, by points or by GRIDs.

A system's origin is A, its z axis goes from A to B, and C lies in the half plane from which x (or
the azimuth) is measured. Angles are degrees. The arithmetic is that of doubles, sum by sum without
contraction, with the platform's sine and cosine: a placed coordinate is within a few units in the
last place of the largest number that goes into it. What comes out is the input of all answers.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from obbcli.mesh.formats.nastran.deck import Deck

#: Sine of the least angle at A between B and C: below it their plane is rounding alone.
_LEAST_SINE = 1e-10


class Definition(NamedTuple):
    """Holds a system as its card defines it.

    Args:
        line: of the deck.
        kind: `R`, `C` or `S`; empty where its card is of a kind that is not read.
        reference: the system in which the points stand.
        points: A, B and C in it, (3, 3); None where GRIDs are named.
        grids: the GRIDs at A, B and C.
    """

    line: int
    kind: str
    reference: int = 0
    points: NDArray[np.float64] | None = None
    grids: tuple[int, ...] = ()


class Grid(NamedTuple):
    """Holds where a GRID stands: in which system, and at which coordinates of it, (3,)."""

    system: int
    place: NDArray[np.float64]


class _Frame(NamedTuple):
    """Holds a system in basic coordinates: kind, origin (3,), unit axes as rows (3, 3)."""

    kind: str
    origin: NDArray[np.float64]
    axes: NDArray[np.float64]


_BASIC = _Frame("R", np.zeros(3), np.eye(3))


class Systems:
    """Resolves the systems of a section, which may stand in one another.

    Args:
        deck: the deck, whose lines errors name.
        definitions: by identification number.
        grid: returns a GRID, None where there is none of that number.
    """

    def __init__(
        self,
        deck: Deck,
        definitions: Mapping[int, Definition],
        grid: Callable[[int], Grid | None],
    ) -> None:
        self._deck = deck
        self._definitions = definitions
        self._grid = grid
        self._frames = {0: _BASIC}

    def placed(self, system: int, places: NDArray[np.float64], line: int) -> NDArray[np.float64]:
        """Return points of a system in basic coordinates, (n, 3).

        Args:
            system: identification number; 0 is the basic one.
            places: (n, 3) x y z, r theta z or r theta phi.
            line: of the card that stands in it, which errors name.

        Raises:
            MeshError: a system that is missing, of a kind that is not read, without direction, or
                defined by itself.
        """
        return _placed(self._frame(system, line), places)

    def _frame(self, system: int, line: int) -> _Frame:
        """Return a system, with those that it stands in resolved before it."""
        waiting, opened = [(system, line)], {system}
        while waiting:
            number, line = waiting[-1]
            if number in self._frames:
                opened.discard(waiting.pop()[0])
                continue
            definition = self._definition(number, line)
            above = [item for item in self._needed(definition) if item not in self._frames]
            if not above:
                self._frames[number] = self._resolved(definition)
                continue
            if not opened.isdisjoint(above):
                raise self._deck.error(
                    definition.line,
                    f"coordinate system {number} is defined by itself",
                    "define one of the circle by points in the basic system",
                )
            waiting.append((above[0], definition.line))
            opened.add(above[0])
        return self._frames[system]

    def _definition(self, number: int, line: int) -> Definition:
        definition = self._definitions.get(number)
        if definition is None:
            fault = f"coordinate system {number} is not in the deck"
            raise self._deck.error(line, fault, "add its CORD card")
        if not definition.kind:
            raise self._deck.error(
                definition.line,
                f"coordinate system {number} is of a kind that is not read, and points stand in it",
                "define it by CORD1R, CORD1C, CORD1S, CORD2R, CORD2C or CORD2S",
            )
        return definition

    def _needed(self, definition: Definition) -> list[int]:
        """Return the systems in which A, B and C stand."""
        if definition.points is not None:
            return [definition.reference]
        return [self._named(definition, number).system for number in definition.grids]

    def _named(self, definition: Definition, number: int) -> Grid:
        grid = self._grid(number)
        if grid is None:
            fault = f"names GRID {number}, which is not in the deck"
            raise self._deck.error(definition.line, fault, "add the GRID")
        return grid

    def _resolved(self, definition: Definition) -> _Frame:
        """Return a system whose references are resolved."""
        if definition.points is not None:
            corners = _placed(self._frames[definition.reference], definition.points)
        else:
            grids = [self._named(definition, number) for number in definition.grids]
            corners = np.concatenate(
                [_placed(self._frames[grid.system], grid.place[np.newaxis]) for grid in grids]
            )
        origin, on_axis, in_plane = corners
        across = _cross(on_axis - origin, in_plane - origin)
        axis, length = on_axis - origin, _length(on_axis - origin)
        if not _length(across) > _LEAST_SINE * length * _length(in_plane - origin):
            raise self._deck.error(
                definition.line,
                "the three points of the coordinate system lie on one line",
                "move the third off the line through the first two",
            )
        z, y = axis / length, across / _length(across)
        return _Frame(definition.kind, origin, np.stack([_cross(y, z), y, z]))


def _placed(frame: _Frame, places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points of a resolved system in basic coordinates, (n, 3)."""
    if frame is _BASIC:
        return places
    first, second, third = places.T
    if frame.kind == "C":
        cosine, sine = _of_degrees(second)
        first, second = first * cosine, first * sine
    elif frame.kind == "S":
        cosine, sine = _of_degrees(second)
        around, aside = _of_degrees(third)
        first, second, third = first * sine * around, first * sine * aside, first * cosine
    x, y, z = frame.axes
    steps = [first * x[k] + second * y[k] + third * z[k] + frame.origin[k] for k in range(3)]
    placed: NDArray[np.float64] = np.stack(steps, axis=1)
    return placed


def _of_degrees(angles: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return cosine and sine; multiples of 90 degrees give exactly 0 and 1."""
    distinct, which = np.unique(angles, return_inverse=True)
    pairs = np.array([_turn(angle) for angle in distinct.tolist()]).reshape(-1, 2)
    return pairs[which, 0], pairs[which, 1]


def _turn(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle in degrees, taken from the nearest multiple of 90."""
    within = math.fmod(angle, 360.0)
    rest = math.remainder(within, 90.0)  # exact
    cosine, sine = math.cos(math.radians(rest)), math.sin(math.radians(rest))
    quarters = round((within - rest) / 90.0) % 4
    return ((cosine, sine), (-sine, cosine), (-cosine, -sine), (sine, -cosine))[quarters]


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    (a0, a1, a2), (b0, b1, b2) = a, b
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])


def _length(vector: NDArray[np.float64]) -> float:
    return math.hypot(*vector.tolist())
