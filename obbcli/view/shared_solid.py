"""What two solids share as a mesh, by manifold3d: to be looked at, not proven."""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from obbcli.errors import MeshError, ObbError
from obbcli.view.picture import Picture, Surface

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.motion.body import Body
    from obbcli.tree.tree import ObbTree

PACKAGE = "manifold3d"
REMEDY = "install it: pip install manifold3d"
_COLOR = (214, 30, 16)


class SharedSolid(NamedTuple):
    """The space that two solids share, as manifold3d has it.

    Attributes:
        vertices: float64 (V, 3), world coordinates.
        triangles: int64 (F, 3), turned outwards; none where they share nothing.
        volume: cubed mesh units, as it comes from these triangles.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    volume: float

    def surface(self) -> Surface:
        """Return it as a part of a picture."""
        return Surface(
            name="overlap of A and B",
            vertices=self.vertices,
            triangles=self.triangles,
            color=_COLOR,
        )

    def picture(self) -> Picture:
        """Return a picture of it alone."""
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        return Picture(title="overlap", parts=[self.surface()], focus=low / 2 + high / 2)


def require_package(what: str) -> None:
    """Refuse what needs manifold3d where it is not installed.

    Raises:
        ObbError: it is not.
    """
    if find_spec(PACKAGE) is None:
        raise ObbError(what, f"needs the package {PACKAGE}, which is not installed", REMEDY)


def shared_solid(bodies: tuple[Body, Body]) -> SharedSolid:
    """Return what two closed bodies share at t = 0.

    Nothing of it is proven: coordinates are rounded to a tolerance of their own, and surfaces that
    wind about some space twice are taken as if they did once.

    Args:
        bodies: A and B; their shapes are trees of watertight meshes.

    Raises:
        MeshError: manifold3d does not take a mesh for a solid.
    """
    first, second = (_manifold(name, body) for name, body in zip("AB", bodies, strict=True))
    shared = first ^ second
    mesh = shared.to_mesh64()
    vertices = np.array(mesh.vert_properties[:, :3], dtype=np.float64)
    return SharedSolid(vertices, np.array(mesh.tri_verts, dtype=np.int64), shared.volume())


def _manifold(name: str, body: Body) -> Any:
    """Return a body as manifold3d has it, turned outwards."""
    import manifold3d

    tree: ObbTree = body.shape  # type: ignore[assignment]
    mesh = tree.mesh
    # Corners at one place are one, as of STL, where no two triangles share any.
    ids = mesh.corner_ids
    _, firsts, rows = np.unique(ids, return_index=True, return_inverse=True)
    corners = body.pose.apply(mesh.vertices)[mesh.triangles].reshape(-1, 3)
    triangles = rows.reshape(-1, 3).astype(np.uint64)
    if _signed_volume(corners.reshape(-1, 3, 3)) < 0:
        triangles = triangles[:, ::-1]
    made = manifold3d.Manifold(
        manifold3d.Mesh64(
            vert_properties=np.ascontiguousarray(corners[firsts]),
            tri_verts=np.ascontiguousarray(triangles),
        )
    )
    if made.status() != manifold3d.Error.NoError:
        fault = f"is no solid for {PACKAGE} ({made.status().name})"
        raise MeshError(name, fault, "repair the mesh, or ask without its shape")
    return made


def _signed_volume(corners: NDArray[np.float64]) -> float:
    """Return about the volume of a closed surface, negative where it is turned inward."""
    a, b, c = (corners[:, k] - corners[0, 0] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)))
