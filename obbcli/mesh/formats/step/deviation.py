"""How far triangles are from the surfaces, and their edges from the curves, that they stand for.

The library aims at a deviation, and on spheres misses it by twice: so it is measured, at points of
each triangle and edge.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAbs import (
    GeomAbs_Cone,
    GeomAbs_Cylinder,
    GeomAbs_Plane,
    GeomAbs_Sphere,
    GeomAbs_Torus,
)
from OCP.GeomAdaptor import GeomAdaptor_Surface
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopLoc import TopLoc_Location

from obbcli.mesh.formats.step.occ import as_edge, shapes_in

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: Where triangles are measured, barycentric: middles of edges, the centroid, between it and all.
_WEIGHTS = np.array(
    [
        *((2, 2, 0), (0, 2, 2), (2, 0, 2)),
        *((3, 1, 0), (1, 3, 0), (0, 3, 1), (0, 1, 3), (3, 0, 1), (1, 0, 3)),
        *((2, 1, 1), (1, 2, 1), (1, 1, 2)),
        (4 / 3, 4 / 3, 4 / 3),
    ]
)
_WEIGHTS = _WEIGHTS / _WEIGHTS.sum(axis=1, keepdims=True)
#: Of surfaces that have to be evaluated point by point: middles and centroid.
_FEW = np.array([0, 1, 2, 12])
#: Where edges are measured, between their nodes.
_STEPS = (0.25, 0.5, 0.75)


def deviation_of_face(
    face: Any, cut: Any, nodes: NDArray[np.float64], triangles: NDArray[np.int64]
) -> float:
    """Return how far the triangles of a face are from its surface, at the points measured.

    Args:
        face: the face.
        cut: its triangulation.
        nodes: of it, (V, 3), where the face itself is not placed.
        triangles: rows of the nodes, (F, 3).
    """
    surface = BRep_Tool.Surface_s(face, TopLoc_Location())
    if surface is None:
        return 0.0  # a tessellation of the file itself
    shape = GeomAdaptor_Surface(surface)
    kind = shape.GetType()
    points = np.einsum("wk,fkd->fwd", _WEIGHTS, nodes[triangles]).reshape(-1, 3)
    points = np.vstack([points, nodes])
    if kind == GeomAbs_Plane:
        return _largest(_along(points, shape.Plane().Position())[2])
    if kind == GeomAbs_Cylinder:
        x, y, _ = _along(points, shape.Cylinder().Position())
        return _largest(np.hypot(x, y) - shape.Cylinder().Radius())
    if kind == GeomAbs_Sphere:
        x, y, z = _along(points, shape.Sphere().Position())
        return _largest(np.hypot(np.hypot(x, y), z) - shape.Sphere().Radius())
    if kind == GeomAbs_Torus:
        x, y, z = _along(points, shape.Torus().Position())
        ring, tube = shape.Torus().MajorRadius(), shape.Torus().MinorRadius()
        return _largest(np.hypot(np.hypot(x, y) - ring, z) - tube)
    if kind == GeomAbs_Cone:
        x, y, z = _along(points, shape.Cone().Position())
        angle, radius = shape.Cone().SemiAngle(), shape.Cone().RefRadius()
        away = np.hypot(x, y) - np.abs(radius + z * np.tan(angle))
        return _largest(away * np.cos(angle))
    return _evaluated(shape, cut, nodes, triangles)


def _largest(distances: NDArray[np.float64]) -> float:
    return float(np.abs(distances).max())


def _along(
    points: NDArray[np.float64], system: Any
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return points in a system of axes."""
    origin = system.Location()
    away = points - np.array([origin.X(), origin.Y(), origin.Z()])
    x, y, z = (
        away @ np.array([axis.X(), axis.Y(), axis.Z()])
        for axis in (system.XDirection(), system.YDirection(), system.Direction())
    )
    return x, y, z


def _evaluated(
    surface: Any, cut: Any, nodes: NDArray[np.float64], triangles: NDArray[np.int64]
) -> float:
    """Return how far points of a surface are from the planes of the triangles under them."""
    if not cut.HasUVNodes():
        return float("inf")
    parameters = np.array([(p.X(), p.Y()) for p in map(cut.UVNode, range(1, cut.NbNodes() + 1))])
    corners = nodes[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    flat = lengths > 0.0
    normals = normals[flat] / lengths[flat, None]
    weights = _WEIGHTS[_FEW]
    places = np.einsum("wk,fkd->fwd", weights, parameters[triangles[flat]])
    point, found = gp_Pnt(), np.empty((*places.shape[:2], 3))
    for row, each in zip(found.reshape(-1, 3), places.reshape(-1, 2).tolist(), strict=True):
        surface.D0(each[0], each[1], point)
        row[:] = point.X(), point.Y(), point.Z()
    away = np.einsum("fwd,fd->fw", found - corners[flat, :1], normals)
    return _largest(away) if away.size else 0.0


def deviation_of_edges(face: Any, cut: Any, location: Any, nodes: NDArray[np.float64]) -> float:
    """Return how far the edges of a face's triangulation are from its exact edges.

    Args:
        face: the face.
        cut: its triangulation.
        location: where the face is placed.
        nodes: of the triangulation, (V, 3), where the face is not placed.
    """
    farthest = 0.0
    back = location.Inverted()
    for each in shapes_in(face, TopAbs_EDGE):
        edge = as_edge(each)
        polygon = BRep_Tool.PolygonOnTriangulation_s(edge, cut, location)
        if polygon is None or not polygon.HasParameters() or BRep_Tool.Degenerated_s(edge):
            continue
        count = polygon.NbNodes()
        ends = nodes[[polygon.Node(k) - 1 for k in range(1, count + 1)]]
        values = np.array([polygon.Parameter(k) for k in range(1, count + 1)])
        farthest = max(farthest, _curve(as_edge(edge.Moved(back)), ends, values))
    return farthest


def _curve(edge: Any, ends: NDArray[np.float64], values: NDArray[np.float64]) -> float:
    """Return how far points of a curve are from the lines between its nodes."""
    curve = BRepAdaptor_Curve(edge)
    chords = np.diff(ends, axis=0)
    lengths = np.linalg.norm(chords, axis=1)
    kept = lengths > 0.0
    directions = chords[kept] / lengths[kept, None]
    farthest = 0.0
    point = gp_Pnt()
    for step in _STEPS:
        places = (values[:-1] + step * np.diff(values))[kept]
        found = np.empty((len(places), 3))
        for row, place in zip(found, places.tolist(), strict=True):
            curve.D0(place, point)
            row[:] = point.X(), point.Y(), point.Z()
        away = found - ends[:-1][kept]
        away -= np.einsum("nd,nd->n", away, directions)[:, None] * directions
        if len(away):
            farthest = max(farthest, float(np.linalg.norm(away, axis=1).max()))
    return farthest
