"""The record of `obbtree info` and its tables."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from obbcli.mesh import Mesh
from obbcli.mesh.quality import grain_of, warnings_of
from obbcli.report.record import Source, document, file_sha256, finite
from obbcli.report.table import Table, count, length, point, size

if TYPE_CHECKING:
    from obbcli.report.record import Record
    from obbcli.tree.tree import ObbTree

_CHANGES = {
    "unchanged": "unchanged since",
    "changed": "CHANGED since: the tree answers for the mesh as it was",
    "not found": "not found beside the tree",
}


# Meshes of up to so many triangles are looked at unasked: it takes a tenth of a second.
_FEW = 20_000


def info_record(
    path: str,
    shape: Mesh | ObbTree,
    sha256: str,
    *,
    is_checked: bool,
    looks_for_overlap: bool = False,
) -> Record:
    """Return the record of a file.

    Args:
        path: as the user wrote it; `-` for standard input.
        shape: what it holds.
        sha256: of its bytes, in hexadecimal.
        is_checked: whether its tree was proven.
        looks_for_overlap: whether to tell of a large mesh, too, if it overlaps itself.

    Raises:
        TreeFileError: the tree contradicts itself.
        OSError: the file is gone.
    """
    is_mesh = isinstance(shape, Mesh)
    mesh = shape if isinstance(shape, Mesh) else shape.mesh
    source = Source.of(path, sha256, mesh)
    result: Record = {"kind": "mesh" if is_mesh else "tree", **_mesh_part(mesh)}
    result["self_overlap"] = _self_overlap_part(shape, mesh, is_asked=looks_for_overlap)
    result["tree"] = None if isinstance(shape, Mesh) else _tree_part(path, shape)
    result["check"] = "passed" if is_checked else None
    return document("info", {"file": source.part()}, result=result)


def _mesh_part(mesh: Mesh) -> Record:
    return {
        "triangle_count": len(mesh.triangles),
        "vertex_count": len(mesh.vertices),
        "bounds": mesh.bounds.tolist(),
        "size": finite(mesh.size),
        "surface_centroid": mesh.surface_centroid.tolist(),
        "is_watertight": mesh.is_watertight,
        "degenerate_count": mesh.degenerate_count,
        "duplicate_count": mesh.duplicate_count,
        "accuracy": _accuracy_part(mesh),
    }


def _self_overlap_part(shape: Mesh | ObbTree, mesh: Mesh, *, is_asked: bool) -> Record:
    """Return whether a mesh overlaps itself, or why that is not told."""
    from obbcli.questions.self_overlap import self_overlap

    part: Record = dict.fromkeys(("overlaps_itself", "volume", "excess", "reason"))
    if not mesh.is_watertight:
        return part | {"reason": "the surface does not close"}
    if len(mesh.triangles) > _FEW and not is_asked:
        return part | {"reason": "not looked at in a mesh this large without --overlaps-itself"}
    found = self_overlap(shape)
    bounds = {name: [finite(x) for x in getattr(found, name)] for name in ("volume", "excess")}
    reason = "rounding leaves it open" if found.overlaps_itself is None else None
    return part | {"overlaps_itself": found.overlaps_itself, **bounds, "reason": reason}


def _accuracy_part(mesh: Mesh) -> Record:
    """Return what of the mesh itself limits answers about it."""
    grain = grain_of(mesh)
    values = {
        name: finite(value) if isinstance(value, float) else value
        for name, value in grain._asdict().items()
    }
    return values | {"warnings": warnings_of(mesh, grain)}


def _tree_part(path: str, tree: ObbTree) -> Record:
    return {
        "fit": tree.fit,
        "split": tree.split,
        "leaf_size": tree.leaf_size,
        "max_depth": tree.max_depth,
        "node_count": tree.node_count,
        "possible_node_count": tree.possible_node_count,
        "nbytes": tree.nbytes,
        "bytes_per_triangle": tree.nbytes / tree.triangle_count,
        "source": tree.source,
        "source_sha256": tree.source_sha256,
        "source_state": _source_state(path, tree),
        "tool_version": tree.tool_version,
        "levels": [level._asdict() for level in tree.levels],
    }


def _source_state(path: str, tree: ObbTree) -> str | None:
    """Return what became of the mesh that the tree was built from; None where it has no name."""
    if tree.source is None or tree.source_sha256 is None:
        return None
    # Only beside the tree: a file from elsewhere must not choose what is read.
    mesh_file = Path(path).parent / Path(tree.source).name
    if path == "-" or not mesh_file.is_file():
        return "not found"
    return "unchanged" if file_sha256(mesh_file) == tree.source_sha256 else "changed"


def info_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the mesh, and the tree and its levels where there is one."""
    result = record["result"]
    tables = [Table(_mesh_rows(record["inputs"]["file"], result))]
    if result["tree"] is not None:
        tables.append(Table(_tree_rows(result["tree"]), title="tree"))
        tables.append(_levels_table(result["tree"]["levels"]))
    if result["check"] is not None:
        tables.append(Table([("check", "passed: every triangle lies in all boxes above it")]))
    return tables


