"""Edges of one body that pierce triangles of the other: five functions that stay positive.

The ends of the edge are on either side of the triangle's plane, and its line passes the three
borders on the same side. All is seen from the triangle, which rests.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.questions.intervals.polynomials import Reach, norm, plus, poly, reach_of, times
from obbcli.questions.intervals.witness import ERROR_FACTOR, Functions

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.questions.intervals.relative_motion import Path, RelativeMotion

    Floats = NDArray[np.float64]


class _Scene(NamedTuple):
    """Edges and triangles as seen from the triangles.

    Attributes:
        ends: the paths of the two ends of each edge.
        reaches: what bounds these.
        way: how the vector from one end to the other turns.
        corners: (N, 3, 3).
        borders: from each corner to the next, (N, 3, 3).
        error: mesh units.
        turn_bounds: as `RelativeMotion` has them.
    """

    ends: tuple[Path, Path]
    reaches: tuple[Reach, Reach]
    way: Path
    corners: Floats
    borders: Floats
    error: float
    turn_bounds: tuple[float, float, float]


def piercings(motion: RelativeMotion, edges: Floats, faces: Floats, error: float) -> Functions:
    """Return the functions of edges of X and triangles of Y; where not pierced, one is negative.

    Args:
        motion: of X seen from Y.
        edges: (N, 2, 3), at the start of the leg.
        faces: (N, 3, 3), likewise.
        error: mesh units; by how much any place is off at most.
    """
    p, q = motion.path(edges[:, 0]), motion.path(edges[:, 1])
    growth = motion.third_growth
    reaches = reach_of(p, growth), reach_of(q, growth)
    corners = motion.fixed(faces)
    scene = _Scene(
        (p, q),
        reaches,
        motion.turn_of(q.place - p.place),
        corners,
        np.roll(corners, -1, axis=1) - corners,
        error,
        motion.turn_bounds,
    )
    return Functions(*map(_joined, _plane_functions(scene), _border_functions(scene)))


def _plane_functions(scene: _Scene) -> Functions:
    """Return how far the ends are from the plane, times the size of its normal."""
    corner, borders = scene.corners[:, 0], scene.borders
    normal = np.cross(borders[:, 0], -borders[:, 2])
    # The two ends count with opposite signs.
    signs = np.sign(_dot(normal, scene.ends[0].place - corner))[:, None] * [1.0, -1.0]

    def along(vectors: list[Floats]) -> Floats:
        parts: Floats = np.stack([_dot(normal, v) for v in vectors], axis=1) * signs
        return parts

    length = norm(borders).max(axis=1)
    ways = [poly(norm(end.place - corner)) for end in scene.ends]
    reaches = scene.reaches
    sizes = plus(poly(length), *ways, reaches[0].way, reaches[1].way)
    error = times(poly(ERROR_FACTOR * scene.error * length), sizes)
    size = poly(norm(normal))
    return Functions(
        along([end.place - corner for end in scene.ends]),
        along([end.first for end in scene.ends]),
        along([end.second for end in scene.ends]),
        np.stack([times(size, reach.third) for reach in reaches], axis=1),
        np.stack([error, error], axis=1),
    )


def _border_functions(scene: _Scene) -> Functions:
    """Return the volumes that the edge's line makes with the borders."""
    borders, p, reach = scene.borders, scene.ends[0], scene.reaches[0]
    arm = p.place[:, None] - scene.corners
    p1, p2 = p.first[:, None], p.second[:, None]
    d, d1, d2 = (part[:, None] for part in scene.way[:3])
    value = _dot(borders, np.cross(arm, d))
    first = _dot(borders, np.cross(p1, d) + np.cross(arm, d1))
    second = _dot(borders, np.cross(p2, d) + 2 * np.cross(p1, d1) + np.cross(arm, d2))
    side = np.sign(value.sum(axis=1))[:, None]
    o1, o2, o3 = scene.turn_bounds
    length, width = norm(scene.way.place)[:, None], norm(borders)
    arms = plus(poly(norm(arm)), reach.way[:, None])
    third = plus(
        reach.third[:, None],
        3 * o1 * reach.second[:, None],
        3 * o2 * reach.first[:, None],
        o3 * arms,
    )
    sizes = plus(poly(width * length), times(poly(width + length), arms))
    return Functions(
        side * value,
        side * first,
        side * second,
        times(poly(width * length), third),
        ERROR_FACTOR * scene.error * sizes,
    )


def _dot(a: Floats, b: Floats) -> Floats:
    products: Floats = (a * b).sum(axis=-1)
    return products


def _joined(a: Floats, b: Floats) -> Floats:
    """Return two groups of functions as one; coefficients of fewer degrees are filled up."""
    if a.ndim == 2:
        return np.concatenate([a, b], axis=1)
    size = max(a.shape[-1], b.shape[-1])
    parts = [np.pad(x, ((0, 0), (0, 0), (0, size - x.shape[-1]))) for x in (a, b)]
    return np.concatenate(parts, axis=1)
