"""The boxes of a tree over its mesh: those of a level, or the last ones under a node."""

from __future__ import annotations

import colorsys
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli import kernels
from obbcli.errors import ObbError, TreeFileError
from obbcli.view.picture import VIEWS, Lines, Picture, Surface, bounds_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.tree.tree import ObbTree
    from obbcli.view.picture import Color

_MESH = (222, 224, 228)
_EDGE = (38, 42, 52)
_OPACITY = 0.3
# Neighbours of one depth differ by their shade, so that they can be told apart.
_SHADES = (1.0, 0.66, 1.36)
# Hues go once around in so many levels, in steps that neighbours differ by.
_HUES = 11
_HUE_STEP = 4

_SIGNS = np.array(list(product((-1.0, 1.0), repeat=3)))
# Corners in the order of `_SIGNS`, counter-clockwise from outside.
_FACES = np.array(
    [
        *((0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)),
        *((2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)),
    ]
)
_EDGES = np.array([(i, i | bit) for bit in (1, 2, 4) for i in range(8) if not i & bit])


class Boxes(NamedTuple):
    """Boxes of a tree.

    Attributes:
        nodes: (N,) rows of the tree's boxes.
        depths: (N,) the root's is 0.
        triangle_counts: (N,) how many triangles each holds.
        centers: (N, 3) mesh units.
        axes: (N, 3, 3), a row is a unit axis.
        half_extents: (N, 3) mesh units.
    """

    nodes: NDArray[np.int64]
    depths: NDArray[np.int64]
    triangle_counts: NDArray[np.int64]
    centers: NDArray[np.float64]
    axes: NDArray[np.float64]
    half_extents: NDArray[np.float64]

    @classmethod
    def of(cls, refs: NDArray[np.uint32], boxes: NDArray[np.float64]) -> Boxes:
        """Return boxes from the rows of the kernels."""
        node, depth, begin, end = refs.astype(np.int64).T
        axes = boxes[:, 3:12].reshape(-1, 3, 3)
        return cls(node, depth, end - begin, boxes[:, :3], axes, boxes[:, 12:])

    def corners(self) -> NDArray[np.float64]:
        """Return the corners of all boxes, (N, 8, 3)."""
        arms = _SIGNS[None] * self.half_extents[:, None]
        corners: NDArray[np.float64] = self.centers[:, None] + arms @ self.axes
        return corners


def boxes_of_level(tree: ObbTree, level: int, *, or_last: bool = False) -> Boxes:
    """Return the boxes of one depth. Of a tree that grows nothing below them is made.

    Args:
        tree: whose boxes.
        level: the root is 0.
        or_last: take the last level of a tree that does not go so deep.

    Raises:
        ObbError: there is none so deep.
        TreeFileError: the tree's file is damaged.
    """
    try:
        refs, boxes, deepest = tree.kernel.boxes_of_level(min(level, 2**32 - 1))
    except kernels.TreeError as fault:
        raise TreeFileError(tree.place, str(fault), "build it again") from fault
    if not len(refs) and or_last and tree.triangle_count > 1:
        return boxes_of_level(tree, deepest)
    if not len(refs):
        raise ObbError(f"level {level}", _nothing(tree, f"its last level is {deepest}"))
    return Boxes.of(refs, boxes)


def last_boxes_under(tree: ObbTree, node: int) -> Boxes:
    """Return the last box above each triangle under a node.

    Raises:
        ObbError: there is no such node.
        TreeFileError: the tree's file is damaged.
    """
    try:
        found = tree.kernel.last_boxes_under(min(node, 2**32 - 1))
    except kernels.TreeError as fault:
        raise TreeFileError(tree.place, str(fault), "build it again") from fault
    if found is None:
        raise ObbError(f"node {node}", _nothing(tree, "no box has this number"))
    return Boxes.of(*found[:2])


def _nothing(tree: ObbTree, otherwise: str) -> str:
    if tree.triangle_count == 1:
        return "the tree has no boxes: a single triangle needs none"
    return f"the tree does not go there: {otherwise}"


def tree_picture(tree: ObbTree, boxes: Boxes, title: str) -> Picture:
    """Return the picture of boxes over the mesh, colored by depth."""
    mesh = tree.mesh
    parts: list[Surface | Lines] = [
        Surface(name="mesh", vertices=mesh.vertices, triangles=mesh.triangles, color=_MESH)
    ]
    corners = boxes.corners()
    for depth in np.unique(boxes.depths).tolist():
        rows = np.flatnonzero(boxes.depths == depth)
        for shade, lightness in enumerate(_SHADES):
            chosen = corners[rows[shade :: len(_SHADES)]]
            if len(chosen):
                parts.append(_solid(f"depth {depth}, shade {shade}", chosen, depth, lightness))
        parts.append(_wires(f"depth {depth}, edges", corners[rows]))
    low, high = bounds_of(parts)
    return Picture(title=title, parts=parts, focus=low / 2 + high / 2, direction=VIEWS[0])


def depth_color(depth: int, lightness: float = 1.0) -> Color:
    """Return the color of a depth; shades of one have one hue."""
    hue = (depth * _HUE_STEP + 6) % _HUES / _HUES
    r, g, b = colorsys.hls_to_rgb(hue, 0.5 * lightness, 0.95)
    return round(255 * r), round(255 * g), round(255 * b)


def _solid(name: str, corners: NDArray[np.float64], depth: int, lightness: float) -> Surface:
    return Surface(
        name=name,
        vertices=corners.reshape(-1, 3),
        triangles=_each(_FACES, len(corners)),
        color=depth_color(depth, lightness),
        opacity=_OPACITY,
        is_layered=True,
    )


def _wires(name: str, corners: NDArray[np.float64]) -> Lines:
    return Lines(
        name=name,
        vertices=corners.reshape(-1, 3),
        segments=_each(_EDGES, len(corners)),
        color=_EDGE,
    )


def _each(rows: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Return rows of corners once a box."""
    return (rows[None] + 8 * np.arange(count)[:, None, None]).reshape(-1, rows.shape[1])
