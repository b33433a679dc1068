"""VTK's grids, whose cells no file lists, as their outer faces: images, rectilinear, structured.

A grid of three axes is a block of space, of which the surface is the boundary; one of two axes is a
surface itself. Cells are numbered along x first, as VTK does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.mesh.formats.cells.faces import signed_volumes
from obbcli.mesh.formats.cells.surface import Block
from obbcli.mesh.formats.cells.types import CELLS
from obbcli.mesh.formats.text import counted, its
from obbcli.mesh.formats.vtk.cells import numbers, points_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.source import Source

    Ints = NDArray[np.int64]

_FACES = tuple(face.corners for face in CELLS["hexahedron"].faces)
#: Of each face of a hexahedron the axis across it, and whether it is that axis' upper end.
_SIDES = ((0, False), (0, True), (1, False), (1, True), (2, False), (2, True))
#: Corners of a hexahedron as steps along the axes.
_STEPS = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
)


def grid_sides(grid: Any) -> tuple[int, ...]:
    """Return how many points a grid has along x, y and z."""
    ends = grid.GetExtent()
    return tuple(1 + high - low for low, high in zip(ends[::2], ends[1::2], strict=True))


def grid_points(grid: Any) -> NDArray[np.float64]:
    """Return the points of a grid, (V, 3), those along x first."""
    if grid.GetDataObjectType() == _STRUCTURED:
        return points_of(grid)
    sides = grid_sides(grid)
    if hasattr(grid, "GetXCoordinates"):
        axes = [grid.GetXCoordinates(), grid.GetYCoordinates(), grid.GetZCoordinates()]
        ticks = [np.array(numbers(axis), dtype=np.float64) for axis in axes]
    else:
        firsts = grid.GetExtent()[::2]
        spaces = zip(firsts, sides, grid.GetSpacing(), strict=True)
        with np.errstate(invalid="ignore", over="ignore"):  # what is not finite is refused later
            ticks = [space * (first + np.arange(count)) for first, count, space in spaces]
    z, y, x = np.meshgrid(*ticks[::-1], indexing="ij")
    places = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    if hasattr(grid, "GetXCoordinates"):
        return places
    turn = grid.GetDirectionMatrix()
    matrix = np.array([[turn.GetElement(i, j) for j in range(3)] for i in range(3)])
    is_turned = not np.array_equal(matrix, np.eye(3))
    return np.asarray((places @ matrix.T if is_turned else places) + grid.GetOrigin())


#: VTK's number of structured grids, which list their points.
_STRUCTURED = 2


def outer_blocks(
    source: Source, sides: tuple[int, ...], points: NDArray[np.float64],
    kept: NDArray[np.bool_] | None,
) -> list[Block]:  # fmt: skip
    """Return the surface of a grid as blocks of cells.

    Args:
        source: the file, which is given the note.
        sides: how many points the grid has along x, y and z.
        points: (V, 3).
        kept: which cells to take; None for all.
    """
    axes = [axis for axis in range(3) if sides[axis] > 1]
    if len(axes) < 2:
        return []
    cells = np.arange(int(np.prod([max(1, side - 1) for side in sides])))
    if kept is not None:
        cells = cells[kept]
    if len(axes) == 2:
        return [Block("quad", _corners(sides, cells, axes, _STEPS[:4, :2]), cells)]
    if kept is not None:
        return [Block("hexahedron", _corners(sides, cells, axes, _STEPS), cells)]
    source.note(f"{counted(len(cells), 'volume cell')} taken as {its(len(cells))} boundary")
    return [
        _side(sides, points, number, axis, is_upper=is_upper)
        for number, (axis, is_upper) in enumerate(_SIDES)
    ]


def _side(
    sides: tuple[int, ...], points: NDArray[np.float64], number: int, axis: int, *, is_upper: bool
) -> Block:
    """Return one of the six sides of a grid, each face turned outwards by its cell's volume."""
    counts = [side - 1 for side in sides]
    ranges = [np.arange(count) for count in counts]
    ranges[axis] = ranges[axis][-1:] if is_upper else ranges[axis][:1]
    z, y, x = (part.ravel() for part in np.meshgrid(*ranges[::-1], indexing="ij"))
    cells = x + counts[0] * (y + counts[1] * z)
    corners = _corners(sides, cells, [0, 1, 2], _STEPS)
    faces = corners[:, _FACES[number]]
    inverted = signed_volumes(corners, _FACES, points) < 0
    faces[inverted] = faces[inverted, ::-1]
    # Six numbers a cell, so that the faces of one cell stand together.
    return Block("quad", faces, 6 * cells + number)


def _corners(
    sides: tuple[int, ...], cells: Ints, axes: list[int], steps: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return the points of cells of a grid, (N, corners)."""
    strides = (1, sides[0], sides[0] * sides[1])
    first = np.zeros(len(cells), dtype=np.int64)
    left = cells
    for axis in range(3):
        count = max(1, sides[axis] - 1)
        first += (left % count) * strides[axis]
        left = left // count
    offsets = steps @ np.array([strides[axis] for axis in axes])
    return np.asarray(first[:, np.newaxis] + offsets)
