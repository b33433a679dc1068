"""Triangles of exact shapes: every face is cut, and every cut is measured against its surface."""

from __future__ import annotations

from math import floor, ldexp, log10
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED, TopAbs_SOLID
from OCP.TopLoc import TopLoc_Location

from obbcli.mesh.formats.step.deviation import deviation_of_edges, deviation_of_face
from obbcli.mesh.formats.step.occ import as_face, matrix_of, shapes_in
from obbcli.mesh.formats.step.refusal import StepError
from obbcli.mesh.parts.placed import mirrors, transformed

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: The sag where none is asked for, as a share of the product's size.
_SHARE = 1e-3
#: Normals of neighbouring triangles differ by less, rad: the library's own default, which gives
#: small rounds a dozen sides however large the sag.
_ANGLE = 0.5
#: The library aims at a deviation and may miss it by twice: so often it is asked for less.
_TRIES = 8
_MARGIN = 0.8
#: Between the points that are measured triangles are farther off than at them, by a fifteenth where
#: a surface is a quadric.
_SPARE = 1.1


class Tessellation(NamedTuple):
    """Holds the triangles of one product.

    Attributes:
        vertices: (V, 3), each position once, in the order in which triangles use them.
        triangles: (F, 3), face by face in the file's order.
        sag: no triangle or edge is measured to be farther from its surface or curve.
        face_count: how many faces were cut.
        open_edge_count: of solids alone: edges that no two triangles share, turned alike.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    sag: float
    face_count: int
    open_edge_count: int


def tessellated(shape: Any, sag: float | None, exponent: int) -> Tessellation:
    """Return the triangles of a shape.

    Args:
        shape: of a product.
        sag: how far triangles may be from it; None for 1e-3 of its size.
        exponent: of the power of two that lengths of the shape are times those told and returned.

    Raises:
        StepError: a face gets no triangles, or cannot be cut within the sag.
    """
    aim = ldexp(sag, exponent) if sag is not None else _SHARE * _rough_size(shape)
    for _ in range(_TRIES):
        cut = _cut(shape, aim)
        vertices = np.ldexp(cut.vertices, -exponent)
        cut = cut._replace(vertices=vertices, sag=ldexp(cut.sag, -exponent))
        wanted = sag if sag is not None else _default_sag(vertices)
        if cut.sag <= wanted:
            return cut._replace(sag=wanted)
        aim = min(_MARGIN * aim * wanted / cut.sag, _MARGIN * aim)
    fault = f"has surfaces that triangles miss by {cut.sag:.3g}, where {wanted:.3g} is asked for"
    raise StepError(fault, f"take a sag of {2 * cut.sag:.1g} or more, or export it as STL")


def _rough_size(shape: Any) -> float:
    """Return the diagonal of a box that holds a shape, and may be larger than need be."""
    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box, False)
    size = 0.0 if box.IsVoid() else float(box.SquareExtent()) ** 0.5
    if not 0.0 < size < float("inf"):
        raise StepError("is a shape without end or extent", "export it again")
    return size


def _default_sag(vertices: NDArray[np.float64]) -> float:
    """Return 1e-3 of the size of a mesh, rounded down to two digits."""
    value = _SHARE * float(np.linalg.norm(np.ptp(vertices, axis=0)))
    if value <= 0.0:
        raise StepError("is a shape without extent", "export it again")
    digits = 1 - floor(log10(value))
    return float(f"{floor(value * 10.0**digits)}e{-digits}")


def _cut(shape: Any, aim: float) -> Tessellation:
    """Return triangles whose sag is what they were measured to be."""
    BRepTools.Clean_s(shape)
    BRepMesh_IncrementalMesh(shape, aim, False, _ANGLE, False)
    points: list[NDArray[np.float64]] = []
    rows: list[NDArray[np.int64]] = []
    farthest, first = 0.0, 0
    for number, each in enumerate(shapes_in(shape, TopAbs_FACE)):
        face = as_face(each)
        vertices, triangles, deviation = _face(face, number)
        points.append(vertices)
        rows.append(triangles + first)
        first += len(vertices)
        farthest = max(farthest, deviation)
    vertices, triangles = _joined(np.vstack(points), np.vstack(rows))
    closed = sum(
        1 for solid in shapes_in(shape, TopAbs_SOLID) for _ in shapes_in(solid, TopAbs_FACE)
    )
    # Sheets beside solids have open edges of their own.
    loose = _open_edges(triangles) if closed == len(points) else 0
    return Tessellation(vertices, triangles, _SPARE * farthest, len(points), loose)


def _face(face: Any, number: int) -> tuple[NDArray[np.float64], NDArray[np.int64], float]:
    """Return a face's nodes as placed, its triangles, and how far they are off."""
    location = TopLoc_Location()
    found = BRep_Tool.Triangulation_s(face, location)
    if found is None or found.NbTriangles() == 0:
        fault = "gets no triangles, and would be lost"
        raise StepError(fault, "export it again, or as STL", f"face {number + 1}")
    nodes = np.array(
        [(p.X(), p.Y(), p.Z()) for p in map(found.Node, range(1, found.NbNodes() + 1))]
    )
    triangles = np.array(
        [found.Triangle(k).Get() for k in range(1, found.NbTriangles() + 1)], dtype=np.int64
    )
    triangles -= 1
    deviation = deviation_of_face(face, found, nodes, triangles)
    deviation = max(deviation, deviation_of_edges(face, found, location, nodes))
    if not np.isfinite(nodes).all() or not np.isfinite(deviation):
        fault = "is cut into triangles that are not finite"
        raise StepError(fault, "export it again, or as STL", f"face {number + 1}")
    matrix = matrix_of(location)
    if (face.Orientation() == TopAbs_REVERSED) != mirrors(matrix):
        triangles = triangles[:, ::-1]
    kept = _kept(nodes, triangles)
    if not len(kept):
        fault = "is cut into triangles of no area, and would be lost"
        raise StepError(fault, "take a smaller sag, or export it again", f"face {number + 1}")
    return transformed(nodes, matrix) + 0.0, kept, deviation


def _kept(nodes: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the triangles whose corners are three places: at poles some have two."""
    a, b, c = (nodes[triangles[:, k]] for k in range(3))
    is_two = (a == b).all(axis=1) | (b == c).all(axis=1) | (c == a).all(axis=1)
    kept: NDArray[np.int64] = triangles[~is_two]
    return kept


def _joined(
    points: NDArray[np.float64], triangles: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return each position once, in the order in which triangles use them: faces share edges."""
    _, first, place = np.unique(points, axis=0, return_index=True, return_inverse=True)
    corners = first[place.reshape(-1)][triangles].reshape(-1)
    used, at, number = np.unique(corners, return_index=True, return_inverse=True)
    order = np.argsort(at, kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return points[used[order]], rank[number.reshape(-1)].reshape(-1, 3)


def _open_edges(triangles: NDArray[np.int64]) -> int:
    """Return how many edges are not run through as often one way as the other."""
    starts = triangles.reshape(-1)
    ends = np.roll(triangles, -1, axis=1).reshape(-1)
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    _, place = np.unique(np.stack([low, high], axis=1), axis=0, return_inverse=True)
    balance = np.bincount(place.reshape(-1), weights=np.where(starts < ends, 1.0, -1.0))
    return int(np.count_nonzero(balance))
