"""Truth about the first contact of small meshes under linear and angular velocity.

Features are proven apart over pieces of time that are cut in half until only neighbourhoods of
their roots are left (doubles, many at once); these are then closed in on from before in wide
numbers, and contact is proven by the exact test of triangles at rest. Translation alone is exact.
Shares nothing with the kernels.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import mpmath
import numpy as np
from oracles.exact import plain
from oracles.mesh import mesh_first_contact, mesh_pairs, posed
from oracles.rigid import rigid_points
from oracles.screw_bounds import DOUBLE, WIDE, WIDE_DIGITS, Arithmetic, Couple, rotor
from oracles.screw_features import feature_pairs
from oracles.screw_search import Search
from oracles.still import triangles_intersect

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

Status = Literal["separated", "contact", "overlap_at_start", "undecided"]


@dataclass(frozen=True, eq=False)
class Mover:
    """A mesh with its pose at 0 and its motion, in the contract's terms."""

    vertices: Any
    faces: Any
    rotation: Any = field(default_factory=lambda: np.eye(3))
    translation: Any = (0.0, 0.0, 0.0)
    velocity: Any = (0.0, 0.0, 0.0)
    spin: Any = (0.0, 0.0, 0.0)
    pivot: Any = (0.0, 0.0, 0.0)

    @cached_property
    def start(self) -> NDArray[np.float64]:
        """The posed vertices, with the contract's rounding."""
        return posed(self.vertices, self.rotation, self.translation)

    def at(self, time: Any, vertices: Iterable[int] | None = None) -> list[tuple[Fraction, ...]]:
        """Return vertices, by default all, at a time, to 50 digits."""
        points = self.start if vertices is None else self.start[list(vertices)]
        return list(rigid_points(points, self.velocity, self.spin, self.pivot, time))

    @property
    def turns(self) -> bool:
        return any(plain(self.spin))


class Truth(NamedTuple):
    """The first contact lies in [`lo`, `hi`]; `undecided`: no contact before `lo`, no more said.

    The bounds are rationals: nothing touches before `lo`, triangles do at `hi`.
    """

    status: Status
    lo: Fraction | None = None
    hi: Fraction | None = None


def screw_first_contact(a: Mover, b: Mover, duration: float) -> Truth:
    """Return the first contact of two moving meshes in the closed interval [0, duration]."""
    if mesh_pairs(a.start, a.faces, b.start, b.faces):
        return Truth("overlap_at_start", Fraction(0), Fraction(0))
    if duration == 0:
        return Truth("separated")
    if not (a.turns or b.turns):
        found = mesh_first_contact(
            (a.start, a.faces), (b.start, b.faces), a.velocity, b.velocity, duration
        )
        return Truth("separated") if found is None else Truth("contact", found[0], found[0])
    return _turning(a, b, duration)


def _turning(a: Mover, b: Mover, duration: float) -> Truth:
    def touching(owners: tuple[tuple[int, ...], tuple[int, ...]], time: Any) -> bool:
        return triangles_touch(a, b, owners, time * Fraction(duration))

    with mpmath.workdps(WIDE_DIGITS):
        couples = [scaled(a, b, duration, kind) for kind in (DOUBLE, WIDE)]
        features = feature_pairs(a.faces, b.faces)
        lo, hi = Search(*couples, features, touching).run()
    if lo is None:
        return Truth("separated")
    lo *= Fraction(duration)
    if hi is None:
        return Truth("undecided", lo)
    return Truth("contact", lo, hi * Fraction(duration))


def triangles_touch(
    a: Mover, b: Mover, owners: tuple[tuple[int, ...], tuple[int, ...]], time: Fraction
) -> bool:
    """Return whether any of the named triangles of A meets one of B's at a time."""
    corners = []
    for body, rows in zip((a, b), owners, strict=True):
        faces = np.asarray(body.faces)[list(rows)]
        points = body.at(time, faces.ravel())
        corners.append([points[i : i + 3] for i in range(0, len(points), 3)])
    return any(triangles_intersect(p, q) for p, q in product(*corners))


def scaled(a: Mover, b: Mover, duration: float, kind: Arithmetic) -> Couple:
    """Return the bodies seen from A's pivot, with the duration and the size brought to about 1."""
    pivots = [[Fraction(x) for x in plain(body.pivot)] for body in (a, b)]
    arms = [
        [[Fraction(x) - k for x, k in zip(row, pivot, strict=True)] for row in body.start.tolist()]
        for body, pivot in zip((a, b), pivots, strict=True)
    ]
    clock = Fraction(duration)
    offset = [q - p for p, q in zip(*pivots, strict=True)]
    velocities = [[Fraction(x) * clock for x in plain(body.velocity)] for body in (a, b)]
    drift = [q - p for p, q in zip(*velocities, strict=True)]
    largest = max(abs(x) for side in arms for row in side for x in row)
    unit = Fraction(2) ** int(np.floor(np.log2(float(largest or 1))))
    spins = [[Fraction(x) * clock for x in plain(body.spin)] for body in (a, b)]
    still = [Fraction(0)] * 3
    rotors = [
        rotor([[x / unit for x in row] for row in side], spin, *where, kind)
        for side, spin, where in zip(
            arms,
            spins,
            ((still, still), ([x / unit for x in offset], [x / unit for x in drift])),
            strict=True,
        )
    ]
    return Couple(rotors[0], rotors[1], kind)
