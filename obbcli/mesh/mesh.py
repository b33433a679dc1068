"""`Mesh`: checked triangles in file order, what every reader makes and every tree takes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from obbcli import kernels
from obbcli.mesh import measure, topology
from obbcli.mesh.checked_arrays import checked_triangles, checked_vertices

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

    from obbcli.mesh.spacing import Spacing


class PartRows(NamedTuple):
    """Tells which triangles of a mesh are those of one part of its file.

    Attributes:
        path: of the part: names from the root down, joined by `/`.
        first_triangle: the first row.
        triangle_count: how many rows.
    """

    path: str
    first_triangle: int
    triangle_count: int


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Mesh:
    """Holds a surface: vertices and the triangles between them, checked and read-only.

    Nothing is merged, dropped or reordered: degenerate and repeated triangles stay, and row `i` of
    `triangles` is triangle `i` of the file.

    Args:
        vertices: float64 (V, 3), mesh units, finite. Arrays open to writing are copied.
        triangles: int32 (F, 3), rows of `vertices`; any whole numbers are taken.
        source: the file's name, or None for a mesh made in code; named in errors.
        sha256: SHA-256 of the file's bytes in hexadecimal, or None.
        notes: what of the file was taken with a change, a sentence each.
        unit: the length of 1 that the file states (`"m"`, `"mm"`, ...), or None.
        parts: the parts of the file that were selected, with their rows; empty where all was taken.
        sag: how far triangles are at most from the exact surfaces that they were cut from (STEP),
            mesh units; None where the file holds triangles.
        spacing: how far apart the file's coordinates were before they were scaled, in mesh units
            since; None where they were not scaled, and tell it themselves.

    Raises:
        MeshError: no triangles, a wrong shape, an index out of range, a coordinate that is
            not finite.

    Example:
        >>> Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).size
        1.4142135623730951
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    source: str | None
    sha256: str | None
    notes: tuple[str, ...]
    unit: str | None
    parts: tuple[PartRows, ...]
    sag: float | None
    spacing: float | None

    def __init__(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        source: str | None = None,
        sha256: str | None = None,
        notes: Iterable[str] = (),
        *,
        unit: str | None = None,
        parts: Iterable[PartRows] = (),
        sag: float | None = None,
        spacing: float | None = None,
    ) -> None:
        prefix = f"{source}: " if source else ""
        checked = checked_vertices(vertices, prefix)
        # The dataclass is frozen to everybody else.
        put = object.__setattr__
        put(self, "vertices", checked)
        put(self, "triangles", checked_triangles(triangles, len(checked), prefix))
        put(self, "source", source)
        put(self, "sha256", sha256)
        put(self, "notes", tuple(map(_printable, notes)))
        put(self, "unit", unit)
        put(self, "parts", tuple(parts))
        put(self, "sag", sag)
        put(self, "spacing", spacing)

    def __repr__(self) -> str:
        source = f", source={self.source!r}" if self.source else ""
        return f"Mesh({len(self.vertices)} vertices, {len(self.triangles)} triangles{source})"

    def in_unit(self, unit: str) -> Mesh:
        """Return the mesh in m, cm, mm, um, in or ft: scaled where its file states another unit.

        A coordinate p becomes fl(p r) or fl(p / r) with r >= 1, the double nearest to the ratio of
        the units. A mesh that states no unit is taken to be in this one.

        Raises:
            MeshError: the unit is not known, or a coordinate leaves the range of double.
        """
        from obbcli.mesh.units import checked_unit, converted

        checked_unit(unit)
        if self.unit is None or self.unit == unit:
            return self._changed(unit=unit)
        vertices, note = converted(self.vertices, self.unit, unit)
        told = np.array([self.sag or 0.0, self.coordinate_spacing.value])
        sag, spacing = converted(told, self.unit, unit)[0].tolist()
        return self._changed(note, vertices=vertices, unit=unit, sag=sag or None, spacing=spacing)

    def stated(self, unit: str | None) -> Mesh:
        """Return the mesh with the same coordinates, taken to be in another unit.

        Raises:
            MeshError: the unit is not known.
        """
        from obbcli.mesh.units import checked_unit

        return self._changed(unit=None if unit is None else checked_unit(unit))

    def scaled(self, factor: float, unit: str | None = None) -> Mesh:
        """Return the mesh with coordinates fl(p factor), in `unit`, whatever its file states.

        Raises:
            MeshError: the factor is no finite number above 0, the unit is not known, or a
                coordinate leaves the range of double.
        """
        from obbcli.mesh.units import checked_unit, scaled

        if unit is not None:
            checked_unit(unit)
        vertices, note = scaled(self.vertices, factor)
        sag = self.sag and self.sag * float(factor)
        spacing = self.coordinate_spacing.value * float(factor)
        return self._changed(note, vertices=vertices, unit=unit, sag=sag, spacing=spacing)

    def welded(self, distance: float) -> Mesh:
        """Return the mesh with vertices within `distance` at the place of the first of them.

        Triangles keep their rows, also those that collapse; a note tells what moved, and how far.

        Raises:
            MeshError: the distance is no finite number above 0, or vertices that it joins by steps
                are farther apart.
        """
        from obbcli.mesh.weld import note_of, welded

        done = welded(self.vertices, self.triangles, distance)
        sag = self.sag and self.sag + done.farthest
        return self._changed(note_of(done, distance), vertices=done.vertices, sag=sag)

    def _changed(self, note: str = "", **changes: Any) -> Mesh:
        """Return the mesh with other vertices, unit or sag, and with one more note."""
        changes.get("vertices", self.vertices).setflags(write=False)
        kept = {name: getattr(self, name) for name in self.__dataclass_fields__}
        notes = (*self.notes, note) if note else self.notes
        return Mesh(**kept | {"notes": notes} | changes)

    @cached_property
    def bounds(self) -> NDArray[np.float64]:
        """Return the lower and upper corner of the surface's axis-aligned box, (2, 3).

        Vertices that no triangle uses are no part of the surface.
        """
        return measure.bounds(self.vertices, self.triangles)

    @cached_property
    def size(self) -> float:
        """Return the diagonal of `bounds`; infinite only where it exceeds the largest double."""
        return measure.diagonal(self.bounds)

    @cached_property
    def coordinate_spacing(self) -> Spacing:
        """Return how far apart the file's coordinates are: no two of them could be nearer."""
        from obbcli.mesh.spacing import Spacing, spacing_of

        if self.spacing is not None:
            return Spacing(self.spacing, "scaled")
        return spacing_of(self.vertices, self.triangles)

    @cached_property
    def surface_centroid(self) -> NDArray[np.float64]:
        """Return the area-weighted centroid of the surface, (3,): the default pivot.

        The mean of the used vertices where the area is exactly zero. The same bits on every
        machine: sums run pairwise in file order.
        """
        return measure.surface_centroid(self.vertices, self.triangles)

    @cached_property
    def degenerate_count(self) -> int:
        """Return how many triangles have an area of exactly zero, decided without rounding."""
        return measure.degenerate_count(self.vertices, self.triangles)

    @cached_property
    def duplicate_count(self) -> int:
        """Return how many triangles repeat an earlier one: same three places, in any order."""
        return topology.duplicate_count(self.corner_ids)

    @cached_property
    def is_watertight(self) -> bool:
        """Return whether the surface closes: each edge between two triangles, turned alike.

        Edges are told apart by exact positions, not by indices (STL repeats its vertices), and each
        must be run through exactly once in either direction. Triangles with two corners at one
        position bound nothing and are left out; a surface of those alone is not watertight.
        """
        return topology.is_watertight(self.corner_ids)

    @cached_property
    def part_rows(self) -> NDArray[np.int64]:
        """Return the first triangle of each connected part, (P,); parts share no position."""
        return kernels.first_triangles_of_parts(self.corner_ids, int(self.corner_ids.max()) + 1)

    @cached_property
    def corner_ids(self) -> NDArray[np.int64]:
        """Return the corners as numbers of distinct positions, (F, 3)."""
        return topology.position_ids(self.vertices)[self.triangles]


def _printable(note: str) -> str:
    """Return a sentence as terminals and tree files can hold it: names in it come from files."""
    return "".join(letter if letter.isprintable() else "?" for letter in note)
