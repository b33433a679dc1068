"""Pictures as scenes of triangles and lines that turn in a viewer: GLB files, which trimesh writes.

Numbers of such a file are float32; its bodies keep their own coordinates, and where they are stands
beside them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from obbcli.errors import ObbError
from obbcli.view.picture import Lines, bounds_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.motion.pose import Pose
    from obbcli.view.picture import Picture, Surface

# Beyond, float32 ends.
_LARGEST, _SMALLEST = 2.0**120, 2.0**-90
# A picture is at least this share of its largest coordinate wide: 1,024 steps of float32.
_LEAST_SHARE = 2.0**-14
_DIM = 0.8


def glb_bytes(picture: Picture) -> bytes:
    """Return a picture as a GLB file, in mesh units.

    Raises:
        ObbError: float32 cannot hold its coordinates, or is too coarse for them.
    """
    largest = max(float(np.abs(part.world()).max()) for part in picture.parts)
    largest = max(largest, *(float(np.abs(part.vertices).max()) for part in picture.parts))
    if not _SMALLEST <= largest <= _LARGEST:
        fault = f"holds numbers as float32, and the largest coordinate is {largest:g}"
        raise ObbError("a GLB file", fault, "choose other units, or draw a .png or .html")
    low, high = bounds_of(picture.parts)
    width = float((high - low).max())
    if width < _LEAST_SHARE * largest:
        fault = f"holds numbers as float32, too coarse at {largest:g} for what is {width:g} wide"
        raise ObbError("a GLB file", fault, "shift it to the origin, or draw a .png or .html")
    data: bytes = scene_of(picture).export(file_type="glb", include_normals=False)
    return data


def scene_of(picture: Picture, *, is_linear: bool = True) -> Any:
    """Return a picture as a `trimesh.Scene`: a node a part, named as the part is.

    Args:
        picture: what to show.
        is_linear: whether colors are proportional to light, as the format has it, and not sRGB as
            a viewer shows them that knows no difference, and whose lamp is bright.
    """
    import trimesh

    scene = trimesh.Scene()
    for part in picture.parts:
        if isinstance(part, Lines):
            scene.add_geometry(_path(part), node_name=part.name, geom_name=part.name)
        else:
            scene.add_geometry(
                _mesh(part, is_linear=is_linear),
                node_name=part.name,
                geom_name=part.name,
                transform=matrix_of(part.pose),
            )
    return scene


def matrix_of(pose: Pose) -> NDArray[np.float64]:
    """Return a pose as a (4, 4) matrix."""
    matrix = np.eye(4)
    matrix[:3, :3] = pose.rotation
    matrix[:3, 3] = pose.translation
    return matrix


def _mesh(part: Surface, *, is_linear: bool) -> Any:
    import trimesh

    shares = np.array(part.color) / 255.0
    light = ((shares + 0.055) / 1.055) ** 2.4 if is_linear else _DIM * shares
    rgb = np.rint(255.0 * light).astype(int).tolist()
    material = trimesh.visual.material.PBRMaterial(
        name=part.name,
        baseColorFactor=[*rgb, round(255 * part.opacity)],
        metallicFactor=0.0,
        roughnessFactor=0.65,
        alphaMode="OPAQUE" if part.opacity == 1 else "BLEND",
        doubleSided=not part.is_layered,
    )
    visual = trimesh.visual.TextureVisuals(material=material)
    return trimesh.Trimesh(part.vertices, part.triangles, visual=visual, process=False)


def _path(part: Lines) -> Any:
    from trimesh.path import Path3D
    from trimesh.path.entities import Line

    entities = [Line(segment) for segment in part.segments]
    color = np.array([*part.color, 255], np.uint8)
    return Path3D(entities, part.vertices, colors=np.tile(color, (len(entities), 1)), process=False)
