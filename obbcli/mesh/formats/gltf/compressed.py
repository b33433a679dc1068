"""Compressed glTF geometry, unpacked by the codecs' own libraries where those are installed.

KHR_draco_mesh_compression by DracoPy (Google's Draco), EXT_meshopt_compression by meshopt
(meshoptimizer). Both come with the extra `gltf`. What they return is held against what the
document says of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from obbcli.errors import MeshError
from obbcli.mesh.formats.gltf.json import NotAsExpectedError, count_in
from obbcli.mesh.formats.through_meshio.guard import fenced

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from obbcli.mesh.formats.gltf.json import Json
    from obbcli.mesh.source import Source

DRACO = "KHR_draco_mesh_compression"
#: Runs of equal rows take a byte for a thousand; nothing takes less.
_LARGEST_RATIO = 1024
_SIZES = {"ATTRIBUTES": range(4, 257, 4), "TRIANGLES": (2, 4), "INDICES": (2, 4)}
_FILTERS = {
    "OCTAHEDRAL": (4, 8),
    "QUATERNION": (8,),
    "EXPONENTIAL": range(4, 257, 4),
    "COLOR": (4, 8),
}


class DracoMesh(NamedTuple):
    """Holds what a Draco buffer unpacks to.

    Args:
        triangles: int64 (F, 3).
        attributes: values (V, width) by Draco's unique ids.
    """

    triangles: NDArray[np.int64]
    attributes: dict[int, NDArray[Any]]


def decoded_view(source: Source, data: bytes, item: Json, place: str) -> bytes:
    """Return the bytes of a buffer view that meshoptimizer's codec has packed.

    Args:
        source: the file, whose size bounds what the codec may take.
        data: the packed bytes.
        item: what the extension says of them.
        place: of the buffer view.

    Raises:
        NotAsExpectedError: settings that are not the extension's, damaged bytes, no package.
    """
    count, size = count_in(item, "count", place), count_in(item, "byteStride", place)
    mode, how = item.get("mode"), item.get("filter", "NONE")
    if not isinstance(mode, str) or size not in _SIZES.get(mode, ()):
        raise NotAsExpectedError(place, "is compressed in no known mode and row size")
    known = how == "NONE" or (isinstance(how, str) and size in _FILTERS.get(how, ()))
    if not known or (mode != "ATTRIBUTES" and how != "NONE"):
        raise NotAsExpectedError(place, "is compressed with no known filter")
    if mode == "TRIANGLES" and count % 3:
        raise NotAsExpectedError(place, f"has {count} indices, not three a triangle")
    if count * size > _LARGEST_RATIO * (len(data) + 4):
        raise NotAsExpectedError(place, f"claims {count * size} bytes packed into {len(data)}")

    def decode() -> bytes:
        import meshopt

        rows = meshopt.decode_gltf_buffer(data, count, size, mode, None if how == "NONE" else how)
        return np.asarray(rows).tobytes()

    return _unpacked(source, decode, "meshopt", place) if count else b""


def decoded_draco(source: Source, data: bytes, place: str) -> DracoMesh:
    """Return triangles and attributes of a Draco buffer.

    Raises:
        NotAsExpectedError: damaged bytes, a point cloud, no package.
    """

    def decode() -> DracoMesh | None:
        import DracoPy

        mesh = DracoPy.decode(data)
        if not hasattr(mesh, "faces"):
            return None
        triangles = np.asarray(mesh.faces).astype(np.int64).reshape(-1, 3)
        found = {int(a["unique_id"]): np.asarray(a["data"]) for a in mesh.attributes}
        return DracoMesh(triangles, {key: v.reshape(len(v), -1) for key, v in found.items()})

    mesh: DracoMesh | None = _unpacked(source, decode, "DracoPy", place)
    if mesh is None:
        raise NotAsExpectedError(place, "is compressed, but holds points without triangles")
    return mesh


def _unpacked(source: Source, decode: Callable[[], Any], package: str, place: str) -> Any:
    """Return what a library unpacks, its errors in our words."""
    try:
        return fenced(source, package, decode)
    except MeshError as fault:
        if isinstance(fault.__cause__, ImportError):
            codec = "Draco" if package == "DracoPy" else "meshopt"
            raise NotAsExpectedError(
                place,
                f"is compressed by {codec}, and the package that unpacks it is not installed",
                f"pip install {package}",
            ) from fault
        raise NotAsExpectedError(
            place, "holds compressed bytes that are damaged", "export or download it again"
        ) from fault
