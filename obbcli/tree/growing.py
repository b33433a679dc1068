"""`Growth`: a tree over a mesh that makes its nodes when questions reach them, or all at once."""

from __future__ import annotations

from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, get_args

import numpy as np

from obbcli import kernels
from obbcli.errors import MeshError
from obbcli.threads import thread_count
from obbcli.tree.file import TreeArrays
from obbcli.tree.header import Description, Fit, Split
from obbcli.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable

    from obbcli.mesh import Mesh

_FITS = {
    "triangles": kernels.Fit.TRIANGLES,
    "points": kernels.Fit.POINTS,
    "hull": kernels.Fit.HULL,
    "min-volume": kernels.Fit.MIN_VOLUME,
    "axis-aligned": kernels.Fit.AXIS_ALIGNED,
}
_SPLITS = {
    "median": kernels.Split.MEDIAN,
    "center": kernels.Split.CENTER,
    "compact": kernels.Split.COMPACT,
}
_NO_LIMIT = 2**32 - 1

_HULL_FITS = ("hull", "min-volume")
# What a thread does of a build between two looks at signals and progress: tens of milliseconds.
_TRIANGLES_A_SLICE = 200_000
_HULL_TRIANGLES_A_SLICE = 10_000
# What a build holds at its peak: the moving triangles, keys and boxes; and the arrays of the tree.
_BUILD_BYTES_A_TRIANGLE = 200
# The corners of all triangles, as they are and on the hull's grid.
_HULL_BYTES_A_TRIANGLE = 200


class Growth:
    """A tree in the making. Safe to share between threads; whoever asks first makes a node.

    Args:
        mesh: what the tree is over.
        fit, split, leaf_size, max_depth: as `ObbTree.build`.
        max_memory: bytes that the build may need at its peak. None: no limit.
        on_demand: whether questions may be asked before the tree is whole.
        threads: how many work on large nodes, or on a tree that is made at once. None: as many as
            this process may use cores. They change nothing but the time it takes.

    Raises:
        MeshError: an option is none of those, or more memory is needed.
        ObbError: `threads` is no positive integer.
    """

    def __init__(
        self,
        mesh: Mesh,
        fit: Fit,
        split: Split,
        leaf_size: int,
        max_depth: int | None,
        max_memory: int | None,
        *,
        on_demand: bool = True,
        threads: int | None = None,
    ) -> None:
        _check_options(fit, split, leaf_size, max_depth)
        _check_memory(mesh, fit, max_memory)
        self.mesh = mesh
        self._threads = thread_count(threads)
        self.description = Description(
            fit=fit,
            split=split,
            leaf_size=int(leaf_size),
            max_depth=None if max_depth is None else int(max_depth),
            source=None if mesh.source is None else Path(mesh.source).name,
            source_sha256=mesh.sha256,
            tool_version=__version__,
            notes=mesh.notes,
        )
        self._builder = kernels.TreeBuilder(
            mesh.vertices,
            mesh.triangles.view(np.uint32),
            _FITS[fit],
            _SPLITS[split],
            min(leaf_size, _NO_LIMIT),
            _NO_LIMIT if max_depth is None else min(max_depth, _NO_LIMIT),
            on_demand,
            self._threads,
        )
        self.kernel = self._builder.tree()
        self._lock = Lock()
        self._arrays: TreeArrays | None = None
        self.kernel.possible_node_count = _possible_nodes(
            len(mesh.triangles), split, leaf_size, max_depth
        )

    def arrays(self, progress: Callable[[float], object] | None = None) -> TreeArrays:
        """Make what is missing, and return the whole tree as arrays.

        Between slices of the work other threads and signals get their turn, and `progress` is
        called with the share done, from 0 to 1. What was made stays where it is interrupted.
        """
        with self._lock:
            if self._arrays is not None:
                return self._arrays
            by_hull = self.description.fit in _HULL_FITS
            work = _HULL_TRIANGLES_A_SLICE if by_hull else _TRIANGLES_A_SLICE
            while not self._builder.advance(work * self._threads):
                if progress is not None:
                    progress(self._builder.progress())
            nodes, corners, triangle_ids = self._builder.arrays()
            self._arrays = TreeArrays(
                nodes=nodes,
                corners=corners,
                triangle_ids=triangle_ids,
                vertices=self.mesh.vertices,
                scale_exponent=self._builder.scale_exponent,
                description=self.description,
            )
            self.kernel.possible_node_count = len(nodes)
            return self._arrays

    @property
    def triangle_count(self) -> int:
        """How many triangles the mesh has."""
        return len(self.mesh.triangles)

    @property
    def vertex_count(self) -> int:
        """How many vertices the mesh has."""
        return len(self.mesh.vertices)

    @property
    def node_count(self) -> int:
        """How many boxes there are so far."""
        return self.kernel.node_count

    @property
    def nbytes(self) -> int:
        """Bytes of the tree as far as it is made, its triangles and vertices among them."""
        return self._builder.byte_count + self.mesh.vertices.nbytes


def _possible_nodes(triangles: int, split: str, leaf_size: int, max_depth: int | None) -> int:
    """Return how many boxes a tree can have."""
    if split != "median":
        most = triangles - 1 if triangles > leaf_size else min(1, triangles - 1)
        return most if max_depth is None else min(most, 2 ** (min(max_depth, 32) + 1) - 1)
    count = depth = 0
    ranges = {triangles: 1}  # how many ranges of this depth hold so many triangles
    while ranges:
        count += sum(number for size, number in ranges.items() if size > 1)
        halves: dict[int, int] = {}
        if max_depth is None or depth < max_depth:
            for size, number in ranges.items():
                if size > leaf_size:
                    for half in (size // 2, size - size // 2):
                        halves[half] = halves.get(half, 0) + number
        ranges = halves
        depth += 1
    return count


def _check_options(fit: str, split: str, leaf_size: int, max_depth: int | None) -> None:
    if not isinstance(fit, str) or fit not in _FITS:
        raise MeshError("fit", f"is {fit!r}", "use one of " + ", ".join(get_args(Fit)))
    if not isinstance(split, str) or split not in _SPLITS:
        raise MeshError("split", f"is {split!r}", "use one of " + ", ".join(get_args(Split)))
    if isinstance(leaf_size, bool) or not isinstance(leaf_size, (int, np.integer)) or leaf_size < 1:
        raise MeshError("leaf_size", f"is {leaf_size!r}", "use a whole number of at least 1")
    if max_depth is not None and (
        isinstance(max_depth, bool) or not isinstance(max_depth, (int, np.integer)) or max_depth < 0
    ):
        raise MeshError("max_depth", f"is {max_depth!r}", "use a whole number of at least 0")


def _check_memory(mesh: Mesh, fit: str, max_memory: int | None) -> None:
    each = _BUILD_BYTES_A_TRIANGLE + (_HULL_BYTES_A_TRIANGLE if fit in _HULL_FITS else 0)
    needed = each * len(mesh.triangles) + mesh.vertices.nbytes
    if max_memory is not None and needed > max_memory:
        raise MeshError(
            mesh.source or "mesh",
            f"a build over {len(mesh.triangles)} triangles needs about {needed} bytes, "
            f"{max_memory} are allowed",
            "allow more, or split the mesh",
        )
