"""The record of `obbtree build` and its table."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli.errors import ObbError
from obbcli.report.record import Source, document, note_rows
from obbcli.report.table import Table, count, seconds, size

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from obbcli.report.record import Record
    from obbcli.tree.tree import ObbTree


class Built(NamedTuple):
    """A tree that was saved.

    Attributes:
        tree: the tree.
        output: its file.
        file_bytes: how long that is.
        seconds: s of wall time by stage.
    """

    tree: ObbTree
    output: str
    file_bytes: int
    seconds: Mapping[str, float]


def build_record(
    names: Sequence[str], files: Sequence[Built | ObbError], options: Record
) -> Record:
    """Return the record of a build.

    Args:
        names: the meshes, as the user wrote them.
        files: what became of each.
        options: what shaped the trees.
    """
    inputs = [_source(name, file).part() for name, file in zip(names, files, strict=True)]
    errors = [_error(name, file) for name, file in zip(names, files, strict=True)]
    return document(
        "build",
        inputs,
        options=options,
        result={
            "files": [_file_part(file) for file in files],
            "errors": [error for error in errors if error is not None],
        },
        stats={"seconds": [dict(getattr(file, "seconds", {})) for file in files]},
    )


def _source(name: str, file: Built | ObbError) -> Source:
    if isinstance(file, ObbError):
        return Source(name, None, None)
    return Source.of(name, file.tree.source_sha256, file.tree)


def _error(name: str, file: Built | ObbError) -> Record | None:
    """Return why there is no tree of a mesh; None where there is one."""
    if not isinstance(file, ObbError):
        return None
    return {"path": name, "error": file.fault, "where": file.where, "remedy": file.remedy}


def _file_part(file: Built | ObbError) -> Record:
    """Return what was written, or why nothing was."""
    if isinstance(file, ObbError):
        return {"output": None, "error": str(file)}
    tree = file.tree
    return {
        "output": file.output,
        "error": None,
        "triangle_count": tree.triangle_count,
        "vertex_count": tree.vertex_count,
        "node_count": tree.node_count,
        "level_count": len(tree.levels),
        "file_bytes": file.file_bytes,
        "bytes_per_triangle": file.file_bytes / tree.triangle_count,
    }


def build_tables(record: Record) -> list[Table]:
    """Return the table of a record: one row a tree that was built, then what was changed."""
    rows = [
        (
            source["path"],
            file["output"],
            count(file["triangle_count"]),
            count(file["node_count"]),
            str(file["level_count"]),
            size(file["file_bytes"]),
            f"{file['bytes_per_triangle']:.1f}",
            seconds(sum(stages.values())),
        )
        for source, file, stages in zip(
            record["inputs"], record["result"]["files"], record["stats"]["seconds"], strict=True
        )
        if file["error"] is None
    ]
    headings = ("mesh", "tree", "triangles", "boxes", "levels", "file", "B/triangle", "time")
    notes = note_rows((source["path"], source) for source in record["inputs"])
    return [Table(rows, headings, name_count=2), *([Table(notes)] if notes else [])]
