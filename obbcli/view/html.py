"""Pictures as one HTML file that turns under the mouse and opens offline.

trimesh's own page holds the viewer, three.js, as a whole.
"""

from __future__ import annotations

import math
from dataclasses import replace
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from obbcli.motion.pose import Pose
from obbcli.view.camera import axes_of
from obbcli.view.gltf import scene_of
from obbcli.view.picture import Lines, Picture, Surface, bounds_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

# The page takes y for up.
_Y_UP = np.array([(1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)])
_FIELD_OF_VIEW = 35.0
_NEAR, _FAR = 0.01, 100.0
_STYLE = (
    "position:fixed;left:0;top:0;margin:14px;font:14px/1.5 system-ui,sans-serif;color:#222;"
    "pointer-events:none;white-space:pre-line"
)


def html_page(picture: Picture, legend: Sequence[str]) -> bytes:
    """Return a picture as an HTML file that needs no other.

    Args:
        picture: what to show.
        legend: lines of text above it.
    """
    from trimesh.viewer.notebook import scene_to_html

    centered = _centered(picture)
    scene = scene_of(centered, is_linear=False)
    distance = 0.95 / math.sin(math.radians(_FIELD_OF_VIEW) / 2)
    scene.camera.fov = (_FIELD_OF_VIEW, _FIELD_OF_VIEW)
    scene.camera.z_near, scene.camera.z_far = _NEAR, _FAR
    scene.camera_transform = _looking(picture.direction, distance)
    page = scene_to_html(scene)
    words = "\n".join(escape(line) for line in legend)
    head, _, rest = page.partition("<title>")
    rest = f"{escape(picture.title)}</title>" + rest.partition("</title>")[2]
    body, _, end = rest.rpartition("</body>")
    whole = f'{head}<title>{body}<div style="{_STYLE}">{words}</div></body>{end}'
    return whole.encode("utf-8", errors="backslashreplace")


def _centered(picture: Picture) -> Picture:
    """Return a picture with y up and within a ball of radius 1: whatever its units, floats do."""
    low, high = bounds_of(picture.parts)
    exponent = math.frexp(max(float(np.abs(low).max()), float(np.abs(high).max())))[1]
    low, high = np.ldexp(low, -exponent), np.ldexp(high, -exponent)
    middle, radius = (low + high) / 2, math.hypot(*(high - low).tolist()) / 2

    def moved(points: NDArray[np.float64]) -> NDArray[np.float64]:
        inside = (np.ldexp(points, -exponent) - middle) / (radius or 1.0)
        turned: NDArray[np.float64] = inside @ _Y_UP.T
        return turned

    parts: list[Surface | Lines] = []
    for part in picture.parts:
        if isinstance(part, Lines):
            parts.append(replace(part, vertices=moved(part.vertices)))
            continue
        # Of one body the same numbers, wherever it is: the file holds them once.
        own = part.vertices.min(axis=0) / 2 + part.vertices.max(axis=0) / 2
        local = np.ldexp(part.vertices - own, -exponent) / (radius or 1.0)
        place = moved(part.pose.apply(own[None]))[0]
        pose = Pose.carried(_Y_UP @ part.pose.rotation, place)
        parts.append(replace(part, vertices=local, pose=pose))
    return replace(picture, parts=parts)


def _looking(direction: NDArray[np.float64], distance: float) -> NDArray[np.float64]:
    """Return the placement of a camera that looks at the origin, (4, 4); it looks along -z."""
    right, down, back = axes_of(direction) @ _Y_UP.T
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([right, -down, back], axis=1)
    matrix[:3, 3] = distance * back
    return matrix
