"""How far apart two bodies are, and where, frozen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from obbcli.answers.contact import Vector
    from obbcli.answers.counts import QueryStats


@dataclass(frozen=True, init=False)
class Distance:
    """How far apart two bodies are at rest.

    Attributes:
        distance: mesh units; the upper one of `bounds`. 0 where the surfaces touch, and only there.
        bounds: mesh units; (lo, hi), both proven. A limit that ended the search leaves them wide.
        point_a: where on A hi was measured, world coordinates, rounded to double. Of bodies that
            touch a common point.
        point_b: where on B.
        triangle_a: row of A's mesh file that `point_a` lies in.
        triangle_b: row of B's mesh file that `point_b` lies in.
        stats: what the question cost.
        part_a: path of the part of A that `triangle_a` is of, where `FILE#PATTERN` selected parts.
        part_b: path of the part of B that `triangle_b` is of, likewise.
    """

    distance: float
    bounds: tuple[float, float]
    point_a: Vector
    point_b: Vector
    triangle_a: int
    triangle_b: int
    stats: QueryStats
    part_a: str | None = None
    part_b: str | None = None

    def __init__(
        self,
        *,
        distance: float,
        bounds: tuple[float, float],
        point_a: Vector,
        point_b: Vector,
        triangle_a: int,
        triangle_b: int,
        stats: QueryStats,
        part_a: str | None = None,
        part_b: str | None = None,
    ) -> None:
        # The fields are set past the frozen dataclass, as in `Collision`.
        fields = vars(self)
        fields["distance"] = distance
        fields["bounds"] = bounds
        fields["point_a"] = point_a
        fields["point_b"] = point_b
        fields["triangle_a"] = triangle_a
        fields["triangle_b"] = triangle_b
        fields["stats"] = stats
        fields["part_a"] = part_a
        fields["part_b"] = part_b
