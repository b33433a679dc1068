"""The record of `obbtree info --parts` and its tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.measure import diagonal
from obbcli.report.record import Source, document, finite
from obbcli.report.table import Table, count, length, point

if TYPE_CHECKING:
    from obbcli.motion.assembly import Assembly, Part
    from obbcli.report.record import Record

_COLUMNS = ("part", "triangles", "lowest", "highest", "unit", "watertight")


def parts_record(path: str, assembly: Assembly) -> Record:
    """Return the record of a file's parts, each as it is placed; copies are measured once.

    Args:
        path: as the user wrote it.
        assembly: the parts.

    Raises:
        MeshError: a part is damaged.
    """
    parts = [_part(part) for part in assembly]
    bounds = np.array([part["bounds"] for part in parts])
    whole = np.array([bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)])
    triangles = sum(part["triangle_count"] for part in parts)
    notes = dict.fromkeys(note for part in assembly for note in part.mesh.notes)
    result: Record = {
        "kind": "assembly",
        "part_count": len(parts),
        "mesh_count": len({id(part.shape) for part in assembly}),
        "triangle_count": triangles,
        "bounds": whole.tolist(),
        "size": finite(diagonal(whole)),
        "parts": parts,
    }
    source = Source(path, assembly.sha256, triangles, tuple(notes))
    return document("info", {"file": source.part()}, result=result)


def _part(part: Part) -> Record:
    mesh = part.mesh
    return {
        "path": part.path,
        "triangle_count": len(mesh.triangles),
        "bounds": part.placed_bounds().tolist(),
        "unit": part.unit,
        "is_watertight": mesh.is_watertight,
    }


def parts_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the file, and its parts."""
    file, result = record["inputs"]["file"], record["result"]
    low, high = result["bounds"]
    rows = [
        ("file", file["path"]),
        ("parts", count(result["part_count"])),
        ("meshes", f"{count(result['mesh_count'])}, which copies share"),
        ("triangles", count(result["triangle_count"])),
        ("bounds", f"{point(low)}  to  {point(high)}"),
        ("size", f"{length(result['size'])} (diagonal, mesh units)"),
        *[("note", text) for text in file["notes"]],
    ]
    return [Table(rows), Table([_row(part) for part in result["parts"]], _COLUMNS)]


def _row(part: Record) -> tuple[str, ...]:
    low, high = part["bounds"]
    return (
        part["path"] or "(no name)",
        count(part["triangle_count"]),
        point(low),
        point(high),
        part["unit"] or "-",
        "yes" if part["is_watertight"] else "no",
    )


def parts_bare(record: Record) -> str:
    """Return the paths, a line each."""
    return "".join(f"{part['path']}\n" for part in record["result"]["parts"])
