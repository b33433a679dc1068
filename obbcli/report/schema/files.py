"""Schemas of what commands say of files: `info`, `build`, `sweep` and its results, and errors."""

from __future__ import annotations

from obbcli.mesh.quality import Grain
from obbcli.report.record import SCHEMA_VERSION
from obbcli.report.schema.shared import (
    BUILD_FIELDS,
    CONTACT_FIELDS,
    COUNTERS,
    LATER_COUNTERS,
    PART_NAMES,
    SECONDS,
    document,
)
from obbcli.report.schema.words import (
    AMOUNT,
    COUNT,
    FLAG,
    NUMBER,
    SHA256,
    TEXT,
    VECTOR,
    Schema,
    documented,
    list_of,
    or_null,
    record,
    ref,
    table_of,
    told,
    word_of,
)
from obbcli.report.sweep import STATUSES
from obbcli.tree.facts import Level

_FAULT = told(TEXT, "what was found and what was wanted")
_PLACE = told(TEXT, "file and line, row or byte, or option")
_REMEDY = told(TEXT, "what to do about it; empty where nothing can be said")


def _part() -> Schema:
    return record(
        {
            "path": told(TEXT, "names from the root down, joined by /; empty without a name"),
            "triangle_count": COUNT,
            "bounds": told(list_of(VECTOR, 2), "as placed, mesh units"),
            "unit": told(or_null(TEXT), "that the file states; null where it states none"),
            "is_watertight": told(FLAG, "whether every edge has two triangles that agree on it"),
        }
    )


def info() -> Schema:
    """Return the schema of `obbtree info`."""
    parts = record(
        {
            "kind": {"const": "assembly"},
            "part_count": COUNT,
            "mesh_count": told(COUNT, "meshes that the parts are placed copies of"),
            "triangle_count": told(COUNT, "of all parts"),
            "bounds": told(list_of(VECTOR, 2), "of all parts as placed, mesh units"),
            "size": told(or_null(AMOUNT), "diagonal, mesh units; null beyond the largest double"),
            "parts": told(list_of(_part()), "in the file's order"),
        },
        description="With --parts.",
    )
    result = {
        "kind": word_of(("mesh", "tree")),
        "triangle_count": COUNT,
        "vertex_count": COUNT,
        "bounds": told(list_of(VECTOR, 2), "lowest and highest coordinates, mesh units"),
        "size": told(or_null(AMOUNT), "diagonal, mesh units; null beyond the largest double"),
        "surface_centroid": told(VECTOR, "weighted by area; the default pivot"),
        "is_watertight": told(FLAG, "whether every edge has two triangles that agree on it"),
        "self_overlap": _self_overlap(),
        "degenerate_count": told(COUNT, "triangles without area"),
        "duplicate_count": told(COUNT, "triangles that are there already"),
        "accuracy": _grain(),
        "tree": or_null(_tree()),
        "check": told(or_null(word_of(("passed",))), "null where --check was not asked for"),
    }
    inputs = record({"file": ref("source")})
    either: Schema = {"oneOf": [record(result, optional=("self_overlap",)), parts]}
    return document("info", inputs, result=either, stats=record({"seconds": SECONDS}))


def _self_overlap() -> Schema:
    bracket = or_null(list_of(or_null(NUMBER), 2))
    volume = "[lo, hi], proven, cubic mesh units; negative of a surface turned inward; "
    return told(
        record(
            {
                "overlaps_itself": told(
                    or_null(FLAG),
                    "whether the surface winds about any space other than once, by proof; false: "
                    "about less than 1e-9 of its volume; null: see reason",
                ),
                "volume": told(bracket, volume + "null where it was not looked at"),
                "excess": told(
                    bracket,
                    "[lo, hi], proven, cubic mesh units: the integral of w^2 - w, w being how "
                    "often the surface winds about a place; twice the space wound about other than "
                    "once, or more",
                ),
                "reason": told(or_null(TEXT), "why it is not told; null where it is"),
            }
        ),
        "What the mesh is as a solid. Null beside a null: beyond the largest double.",
    )


def _grain() -> Schema:
    numbers = ("spacing", "shortest_edge", "smallest_altitude", "largest_aspect")
    fields: dict[str, Schema] = {
        "digits": word_of(("float32", "float64")),
        **dict.fromkeys(numbers, or_null(AMOUNT)),
        "sliver_count": COUNT,
        "extents_ratio": or_null(AMOUNT),
    }
    warnings = {"warnings": told(list_of(TEXT), "what of it answers may suffer from")}
    return told(record(documented(Grain, fields) | warnings), "What the mesh itself limits.")


