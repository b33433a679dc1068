"""Schema of what `obbtree view` says of its pictures."""

from __future__ import annotations

from obbcli.report.schema.overlaps import SHARED_SOLID, overlap_document
from obbcli.report.schema.relations import overlap_fields
from obbcli.report.schema.shared import (
    CONTACT_FIELDS,
    PART_NAMES,
    SECONDS,
    document,
    pair_document,
)
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
    word_of,
)
from obbcli.report.view import Choice, Output
from obbcli.view.contact import Moment

_FILE = documented(
    Output,
    {
        "file": TEXT,
        "format": word_of(("png", "html", "glb")),
        "byte_count": COUNT,
        "size": or_null(list_of(COUNT, 2)),
    },
)
_MARKS = ("point", "normal", "triangle_a", "triangle_b")


def view() -> Schema:
    """Return the schema of `obbtree view`: of the boxes of a tree, a contact, or an overlap."""
    return {"oneOf": [_boxes(), _contact(), _overlap()]}


def _boxes() -> Schema:
    of_depth = record({"depth": COUNT, "box_count": COUNT})
    drawn = _FILE | {
        "what": {"const": "boxes"},
        **documented(Choice, {"level": or_null(COUNT), "node": or_null(COUNT)}),
        "triangle_count": told(COUNT, "of the mesh"),
        "box_count": told(COUNT, "how many were drawn"),
        "depths": told(list_of(of_depth), "how many at each depth; 0 is the root"),
        "nodes": told(list_of(COUNT), "which boxes: their rows in the tree, as of --node"),
    }
    return document(
        "view",
        record({"a": ref("source")}),
        result=record({"drawn": record(drawn)}),
        stats=record({"seconds": SECONDS}),
    )


def _contact() -> Schema:
    drawn = _FILE | {
        "what": {"const": "contact"},
        **documented(Moment, {"time": AMOUNT, "ghost_times": list_of(AMOUNT)}),
        "ghosts_of": told(list_of(word_of(("a", "b"))), "bodies that move by then"),
        "marks": told(list_of(word_of(_MARKS)), "fields of the answer that are marked"),
    }
    return pair_document(
        "view",
        record(CONTACT_FIELDS | PART_NAMES | {"drawn": record(drawn)}, optional=PART_NAMES),
        solid=told(FLAG, "whether a body inside the other counts as contact"),
    )


def _overlap() -> Schema:
    drawn = record(_FILE | {"what": {"const": "overlap"}, **SHARED_SOLID})
    return overlap_document("view", record(overlap_fields() | {"drawn": drawn}))
