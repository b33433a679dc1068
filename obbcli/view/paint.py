"""A picture as pixels: hidden surfaces, light, outlines, ghosts, and marks on top."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.view.camera import camera_for
from obbcli.view.picture import Lines, Surface
from obbcli.view.raster import (
    DEEPEST,
    EMPTY,
    NOTHING,
    Fragments,
    Nearest,
    segment_fragments,
    triangle_fragments,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from obbcli.view.camera import Camera
    from obbcli.view.picture import Picture

# Each pixel is the mean of so many by so many.
SAMPLES = 2
_BACKGROUND = (1.0, 1.0, 1.0)
# To the lamps, in the camera's axes (right, down, to the eye), and how bright they are.
_LAMPS = (((-0.45, -0.65, 0.62), 0.62), ((0.75, 0.15, 0.65), 0.20), ((0.0, 0.0, 1.0), 0.20))
_AMBIENT = 0.20
# Of what is seen through: light from all sides, so that its color stays what it is.
_GLOW = 0.6
# Faces that meet at a sharper angle have an outline between them: cos 25 degrees.
_CREASE = 0.906
# Where the surface behind is farther by so many pixels of the picture, there is an outline too.
_STEP = 6.0
_OUTLINE = 0.42
_GHOST_OUTLINE = 0.55
_HIDDEN_MARK = 0.7
_HALO = 2
_LINE = 2
_MARK_LINE = 4
# Segments lie on the faces they bound; so much nearer, in pixels of the picture, they are seen.
_LIFT = 0.75


class Drawn(NamedTuple):
    """A part in pixels.

    Attributes:
        part: what it is.
        corners: (F, 3, 3) or, of lines, (S, 2, 3): x, y and depth, in steps.
        colors: (F, 3) as lit, 0 to 1.
        normals: (F, 3) unit, towards the eye; 0 of lines.
    """

    part: Surface | Lines
    corners: NDArray[np.float64]
    colors: NDArray[np.float32]
    normals: NDArray[np.float32]

    def fragments(self, size: tuple[int, int]) -> Iterator[Fragments]:
        """Yield what the part covers."""
        if isinstance(self.part, Surface):
            yield from triangle_fragments(self.corners, size)
        elif len(self.corners):
            width = _MARK_LINE if self.part.is_mark else _LINE
            yield from segment_fragments(self.corners, size, width)


def paint(picture: Picture, size: tuple[int, int], zoom: float = 1.0) -> NDArray[np.uint8]:
    """Return a picture as sRGB pixels, (height, width, 3).

    Args:
        picture: what to show.
        size: width and height.
        zoom: how many times closer than all of it; about its focus.
    """
    fine = (size[0] * SAMPLES, size[1] * SAMPLES)
    camera = camera_for(picture, fine, zoom)
    drawn = [_drawn(part, camera) for part in picture.parts]
    step = _in_steps(drawn)
    nearest = Nearest(fine)
    solid = [d for d in drawn if not d.part.is_mark and _opacity(d.part) == 1.0]
    image = _show_solid(solid, nearest, fine, step)
    seen = [d for d in drawn if not d.part.is_mark and _opacity(d.part) < 1.0]
    _blend(image, [_translucent(d, nearest, fine, step) for d in seen])
    marks = [d for d in drawn if d.part.is_mark]
    if marks:
        _show_marks(image, marks, nearest, fine)
    coarse = image.reshape(size[1], SAMPLES, size[0], SAMPLES, 3).mean(axis=(1, 3))
    pixels: NDArray[np.uint8] = np.clip(np.rint(255.0 * coarse), 0, 255).astype(np.uint8)
    return pixels


def _in_steps(drawn: Sequence[Drawn]) -> float:
    """Turn depths into steps, 1 to `DEEPEST` over all that is drawn; return how many a pixel."""
    depths = [one.corners[..., 2] for one in drawn if one.corners.size]
    far, near = min(float(d.min()) for d in depths), max(float(d.max()) for d in depths)
    step = (DEEPEST - 1.0) / max(near - far, 1.0)
    for d in depths:
        np.clip((d - far) * step + 1.0, 1.0, DEEPEST, out=d)
    return step


def _opacity(part: Surface | Lines) -> float:
    return part.opacity if isinstance(part, Surface) else 1.0


def _drawn(part: Surface | Lines, camera: Camera) -> Drawn:
    """Return a part in pixels, lit."""
    points = camera.project(part.world())
    base = np.array(part.color, np.float32) / np.float32(255.0)
    if isinstance(part, Lines):
        corners = points[part.segments]
        corners[..., 2] += _LIFT * SAMPLES
        flat = np.zeros((len(corners), 3), np.float32)
        return Drawn(part, corners, flat + base, flat)
    corners = points[part.triangles]
    if part.is_layered:
        corners = corners[_turns(corners) < 0]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    # Light falls on both sides, since meshes in the wild are turned anyhow.
    normals *= np.where(normals[:, 2:] < 0, -1.0, 1.0)
    light = np.full(len(normals), _AMBIENT)
    for lamp, brightness in _LAMPS:
        toward = np.array(lamp) / np.linalg.norm(lamp)
        light += brightness * np.maximum(normals @ toward, 0.0)
    if part.is_layered:
        light = _GLOW + (1.0 - _GLOW) * light
    colors = np.clip(light[:, None].astype(np.float32) * base, 0.0, 1.0)
    return Drawn(part, corners, colors, normals.astype(np.float32))


def _turns(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return twice the areas of triangles as seen; negative where they face the eye: y is down."""
    u, v = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    areas: NDArray[np.float64] = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return areas


