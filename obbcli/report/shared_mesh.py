"""What is said of a mesh of what two solids share: that it is not proven, and how far it is off.

Of its file, and of a picture of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.report.table import count, length

if TYPE_CHECKING:
    from obbcli.answers.overlap import Volume
    from obbcli.report.record import Record
    from obbcli.view.shared_solid import SharedSolid


def shared_mesh_part(
    file: str, solid: SharedSolid, byte_count: int | None, volume: Volume | None
) -> Record:
    """Return what a document says of a shared solid's file.

    Args:
        file: its path, as the user wrote it.
        solid: what it holds.
        byte_count: its size; None: nothing was written, as both share nothing.
        volume: what is proven of the volume; None: nothing.
    """
    part = {"file": None if byte_count is None else file, "format": "glb", "byte_count": byte_count}
    return part | solid_part(solid, volume)


def solid_part(solid: SharedSolid, volume: Volume | None) -> Record:
    """Return what a document says of a shared solid, held against the proven volume."""
    off = None
    if volume is not None:
        low, high = volume.bounds
        off = max(low - solid.volume, solid.volume - high, 0.0)
    return {
        "triangle_count": len(solid.triangles),
        "volume": solid.volume,
        "off_by": off,
        "is_proven": False,
    }


def drawn_rows(drawn: Record) -> list[tuple[str, str]]:
    """Return the rows of a table about what a picture shows."""
    if not drawn["triangle_count"]:
        return [("drawn", "A and B at t = 0, which share no solid")]
    return [("drawn", "faintly A and B at t = 0, in full what they share"), *_volume_rows(drawn)]


def _volume_rows(part: Record) -> list[tuple[str, str]]:
    if part["off_by"] is None:
        return []
    off = f"off by {length(part['off_by'])} beyond what is proven" if part["off_by"] else ""
    return [("its volume", f"{length(part['volume'])}, {off or 'as proven'}")]


def shared_mesh_rows(part: Record | None) -> list[tuple[str, str]]:
    """Return the rows of a table about it."""
    if part is None:
        return []
    if part["file"] is None:
        return [("mesh", "none written: there is no shared solid")]
    told = f"{part['file']}: {count(part['triangle_count'])} triangles by manifold3d, not proven"
    return [("mesh", told), *_volume_rows(part)]
