"""Schemas of what is said of clearances."""

from __future__ import annotations

from obbcli.answers.clearance import (
    AtLeast,
    Clearance,
    CurvePiece,
    GreatestClearance,
    LeastClearance,
)
from obbcli.report.schema.answers import IGNORE, moving_bodies, scene_stats
from obbcli.report.schema.shared import PART_NAMES, STATS_FIELDS, document, pair_document
from obbcli.report.schema.typed import schemas_of
from obbcli.report.schema.words import (
    AMOUNT,
    COUNT,
    FLAG,
    TEXT,
    Schema,
    documented,
    list_of,
    or_null,
    record,
    ref,
    told,
    tuple_of,
)
from obbcli.scene.clearances import SceneClearance


def clearance() -> Schema:
    """Return the schema of `obbtree clearance`."""
    solid = told(FLAG, "whether a body inside the other touches it")
    return pair_document(
        "clearance",
        record(_fields()),
        solid=solid,
        asked=record(_ASKED),
        stats=record(STATS_FIELDS),
    )


def scene_clearances() -> Schema:
    """Return the schema of `obbtree scene --least-clearance`."""
    inputs = record(
        {"scene": ref("source"), "meshes": told(list_of(ref("source")), "of the bodies, each once")}
    )
    within = told(or_null(AMOUNT), "mesh units; pairs proven further apart are left out")
    limit = told(or_null(COUNT), "of pairs that are listed; null: all")
    pair = record(documented(SceneClearance, {"body_a": TEXT, "body_b": TEXT}) | _fields())
    result = {
        "pairs": told(list_of(pair), "in the order of the lower ends of their brackets"),
        "others_at_least": told(
            or_null(AMOUNT),
            "mesh units; pairs that count as later are proven never to be nearer; null where there "
            "are none",
        ),
        "complete": told(FLAG, "whether no limit left a pair open; `limit` is none"),
        "interrupted": told(FLAG, "whether Ctrl-C ended the search"),
    }
    return document(
        "scene-clearances",
        inputs,
        duration=told(AMOUNT, "s"),
        bodies=moving_bodies(),
        ignore=list_of(IGNORE),
        accuracy=ref("accuracy"),
        solid=told(FLAG, "whether a body inside another touches it"),
        asked=record(_ASKED | {"within": within, "limit": limit}),
        result=record(result),
        stats=scene_stats(),
    )


_ASKED: dict[str, Schema] = {
    "tolerance": told(AMOUNT, "relative width asked of the bracket"),
    "at_least": told(or_null(AMOUNT), "mesh units; null where it was not asked"),
}


def _fields() -> dict[str, Schema]:
    """Return what is said of a clearance."""
    return documented(
        Clearance,
        {
            "minimum": _least(),
            "maximum": or_null(record(schemas_of(GreatestClearance))),
            "curve": or_null(list_of(_piece())),
            "at_least": or_null(record(schemas_of(AtLeast))),
            "first_contact": or_null(ref("contact")),
            "complete": FLAG,
        },
    )


def _least() -> Schema:
    stretches = list_of(tuple_of(AMOUNT, AMOUNT))
    fields = schemas_of(LeastClearance, when=stretches)
    for name in PART_NAMES:
        del fields[name]
    return record(fields | PART_NAMES, optional=PART_NAMES)


def _piece() -> Schema:
    fields = schemas_of(CurvePiece, bounds=tuple_of(AMOUNT, or_null(AMOUNT)))
    ends = {"from": fields.pop("start"), "to": fields.pop("end")}
    return record(ends | fields)