def _show_solid(
    solid: Sequence[Drawn], nearest: Nearest, size: tuple[int, int], step: float
) -> NDArray[np.float32]:
    """Return the image of what hides, with its outlines; `nearest` keeps how near it is."""
    colors, normals, owners = _collect(solid, nearest, size)
    ids = nearest.ids
    image = colors[ids]
    edges = _outlines(ids, nearest.depths / step, normals, owners)
    image[edges] *= np.float32(_OUTLINE)
    return image


def _collect(
    drawn: Sequence[Drawn], nearest: Nearest, size: tuple[int, int]
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]]:
    """Draw parts; return color, normal and part by id, the first of which is the background."""
    colors = [np.array([_BACKGROUND], np.float32)]
    normals = [np.zeros((1, 3), np.float32)]
    owners = [np.zeros(1, np.int32)]
    count = 1
    for number, one in enumerate(drawn, 1):
        for fragments in one.fragments(size):
            nearest.add(fragments, fragments.owners + count)
        count += len(one.colors)
        colors.append(one.colors)
        normals.append(one.normals)
        label = number if isinstance(one.part, Surface) else -1
        owners.append(np.full(len(one.colors), label, np.int32))
    return np.concatenate(colors), np.concatenate(normals), np.concatenate(owners)


def _outlines(
    ids: NDArray[np.int64],
    depths: NDArray[np.float64],
    normals: NDArray[np.float32],
    owners: NDArray[np.int32],
) -> NDArray[np.bool_]:
    """Return the pixels where what is seen ends, or bends sharply: those on the nearer side."""
    edges = np.zeros(ids.shape, bool)
    owner = owners[ids]
    for axis in (0, 1):
        here = tuple(slice(None, -1) if k == axis else slice(None) for k in (0, 1))
        there = tuple(slice(1, None) if k == axis else slice(None) for k in (0, 1))
        differs = ids[here] != ids[there]
        a, b = ids[here][differs], ids[there][differs]
        bends = np.einsum("ij,ij->i", normals[a], normals[b]) < _CREASE
        steps = np.abs(depths[here][differs] - depths[there][differs]) > _STEP * SAMPLES
        parts = owner[here][differs] != owner[there][differs]
        # Lines are outlines themselves.
        is_edge = (bends | steps | parts) & (owners[a] >= 0) & (owners[b] >= 0)
        nearer = depths[here][differs] >= depths[there][differs]
        for part, side in ((here, nearer), (there, ~nearer)):
            marked = np.zeros(differs.shape, bool)
            marked[differs] = is_edge & side
            edges[part] |= marked
    edges &= ids != EMPTY
    return edges


