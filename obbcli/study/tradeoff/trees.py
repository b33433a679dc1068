"""The same two bodies over trees that are built in one way or another."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from obbcli.mesh import Mesh, load_mesh
from obbcli.motion.body import Body
from obbcli.tree.tree import ObbTree, begins_as_tree, check_measures

if TYPE_CHECKING:
    from collections.abc import Callable

    from obbcli.motion.body import Shape
    from obbcli.tree.options import BuildOptions


class _OutOfTimeError(Exception):
    """A build takes longer than it may."""


class Built(NamedTuple):
    """Two bodies over trees that are whole, and what these cost: s of wall time, bytes."""

    bodies: tuple[Body, Body]
    seconds: float
    nbytes: int


class Trees:
    """The trees of two bodies, each way of building them made once. What came as a tree stays.

    Args:
        bodies: A and B over any shapes.

    Attributes:
        bodies: the same over meshes or trees.
        can_vary: whether one of them is a mesh.

    Raises:
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """

    def __init__(self, bodies: tuple[Body, Body]) -> None:
        a, b = bodies
        first = _shape(a.shape)
        second = first if b.shape is a.shape else _shape(b.shape)
        self._shapes = first, second
        self.bodies = Body(first, a.pose, a.motion), Body(second, b.pose, b.motion)
        self.can_vary = isinstance(first, Mesh) or isinstance(second, Mesh)
        self._known: dict[BuildOptions, Built] = {}

    @property
    def size(self) -> float:
        """The size of the pair, mesh units."""
        return max(shape.size for shape in self._shapes)

    @property
    def triangle_count(self) -> int:
        """How many triangles the larger one has."""
        return max(
            len(shape.triangles) if isinstance(shape, Mesh) else shape.triangle_count
            for shape in self._shapes
        )

    def options(self, build: BuildOptions) -> dict[str, Any]:
        """Return options of `ObbTree.build`; none where both bodies came as trees."""
        return build._asdict() if self.can_vary else {}

    def built(self, build: BuildOptions, seconds: float | None = None) -> Built | None:
        """Return the bodies over trees that are built so; None where that takes longer.

        Args:
            build: how.
            seconds: s that it may take. None: no limit.
        """
        known = self._known.get(build)
        if known is not None:
            return known
        start = time.perf_counter()

        def look(_share: float) -> None:
            if seconds is not None and time.perf_counter() - start > seconds:
                raise _OutOfTimeError

        first, second = self._shapes
        try:
            a = _tree(first, build, look)
            b = a if second is first else _tree(second, build, look)
        except _OutOfTimeError:
            return None
        spent = time.perf_counter() - start
        nbytes = a.nbytes + (0 if b is a else b.nbytes)
        here, there = self.bodies
        bodies = Body(a, here.pose, here.motion), Body(b, there.pose, there.motion)
        self._known[build] = Built(bodies, spent, nbytes)
        return self._known[build]


def _shape(shape: Shape) -> Mesh | ObbTree:
    """Return a tree as it is, and the mesh of all else."""
    if isinstance(shape, (Mesh, ObbTree)):
        return shape
    decoded = getattr(shape, "mesh", None)  # that of a part
    if isinstance(decoded, Mesh):
        return decoded
    assert isinstance(shape, (str, os.PathLike))  # a Body holds nothing else
    if not begins_as_tree(Path(shape)):
        return load_mesh(shape)
    tree = ObbTree.open(os.fspath(shape))
    check_measures(shape, tree.unit)
    return tree


def _tree(shape: Mesh | ObbTree, build: BuildOptions, look: Callable[[float], object]) -> ObbTree:
    if isinstance(shape, ObbTree):
        return shape
    return ObbTree.build(shape, **build._asdict(), lazy=False, progress=look)
