"""Schemas of how two bodies lie to each other, which several documents say."""

from __future__ import annotations

from obbcli.answers.overlap import (
    Band,
    Depth,
    Gap,
    Overlap,
    Region,
    SeparationAlong,
    Volume,
)
from obbcli.report.schema.typed import schemas_of
from obbcli.report.schema.words import Schema, list_of, record, ref

_PARTS = ("part_a", "part_b")
_DEPTH_FIELDS = ("thickness", "protrusion_a", "protrusion_b")


def overlap_fields() -> dict[str, Schema]:
    """Return the schema of each field of an answer, less what it cost."""
    fields = schemas_of(
        Overlap,
        band=record(schemas_of(Band)),
        distance=record(schemas_of(Gap), optional=_PARTS),
        volume=record(schemas_of(Volume)),
        regions=list_of(record(schemas_of(Region), optional=_PARTS)),
        separation_along=record(schemas_of(SeparationAlong)),
        stats=ref("stats"),
        **dict.fromkeys(_DEPTH_FIELDS, record(schemas_of(Depth), optional=_PARTS)),
    )
    del fields["stats"]
    return fields


def relation_fields() -> dict[str, Schema]:
    """Return the schema of what `obbtree collide --relation` adds to its answer."""
    fields = overlap_fields()
    return {name: fields[name] for name in ("relation", *_DEPTH_FIELDS)}
