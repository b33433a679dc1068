"""What a picture is made of: surfaces and lines with a place and a color; no format yet."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from obbcli.motion.pose import Pose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Color: TypeAlias = tuple[int, int, int]

_AS_LOADED = Pose()


@dataclass(frozen=True, kw_only=True)
class Surface:
    """Triangles of one color, with a place.

    Attributes:
        name: what viewers call it.
        vertices: float64 (V, 3), mesh units.
        triangles: int (F, 3), rows of `vertices`.
        pose: where they are.
        color: sRGB, 0 to 255 each.
        opacity: 1 hides what is behind.
        is_layered: whether all faces that look at the eye are seen through each other, as those of
            many boxes, and not the nearest alone, as those of a ghost. Of translucent ones.
        is_mark: whether it shows through what is in front of it.
    """

    name: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.integer]
    color: Color
    pose: Pose = _AS_LOADED
    opacity: float = 1.0
    is_layered: bool = False
    is_mark: bool = False

    def world(self) -> NDArray[np.float64]:
        """Return the vertices where they are, (V, 3)."""
        return self.pose.apply(self.vertices)


@dataclass(frozen=True, kw_only=True)
class Lines:
    """Segments of one color.

    Attributes:
        name: what viewers call them.
        vertices: float64 (V, 3), world coordinates.
        segments: int (S, 2), rows of `vertices`.
        color: sRGB, 0 to 255 each.
        is_mark: as of surfaces.
    """

    name: str
    vertices: NDArray[np.float64]
    segments: NDArray[np.integer]
    color: Color
    is_mark: bool = False

    def world(self) -> NDArray[np.float64]:
        """Return the vertices where they are, (V, 3)."""
        return self.vertices


@dataclass(frozen=True, kw_only=True)
class Picture:
    """What is drawn.

    Attributes:
        title: one line, for those formats that have words.
        parts: surfaces and lines; marks last.
        focus: (3,) what a closer look is aimed at, world coordinates.
        direction: (3,) unit, from there to the eye.
    """

    title: str
    parts: Sequence[Surface | Lines]
    focus: NDArray[np.float64]
    direction: NDArray[np.float64] = field(default_factory=lambda: VIEWS[0])


def seen_from(picture: Picture, direction: Sequence[float]) -> Picture:
    """Return a picture seen from a direction, of any length but 0."""
    vector = np.array(direction)
    vector = vector / np.abs(vector).max()
    return replace(picture, direction=vector / np.linalg.norm(vector))


def bounds_of(parts: Sequence[Surface | Lines]) -> NDArray[np.float64]:
    """Return lower and upper corner of what is drawn, (2, 3), but for marks."""
    worlds = [part.world() for part in parts if not part.is_mark]
    low = np.min([world.min(axis=0) for world in worlds if len(world)], axis=0)
    high = np.max([world.max(axis=0) for world in worlds if len(world)], axis=0)
    return np.stack([low, high])


def _around() -> NDArray[np.float64]:
    """Return directions to look from, those that people expect first."""
    angles = np.radians([-60, -30, -90, 0, -120, 30, -150, 180, 60, 150, 90, 120])
    upper = np.stack([np.cos(angles), np.sin(angles), np.full(12, 0.55)], axis=1)
    lower = upper * (1.0, 1.0, -1.0)
    around = np.concatenate([upper, lower])
    unit: NDArray[np.float64] = around / np.linalg.norm(around, axis=1, keepdims=True)
    return unit


VIEWS: NDArray[np.float64] = _around()
