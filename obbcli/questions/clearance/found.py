"""What searches for the least clearance have found so far: a bracket and where it is attained."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from obbcli.answers.contact import Vector
    from obbcli.answers.counts import Counts

Span = tuple[float, float]


class Place(NamedTuple):
    """When and where a distance was measured.

    Attributes:
        time: s.
        point_a: on A, world coordinates.
        point_b: on B.
        triangle_a: row of A's mesh file.
        triangle_b: row of B's mesh file.
    """

    time: float
    point_a: Vector
    point_b: Vector
    triangle_a: int
    triangle_b: int


class LeastSearch(Protocol):
    """A search for the least distance over a motion, which can be advanced."""

    @property
    def low(self) -> float:
        """The bodies are never nearer: proven. Mesh units."""

    @property
    def high(self) -> float:
        """At `place.time` they are no further apart, mesh units; infinite while unknown."""

    @property
    def place(self) -> Place | None:
        """Where `high` was measured."""

    @property
    def is_contact(self) -> bool:
        """Whether triangles are proven to intersect at some time."""

    @property
    def counts(self) -> Counts:
        """What it has cost so far."""

    def step(self, pops: int) -> bool:
        """Take at most so many pairs from the queue; return whether the search is over."""

    def when(self) -> list[Span]:
        """Return stretches of time, s: at all others the distance is proven to exceed `high`."""


def joined(spans: list[Span]) -> list[Span]:
    """Return stretches of time in order, joined where they meet."""
    result: list[Span] = []
    for low, high in sorted(spans):
        if result and low <= result[-1][1]:
            result[-1] = (result[-1][0], max(result[-1][1], high))
        else:
            result.append((low, high))
    return result


def share_of(spans: list[Span], duration: float) -> float:
    """Return the part of the duration that stretches of time take; 1 where it is 0."""
    return min(math.fsum(high - low for low, high in spans) / duration, 1.0) if duration else 1.0
