"""Which extensions of glTF are understood, which carry no surface, and which are refused."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from obbcli.mesh.formats.gltf.buffers import MESHOPT
from obbcli.mesh.formats.gltf.compressed import DRACO
from obbcli.mesh.formats.gltf.json import NotAsExpectedError

if TYPE_CHECKING:
    from obbcli.mesh.formats.gltf.data import Document

INSTANCING = "EXT_mesh_gpu_instancing"
VISIBILITY = "KHR_node_visibility"

#: They make or place surface, and are read.
SUPPORTED = frozenset(
    (*MESHOPT, DRACO, INSTANCING, VISIBILITY, "KHR_mesh_quantization", "KHR_accessor_float64")
)
#: They place surface and are not read: refused even where a document does not require them.
REFUSED = frozenset(("CESIUM_RTC",))
#: They say nothing about where a surface is: looks, light, sound, names, physics, and which of
#: several models is drawn from afar.
_WITHOUT_SURFACE = frozenset(
    (
        *("KHR_techniques_webgl", "KHR_technique_webgl", "KHR_blend", "KHR_xmp", "KHR_xmp_json_ld"),
        *("KHR_lights_punctual", "KHR_lights_common", "KHR_environment_map", "KHR_interactivity"),
        *("KHR_animation_pointer", "KHR_node_selectability", "KHR_node_hoverability"),
        *("KHR_audio", "KHR_audio_emitter", "KHR_physics_rigid_bodies", "KHR_implicit_shapes"),
        *("EXT_mesh_features", "EXT_instance_features", "EXT_structural_metadata"),
        *("EXT_feature_metadata", "EXT_property_animation", "EXT_mesh_manifold"),
        *("EXT_mesh_primitive_edge_visibility", "CESIUM_primitive_outline"),
        *("MSFT_lod", "MSFT_audio_emitter", "MSFT_packing_occlusionRoughnessMetallic"),
        *("MSFT_packing_normalRoughnessMetallic", "AGI_articulations", "AGI_stk_metadata"),
        *("FB_ngon_encoding", "FB_geometry_metadata", "GODOT_single_root", "MAXAR_image_ortho"),
        *("VRM", "VRMC_vrm", "VRMC_springBone", "VRMC_vrm_animation", "MOZ_hubs_components"),
    )
)
_LOOKS = re.compile(r"[A-Z0-9]+_(materials|texture|image|lights)_\w+")


def check_extensions(document: Document) -> None:
    """Refuse what a document needs and we do not read; note what may be left out but is unknown.

    A client must not load what requires an extension that it does not know (glTF 2.0, 3.12).

    Raises:
        NotAsExpectedError: the first extension that is not read, by name.
    """
    required = document.names("extensionsRequired")
    used = list(dict.fromkeys([*document.names("extensionsUsed"), *required]))
    unknown = [name for name in used if name not in SUPPORTED and not _is_without_surface(name)]
    for name in unknown:
        if name in required or name in REFUSED:
            place = "extensionsRequired" if name in required else "extensionsUsed"
            raise NotAsExpectedError(
                place,
                f"{name[:80]} is not read, and the shape depends on it",
                "export it without this extension",
            )
    if unknown:
        names = ", ".join(name[:80] for name in unknown[:3])
        more = f" and {len(unknown) - 3} more" if len(unknown) > 3 else ""
        document.source.note(f"not required and not known, passed over: {names}{more}")


def _is_without_surface(name: str) -> bool:
    return name in _WITHOUT_SURFACE or _LOOKS.fullmatch(name) is not None
