"""What a question cost: the five counters of a search, and with them trees and wall time."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping


class Counts(NamedTuple):
    """What every search counts, in the order in which the kernels tell it: `Counts(*q.counts())`.

    Two of them add up, and the difference of two is what was spent between.

    Attributes:
        box_tests: pairs of boxes tested.
        triangle_tests: pairs of triangles tested.
        exact_triangle_tests: those of them that exact arithmetic had to decide.
        pops: pairs taken from the queue or stack.
        image_tests: pairs of images tested, on the common screw of two bodies; 0 where boxes and
            steps were the way to the answer.

    Example:
        >>> Counts(5, 2, 0, 4) + Counts(1, 1, 1, 1) - Counts(pops=3)
        Counts(box_tests=6, triangle_tests=3, exact_triangle_tests=1, pops=2, image_tests=0)
    """

    box_tests: int = 0
    triangle_tests: int = 0
    exact_triangle_tests: int = 0
    pops: int = 0
    image_tests: int = 0

    def __add__(self, other: Counts) -> Counts:  # type: ignore[override]  # not joined, but added
        """Return what two searches cost together."""
        a, b, c, d, e = self
        p, q, r, s, t = other
        return Counts(a + p, b + q, c + r, d + s, e + t)

    def __sub__(self, other: Counts) -> Counts:
        """Return what this cost beyond the other."""
        a, b, c, d, e = self
        p, q, r, s, t = other
        return Counts(a - p, b - q, c - r, d - s, e - t)


class QueryStats(NamedTuple):
    """What a question cost.

    Attributes:
        box_tests: pairs of boxes tested, each counted once: the two around whole bodies at rest, of
            which spheres and face axes are tested first, as well.
        triangle_tests: pairs of triangles tested.
        exact_triangle_tests: those of them that exact arithmetic had to decide.
        pops: pairs taken from the queue or stack.
        image_tests: pairs of images tested, on the common screw of two bodies; 0 where boxes and
            steps were the way to the answer.
        nodes_built_a: nodes of A's tree that exist after the question; a lazy tree builds only what
            is asked for.
        nodes_built_b: the same for B.
        nodes_possible_a: nodes that A's tree can have.
        nodes_possible_b: the same for B.
        seconds: s of wall time by stage. Where `collide` or `first_contact` is asked about two
            bodies whose trees are all there, and nothing else, the clock starts after the first 32
            pops, some microseconds: two looks at it would take a third of a short question. One
            that ends before tells 0.
    """

    box_tests: int
    triangle_tests: int
    exact_triangle_tests: int
    pops: int
    image_tests: int
    nodes_built_a: int
    nodes_built_b: int
    nodes_possible_a: int
    nodes_possible_b: int
    seconds: Mapping[str, float]

    @property
    def counts(self) -> Counts:
        """Return what the search itself counted."""
        return Counts(*self[:5])
