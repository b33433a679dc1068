"""`MeasuredFile`: a path that says in which unit, or by which scale, its file is taken."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING

from obbcli.errors import MeshError

if TYPE_CHECKING:
    from obbcli.mesh.mesh import Mesh


@dataclass(frozen=True)
class MeasuredFile(os.PathLike[str]):
    """The path of a mesh or tree file, and the unit in which its coordinates are taken.

    Attributes:
        path: of the file.
        unit: that it is scaled to; None: of no matter.
        own: the unit that it is in, in place of what it states; None: what it states.
        scale: by which it is multiplied, in place of what it states; None: by none.
        weld: within which distance vertices become one, before they are scaled; None: none do.
        sag: how far triangles may be from exact surfaces, in the file's unit; None: the default.
    """

    path: str
    unit: str | None = None
    own: str | None = None
    scale: float | None = None
    weld: float | None = None
    sag: float | None = None

    def __fspath__(self) -> str:
        return self.path

    def __str__(self) -> str:
        return self.path

    def measure(self, mesh: Mesh) -> Mesh:
        """Return the file's mesh as it is taken.

        Raises:
            MeshError: a unit or scale is none, a coordinate leaves the range of double, or
                vertices cannot be welded.
        """
        if self.weld is not None:
            mesh = mesh.welded(self.weld)
        if self.scale is not None:
            return mesh.scaled(self.scale, self.unit)
        if self.own is not None:
            mesh = mesh.stated(self.own)
        return mesh if self.unit is None else mesh.in_unit(self.unit)

    def check_tree(self, unit: str | None) -> None:
        """Refuse a tree file that would have to be scaled or welded: its boxes do not allow it.

        Args:
            unit: that the tree is in.

        Raises:
            MeshError: it would.
        """
        remedy = "build a tree of the mesh with --unit, --scale, --weld or --sag"
        if self.sag is not None:
            raise MeshError(self.path, "is a tree file, whose triangles are cut", remedy)
        if self.weld is not None:
            raise MeshError(self.path, "is a tree file, which is not welded", remedy)
        if self.scale is not None:
            raise MeshError(self.path, "is a tree file, which is not scaled", remedy)
        own = self.own or unit
        if self.own is not None and unit not in (None, self.own):
            raise MeshError(self.path, f"is a tree in {unit}, not {self.own}", remedy)
        if self.unit is not None and own not in (None, self.unit):
            raise MeshError(self.path, f"is a tree in {own}, not {self.unit}", remedy)
