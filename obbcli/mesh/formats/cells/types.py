"""Cells of finite elements: their faces, and how each face is cut into flat pieces at its nodes.

Nodes are numbered as VTK does, which meshio turns its formats into: first the corners, then the
middle nodes of edges, then those of faces.
"""

from __future__ import annotations

from typing import NamedTuple


class Face(NamedTuple):
    """One face of a cell, by the cell's own nodes.

    Attributes:
        corners: counter-clockwise seen from outside, or as a surface cell has them.
        nodes: all nodes around the face, beginning with the first corner: the corners, and after
            each the middle node of the edge that leaves it, where the cell has one.
        center: the node in the middle of the face; None where the cell has none.
    """

    corners: tuple[int, ...]
    nodes: tuple[int, ...]
    center: int | None = None

    @property
    def is_flat(self) -> bool:
        """Return whether the face has no nodes but its corners."""
        return self.corners == self.nodes and self.center is None

    @property
    def pieces(self) -> tuple[tuple[int, ...], ...]:
        """Return the polygons that the face is cut into, together through all of its nodes.

        A face of corners alone is one. Around a middle node lie triangles; without one each corner
        is cut off between the middles of its edges, and a polygon of those is left.
        """
        if self.is_flat:
            return (self.corners,)
        after = (*self.nodes[1:], self.nodes[0])
        if self.center is not None:
            center = self.center
            return tuple((center, a, b) for a, b in zip(self.nodes, after, strict=True))
        before = (self.nodes[-1], *self.nodes[:-1])
        around = tuple(zip(before, self.nodes, after, strict=True))
        if len(self.nodes) == 2 * len(self.corners):
            cut_off = tuple(three for three in around if three[1] in self.corners)
            return (*cut_off, tuple(n for n in self.nodes if n not in self.corners))
        # Two opposite edges have middle nodes: the line between these parts two quads.
        first, second = (k for k, node in enumerate(self.nodes) if node not in self.corners)
        ring = self.nodes
        return ring[first : second + 1], (*ring[second:], *ring[: first + 1])


class Cell(NamedTuple):
    """A type of cells.

    Attributes:
        node_count: how many nodes each has.
        faces: those of a volume; of a surface cell the cell itself.
        is_volume: whether it has an inside.
        name: as notes call it, without a number.
    """

    node_count: int
    faces: tuple[Face, ...]
    is_volume: bool
    name: str


#: Cells without area, which no surface is made of: passed over.
WITHOUT_AREA = frozenset(
    (
        *("empty", "vertex", "polyvertex", "polyline", "VTK_LAGRANGE_CURVE"),
        *("line", *(f"line{count}" for count in range(3, 12))),
    )
)

_TRIANGLE = ((0, 1, 2),)
_QUAD = ((0, 1, 2, 3),)
_TETRA = ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1))
_PYRAMID = ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))
_WEDGE = ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0))
_HEXAHEDRON = (
    (0, 4, 7, 3),
    (1, 2, 6, 5),
    (0, 1, 5, 4),
    (3, 7, 6, 2),
    (0, 3, 2, 1),
    (4, 5, 6, 7),
)

_RING_3 = ((0, 1), (1, 2), (2, 0))
_RING_4 = ((0, 1), (1, 2), (2, 3), (3, 0))
_TETRA_EDGES = (*_RING_3, (0, 3), (1, 3), (2, 3))
_PYRAMID_EDGES = (*_RING_4, (0, 4), (1, 4), (2, 4), (3, 4))
_WEDGE_RINGS = (*_RING_3, (3, 4), (4, 5), (5, 3))
_WEDGE_EDGES = (*_WEDGE_RINGS, (0, 3), (1, 4), (2, 5))
_HEXAHEDRON_EDGES = (
    *_RING_4,
    *((4, 5), (5, 6), (6, 7), (7, 4)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
)


def _prism(sides: int) -> tuple[tuple[int, ...], ...]:
    """Return the faces of a prism over a polygon: both ends, then the sides."""
    low = tuple(range(sides))
    walls = tuple((k, (k + 1) % sides, sides + (k + 1) % sides, sides + k) for k in low)
    return (low[::-1], tuple(range(sides, 2 * sides)), *walls)


def _cell(
    name: str,
    corners: tuple[tuple[int, ...], ...],
    edges: tuple[tuple[int, int], ...] = (),
    centers: tuple[int, ...] = (),
    more: int = 0,
) -> Cell:
    """Return a type of cells.

    Args:
        name: as notes call it.
        corners: of each face.
        edges: those that have a middle node, in the order of these nodes, which follow the corners.
        centers: faces that have a middle node, in the order of these nodes, which follow.
        more: how many nodes inside the cell follow.
    """
    corner_count = 1 + max(corner for face in corners for corner in face)
    middles = {frozenset(edge): corner_count + k for k, edge in enumerate(edges)}
    first = corner_count + len(edges)
    faces = []
    for number, face in enumerate(corners):
        nodes: list[int] = []
        for a, b in zip(face, (*face[1:], face[0]), strict=True):
            middle = middles.get(frozenset((a, b)))
            nodes += [a] if middle is None else [a, middle]
        center = first + centers.index(number) if number in centers else None
        faces.append(Face(face, tuple(nodes), center))
    return Cell(first + len(centers) + more, tuple(faces), len(corners) > 1, name)


#: All types whose faces are known, by meshio's names. A polygon and a polyhedron bring their own.
CELLS = {
    "triangle": _cell("triangle", _TRIANGLE),
    "triangle6": _cell("quadratic triangle", _TRIANGLE, _RING_3),
    "triangle7": _cell("quadratic triangle", _TRIANGLE, _RING_3, (0,)),
    "quad": _cell("quad", _QUAD),
    "quad6": _cell("quadratic quad", _QUAD, ((0, 1), (2, 3))),
    "quad8": _cell("quadratic quad", _QUAD, _RING_4),
    "quad9": _cell("quadratic quad", _QUAD, _RING_4, (0,)),
    "tetra": _cell("tetrahedron", _TETRA),
    "tetra10": _cell("quadratic tetrahedron", _TETRA, _TETRA_EDGES),
    "pyramid": _cell("pyramid", _PYRAMID),
    "pyramid13": _cell("quadratic pyramid", _PYRAMID, _PYRAMID_EDGES),
    "pyramid14": _cell("quadratic pyramid", _PYRAMID, _PYRAMID_EDGES, (0,)),
    "pyramid19": _cell("quadratic pyramid", _PYRAMID, _PYRAMID_EDGES, (0, 1, 2, 3, 4), 1),
    "wedge": _cell("wedge", _WEDGE),
    "wedge12": _cell("quadratic wedge", _WEDGE, _WEDGE_RINGS),
    "wedge15": _cell("quadratic wedge", _WEDGE, _WEDGE_EDGES),
    "wedge18": _cell("quadratic wedge", _WEDGE, _WEDGE_EDGES, (2, 3, 4)),
    "hexahedron": _cell("hexahedron", _HEXAHEDRON),
    "hexahedron20": _cell("quadratic hexahedron", _HEXAHEDRON, _HEXAHEDRON_EDGES),
    "hexahedron24": _cell("quadratic hexahedron", _HEXAHEDRON, _HEXAHEDRON_EDGES, (0, 1, 2, 3)),
    "hexahedron27": _cell(
        "quadratic hexahedron", _HEXAHEDRON, _HEXAHEDRON_EDGES, (0, 1, 2, 3, 4, 5), 1
    ),
    "penta_prism": _cell("pentagonal prism", _prism(5)),
    "hexa_prism": _cell("hexagonal prism", _prism(6)),
}
