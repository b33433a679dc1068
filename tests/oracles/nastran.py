"""Coordinate systems of Nastran by their definition, in fifty digits.

A GRID's place is found by walking up the chain of systems; nothing is shared with the reader.
"""

from __future__ import annotations

from typing import NamedTuple

import mpmath as mp

DIGITS = 50


class System(NamedTuple):
    """A system by points of another: kind R, C or S, number of the other, A, B and C."""

    kind: str
    reference: int
    points: tuple


def basic(systems, number: int, place):
    """Return a place of a system in basic coordinates."""
    with mp.workdps(DIGITS):
        return _basic(systems, number, [mp.mpf(x) for x in place])


def _basic(systems, number, place):
    if number == 0:
        return mp.matrix(place)
    system = systems[number]
    a, b, c = (_basic(systems, system.reference, [mp.mpf(x) for x in p]) for p in system.points)
    z = (b - a) / mp.norm(b - a)
    # What is left of C - A without its part along z.
    toward = (c - a) - z * (z.T * (c - a))[0]
    x = toward / mp.norm(toward)
    y = mp.matrix([z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]])
    u, v, w = place
    if system.kind == "C":
        u, v = u * mp.cos(mp.radians(v)), u * mp.sin(mp.radians(v))
    elif system.kind == "S":
        r, theta, phi = u, mp.radians(v), mp.radians(w)
        u, v, w = (
            r * mp.sin(theta) * mp.cos(phi),
            r * mp.sin(theta) * mp.sin(phi),
            r * mp.cos(theta),
        )
    return a + x * u + y * v + z * w
