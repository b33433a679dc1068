"""`Growth`: a tree over a mesh that makes its nodes when questions reach them, or all at once."""

from __future__ import annotations

from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np

from obbcli import kernels
from obbcli.errors import MeshError
from obbcli.threads import thread_count
from obbcli.tree.options import Description, kernel_limits
from obbcli.tree.whole import TreeArrays, TreeInMemory
from obbcli.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from obbcli.mesh import Mesh
    from obbcli.tree.options import BuildOptions

# What a thread does of a build between two looks at signals and progress: tens of milliseconds.
_TRIANGLES_A_SLICE = 200_000
_HULL_TRIANGLES_A_SLICE = 10_000
# What a build holds at its peak: the moving triangles, keys and boxes; and the arrays of the tree.
_BUILD_BYTES_A_TRIANGLE = 200
# The corners of all triangles, as they are and on the hull's grid.
_HULL_BYTES_A_TRIANGLE = 200


class Growth(TreeInMemory):
    """A tree in the making. Safe to share between threads; whoever asks first makes a node.

    Args:
        mesh: what the tree is over.
        options: how it is built.
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
        options: BuildOptions,
        max_memory: int | None = None,
        *,
        on_demand: bool = True,
        threads: int | None = None,
    ) -> None:
        options = options.checked()
        _check_memory(mesh, options, max_memory)
        self._mesh = mesh
        self._threads = thread_count(threads)
        self._needs_hulls = options.needs_hulls
        self.description = Description(
            **options._asdict(),
            source=None if mesh.source is None else Path(mesh.source).name,
            source_sha256=mesh.sha256,
            tool_version=__version__,
            notes=mesh.notes,
            unit=mesh.unit,
            parts=mesh.parts,
            sag=mesh.sag,
            spacing=mesh.spacing,
        )
        self._builder = kernels.TreeBuilder(
            mesh.vertices,
            mesh.triangles.view(np.uint32),
            kernels.Fit[_kernel_name(options.fit)],
            kernels.Split[_kernel_name(options.split)],
            *kernel_limits(options.leaf_size, options.max_depth),
            on_demand,
            self._threads,
        )
        self.kernel = self._builder.tree()
        self._lock = Lock()
        self._arrays: TreeArrays | None = None
        self.kernel.possible_node_count = _possible_nodes(len(mesh.triangles), options)

    def arrays(self, progress: Callable[[float], object] | None = None) -> TreeArrays:
        """Make what is missing, and return the whole tree as arrays.

        Between slices of the work other threads and signals get their turn, and `progress` is
        called with the share done, from 0 to 1. What was made stays where it is interrupted.
        """
        with self._lock:
            if self._arrays is not None:
                return self._arrays
            work = _HULL_TRIANGLES_A_SLICE if self._needs_hulls else _TRIANGLES_A_SLICE
            while not self._builder.advance(work * self._threads):
                if progress is not None:
                    progress(self._builder.progress())
            nodes, corners, triangle_ids = self._builder.arrays()
            self._arrays = TreeArrays(
                nodes=nodes,
                corners=corners,
                triangle_ids=triangle_ids,
                vertices=self._mesh.vertices,
                scale_exponent=self._builder.scale_exponent,
                description=self.description,
            )
            self.kernel.possible_node_count = len(nodes)
            return self._arrays

    @property
    def scale_exponent(self) -> int:
        """Boxes are in mesh units times 2 to the minus this, which no coordinate exceeds."""
        return self._builder.scale_exponent

    @property
    def mesh(self) -> Mesh:
        """The mesh that the tree is over."""
        return self._mesh

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices of the mesh, (V, 3), read-only."""
        return self._mesh.vertices

    @property
    def surface(self) -> None:
        """No file says anything of the mesh as a whole: it is at hand."""
        return

    @property
    def triangle_count(self) -> int:
        """How many triangles the mesh has."""
        return len(self._mesh.triangles)

    @property
    def vertex_count(self) -> int:
        """How many vertices the mesh has."""
        return len(self._mesh.vertices)

    @property
    def node_count(self) -> int:
        """How many boxes there are so far."""
        return self.kernel.node_count

    @property
    def nbytes(self) -> int:
        """Bytes of the tree as far as it is made, its triangles and vertices among them."""
        return self._builder.byte_count + self._mesh.vertices.nbytes


def _kernel_name(word: str) -> str:
    """Return what the kernels call a fit or a split."""
    return word.upper().replace("-", "_")


def _possible_nodes(triangles: int, options: BuildOptions) -> int:
    """Return how many boxes a tree can have."""
    _, split, leaf_size, max_depth = options
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


def _check_memory(mesh: Mesh, options: BuildOptions, max_memory: int | None) -> None:
    each = _BUILD_BYTES_A_TRIANGLE + (_HULL_BYTES_A_TRIANGLE if options.needs_hulls else 0)
    needed = each * len(mesh.triangles) + mesh.vertices.nbytes
    if max_memory is not None and needed > max_memory:
        raise MeshError(
            mesh.source or "mesh",
            f"a build over {len(mesh.triangles)} triangles needs about {needed} bytes, "
            f"{max_memory} are allowed",
            "allow more, or split the mesh",
        )
