"""Schemas of what is said of pieces of a motion."""

from __future__ import annotations

from obbcli.answers.contact_piece import ContactPiece
from obbcli.report.schema.shared import STATS_FIELDS, pair_document
from obbcli.report.schema.typed import schemas_of
from obbcli.report.schema.words import (
    AMOUNT,
    COUNT,
    FLAG,
    Schema,
    list_of,
    or_null,
    record,
    told,
)


def intervals() -> Schema:
    """Return the schema of `obbtree intervals`."""
    asked = {
        "within": told(AMOUNT, "mesh units; surfaces this close are in contact"),
        "limit": told(or_null(COUNT), "at most so many pieces; null: all"),
    }
    fields = {
        "pieces": told(list_of(record(schemas_of(ContactPiece))), "earliest first"),
        "undecided_count": told(COUNT, "pieces of which neither contact nor freedom is proven"),
        "undecided_total": told(AMOUNT, "s; how long these are, all together"),
        "complete_until": told(AMOUNT, "s; the pieces say all up to then"),
        "unresolved_after": told(
            or_null(AMOUNT), "s; where a limit of the search was reached; null: nowhere"
        ),
    }
    solid = told(FLAG, "whether a body inside the other counts as contact")
    return pair_document(
        "intervals", record(fields), solid=solid, asked=record(asked), stats=record(STATS_FIELDS)
    )
