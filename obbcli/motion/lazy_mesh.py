"""`LazyMesh`: the mesh of a part, decoded when it is first asked for."""

from __future__ import annotations

from functools import cached_property
from threading import RLock
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh import Mesh, measure

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray


class LazyMesh:
    """A mesh that is decoded when it is first asked for; the parts of one shape share it.

    Args:
        decode: returns the mesh.
    """

    def __init__(self, decode: Callable[[], Mesh]) -> None:
        self._decode: Callable[[], Mesh] | None = decode
        self._mesh: Mesh | None = None
        self._lock = RLock()

    @property
    def is_decoded(self) -> bool:
        """Whether the mesh was asked for."""
        return self._mesh is not None

    @property
    def mesh(self) -> Mesh:
        """The mesh.

        Raises:
            MeshError: it is damaged.
        """
        with self._lock:
            if self._mesh is None:
                assert self._decode is not None
                self._mesh, self._decode = self._decode(), None
            return self._mesh

    @cached_property
    def coordinates(self) -> NDArray[np.float64]:
        """The vertices that triangles use, an axis a row, (3, N): what bounds of copies take."""
        return used_coordinates(self.mesh)

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Lower and upper corner of the mesh, (2, 3)."""
        return self.mesh.bounds

    @property
    def surface_centroid(self) -> NDArray[np.float64]:
        """Area-weighted centroid of the mesh, (3,)."""
        return self.mesh.surface_centroid


def used_coordinates(shape: Mesh | LazyMesh) -> NDArray[np.float64]:
    """Return the vertices that triangles use, an axis a row, (3, N)."""
    if isinstance(shape, LazyMesh):
        return shape.coordinates
    return np.ascontiguousarray(measure.used_vertices(shape.vertices, shape.triangles).T)
