"""Schemas of what is said of free ranges."""

from __future__ import annotations

from obbcli.answers.free_range import FreeRange
from obbcli.report.schema.shared import STATS_FIELDS, pair_document
from obbcli.report.schema.words import (
    AMOUNT,
    FLAG,
    NUMBER,
    Schema,
    documented,
    or_null,
    record,
    ref,
    told,
    tuple_of,
)


def range() -> Schema:  # noqa: A001  # named as the document is
    """Return the schema of `obbtree range`."""
    fields = documented(
        FreeRange,
        {
            "free": or_null(tuple_of(NUMBER, AMOUNT)),
            "complete": FLAG,
            "before": ref("contact"),
            "after": ref("contact"),
        },
    )
    solid = told(FLAG, "whether a body inside the other counts as contact")
    return pair_document("range", record(fields), solid=solid, stats=record(STATS_FIELDS))
