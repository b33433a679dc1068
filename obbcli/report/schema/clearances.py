"""Schemas of what is said of clearances."""

from __future__ import annotations

from obbcli.answers.clearance import (
    AtLeast,
    Clearance,
    CurvePiece,
    GreatestClearance,
    LeastClearance,
)
from obbcli.report.schema.shared import PART_NAMES, STATS_FIELDS, pair_document
from obbcli.report.schema.typed import schemas_of
from obbcli.report.schema.words import (
    AMOUNT,
    FLAG,
    Schema,
    documented,
    list_of,
    or_null,
    record,
    ref,
    told,
    tuple_of,
)


def clearance() -> Schema:
    """Return the schema of `obbtree clearance`."""
    asked = {
        "tolerance": told(AMOUNT, "relative width asked of the bracket"),
        "at_least": told(or_null(AMOUNT), "mesh units; null where it was not asked"),
    }
    fields = documented(
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
    solid = told(FLAG, "whether a body inside the other touches it")
    return pair_document(
        "clearance", record(fields), solid=solid, asked=record(asked), stats=record(STATS_FIELDS)
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
