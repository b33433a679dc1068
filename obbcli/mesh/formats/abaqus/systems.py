"""Where Abaqus puts nodes: local systems of *SYSTEM, cylindrical coordinates, *INSTANCE."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.number_rows import comma_rows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.abaqus.sections import Section
    from obbcli.mesh.formats.number_rows import Rows


class LocalSystem(NamedTuple):
    """Holds a rectangular system.

    Args:
        origin: (3,).
        axes: (3, 3), its unit axes as rows.
    """

    origin: NDArray[np.float64]
    axes: NDArray[np.float64]

    def placed(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return coordinates in this system, (N, 3), as coordinates outside of it."""
        return places @ self.axes + self.origin


def from_cylindrical(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return rectangular coordinates of radius, angle in degrees and height, (N, 3)."""
    radius, angle, height = places.T
    return np.stack([radius * _cosine(angle), radius * _sine(angle), height], axis=1)


def _cosine(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    # Whole turns are taken off first, which is exact: of a large angle 90 would be lost.
    return _sine(np.fmod(degrees, 360.0) + 90.0)


def _sine(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return sines of degrees, exact at multiples of 90."""
    degrees = np.fmod(degrees, 360.0)
    quarters = np.round(degrees / 90.0)
    rest = np.radians(degrees - 90.0 * quarters)
    odd = quarters % 2 == 1
    values = np.where(odd, np.cos(rest), np.sin(rest))
    return np.where(quarters % 4 >= 2, -values, values)


def local_system(section: Section) -> LocalSystem | None:
    """Return the system of *SYSTEM, or None where it has no data: the system outside again.

    The origin a; a point b on the X axis; on a second line a point c on the side of positive Y.
    Without b the system is only moved; without c the Z axis stays, and X is projected onto X, Y.

    Raises:
        MeshError: other counts of numbers, or points that give no system; with the line.
    """
    rows = comma_rows(section.source, section.data, section.first)
    table = np.nan_to_num(rows.table(6))
    if len(table) == 0:
        return None
    if len(table) > 2 or rows.counts[0] > 6 or (rows.counts[1:] > 3).any():
        raise _no_system(section, "three points on at most two lines are wanted")
    origin, b = table[0, :3], table[0, 3:]
    if rows.counts[0] <= 3:
        if len(table) == 2:
            raise _no_system(section, "a second line needs a point on the X axis in the first")
        return LocalSystem(origin, np.eye(3))
    x = b - origin
    if len(table) == 1:
        x[2] = 0.0
        z = np.array([0.0, 0.0, 1.0])
    else:
        z = np.cross(x, table[1, :3] - origin)
    length, height = np.linalg.norm(x), np.linalg.norm(z)
    if not (length > 0.0 and height > 0.0 and np.isfinite(length * height)):
        raise _no_system(section, "its points lie on a line")
    x, z = x / length, z / height
    return LocalSystem(origin, np.stack([x, np.cross(z, x), z]))


def _no_system(section: Section, why: str) -> Exception:
    remedy = "write the origin and a point on the X axis, then a point on the side of Y"
    return section.source.error(f"*SYSTEM: {why}", remedy, at=str(section.line))


class Placement(NamedTuple):
    """Holds where an instance stands: first it is moved, then turned.

    Args:
        shift: (3,).
        point: (3,), a point on the axis.
        turn: (3, 3), the rotation; None where there is none.
    """

    shift: NDArray[np.float64]
    point: NDArray[np.float64]
    turn: NDArray[np.float64] | None

    @property
    def matrix(self) -> NDArray[np.float64] | None:
        """The placement as a matrix, (4, 4), that is applied to columns; None: the identity."""
        if self.turn is None and not self.shift.any():
            return None
        found = np.eye(4)
        found[:3, 3] = self.shift
        if self.turn is not None:
            found[:3, :3] = self.turn
            found[:3, 3] = self.turn @ (self.shift - self.point) + self.point
        return found

    def placed(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return coordinates of the part, (N, 3), where the instance has them."""
        moved = places + self.shift
        return moved if self.turn is None else (moved - self.point) @ self.turn.T + self.point


def placement(section: Section, times: int = 1) -> Placement:
    """Return the placement that the data of *INSTANCE, or of *NCOPY with SHIFT, give.

    A line with a translation; a line with two points on an axis and an angle in degrees.

    Args:
        section: the keyword.
        times: how often the rotation is applied.

    Raises:
        MeshError: other counts of numbers, or an axis without direction; with the line.
    """
    rows = comma_rows(section.source, section.data, section.first)
    table = np.nan_to_num(rows.table(7))
    fits = len(table) <= 2 and (rows.counts[:1] <= 3).all() and (rows.counts[1:] == 7).all()
    if not fits:
        raise _no_placement(section, rows, "a translation and, on a second line, an axis and angle")
    shift = table[0, :3] if len(table) else np.zeros(3)
    if len(table) < 2:
        return Placement(shift, np.zeros(3), None)
    point, degrees = table[1, :3], table[1, 6:]
    axis = table[1, 3:6] - point
    length = np.linalg.norm(axis)
    if not (length > 0.0 and np.isfinite(length)):
        raise _no_placement(section, rows, "two different points on the axis")
    x, y, z = axis / length
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    cosine, sine = _cosine(degrees * times), _sine(degrees * times)
    along = np.outer(axis / length, axis / length)
    return Placement(shift, point, cosine * np.eye(3) + sine * cross + (1.0 - cosine) * along)


def _no_placement(section: Section, rows: Rows, wanted: str) -> Exception:
    line = rows.lines[-1] if len(rows.lines) else section.line
    remedy = "export the deck again"
    return section.source.error(f"*{section.keyword} wants {wanted}", remedy, at=str(int(line)))
