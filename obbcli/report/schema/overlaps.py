"""Schemas of what is said of overlaps."""

from __future__ import annotations

from obbcli.answers.overlap import OverlapStats
from obbcli.report.schema.answers import BODY_FIELDS, IGNORE, scene_stats
from obbcli.report.schema.relations import overlap_fields
from obbcli.report.schema.shared import STATS_FIELDS, document, pair_document
from obbcli.report.schema.words import (
    AMOUNT,
    COUNT,
    FLAG,
    NUMBER,
    TEXT,
    Schema,
    documented,
    list_of,
    or_null,
    record,
    ref,
    told,
    tuple_of,
    word_of,
)
from obbcli.scene.overlaps import SceneOverlap


def overlap() -> Schema:
    """Return the schema of `obbtree overlap`."""
    file = {
        "file": told(or_null(TEXT), "as written; null: there is no shared solid"),
        "format": word_of(("glb",)),
        "byte_count": told(or_null(COUNT), "of the file; null where there is none"),
    }
    mesh = told(record(file | SHARED_SOLID), "with --mesh")
    return overlap_document(
        "overlap", record(overlap_fields() | {"mesh": mesh}, optional=("mesh",))
    )


def overlap_document(name: str, result: Schema) -> Schema:
    """Return the schema of a document whose result tells of an overlap."""
    asked = {
        "tolerance": told(AMOUNT, "relative width asked of brackets"),
        "deeper_than": told(or_null(AMOUNT), "mesh units; null where it was not asked"),
    }
    return pair_document(name, result, stats=_stats(), asked=record(asked))


SHARED_SOLID: dict[str, Schema] = {
    "triangle_count": told(COUNT, "of what both share"),
    "volume": told(NUMBER, "of these triangles, cubed mesh units, not proven"),
    "off_by": told(
        or_null(AMOUNT),
        "cubed mesh units; how far that is from the proven bracket, 0 within; null where nothing "
        "is proven",
    ),
    "is_proven": told(FLAG, "false: manifold3d made it"),
}
"""What is said of a mesh of what both share."""


def _stats() -> Schema:
    more = documented(OverlapStats, dict.fromkeys(("cells", "points", "rays"), COUNT))
    return record(STATS_FIELDS | more)


def scene_overlaps() -> Schema:
    """Return the schema of `obbtree scene --overlaps`."""
    inputs = record(
        {"scene": ref("source"), "meshes": told(list_of(ref("source")), "of the bodies, each once")}
    )
    asked = {
        "tolerance": told(AMOUNT, "relative width asked of brackets"),
        "touch": told(
            or_null(tuple_of(AMOUNT, AMOUNT)), "gap and overlap, mesh units; null: the default"
        ),
    }
    pair = record(documented(SceneOverlap, {"body_a": TEXT, "body_b": TEXT}) | overlap_fields())
    result = {
        "pairs": told(list_of(pair), "those that are not clear, in the order of the bodies"),
        "interrupted": told(FLAG, "whether Ctrl-C ended the search"),
    }
    return document(
        "scene-overlaps",
        inputs,
        bodies=list_of(record(BODY_FIELDS | {"pose": ref("pose")})),
        ignore=list_of(IGNORE),
        accuracy=ref("accuracy"),
        asked=record(asked),
        result=record(result),
        stats=scene_stats(),
    )