class Layer(NamedTuple):
    """Translucent fragments: pixels, depths, colors and opacities."""

    pixels: NDArray[np.int64]
    depths: NDArray[np.float64]
    colors: NDArray[np.float32]
    opacities: NDArray[np.float32]


def _translucent(one: Drawn, nearest: Nearest, size: tuple[int, int], step: float) -> Layer:
    """Return what of a part is seen before all that hides."""
    assert isinstance(one.part, Surface)
    if not one.part.is_layered:
        return _ghost(one, nearest, size, step)
    kept = []
    for fragments in one.fragments(size):
        kept.append(fragments.where(nearest.is_before(fragments)))
    if not kept:
        kept = [NOTHING]
    pixels, depths, owners = (np.concatenate(some) for some in zip(*kept, strict=True))
    opacities = np.full(len(pixels), one.part.opacity, np.float32)
    return Layer(pixels, depths, one.colors[owners], opacities)


def _ghost(one: Drawn, nearest: Nearest, size: tuple[int, int], step: float) -> Layer:
    """Return the nearest of a part's own faces, its outlines less faint than the rest."""
    own = Nearest(size)
    colors, normals, owners = _collect([one], own, size)
    ids, depths = own.ids, own.depths
    edges = _outlines(ids, depths / step, normals, owners).ravel()
    pixels = np.flatnonzero(ids)
    layer = Fragments(pixels, depths.ravel()[pixels], ids.ravel()[pixels])
    keep = nearest.is_before(layer)
    pixels = pixels[keep]
    opacity = np.float32(_opacity(one.part))
    opacities = np.where(edges[pixels], np.float32(_GHOST_OUTLINE), opacity)
    shown = colors[layer.owners[keep]]
    shown[edges[pixels]] *= np.float32(0.75)
    return Layer(pixels, layer.depths[keep], shown, opacities.astype(np.float32))


def _blend(image: NDArray[np.float32], layers: Sequence[Layer]) -> None:
    """Lay translucent fragments over an image, in each pixel the farthest first."""
    if not layers:
        return
    pixels, depths, colors, opacities = (np.concatenate(x) for x in zip(*layers, strict=True))
    order = np.lexsort((depths, pixels))
    pixels, colors, opacities = pixels[order], colors[order], opacities[order, None]
    is_first = np.concatenate([[True], pixels[1:] != pixels[:-1]])[: len(pixels)]
    begins = np.flatnonzero(is_first)
    counts = np.diff([*begins.tolist(), len(pixels)])
    flat = image.reshape(-1, 3)
    rank = 0
    while len(begins):
        here = begins + rank
        where = pixels[here]
        flat[where] += opacities[here] * (colors[here] - flat[where])
        rank += 1
        keep = counts > rank
        begins, counts = begins[keep], counts[keep]


def _show_marks(
    image: NDArray[np.float32], marks: Sequence[Drawn], nearest: Nearest, size: tuple[int, int]
) -> None:
    """Draw marks with a bright rim; fainter where something stands before them."""
    own = Nearest(size)
    colors, _, _ = _collect(marks, own, size)
    ids = own.ids
    is_mark = ids != EMPTY
    rim = _grown(is_mark, _HALO) & ~is_mark
    image[rim] += np.float32(0.8) * (1.0 - image[rim])
    pixels = np.flatnonzero(is_mark)
    layer = Fragments(pixels, own.depths.ravel()[pixels], ids.ravel()[pixels])
    opacity = np.where(nearest.is_before(layer), 1.0, _HIDDEN_MARK).astype(np.float32)[:, None]
    flat = image.reshape(-1, 3)
    flat[pixels] += opacity * (colors[layer.owners] - flat[pixels])


def _grown(mask: NDArray[np.bool_], by: int) -> NDArray[np.bool_]:
    """Return a mask with all that is so many pixels beside it."""
    grown: NDArray[np.bool_] = mask.copy()
    for axis in (0, 1):
        source = grown.copy()
        for step in range(1, by + 1):
            ahead = tuple(slice(step, None) if k == axis else slice(None) for k in (0, 1))
            behind = tuple(slice(None, -step) if k == axis else slice(None) for k in (0, 1))
            grown[ahead] |= source[behind]
            grown[behind] |= source[ahead]
    return grown
