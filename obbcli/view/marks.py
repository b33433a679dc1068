"""Marks of a contact: a ball at its point and an arrow along its normal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.view.picture import Surface

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.view.picture import Color

_POINT = (224, 0, 52)
_NORMAL = (24, 24, 30)
# Shares of the picture's size.
_BALL = 0.0085
_SHAFT = 0.0032
_HEAD = 0.0095
_HEAD_LENGTH = 0.028
_LENGTH = 0.12
_AROUND = 24


def point_mark(point: NDArray[np.float64], size: float) -> Surface:
    """Return a ball around the point, in a picture of that size."""
    turns = np.linspace(0.0, np.pi, _AROUND // 2 + 1)
    profile = _BALL * size * np.stack([np.sin(turns), -np.cos(turns)], axis=1)
    return _mark("contact point", _POINT, point, profile, np.array((0.0, 0.0, 1.0)))


def normal_mark(point: NDArray[np.float64], normal: NDArray[np.float64], size: float) -> Surface:
    """Return an arrow from the point along the unit normal, in a picture of that size."""
    neck = _LENGTH - _HEAD_LENGTH
    outline = [(0.0, 0.0), (_SHAFT, 0.0), (_SHAFT, neck), (_HEAD, neck), (0.0, _LENGTH)]
    return _mark("contact normal", _NORMAL, point, size * np.array(outline), normal)


def _mark(
    name: str,
    color: Color,
    point: NDArray[np.float64],
    profile: NDArray[np.float64],
    axis: NDArray[np.float64],
) -> Surface:
    vertices, triangles = _turned(profile, axis)
    return Surface(
        name=name, vertices=vertices + point, triangles=triangles, color=color, is_mark=True
    )


def _turned(
    profile: NDArray[np.float64], axis: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the surface that a profile of (radius, height) makes around a unit axis."""
    other = np.eye(3)[int(np.argmin(np.abs(axis)))]
    side = np.cross(axis, other)
    side /= np.linalg.norm(side)
    angles = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    ring = np.cos(angles)[:, None] * side + np.sin(angles)[:, None] * np.cross(axis, side)
    radius, height = profile[:, 0, None, None], profile[:, 1, None, None]
    vertices = (radius * ring[None] + height * axis).reshape(-1, 3)
    here = np.arange(_AROUND)
    there = (here + 1) % _AROUND
    rows = (_AROUND * np.arange(len(profile) - 1))[:, None]
    a, b = rows + here, rows + there
    quads = np.stack([a, b, b + _AROUND, a, b + _AROUND, a + _AROUND], axis=-1)
    return vertices, quads.reshape(-1, 3)