def _tree() -> Schema:
    level = documented(Level, {"box_count": COUNT, "leaf_count": COUNT, "volume": or_null(AMOUNT)})
    return record(
        BUILD_FIELDS
        | {
            "node_count": COUNT,
            "possible_node_count": COUNT,
            "nbytes": COUNT,
            "bytes_per_triangle": AMOUNT,
            "source": told(or_null(TEXT), "the mesh file it was built from"),
            "source_sha256": or_null(SHA256),
            "source_state": told(
                or_null(word_of(("unchanged", "changed", "not found"))),
                "of the mesh file beside it; null where it has no name",
            ),
            "tool_version": told(or_null(TEXT), "of the obbtree that built it"),
            "levels": told(list_of(record(level)), "the root first"),
        }
    )


def build() -> Schema:
    """Return the schema of `obbtree build`."""
    failed = record({"output": {"type": "null"}, "error": TEXT})
    written = record(
        {
            "output": told(TEXT, "the tree file"),
            "error": {"type": "null"},
            "triangle_count": COUNT,
            "vertex_count": COUNT,
            "node_count": COUNT,
            "level_count": COUNT,
            "file_bytes": COUNT,
            "bytes_per_triangle": AMOUNT,
        }
    )
    error = record({"path": TEXT, "error": _FAULT, "where": _PLACE, "remedy": _REMEDY})
    result = {
        "files": told(list_of({"oneOf": [written, failed]}), "one an input"),
        "errors": told(list_of(error), "of the inputs that have no tree"),
    }
    stats = record({"seconds": told(list_of(SECONDS), "one an input")})
    return document(
        "build",
        list_of(ref("source")),
        options=ref("build"),
        result=record(result),
        stats=stats,
    )


_QUERIES = record(
    {"path": TEXT, "sha256": or_null(SHA256), "format": word_of(("csv", "jsonl"))},
    description="The file of questions.",
)
_SWEEP = {
    "inputs": record({"a": ref("source"), "b": ref("source"), "queries": _QUERIES}),
    "options": table_of({}, "Poses, motion and duration of rows that leave them out."),
    "accuracy": ref("accuracy"),
    "digest": told(SHA256, "of all that decides answers"),
}


def sweep() -> Schema:
    """Return the schema of the first line of a sweep's results."""
    return document("sweep", **_SWEEP)


def sweep_summary() -> Schema:
    """Return the schema of what `obbtree sweep --json` prints."""
    result = {
        "output": told(TEXT, "the file of results"),
        "row_count": told(COUNT, "how many rows it has"),
        "resumed_from": told(COUNT, "how many it had before"),
        "statuses": told(record(dict.fromkeys(STATUSES, COUNT)), "rows by status"),
        "error_count": told(COUNT, "rows that could not be asked"),
    }
    return document(
        "sweep-summary", **_SWEEP, result=record(result), stats=record({"seconds": SECONDS})
    )


def sweep_row() -> Schema:
    """Return the schema of all other lines of a sweep's results."""
    head = {
        "row": told(COUNT, "of the file of questions, from 0"),
        "id": {"description": "what the row calls itself; null where it has no name"},
    }
    stats = {"stats": record(dict.fromkeys(COUNTERS, COUNT), optional=LATER_COUNTERS)}
    error = {"error": record({"where": _PLACE, "fault": _FAULT, "remedy": _REMEDY})}
    answered = record(head | CONTACT_FIELDS | PART_NAMES | stats, optional=PART_NAMES)
    return {"oneOf": [answered, record(head | error)]}


def error() -> Schema:
    """Return the schema of what `--json` writes to standard error where a command fails."""
    fields = {
        "schema": {"const": f"obbtree/error/{SCHEMA_VERSION}"},
        "tool_version": TEXT,
        "error": _FAULT,
        "kind": told(TEXT, "the class of the error in Python"),
        "code": told({"type": "integer", "minimum": 1, "maximum": 255}, "the exit code"),
        "where": told(or_null(TEXT), "file and line, row or byte, or option; null where none is"),
        "remedy": told(or_null(TEXT), "what to do about it; null where nothing can be said"),
        "traceback": told(TEXT, "only with --debug: where in obbtree the error was raised"),
    }
    return record(fields, optional=("traceback",))
