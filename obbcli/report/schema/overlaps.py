"""Schemas of what is said of overlaps."""

from __future__ import annotations

from obbcli.answers.overlap import Band, Depth, Gap, Overlap, SeparationAlong
from obbcli.report.schema.shared import STATS_FIELDS, pair_document
from obbcli.report.schema.typed import schemas_of
from obbcli.report.schema.words import AMOUNT, Schema, or_null, record, ref, told


def overlap() -> Schema:
    """Return the schema of `obbtree overlap`."""
    asked = {
        "tolerance": told(AMOUNT, "relative width asked of brackets"),
        "deeper_than": told(or_null(AMOUNT), "mesh units; null where it was not asked"),
    }
    return pair_document(
        "overlap", overlap_result(), stats=record(STATS_FIELDS), asked=record(asked)
    )


def overlap_result() -> Schema:
    """Return the schema of an answer."""
    depth = record(schemas_of(Depth))
    fields = schemas_of(
        Overlap,
        band=record(schemas_of(Band)),
        distance=record(schemas_of(Gap)),
        thickness=depth,
        protrusion_a=depth,
        protrusion_b=depth,
        separation_along=record(schemas_of(SeparationAlong)),
        stats=ref("stats"),
    )
    del fields["stats"]
    return record(fields)
