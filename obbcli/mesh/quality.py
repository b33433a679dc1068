"""What a mesh itself limits: its digits against its features, slivers, odd extents.

A feature here is what moves with a coordinate: an edge, or the altitude of a triangle. Vertices
stand on a grid, that of their digits; where features are few steps of it, the shape that was meant
is not the one that is stored, and an exact answer about it is exact about that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.measure import degenerate, used_vertices
from obbcli.mesh.spacing import are_float32

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.mesh import Mesh

#: Features of fewer steps of the grid than this are told: rounding moves them by 1 in 2,000.
FEW_STEPS = 1000.0
#: Longest edge by altitude: triangles beyond it are told as slivers.
SLIVER = 1000.0
#: Longest by shortest extent of the box: beyond it the short side has six digits fewer.
ODD_EXTENTS = 1e6
_BLOCK = 1 << 14


class Grain(NamedTuple):
    """The digits of a mesh against its features; lengths in mesh units.

    Attributes:
        digits: `"float32"` where every coordinate is one, else `"float64"`.
        spacing: from the largest coordinate to the next number with those digits.
        shortest_edge: above 0; None where all edges are points.
        smallest_altitude: above 0, of triangles that are no lines; None where all are.
        largest_aspect: longest edge by altitude of the thinnest of those.
        sliver_count: how many have an aspect of more than 1,000.
        extents_ratio: longest by shortest side of the box, of those above 0; None of a point.
    """

    digits: str
    spacing: float
    shortest_edge: float | None
    smallest_altitude: float | None
    largest_aspect: float | None
    sliver_count: int
    extents_ratio: float | None

    @property
    def steps(self) -> float | None:
        """How many steps of the grid the smallest feature is; None without one."""
        features = [x for x in (self.shortest_edge, self.smallest_altitude) if x is not None]
        return min(features) / self.spacing if features else None


def grain_of(mesh: Mesh) -> Grain:
    """Return a mesh's grain: rounded, so that its last digits mean nothing."""
    used = used_vertices(mesh.vertices, mesh.triangles)
    # Scaled, so that neither squares nor products leave the doubles.
    exponent = int(np.frexp(np.abs(used).max())[1])
    largest = float(np.abs(used).max())
    is_float32 = are_float32(used)
    spacing = float(np.spacing(np.float32(largest)) if is_float32 else np.spacing(largest))
    edge, altitude, aspect, slivers = _features(mesh, exponent)
    sides = np.ldexp(mesh.bounds[1], -exponent) - np.ldexp(mesh.bounds[0], -exponent)
    sides = sides[sides > 0]
    return Grain(
        "float32" if is_float32 else "float64",
        spacing,
        _unscaled(edge, exponent),
        _unscaled(altitude, exponent),
        aspect,
        slivers,
        float(sides.max() / sides.min()) if len(sides) else None,
    )


def _unscaled(length: float | None, exponent: int) -> float | None:
    with np.errstate(over="ignore", under="ignore"):
        return None if length is None else float(np.ldexp(length, exponent))


def _features(mesh: Mesh, exponent: int) -> tuple[float | None, float | None, float | None, int]:
    """Return the shortest edge and altitude, the largest aspect and the number of slivers."""
    edges, altitudes, aspects = [], [], []
    slivers = 0
    for start in range(0, len(mesh.triangles), _BLOCK):
        corners = np.ldexp(mesh.vertices[mesh.triangles[start : start + _BLOCK]], -exponent)
        sides = np.roll(corners, -1, axis=1) - corners
        lengths = np.sqrt((sides * sides).sum(axis=2))
        longest = lengths.max(axis=1)
        cross = np.cross(sides[:, 0], sides[:, 1])
        area = np.sqrt((cross * cross).sum(axis=1))
        # Of three points on a line rounding makes an area now and then.
        is_full = (area > 0) & ~degenerate(corners)
        altitude = area[is_full] / longest[is_full]
        with np.errstate(over="ignore"):
            aspect = longest[is_full] / altitude
        slivers += int(np.count_nonzero(aspect > SLIVER))
        edges.append(lengths[lengths > 0])
        altitudes.append(altitude[altitude > 0])
        aspects.append(aspect[np.isfinite(aspect)])
    return _least(edges), _least(altitudes), _largest(aspects), slivers


def _least(parts: list[NDArray[np.float64]]) -> float | None:
    values = np.concatenate(parts)
    return float(values.min()) if len(values) else None


def _largest(parts: list[NDArray[np.float64]]) -> float | None:
    values = np.concatenate(parts)
    return float(values.max()) if len(values) else None


def warnings_of(mesh: Mesh, grain: Grain) -> list[str]:
    """Return what of a mesh limits the accuracy of answers, a sentence each."""
    found = []
    steps = grain.steps
    if steps is not None and steps < FEW_STEPS:
        found.append(
            f"coordinates stand on a grid of {grain.spacing:.2g} ({grain.digits}), and the smallest"
            f" feature is {steps:.3g} steps of it"
        )
    if grain.sliver_count and grain.largest_aspect is not None:
        found.append(
            f"slivers: {grain.sliver_count:,}, up to {grain.largest_aspect:.3g} times as long as"
            " high: their normals are that much less certain"
        )
    if mesh.degenerate_count:
        found.append(f"degenerate triangles: {mesh.degenerate_count:,}, which have no normal")
    if mesh.duplicate_count:
        found.append(f"duplicate triangles: {mesh.duplicate_count:,}, which cost and add nothing")
    if grain.extents_ratio is not None and grain.extents_ratio > ODD_EXTENTS:
        found.append(f"the longest side is {grain.extents_ratio:.3g} times the shortest")
    return found
