"""Closed surfaces as solids: does a part of one body lie inside the other at t = 0?

Called by `Query` where `solid` is asked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli import kernels
from obbcli.answers.contact import Contact
from obbcli.answers.counts import Counts
from obbcli.answers.status import Status
from obbcli.errors import MeshError
from obbcli.mesh.topology import bad_seams

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from obbcli.answers.status import Inner
    from obbcli.mesh import Mesh
    from obbcli.motion.body import Body
    from obbcli.questions.pair_question import Trees
    from obbcli.tree.tree import ObbTree

# How the notes of scaled meshes begin.
_SCALED = "coordinates "


class Containment:
    """The question whether a part of one body lies inside the other, their surfaces apart at t = 0.

    Inside is where the surface winds about a point a number of times other than zero: whether all
    of it is turned outwards or inwards, and also where parts overlap, but not in a hollow whose
    surface is turned against the outer one. Exact for the posed vertices.

    One point of each connected part of either surface decides. A winding number changes only where
    a surface passes, so it is the same all over a part that does not touch the surface. For the
    same reason t = 0 is the only time to ask at: as long as moving surfaces do not touch, the
    winding number of one about a point of the other is a whole number that depends continuously on
    time. A body that gets inside another touches it first.

    Args:
        bodies: A and B as they are at t = 0.
        trees: the trees of A and B.
        at_start: whether their surfaces touch at t = 0; advanced where that is not known yet.

    Raises:
        MeshError: a mesh is not watertight; the message says where.
        TreeFileError: a tree file is damaged.
    """

    def __init__(
        self, bodies: tuple[Body, Body], trees: Trees, at_start: kernels.StaticQuery
    ) -> None:
        for name, tree in zip("AB", trees, strict=True):
            require_watertight(tree.mesh, body_name(name, tree))
        self._bodies = bodies
        self._trees = trees
        self._at_start = at_start
        self._done = Counts()
        self._inner: Inner = "a"
        self._points: NDArray[np.float64] | None = None
        self._query: kernels.ContainmentQuery | None = None
        self._contained: Inner | None = None

    @property
    def contained(self) -> Inner | None:
        """The body of which a part was found inside the other; A's parts are looked at first."""
        return self._contained

    def advance(self, pops: int) -> bool:
        """Go on for so many steps of each part; return whether the answer is complete."""
        if not self._at_start.advance(pops):
            return False
        while self._contained is None and not self._at_start.is_contact:
            if self._query is None:
                self._points, self._query = self._ask()
            if not self._query.advance(pops):
                return False
            if self._query.inside is not None:
                self._contained = self._inner
            elif self._inner == "b":
                break
            else:
                self._done, self._query, self._inner = self.counts, None, "b"
        return True

    @property
    def counts(self) -> Counts:
        """What the search has cost so far, but for the question about t = 0."""
        return self._done if self._query is None else self._done + Counts(*self._query.counts())

    @property
    def pops(self) -> int:
        """How many steps were taken so far."""
        return self._done.pops if self._query is None else self._done.pops + self._query.counts()[3]

    def answer(self) -> Contact:
        """Return the contact at t = 0 of a body inside the other: no triangles, but a point."""
        assert self._query is not None
        assert self._points is not None
        x, y, z = (self._points[self._query.inside] + 0.0).tolist()
        return Contact(
            status=Status.OVERLAP_AT_START,
            time=0.0,
            time_bounds=(0.0, 0.0),
            point=(x, y, z),
            contained=self._contained,
        )

    def _ask(self) -> tuple[NDArray[np.float64], kernels.ContainmentQuery]:
        """Return one posed point of each part of the inner body, and the question about them."""
        (a, b), (tree_a, tree_b) = self._bodies, self._trees
        inner, tree, outer, other = (
            (a, tree_a, b, tree_b) if self._inner == "a" else (b, tree_b, a, tree_a)
        )
        mesh = tree.mesh
        points = inner.pose.apply(mesh.vertices[mesh.triangles[mesh.part_rows, 0]])
        return points, kernels.ContainmentQuery(other.kernel, outer.pose.kernel, points)


def require_watertight(mesh: Mesh, where: str) -> None:
    """Refuse a mesh that is no solid.

    Raises:
        MeshError: it is not watertight; the message says where, and which welding closes it.
    """
    fault = why_open(mesh)
    if fault is not None:
        raise MeshError(where, fault, _remedy(mesh))


def why_open(mesh: Mesh) -> str | None:
    """Return what keeps a mesh from being a solid, and where; None of a solid."""
    if mesh.is_watertight:
        return None
    found = bad_seams(mesh.corner_ids)
    if found is None:
        return "is not watertight: all its triangles are collapsed to edges or points"
    count, seam = found
    ends = mesh.vertices[mesh.triangles[seam.triangle]]
    start, end = (tuple(ends[(seam.corner + k) % 3].tolist()) for k in (0, 1))
    edges = "1 edge does" if count == 1 else f"{count} edges do"
    return (
        f"is not watertight: {edges} not join two triangles turned alike, such as that from "
        f"{start} to {end} of triangle {seam.triangle}, {_why(seam.along, seam.against)}"
    )


def body_name(name: str, tree: ObbTree) -> str:
    """Return what errors call a body: A or B, and its file."""
    return f"{name} ({tree.source})" if tree.source else name


def _remedy(mesh: Mesh) -> str:
    from obbcli.mesh.closing import closing_distance

    distance = closing_distance(mesh)
    if distance is None:
        return "mend the mesh, or ask about surfaces, without solid"
    if any(note.startswith(_SCALED) or ": coordinates" in note for note in mesh.notes):
        welding = f"before it is scaled: vertices within {distance!r} as scaled"
    else:
        welding = f"with --weld {distance!r}, or Mesh.welded"
    return f"weld it {welding}, which closes it; or ask about surfaces, without solid"


def _why(along: int, against: int) -> str:
    if along + against == 1:
        return "which has no other triangle"
    if along + against == 2:
        return "whose other triangle is turned over"
    return f"which has {along + against} triangles"
