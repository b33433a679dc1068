"""`PlacedPart`: what a reader tells of one part of its file, decoded when that is asked for."""

from __future__ import annotations

import os
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.source import MeshArrays, Source

    #: The name of a run of triangles, and how many they are.
    Run = tuple[str, int]

#: Instances multiply what a file holds: they may fill this share of the machine's memory.
_SHARE = 4


class PlacedPart(NamedTuple):
    """Tells where one part of a file stands, and how to decode it.

    Attributes:
        path: names from the root down, joined by `/`; no other part of the file has it.
        key: equal for parts that decode to the same arrays, which are then decoded once.
        decode: returns vertices and triangles in the part's own coordinates.
        matrix: (4, 4), applied to columns, from there to the file's world; None: the identity.
        may_be_bare: whether it may turn out to have no triangles; it is no part of the file then.
        kind: what it is called where a note tells that several were joined; else empty.
    """

    path: str
    key: Hashable
    decode: Callable[[], MeshArrays]
    matrix: NDArray[np.float64] | None = None
    may_be_bare: bool = False
    kind: str = ""

    def placed(self) -> MeshArrays:
        """Return vertices and triangles in the file's world.

        Raises:
            MeshError: the part is damaged.
        """
        return placed(self.decode(), self.matrix)


class UniquePaths:
    """Gives every path once: equal ones get `#2`, `#3` in the order in which they are met."""

    def __init__(self) -> None:
        self._taken: set[str] = set()
        self._counts: dict[str, int] = {}

    def take(self, path: str) -> str:
        """Return a path that was not given before; letters that no terminal shows become `?`."""
        path = found = "".join(letter if letter.isprintable() else "?" for letter in path)
        while found in self._taken:
            self._counts[path] = self._counts.get(path, 1) + 1
            found = f"{path}#{self._counts[path]}"
        self._taken.add(found)
        return found


def placed(arrays: MeshArrays, matrix: NDArray[np.float64] | None) -> MeshArrays:
    """Return a mesh placed by a matrix; the triangles of a mirrored one are turned over."""
    vertices, triangles = arrays
    return transformed(vertices, matrix), triangles[:, ::-1] if mirrors(matrix) else triangles


def transformed(
    vertices: NDArray[np.float64], matrix: NDArray[np.float64] | None
) -> NDArray[np.float64]:
    """Return points (V, 3) placed by a matrix, sums from the left: rounded as `Pose` rounds."""
    if matrix is None:
        return vertices
    with np.errstate(over="ignore", invalid="ignore"):
        x, y, z = vertices.T
        rows = [
            ((matrix[k, 0] * x + matrix[k, 1] * y) + matrix[k, 2] * z) + matrix[k, 3]
            for k in range(3)
        ]
    return np.stack(rows, axis=1)


def mirrors(matrix: NDArray[np.float64] | None) -> bool:
    """Return whether a matrix turns the inside of a surface out."""
    if matrix is None:
        return False
    with np.errstate(over="ignore", invalid="ignore"):
        return float(matrix[0, :3] @ np.cross(matrix[1, :3], matrix[2, :3])) < 0


def joined(parts: Iterable[MeshArrays], source: Source, at: str = "") -> MeshArrays:
    """Return meshes as one, vertices and triangles in their order.

    Args:
        parts: the meshes.
        source: the file they are of.
        at: what of the file places them; errors name it.

    Raises:
        MeshError: they fill more than a quarter of this machine's memory.
    """
    room = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // _SHARE
    vertices: list[NDArray[np.float64]] = [np.zeros((0, 3))]
    triangles: list[NDArray[Any]] = [np.zeros((0, 3), dtype=np.int64)]
    start = 0
    for points, rows in parts:
        vertices.append(points)
        triangles.append(rows.astype(np.int64, copy=False) + start)
        start += len(points)
        room -= 2 * (points.nbytes + rows.nbytes)
        if room < 0:
            fault = "place more than a quarter of this machine's memory"
            raise source.error(fault, "split the model", at=at)
    return np.vstack(vertices), np.vstack(triangles)


def rows_of(arrays: MeshArrays, first: int, count: int) -> MeshArrays:
    """Return `count` triangles from `first` on, with the vertices that they use, in their order."""
    vertices, triangles = arrays
    used, corners = np.unique(triangles[first : first + count], return_inverse=True)
    return vertices[used], corners.reshape(-1, 3)


def runs_of(rows: Callable[[int, int], MeshArrays], runs: Iterable[Run]) -> Iterator[PlacedPart]:
    """Yield runs of a file's triangles as parts, in the file's own coordinates.

    Args:
        rows: returns triangles from a row on, so many.
        runs: name and triangle count of each; those without triangles are no parts.
    """
    paths = UniquePaths()
    first = 0
    for name, count in runs:
        if count:
            yield PlacedPart(paths.take(name), first, partial(rows, first, count))
        first += count


def whole(read: Callable[[Source], MeshArrays], source: Source) -> Iterator[PlacedPart]:
    """Yield all of a file as one part without a name, read at once: its notes belong to it."""
    arrays = read(source)
    if len(arrays[1]):
        yield PlacedPart("", 0, lambda: arrays)
