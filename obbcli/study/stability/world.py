"""Two posed bodies as plain arrays in world coordinates, so that extremes can change each number.

Poses are applied here, with the roundings of the queries themselves: the questions stay the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.errors import MotionError
from obbcli.mesh import Mesh
from obbcli.motion.body import Body, pivot_of
from obbcli.motion.motion import Motion
from obbcli.tree.options import BuildOptions
from obbcli.tree.tree import ObbTree

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.accuracy import Accuracy
    from obbcli.questions.pair_question import PairQuestion

    Floats = NDArray[np.float64]

# Bounds below are evaluated in doubles, with far fewer roundings than this allows for.
SLACK = 1.0 + 1e-6
UNIT = 2.0**-53


class Side(NamedTuple):
    """One body in world coordinates at t = 0.

    Attributes:
        vertices: (V, 3).
        triangles: (F, 3).
        velocity: V, (3,).
        spin: W, (3,).
        pivot: K, (3,).
        options: how its tree is built.
    """

    vertices: Floats
    triangles: NDArray[np.int32]
    velocity: Floats
    spin: Floats
    pivot: Floats
    options: BuildOptions

    @property
    def is_turning(self) -> bool:
        """Whether there is an angular velocity."""
        return bool(self.spin.any())

    @property
    def reach(self) -> float:
        """The largest distance of a vertex from the pivot."""
        return longest(self.vertices - self.pivot)

    def motion(self) -> Motion:
        """Return the motion about the pivot."""
        return Motion(self.velocity, self.spin, self.pivot)

    def off_by(
        self,
        duration: float,
        *,
        points: float = 0.0,
        pivot: float = 0.0,
        velocity: float = 0.0,
        spin: float = 0.0,
    ) -> float:
        """Return a bound on how far any point is from where it was, at any time of the duration.

        `x(t) = K + t V + R(t W) (x - K)`, so that a changed K counts twice, and W by the arc.

        Args:
            duration: s.
            points: how far vertices were moved.
            pivot: how far K was.
            velocity: by how much V changed.
            spin: by how much W did.
        """
        moved = points + duration * velocity
        if self.is_turning:
            moved += 2.0 * pivot + (self.reach + points + pivot) * duration * spin
        return moved * SLACK


class Pair(NamedTuple):
    """The question: two bodies, how long, how accurately."""

    a: Side
    b: Side
    duration: float
    accuracy: Accuracy

    @property
    def is_turning(self) -> bool:
        """Whether either body turns."""
        return self.duration > 0 and (self.a.is_turning or self.b.is_turning)

    @property
    def is_exact(self) -> bool:
        """Whether the answer's bits follow from the geometry alone: no rotation, no tolerance."""
        asked = self.accuracy
        is_whole = asked.max_depth_a is None and asked.max_depth_b is None
        is_bare = asked.clearance == 0 and asked.distance_tolerance is None
        return is_whole and is_bare and asked.leaves == "triangles" and not self.is_turning

    @property
    def sides(self) -> tuple[Side, Side]:
        """A and B."""
        return self.a, self.b

    @property
    def size(self) -> float:
        """The larger diagonal of the two boxes."""
        return max(longest(np.ptp(side.vertices, axis=0)[None]) for side in self.sides)

    @property
    def largest(self) -> float:
        """A bound on the coordinates within the duration; infinite beyond the doubles."""
        with np.errstate(over="ignore"):
            return float(
                max(
                    np.abs(side.vertices).max()
                    + np.abs(side.pivot).max() * side.is_turning
                    + np.abs(side.velocity).max() * self.duration
                    for side in self.sides
                )
            )


def longest(rows: Floats) -> float:
    """Return the largest Euclidean length of rows, without overflow or underflow."""
    scale = float(np.abs(rows).max(initial=0.0))
    if scale == 0 or not np.isfinite(scale):
        return scale
    return float(np.sqrt(np.square(rows / scale).sum(axis=1)).max()) * scale


def two_sum(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Return rounded sums and their errors, which are exact (Knuth's two-sum)."""
    with np.errstate(over="ignore", invalid="ignore"):
        total = first + second
        back = total - first
        return total, (first - (total - back)) + (second - back)


def pair_of(asked: PairQuestion) -> Pair:
    """Return the question about two bodies in world coordinates.

    Raises:
        MotionError: the method is sampled, or a body moves through poses.
        ObbError: a shape cannot be read or is refused.
    """
    if asked.accuracy.method == "sampled":
        raise MotionError("method", "is sampled, which proves nothing", "ask for certified answers")
    for name, body in zip("ab", asked.bodies, strict=True):
        if body.motion.steady is None:
            fault = "moves through poses, which extremes are not defined for"
            raise MotionError(f"motion of {name}", fault, "give a velocity")
    first, second = map(_side, asked.bodies, asked.trees)
    return Pair(first, second, asked.duration, asked.accuracy)


def _side(body: Body, tree: ObbTree) -> Side:
    mesh, motion = tree.mesh, body.motion
    options = BuildOptions(tree.fit, tree.split, tree.leaf_size, tree.max_depth)
    return Side(
        body.pose.apply(mesh.vertices),
        mesh.triangles,
        motion.linear_velocity,
        motion.angular_velocity,
        pivot_of(body, tree),
        options,
    )


class Trees:
    """Trees of sides, kept while the arrays they were built from are in use."""

    def __init__(self) -> None:
        self._kept: list[tuple[Side, ObbTree]] = []

    def bodies(self, pair: Pair) -> tuple[Body, Body]:
        """Return a pair's bodies.

        Raises:
            ObbError: coordinates are refused.
        """
        a, b = (Body(self._tree(side), motion=side.motion()) for side in pair.sides)
        return a, b

    def _tree(self, side: Side) -> ObbTree:
        for kept, tree in self._kept:
            if kept.vertices is side.vertices and kept.triangles is side.triangles:
                return tree
        mesh = Mesh(side.vertices, side.triangles)
        tree = ObbTree.build(mesh, **side.options._asdict())
        # The question itself and the last changes: most extremes change one of the two.
        self._kept = [*self._kept[:2], *self._kept[2:][-2:], (side, tree)]
        return tree