def _mesh_rows(file: Record, result: Record) -> list[tuple[str, str]]:
    low, high = result["bounds"]
    warnings = [("warning", text) for text in result["accuracy"]["warnings"]]
    return [
        ("file", f"{file['path']} ({result['kind']})"),
        ("triangles", count(result["triangle_count"])),
        ("vertices", count(result["vertex_count"])),
        ("bounds", f"{point(low)}  to  {point(high)}"),
        ("size", f"{length(result['size'])} (diagonal, mesh units)"),
        ("unit", file.get("unit", "not stated")),
        ("centroid", point(result["surface_centroid"])),
        ("watertight", "yes" if result["is_watertight"] else "no"),
        *_solid_rows(result["self_overlap"]),
        ("degenerate", f"{count(result['degenerate_count'])} triangles"),
        ("duplicate", f"{count(result['duplicate_count'])} triangles"),
        *[("note", text) for text in file["notes"]],
        *warnings,
    ]


def _solid_rows(part: Record) -> list[tuple[str, str]]:
    """Return the rows about the solid that a mesh is: its volume, whether it overlaps itself."""
    verdict = part["overlaps_itself"]
    if part["volume"] is None:
        return [("overlap", f"with itself unknown: {part['reason']}")]
    low, high = part["volume"]
    if None in (low, high):
        return [("overlap", "with itself unknown: its volume exceeds the largest double")]
    rows = [("volume", f"{length((low + high) / 2)} (cubic mesh units)")]
    if verdict is None:
        return [*rows, ("overlap", f"with itself unknown: {part['reason']}")]
    if not verdict:
        return [*rows, ("overlap", "none with itself")]
    share = part["excess"][1] / 2 / max(abs(low), abs(high))
    text = f"WITH ITSELF: up to {share:.2g} of its volume is wound about other than once"
    return [*rows, ("overlap", text)]


def _tree_rows(tree: Record) -> list[tuple[str, str]]:
    depth = "none" if tree["max_depth"] is None else str(tree["max_depth"])
    rows = [
        ("boxes", count(tree["node_count"])),
        ("built by", f"obbtree {tree['tool_version']}"),
        ("options", f"fit {tree['fit']}, split {tree['split']}"),
        ("limits", f"leaf size {tree['leaf_size']}, max depth {depth}"),
        ("memory", f"{size(tree['nbytes'])}, {tree['bytes_per_triangle']:.1f} bytes a triangle"),
    ]
    if tree["source"] is not None:
        rows.append(("source", tree["source"]))
        rows.append(("SHA-256", str(tree["source_sha256"])))
    if tree["source_state"] is not None:
        rows.append(("mesh file", _CHANGES[tree["source_state"]]))
    return rows


def _levels_table(levels: list[Record]) -> Table:
    rows = [
        (str(depth), count(level["box_count"]), count(level["leaf_count"]), length(level["volume"]))
        for depth, level in enumerate(levels)
    ]
    return Table(rows, ("level", "boxes", "leaves", "total volume"))
