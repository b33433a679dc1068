"""From the world to the pixels of a picture, without perspective: parallel lines stay so."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.view.picture import Picture

# Share of the picture that stays free on each side.
_MARGIN = 0.04


class Camera(NamedTuple):
    """How points become pixels: x to the right, y down, depth towards the eye.

    Attributes:
        exponent: points are taken times 2^-exponent first, so that no unit is too large or small.
        center: (3,) what is in the middle, scaled so.
        axes: (3, 3), rows: to the right, down, to the eye.
        scale: pixels a scaled length.
        size: width and height in pixels.
    """

    exponent: int
    center: NDArray[np.float64]
    axes: NDArray[np.float64]
    scale: float
    size: tuple[int, int]

    def project(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return x, y and depth of points, all in pixels, (N, 3)."""
        seen = (np.ldexp(points, -self.exponent) - self.center) @ self.axes.T * self.scale
        seen[:, 0] += self.size[0] / 2
        seen[:, 1] += self.size[1] / 2
        projected: NDArray[np.float64] = seen
        return projected


def axes_of(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the camera's axes for a unit direction to the eye: z is up where it can be."""
    up = np.array((0.0, 0.0, 1.0) if abs(direction[2]) < 0.999 else (0.0, 1.0, 0.0))
    right = np.cross(up, direction)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(right, direction), direction])


def camera_for(picture: Picture, size: tuple[int, int], zoom: float = 1.0) -> Camera:
    """Return the camera that sees all of a picture, or its focus so many times closer."""
    worlds = [part.world() for part in picture.parts if not part.is_mark and len(part.vertices)]
    exponent = math.frexp(max(float(np.abs(world).max()) for world in worlds))[1]
    axes = axes_of(picture.direction)
    middle = np.ldexp(picture.focus, -exponent)
    seen = [(np.ldexp(world, -exponent) - middle) @ axes.T for world in worlds]
    low = np.min([one.min(axis=0) for one in seen], axis=0)
    high = np.max([one.max(axis=0) for one in seen], axis=0)
    extent = np.maximum(high - low, 0.0)[:2]
    free = (1.0 - 2.0 * _MARGIN) * np.array(size)
    with np.errstate(divide="ignore"):
        scale = float(np.min(free / extent))
    if not math.isfinite(scale):  # a point, or a line towards the eye
        scale = 1.0
    if zoom == 1.0:
        middle = middle + (low[:2] / 2 + high[:2] / 2) @ axes[:2]
    return Camera(exponent, middle, axes, scale * zoom, size)
